"""The rank test falls to zero where, and only where, the robot is singular."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.control.rank_test import (
    decoupling_matrices,
    least_gain,
    rank_grid,
    rank_map,
    rank_number,
)
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS
from onpath.models.systems.five_bar_robot import rigid_five_bar
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import conditioning

ROBOT, DEFAULTS = rigid_five_bar(), FIVE_BAR.parameters()


@pytest.mark.parametrize("angle", [0.3, 1.1, 2.4])
def test_zero_exactly_where_the_links_are_collinear(angle: float) -> None:
    for turns in (0.0, np.pi):
        collapsed = np.array([angle, angle + turns])
        assert rank_number(ROBOT, DEFAULTS, collapsed) < 1e-12
        assert rank_number(ROBOT, DEFAULTS, collapsed + [0.0, 0.2]) > 0.02


def test_map_is_positive_inside_and_falls_to_zero_at_the_rim() -> None:
    base = np.array([-0.2, -0.2])  # the base pivot in output coordinates
    direction = np.array([np.cos(0.9), np.sin(0.9)])
    radii = np.array([0.05, 0.15, 0.28, 0.35, 0.39, 0.3999, 0.41])
    values = rank_map(ROBOT, DEFAULTS, base + radii[:, None] * direction)
    assert np.isnan(values[-1])
    assert np.all(values[:-1] > 0)
    assert np.all(np.diff(values[2:-1]) < 0)
    assert values[-2] < 0.05 * values[2]


def test_number_does_not_depend_on_units() -> None:
    matrix = np.array([[3.0, 1.0], [0.5, 0.2]])
    assert np.isclose(conditioning(matrix), conditioning(1e3 * matrix), rtol=1e-12)
    assert 0 < conditioning(matrix) < conditioning(np.eye(2)) == 1
    assert conditioning(np.zeros((2, 2))) == 0


# The map, against a Jacobian by finite differences of the inverse's own end-point.

TIP = FlexibleParameters(alpha=1.0)  # whose controlled output is the actual end-point
CASES = {name: entry.parameters() for name, entry in ROBOTS.items()} | {FLEXIBLE.name: TIP}
EVERY = pytest.mark.parametrize("name", CASES)


def jacobian(robot: Robot, q: Array) -> Array:
    """dh/dq by central differences of the end-point, (p, n)."""
    steps = 1e-6 * np.eye(len(q))
    ends = [(robot.endpoint(q + d) - robot.endpoint(q - d)) / 2e-6 for d in steps]
    return np.stack(ends, axis=1)


def own_matrix(robot: Robot, parameters: Parameters, q: Array) -> Array:
    """J M⁻¹ B, with M alone from the model and B = (I, 0)."""
    mass = np.array(robot.system.function("mass")(q, 0 * q, robot.plant(parameters)))
    return jacobian(robot, q) @ np.linalg.solve(mass, np.eye(len(q))[:, : robot.system.m])


@EVERY
def test_grid_is_the_least_singular_value_of_the_matrix_of_the_theorem(name: str) -> None:
    parameters = CASES[name]
    robot = ROBOTS[name].make(parameters)
    grid = rank_grid(robot, parameters, np.array([-0.3, -0.35]), np.array([0.2, 0.3]), cells=9)
    inside = np.isfinite(grid.values)
    assert inside.sum() > 20
    for z, value in zip(grid.centres[inside], grid.values[inside], strict=True):
        q = robot.rest(robot.frame.lift(z))
        least = np.linalg.svd(own_matrix(robot, parameters, q), compute_uv=False)[-1]
        assert value == pytest.approx(least, rel=1e-5, abs=1e-7)


@EVERY
def test_grid_ends_where_the_reach_does(name: str) -> None:
    parameters = CASES[name]
    robot = ROBOTS[name].make(parameters)
    grid = rank_grid(robot, parameters, np.array([-0.7, -0.9]), np.array([0.5, 0.6]))
    far = np.linalg.norm(robot.place(robot.frame.lift(grid.centres)), axis=-1)
    inner, outer = robot.reach
    assert ((far > inner) & (far < outer) == np.isfinite(grid.values)).all()


@EVERY
def test_towards_the_limit_of_the_reach_it_falls_to_zero_as_the_jacobian_does(name: str) -> None:
    parameters = CASES[name]
    robot = ROBOTS[name].make(parameters)
    base = robot.frame.planar(robot.unplace(np.zeros(3)))
    ahead = robot.frame.lift(base + [0.0, 0.05])  # where a ray upwards, or aside, begins
    reach, ray = robot.reach[1], robot.frame.lift(base + [0.0, 1.05]) - ahead
    lengths = np.linspace(0.0, 2.0, 4001)
    far = np.linalg.norm(robot.place(ahead + lengths[:, None] * ray), axis=1)
    limit = float(np.interp(reach, far, lengths))
    values, sizes = list[float](), list[float]()
    for short in (0.1, 1e-2, 1e-4, 1e-6):
        q = robot.rest(ahead + (limit - short) * ray)
        values.append(float(least_gain(decoupling_matrices(robot, parameters, q[None]))[0]))
        sizes.append(np.linalg.svd(jacobian(robot, q)[:, : robot.system.m], compute_uv=False)[-1])
    assert values[-1] < 0.02 * values[0] and sizes[-1] < 0.02 * sizes[0]
    assert (np.diff(values[1:]) < 0).all()


@EVERY
def test_at_home_it_is_large(name: str) -> None:
    parameters = CASES[name]
    robot = ROBOTS[name].make(parameters)
    low, high = np.array([-0.2, -0.2]), np.array([0.15, 0.15])
    home = rank_grid(robot, parameters, -np.full(2, 1e-3), np.full(2, 1e-3), cells=1).values
    largest = np.nanmax(rank_grid(robot, parameters, low, high).values)
    assert home.item() > (0.2 if name == FLEXIBLE.name else 0.5) * largest


def test_above_its_base_the_spatial_arm_loses_rank() -> None:
    entry = ROBOTS["spatial_arm"]
    robot, parameters = entry.make(entry.parameters()), entry.parameters()
    axis = robot.frame.planar(robot.unplace(np.zeros(3)))
    away = np.array([1e-1, 1e-2, 1e-3, 1e-4])
    q = robot.rest(robot.frame.lift(axis + away[:, None] * [0.8, 0.6]))
    values = least_gain(decoupling_matrices(robot, parameters, q))
    assert values[0] > 1.0
    assert values[1:] / values[1] == pytest.approx(away[1:] / away[1], rel=0.05)


@pytest.mark.parametrize(("alpha", "least", "most"), [(0.5, 0.005, 0.03), (1.0, 0.5, 0.8)])
def test_a_flexible_link_loses_rank_inside_the_workspace(
    alpha: float, least: float, most: float
) -> None:
    """Where the determinant changes its sign: the remark of section IV.B on figure 5.8 of [15].

    With half of the deflection in the output this happens only near the extremities, in 1 to 2 % of
    a vertical section; with the tip itself in two thirds of it.
    """
    parameters = FlexibleParameters(alpha=alpha)
    robot = FLEXIBLE.make(parameters)
    r, height = np.meshgrid(np.linspace(0.02, 0.8, 150), np.linspace(-0.9, 0.45, 150))
    y = np.stack([r, 0 * r, height], axis=-1).reshape(-1, 3)
    far = np.linalg.norm(robot.place(y), axis=1)
    y = y[(far > robot.reach[0] + 1e-4) & (far < robot.reach[1] - 1e-4)]
    signs = np.linalg.det(decoupling_matrices(robot, parameters, robot.rest(y))) < 0
    assert least < signs.mean() < most
    if alpha < 1:  # below the robot, near the axis of the waist
        assert y[signs][:, 0].max() < 0.1 and y[signs][:, 2].max() < -0.45
    one, other = y[signs][0], y[~signs][len(y) // 4]
    along = one + np.linspace(0.0, 1.0, 2001)[:, None] * (other - one)
    far = np.linalg.norm(robot.place(along), axis=1)
    along = along[(far > robot.reach[0]) & (far < robot.reach[1])]
    values = least_gain(decoupling_matrices(robot, parameters, robot.rest(along)))
    assert values.min() < 0.01 * values.max()
