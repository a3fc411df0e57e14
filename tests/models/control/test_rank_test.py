"""The rank test falls to zero where, and only where, the robot is singular."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.control.rank_test import (
    IN_REACH,
    decoupling_matrices,
    least_gain,
    rank_grid,
    rank_map,
    rank_number,
    section_map,
)
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.flexible_robot import LINKS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import conditioning
from tests.support.overhead_crane import ROBOT as CRANE

ROBOT, DEFAULTS = RIGID_FIVE_BAR, FIVE_BAR.parameters()


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


# The map, against a Jacobian by finite differences of the controlled output.

ALL = {**ROBOTS, CRANE.name: CRANE}
CASES = {name: entry.parameters() for name, entry in ALL.items()}
EVERY = pytest.mark.parametrize("name", CASES)


def controlled(robot: Robot, parameters: Parameters, q: Array) -> Array:
    """The controlled output at configurations, (..., n) -> (..., p)."""
    output = robot.system.function("controlled_output")
    rows = q.reshape(-1, robot.system.n).T
    return np.array(output(rows, 0 * rows, robot.plant(parameters))).T.reshape(*q.shape[:-1], -1)


def jacobian(robot: Robot, parameters: Parameters, q: Array) -> Array:
    """dy/dq by central differences of the controlled output, (p, n)."""
    ends = [
        controlled(robot, parameters, q + d) - controlled(robot, parameters, q - d)
        for d in 1e-6 * np.eye(len(q))
    ]
    return np.stack(ends, axis=1) / 2e-6


def own_matrix(robot: Robot, parameters: Parameters, q: Array) -> Array:
    """J M⁻¹ B, with M and B from the model."""
    parts = robot.system.function("mass", "actuation")(q, 0 * q, robot.plant(parameters))
    mass, actuation = (part.full() for part in parts)
    return jacobian(robot, parameters, q) @ np.linalg.solve(mass, actuation)


@EVERY
def test_grid_is_the_least_singular_value_of_the_matrix_of_the_theorem(name: str) -> None:
    parameters = CASES[name]
    robot = ALL[name].make(parameters)
    grid = rank_grid(robot, parameters, np.array([-0.3, -0.35]), np.array([0.2, 0.3]), cells=13)
    inside = np.isfinite(grid.values)
    assert inside.sum() > 20
    for z, value in zip(grid.centres[inside], grid.values[inside], strict=True):
        q = robot.rest(robot.frame.lift(z))
        least = np.linalg.svd(own_matrix(robot, parameters, q), compute_uv=False)[-1]
        assert value == pytest.approx(least, rel=1e-5, abs=1e-7)


@EVERY
def test_grid_ends_where_the_reach_does(name: str) -> None:
    """Where a robot moves about, the map has a number; beyond its reach, it has none.

    Slides may stand in their buffers, which are beyond it.
    """
    parameters, rng = CASES[name], np.random.default_rng(0)
    robot = ALL[name].make(parameters)
    home = robot.rest(robot.frame.lift(np.zeros(2)))
    q = rng.uniform(-1, 1, (400, robot.system.n)) * (np.arange(len(home)) < robot.system.m)
    q = home + rng.uniform(0.05, 1, (400, 1)) * q  # [rad], or [m] where a joint slides
    sound = [row for row in q if robot.fault(row[None], 0 * row[None], parameters) is None]
    reached = robot.endpoint(np.array(sound))
    if robot.system.ends is not None:
        reached = reached[robot.margin(robot.frame.planar(reached)) > 0]
    assert len(reached) > 50
    if robot.system.m == robot.system.p:  # a redundant one takes one of many poses, near its home
        assert np.isfinite(section_map(robot, parameters, reached)).all()
    way = rng.normal(size=(400, 3))
    way *= rng.uniform(1.001, 2.0, (400, 1)) * robot.reach / np.linalg.norm(way, axis=1)[:, None]
    if robot.system.p == 2:
        way = robot.position(robot.output_at(way))  # in the plane of its outputs
    beyond = robot.output_at(way)[np.linalg.norm(way, axis=1) > robot.reach]
    assert len(beyond) > 50
    assert np.isnan(section_map(robot, parameters, beyond)).all()
    z = robot.frame.planar(reached)
    z = z[(robot.margin(z) > IN_REACH)]
    low, high = z.min(axis=0), z.max(axis=0)
    grid = rank_grid(robot, parameters, low, high)
    assert (np.isfinite(grid.values) == (robot.margin(grid.centres) > IN_REACH)).all()


@pytest.mark.parametrize("name", [n for n in CASES if ALL[n].source is None])
def test_towards_the_limit_of_the_reach_it_falls_to_zero_as_the_jacobian_does(name: str) -> None:
    """On a ray from home to where the margin is 0, wherever the base is.

    The inverse of a chain is iterated, and ends before that.
    """
    parameters = CASES[name]
    robot = ALL[name].make(parameters)
    seen = 0
    for angle in np.linspace(0, 2 * np.pi, 12, endpoint=False):
        ray = np.array([np.cos(angle), np.sin(angle)])
        lengths = np.linspace(0.0, 2 * robot.reach, 801)
        out = np.flatnonzero(robot.margin(lengths[:, None] * ray) == 0)
        assert len(out)  # no robot reaches everywhere
        near, limit = lengths[out[0] - 1], lengths[out[0]]
        for _ in range(40):
            middle = (near + limit) / 2
            inside = robot.margin(middle * ray[None])[0] > 0
            near, limit = (middle, limit) if inside else (near, middle)
        short = near - np.array([0.05, 1e-6, 1e-10])
        q = robot.rest(robot.frame.lift(short[:, None] * ray))
        m = robot.system.m
        sizes = [np.linalg.svd(jacobian(robot, parameters, row)[:, :m])[1][-1] for row in q]
        if sizes[-1] > 0.02 * sizes[0]:
            continue  # at a limit of a joint's travel
        seen += 1
        values = least_gain(decoupling_matrices(robot, parameters, q))
        assert values[-1] < 0.02 * values[0] and (np.diff(values) < 0).all()
    assert seen or robot.regularity is not None or robot.system.m > robot.system.p


@EVERY
def test_at_home_it_is_large(name: str) -> None:
    parameters = CASES[name]
    robot = ALL[name].make(parameters)
    low, high = np.array([-0.2, -0.2]), np.array([0.15, 0.15])
    home = rank_grid(robot, parameters, -np.full(2, 1e-3), np.full(2, 1e-3), cells=1).values
    largest = np.nanmax(rank_grid(robot, parameters, low, high).values)
    assert home.item() > 0.5 * largest


def test_above_its_base_the_spatial_arm_loses_rank() -> None:
    entry = ROBOTS["spatial_arm"]
    robot, parameters = entry.make(entry.parameters()), entry.parameters()
    axis = robot.frame.planar(robot.output_at(np.zeros(3)))
    away = np.array([1e-1, 1e-2, 1e-3, 1e-4])
    q = robot.rest(robot.frame.lift(axis + away[:, None] * [0.8, 0.6]))
    values = least_gain(decoupling_matrices(robot, parameters, q))
    assert values[0] > 1.0
    assert values[1:] / values[1] == pytest.approx(away[1:] / away[1], rel=0.05)


@pytest.mark.parametrize(("alpha", "few", "most"), [(0.5, 0.005, 0.03), (1.0, 0.5, 0.8)])
def test_a_flexible_link_loses_rank_inside_the_workspace(
    alpha: float, few: float, most: float
) -> None:
    """Where the determinant changes its sign: the remark of section IV.B on figure 5.8 of [15].

    With half of the deflection in the output this happens only near the extremities, in 1 to 2 % of
    a vertical section; with the tip itself in two thirds of it.
    """
    parameters = FlexibleParameters(alpha=alpha)
    robot = FLEXIBLE.make(parameters)
    r, height = np.meshgrid(np.linspace(0.02, 0.8, 150), np.linspace(-0.9, 0.45, 150))
    y = np.stack([r, 0 * r, height], axis=-1).reshape(-1, 3)
    far = np.linalg.norm(robot.position(y), axis=1)
    least = abs(LINKS.link1 - LINKS.beam)
    y = y[(far > least + 1e-4) & (far < robot.reach - 1e-4)]
    signs = np.linalg.det(decoupling_matrices(robot, parameters, robot.rest(y))) < 0
    assert few < signs.mean() < most
    if alpha < 1:  # below the robot, near the axis of the waist
        assert y[signs][:, 0].max() < 0.1 and y[signs][:, 2].max() < -0.45
    one, other = y[signs][0], y[~signs][len(y) // 4]
    along = one + np.linspace(0.0, 1.0, 2001)[:, None] * (other - one)
    far = np.linalg.norm(robot.position(along), axis=1)
    along = along[(far > least) & (far < robot.reach)]
    values = least_gain(decoupling_matrices(robot, parameters, robot.rest(along)))
    assert values.min() < 0.01 * values.max()
