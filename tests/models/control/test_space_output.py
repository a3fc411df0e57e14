"""θ, ξ1 and ξ3 of space curves along random motions, against finite differences."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.control.space_output import normals, space_output
from onpath.models.control.virtual_output import virtual_output
from onpath.models.paths.curves import (
    HARMONICS,
    SPACE_TABLE_SHAPE,
    Curve,
    chebyshev_curve,
    circle,
    fourier,
)
from onpath.models.paths.frames import LevelPlane, Space
from onpath.models.paths.projection import LocalCurve, basis
from onpath.models.paths.space_curves import in_space, saddle

H = 1e-3  # [s], step of the finite differences
FRAME = Space()


def space_curve(seed: int, closed: bool = True) -> Curve:
    """A space curve about y = 0 whose plan view has no cusp, by its seed."""
    rng = np.random.default_rng(seed)
    if not closed:
        terms = 4e-3 * rng.normal(size=(6, 3)) / np.arange(1, 7)[:, None] ** 2
        terms[1, 0] += 0.06
        return chebyshev_curve(terms)
    falling = 2e-3 / np.arange(1, HARMONICS + 1)[:, None] ** 2
    a, b = falling * rng.normal(size=(2, HARMONICS, 3))
    a[0, 0] += rng.uniform(0.03, 0.06)
    b[0, 1] += rng.uniform(0.03, 0.06)
    a[:3, 2] += 0.012 * rng.normal(size=3)
    return fourier(5e-3 * rng.normal(size=3), a, b)


def local_at(theta: ca.SX, closed: bool, table: ca.SX) -> LocalCurve:
    return LocalCurve.from_values(theta, closed, table @ basis(theta, closed))


def coordinates(closed: bool = True) -> ca.Function:
    """(theta_0, y, y', y'', table) -> (theta, xi), two derivatives, y'' from them."""
    theta, table = ca.SX.sym("t"), ca.SX.sym("table", *SPACE_TABLE_SHAPE)
    y, rate, acceleration = (ca.SX.sym(name, 3) for name in ("y", "dy", "ddy"))
    local = local_at(theta, closed, table)
    for _ in range(4):  # converge from far
        local = local_at(local.project(y).theta, closed, table)
    output = space_output(local, FRAME, y, rate)
    second = ca.inv(output.inverse) @ acceleration + output.offset
    places = ca.vertcat(output.theta, output.xi)
    rates = ca.vertcat(output.theta_rate, output.xi_rate)
    back = output.acceleration(second[0], second[1:])
    inputs = [theta, y, rate, acceleration, table]
    return ca.Function("coordinates", inputs, [places, rates, second, back])


def motion(rng: np.random.Generator, curve: Curve) -> Callable[[float], Array]:
    """A smooth motion of y near a random point of the curve, as a function of time."""
    start = curve.at(rng.uniform(-np.pi, np.pi, 1))[0]
    amplitude = 0.003 * rng.normal(size=(3, 3))
    frequency, phase = rng.uniform(2, 12, 3), rng.uniform(0, 6, 3)
    return lambda t: start + np.sin(frequency * t + phase) @ amplitude


def differences(f: Callable[[float], Array]) -> tuple[Array, Array, Array]:
    """f, f', f'' at 0, to fourth order."""
    far, near, here, after, beyond = (f(k * H) for k in (-2, -1, 0, 1, 2))
    first = (far - 8 * near + 8 * after - beyond) / (12 * H)
    second = (-far + 16 * near - 30 * here + 16 * after - beyond) / (12 * H**2)
    return here, first, second


def table_of(curve: Curve) -> Array:
    return curve.table().reshape(SPACE_TABLE_SHAPE, order="F")


@pytest.mark.parametrize("closed", [True, False])
def test_rates_and_accelerations_are_derivatives(closed: bool) -> None:
    function, still, largest = coordinates(closed), np.zeros(3), 0.0
    for seed in range(60):
        curve = space_curve(seed, closed)
        table, path = table_of(curve), motion(np.random.default_rng(seed), curve)
        y, rate, acceleration = differences(path)
        guess = curve.nearest(y[None])[0][0]
        if not closed and abs(guess) > 2.8:
            continue  # at the ends the curve continues with another curvature

        def at(
            t: float,
            guess: float = guess,
            path: Callable[[float], Array] = path,
            table: Array = table,
        ) -> Array:
            return function(guess, path(t), still, still, table)[0].full().ravel()

        places, first, second = differences(at)
        given = function(guess, y, rate, acceleration, table)
        got, got_first, got_second, back = (column.full().ravel() for column in given)
        assert got == pytest.approx(places, abs=1e-14)
        assert got_first == pytest.approx(first, rel=1e-5, abs=1e-5)
        assert got_second == pytest.approx(second, rel=1e-4, abs=2e-3)
        assert back == pytest.approx(acceleration, abs=1e-10)
        largest = max(largest, float(np.abs(second).max()))
    assert largest > 10.0


def test_xi_is_the_distance_in_the_frame_of_the_normals() -> None:
    """|ξ| = |y - σ|, ξ1 to the left in the plan view, ξ3 on the upper side."""
    function, still, rng = coordinates(), np.zeros(3), np.random.default_rng(1)
    for seed in range(60):
        curve = space_curve(seed)
        theta = rng.uniform(-np.pi, np.pi)
        tangent = curve.at(np.array(theta), 1)
        tangent /= np.linalg.norm(tangent)
        left = np.array([-tangent[1], tangent[0], 0.0]) / np.hypot(tangent[0], tangent[1])
        up = np.cross(tangent, left)
        assert up[2] > 0
        xi = rng.uniform(-0.005, 0.005, 2)
        y = curve.at(np.array(theta)) + xi[0] * left + xi[1] * up
        places = function(theta, y, still, still, table_of(curve))[0].full().ravel()
        assert places == pytest.approx([theta, *xi], abs=1e-9)


def test_the_normals_return_to_themselves_and_turn_as_stated() -> None:
    theta, table = ca.SX.sym("t"), ca.SX.sym("table", *SPACE_TABLE_SHAPE)
    n = normals(local_at(theta, True, table))
    outputs = [ca.horzcat(n.tangent, n.left, n.up), ca.horzcat(*n.bends, n.twist, n.twist_rate)]
    frame = ca.Function("frame", [theta, table], outputs)
    h, turned = 1e-4, 0.0
    for seed in range(20):
        own = table_of(space_curve(seed))
        first, last = (frame(end, own)[0].full() for end in (-np.pi, np.pi))
        assert last == pytest.approx(first, abs=1e-12)
        for at in np.linspace(-3, 3, 7):
            here, numbers = (x.full() for x in frame(at, own))
            assert here.T @ here == pytest.approx(np.eye(3), abs=1e-12)
            (before, low), (after, high) = (frame(at + s * h, own) for s in (-1, 1))
            change = (after.full() - before.full()) / (2 * h)
            b1, b2, twist, twist_rate = numbers[0]
            tangent, left, up = here.T
            assert change[:, 1] == pytest.approx(-b1 * tangent + twist * up, abs=1e-5)
            assert change[:, 2] == pytest.approx(-b2 * tangent - twist * left, abs=1e-5)
            slope = (high.full()[0, 2] - low.full()[0, 2]) / (2 * h)
            assert slope == pytest.approx(twist_rate, abs=1e-4)
            turned = max(turned, abs(twist))
    assert turned > 0.1


def test_a_planar_path_has_the_same_output_in_space() -> None:
    """θ, ξ and y'' are those of the level plane: signed distance and height."""
    planar, rng = circle(0.05), np.random.default_rng(2)
    curve = in_space(planar)
    theta, table, flat = (
        ca.SX.sym("t"),
        ca.SX.sym("table", *SPACE_TABLE_SHAPE),
        ca.SX.sym("flat", 8, SPACE_TABLE_SHAPE[1]),
    )
    y, rate, wanted = (ca.SX.sym(name, 3) for name in ("y", "dy", "wanted"))
    outputs = (
        space_output(local_at(theta, True, table).project(y), FRAME, y, rate),
        virtual_output(local_at(theta, True, flat).project(y[:2]), LevelPlane(), None, y, rate),
    )
    columns = [
        ca.vertcat(o.theta, o.theta_rate, o.xi, o.xi_rate, o.acceleration(wanted[0], wanted[1:]))
        for o in outputs
    ]
    both = ca.Function("both", [theta, y, rate, wanted, table, flat], columns)
    flat_table = planar.table().reshape(8, -1, order="F")
    for at in rng.uniform(-np.pi, np.pi, 20):
        near = curve.at(np.array(at)) + rng.uniform(-4e-3, 4e-3, 3)
        numbers = rng.normal(size=(2, 3))
        in_r3, in_plane = both(at, near, *numbers, table_of(curve), flat_table)
        assert in_r3.full() == pytest.approx(in_plane.full(), rel=1e-9, abs=1e-9)


def test_over_a_circle_the_saddle_lies_on_a_hyperbolic_paraboloid() -> None:
    radius, rise = 0.05, 0.02
    x, y, height = saddle(circle(radius), rise).at(np.linspace(-3, 3, 50)).T
    assert height == pytest.approx(rise * (x**2 - y**2) / radius**2, abs=1e-15)
    assert np.hypot(x, y) == pytest.approx(radius)
