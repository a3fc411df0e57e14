"""The fastest speed along a path keeps the torque limits, and nothing near it is faster."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.control.fastest_speed import (
    COEFFICIENTS,
    LEAST,
    MOST,
    SHARE,
    basis,
    fastest_speed,
)
from onpath.models.control.speed_limit import path_torques
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import Robot
from tests.support.cases import drawn

PATHS = ("circle", "ellipse", "rounded square", "clover", "segment", "figure of eight")
SETTLED = 0.05  # of the torque limit, what the polynomial exceeds its share by between the points


def made(name: str) -> tuple[Robot, tuple[float, ...]]:
    parameters = ROBOTS[name].parameters()
    robot = ROBOTS[name].make(parameters)
    return robot, tuple(robot.model(parameters).tolist())


def share_of(
    robot: Robot, model: tuple[float, ...], curve: Curve, found: Array, sign: float, limit: float
) -> float:
    """The largest torque on the path, as a share of the limit."""
    theta = np.linspace(-np.pi, np.pi, 701)
    value, slope = basis(theta, curve.closed)
    rate = sign * np.sqrt(np.maximum(value @ found, 0))
    u = np.abs(path_torques(robot, model, curve, theta, rate, slope @ found / 2))
    return float((u.max(1) / np.array(robot.system.strength)).max() / limit)


def time_of(curve: Curve, found: Array) -> float:
    """The time from end to end or round the path, [s]."""
    theta = np.pi * np.sin(np.linspace(-np.pi, np.pi, 2001)[1:-1] / 2)
    x = basis(theta, curve.closed)[0] @ found
    return float(np.trapezoid(1 / np.sqrt(np.maximum(x, 1e-9)), theta))


@pytest.mark.thorough
@settings(max_examples=25, deadline=None)
@given(
    st.sampled_from(("five_bar", "two_link_arm")),
    st.sampled_from(PATHS),
    st.floats(0.1, 5),
    st.sampled_from((-1.0, 1.0)),
)
def test_the_torques_stay_below_their_limit_all_along(
    name: str, path: str, limit: float, sign: float
) -> None:
    (robot, model), curve = made(name), presets()[path].curve
    found = fastest_speed(robot, model, curve, limit, sign < 0)
    if not found.any():  # it cannot even rest there
        assert share_of(robot, model, curve, found, sign, limit) > SHARE
        return
    assert share_of(robot, model, curve, found, sign, limit) < SHARE + SETTLED
    rates = np.sqrt(np.maximum(basis(np.linspace(-np.pi, np.pi, 301), curve.closed)[0] @ found, 0))
    assert rates.max() < 1.01 * MOST
    assert not curve.closed or rates.min() > LEAST / 2


@pytest.mark.thorough
@pytest.mark.parametrize("path", drawn(["circle", "clover", "segment"], 1))
def test_no_speed_beside_it_that_keeps_its_torques_is_faster(path: str) -> None:
    """The times of the feasible speeds are a convex function on a convex set but for friction, so
    that to look nearby, in many directions, is to look everywhere."""
    (robot, model), curve = made("five_bar"), presets()[path].curve
    found, rng = fastest_speed(robot, model, curve, 0.5, False), np.random.default_rng(4)
    used, least = share_of(robot, model, curve, found, 1.0, 0.5), time_of(curve, found)
    tried = 0
    for _ in range(300):
        step = rng.normal(size=COEFFICIENTS) / (1 + np.arange(COEFFICIENTS)) ** 1.5
        other = found + rng.uniform(0.001, 0.05) * abs(found[0]) * step / np.linalg.norm(step)
        if share_of(robot, model, curve, other, 1.0, 0.5) <= used:
            tried += 1
            assert time_of(curve, other) > (1 - 1e-3) * least
    slower = 0.9 * found
    assert share_of(robot, model, curve, slower, 1.0, 0.5) <= used
    assert time_of(curve, slower) > least


def test_friction_makes_it_slower_and_the_direction_matters() -> None:
    robot, model = made("five_bar")
    curve, names = presets()["ellipse"].curve, robot.system.parameter_names
    free = tuple(0.0 if name.startswith("b") else x for name, x in zip(names, model, strict=True))
    assert free != model
    times = [
        time_of(curve, fastest_speed(robot, numbers, curve, 0.3, False))
        for numbers in (free, model)
    ]
    assert times[0] < 0.99 * times[1]
    ahead, back = (fastest_speed(robot, model, curve, 0.3, each) for each in (False, True))
    assert not np.allclose(ahead, back)


def test_a_robot_that_cannot_rest_has_none() -> None:
    robot, model = made("spatial_arm")
    assert not fastest_speed(robot, model, presets()["circle"].curve, 0.3, False).any()
