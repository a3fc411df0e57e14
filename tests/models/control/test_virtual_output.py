"""theta and lambda along random motions: rates and accelerations against finite differences."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.control.virtual_output import LevelSet, virtual_output
from onpath.models.paths.curves import TABLE_SHAPE, Curve, circle, ellipse
from onpath.models.paths.frames import Frame, Plane, SlantedPlane
from onpath.models.paths.projection import LocalCurve, basis

H = 1e-3  # [s], step of the finite differences


def coordinates(frame: Frame, level_set: bool) -> ca.Function:
    """(theta_0, y, y', y'', table, conic) -> (eta, xi), two derivatives, y'' from them."""
    theta, table, conic = ca.SX.sym("t"), ca.SX.sym("table", *TABLE_SHAPE), ca.SX.sym("conic", 6)
    y, rate, acceleration = (ca.SX.sym(name, frame.p) for name in ("y", "dy", "ddy"))
    local = LocalCurve.from_values(theta, True, table @ basis(theta, True))
    for _ in range(4):  # converge from far
        local = local.project(frame.split(y)[0])
        local = LocalCurve.from_values(local.theta, True, table @ basis(local.theta, True))
    level = LevelSet(conic[:2], conic[2:5], conic[5]) if level_set else None
    output = virtual_output(local, frame, level, y, rate)
    z_acceleration, zeta_acceleration = frame.split(acceleration, rate=True)
    second = ca.inv(output.inverse) @ z_acceleration + output.offset
    second = ca.vertcat(second, zeta_acceleration)
    places = ca.vertcat(output.theta, output.xi)
    rates = ca.vertcat(output.theta_rate, output.xi_rate)
    back = output.acceleration(second[0], second[1:])
    return ca.Function(
        "coordinates", [theta, y, rate, acceleration, table, conic], [places, rates, second, back]
    )


def motion(rng: np.random.Generator, curve: Curve, frame: Frame) -> Callable[[float], Array]:
    """A smooth motion of y near a random point of the curve, as a function of time."""
    start = curve.at(rng.uniform(-np.pi, np.pi, 1))[0]
    amplitude = 0.004 * rng.normal(size=(3, frame.p))
    frequency, phase = rng.uniform(2, 12, 3), rng.uniform(0, 6, 3)

    def at(t: float) -> Array:
        return frame.lift(start) + np.sin(frequency * t + phase) @ amplitude

    return at


def differences(f: Callable[[float], Array]) -> tuple[Array, Array, Array]:
    """f, f', f'' at 0, to fourth order."""
    far, near, here, after, beyond = (f(k * H) for k in (-2, -1, 0, 1, 2))
    first = (far - 8 * near + 8 * after - beyond) / (12 * H)
    second = (-far + 16 * near - 30 * here + 16 * after - beyond) / (12 * H**2)
    return here, first, second


CASES = [
    (Plane(), False, "random"),
    (Plane(), False, "circle"),
    (Plane(), True, "circle"),
    (Plane(), True, "ellipse"),
    (Plane(), True, "turned"),
    (SlantedPlane(), False, "random"),
    (SlantedPlane(), True, "circle"),
]


def check_rates(
    function: ca.Function, frame: Frame, curve: Curve, conic: Array, seed: int
) -> float:
    """Along one random motion; returns the largest acceleration met."""
    table = curve.table().reshape(TABLE_SHAPE, order="F")
    path = motion(np.random.default_rng(seed), curve, frame)
    y, rate, acceleration = differences(path)
    guess, still = curve.nearest(frame.planar(y))[0][0], np.zeros(frame.p)

    def at(t: float) -> Array:
        return function(guess, path(t), still, still, table, conic)[0].full().ravel()

    places, first, second = differences(at)
    given = function(guess, y, rate, acceleration, table, conic)
    got, got_first, got_second, back = (column.full().ravel() for column in given)
    assert got == pytest.approx(places, abs=1e-14)
    assert got_first == pytest.approx(first, rel=1e-5, abs=1e-5)
    assert got_second == pytest.approx(second, rel=1e-4, abs=1e-3)
    assert back == pytest.approx(acceleration, abs=1e-10)
    return float(np.abs(second).max())


@pytest.mark.parametrize("frame, level_set, name", CASES)
def test_rates_and_accelerations_are_derivatives(
    random_curve: Callable[[int], Curve], frame: Frame, level_set: bool, name: str
) -> None:
    function = coordinates(frame, level_set)
    turned = ellipse((0.06, 0.045), (0.003, 0.0), 0.6)
    fixed = {"circle": circle(0.05), "ellipse": ellipse((0.06, 0.045), (0.003, 0.0))}
    fixed["turned"] = turned
    largest = []
    for seed in range(60):
        curve = fixed.get(name) or random_curve(seed)
        conic = curve.conic() if level_set else None
        numbers = np.zeros(6) if conic is None else np.concatenate([*conic[:2], [conic[2]]])
        largest.append(check_rates(function, frame, curve, numbers, seed))
    assert max(largest) > 10.0


def test_signed_distance_is_the_distance_and_positive_on_the_left(
    random_curve: Callable[[int], Curve],
) -> None:
    function, still = coordinates(Plane(), False), np.zeros(2)
    for seed in range(60):
        curve, rng = random_curve(seed), np.random.default_rng(seed)
        theta = rng.uniform(-np.pi, np.pi)
        first = curve.at(np.array(theta), 1)
        left = np.array([-first[1], first[0]]) / np.linalg.norm(first)
        offset = rng.uniform(-0.008, 0.008)
        y = curve.at(np.array(theta)) + offset * left
        table = curve.table().reshape(TABLE_SHAPE, order="F")
        places = function(theta, y, still, still, table, np.zeros(6))[0].full().ravel()
        assert places == pytest.approx([theta, offset], abs=1e-9)


def test_level_set_is_the_paper_s_polynomial() -> None:
    function, still = coordinates(Plane(), True), np.zeros(2)
    table = circle(0.05).table().reshape(TABLE_SHAPE, order="F")
    conic = [0, 0, 1, 1, 0, 0.0025]
    for y in ((0.05, 0.0), (0.03, 0.04), (0.06, 0.01), (-0.02, 0.03)):
        xi = function(np.arctan2(y[1], y[0]), y, still, still, table, conic)[0][1]
        assert float(xi) == pytest.approx(y[0] ** 2 + y[1] ** 2 - 0.05**2, abs=1e-16)


def test_slanted_plane_measures_across_itself_and_splits_back() -> None:
    frame, rng = SlantedPlane(0.1, 0.5), np.random.default_rng(0)
    z = rng.normal(size=(20, 2))
    assert frame.planar(frame.lift(z)) == pytest.approx(z)
    y = ca.SX.sym("y", 3)
    for rate in (False, True):
        plane, residual = frame.split(y, rate)
        split = ca.Function("split", [y], [residual, frame.join(plane, residual, rate)])
        for point in rng.normal(size=(20, 3)):
            zeta, back = (part.full().ravel() for part in split(point))
            offset = 0.0 if rate else 0.5
            assert zeta == pytest.approx([point[0] - 0.1 * point[1] - offset])
            assert back == pytest.approx(point)
    assert Plane().lift(z) is z and Plane().planar(z) is z
