"""The rank test (11): where the virtual output has a well-defined relative degree.

The test is whether D = J g_v, with J = dh/dq of the controlled output, has rank p. Two numbers tell
how far it is from failing; both are 0 exactly where it fails:

    σ_min / σ_max    without a unit: 1 if all directions are alike,
    σ_min            in (m/s²)/(N m): the acceleration of the output that torques of norm 1 give it
                     in the direction in which they give it least.

The maps are for the robot at rest, in the pose of `Robot.rest`, with flexible links straight.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import conditioning, decoupling_matrix

IN_REACH = 1e-9
"""Smallest `Robot.margin` of a point that counts as in reach."""
CELLS = 64
"""Cells of a grid in either direction."""
CHUNK = 256
"""Points evaluated in one call, so that other threads are not kept waiting."""


@dataclass(frozen=True, slots=True, eq=False)
class RankGrid:
    """σ_min over a rectangle of the path's plane.

    Attributes:
        low, high: opposite corners, shape (2,), [m].
        values: at the centres of the cells, shape (rows, columns), [(m/s²)/(N m)]: the first
            coordinate grows with the column, the second one with the row. NaN out of reach.
    """

    low: Array
    high: Array
    values: Array

    @property
    def centres(self) -> Array:
        """Centres of the cells, shape (rows, columns, 2), [m]."""
        rows, columns = self.values.shape
        return cell_centres(self.low, self.high, (columns, rows))


@lru_cache(maxsize=16)
def _matrix(robot: Robot) -> ca.Function:
    """J g_v as a function, built once for each robot."""
    return decoupling_matrix(robot.system)


def decoupling_matrices(
    robot: Robot, parameters: Parameters, q: Array, by_model: bool = False
) -> Array:
    """D = J g_v at several configurations, shape (k, n) -> (k, p, m), [(m/s²)/(N m)].

    Args:
        q: shape (k, n).
        by_model: of the controller's model, not of the plant.

    Source: eq. (11).
    """
    system, function = robot.system, _matrix(robot)
    numbers = robot.model(parameters) if by_model else robot.plant(parameters)
    found = np.empty((len(q), system.p, system.m))
    for begin in range(0, len(q), CHUNK):
        some = q[begin : begin + CHUNK]
        columns = np.array(function(some.T, numbers)).reshape(system.p, len(some), system.m)
        found[begin : begin + CHUNK] = columns.transpose(1, 0, 2)
    return found


def rank_number(robot: Robot, parameters: Parameters, q: Array, by_model: bool = False) -> float:
    """σ_min / σ_max of J g_v at one configuration, in [0, 1].

    Args:
        q: shape (n,).
        by_model: of the controller's model, not of the plant.

    Source: eq. (11).
    """
    matrices = decoupling_matrices(robot, parameters, q[None], by_model)
    return float(conditioning(matrices)[0])


def least_gain(matrices: Array) -> Array:
    """σ_min of matrices, shape (..., p, m) -> (...); 0 where rank is lost.

    Source: the rank test (11) as a number with a unit.
    """
    return np.asarray(np.linalg.svd(matrices, compute_uv=False), dtype=float)[..., -1]


def rank_map(robot: Robot, parameters: Parameters, z: Array) -> Array:
    """σ_min / σ_max with the end-point at rest at points of the path's plane; NaN out of reach.

    Args:
        parameters: of the plant.
        z: planar coordinates, shape (..., 2), [m].

    Returns:
        Shape (...,), in [0, 1].

    Source: eq. (11).
    """
    inside, matrices = _in_reach(robot, parameters, z)
    values = np.full(inside.shape, np.nan)
    values[inside] = conditioning(matrices)
    return values


def rank_grid(
    robot: Robot, parameters: Parameters, low: Array, high: Array, cells: int = CELLS
) -> RankGrid:
    """σ_min on a grid of end-points in a rectangle of the path's plane.

    Args:
        parameters: of the plant.
        low, high: opposite corners, shape (2,), [m].
        cells: in either direction.

    Source: eq. (11); figure 5.8 of [15], which the paper quotes in section IV.B.
    """
    inside, matrices = _in_reach(robot, parameters, cell_centres(low, high, (cells, cells)))
    values = np.full(inside.shape, np.nan)
    values[inside] = least_gain(matrices)
    return RankGrid(low, high, values)


def section_map(robot: Robot, parameters: Parameters, y: Array) -> Array:
    """σ_min with the end-point at rest at points of the output space; NaN out of reach.

    Args:
        parameters: of the plant.
        y: shape (..., p), [m].

    Returns:
        Shape (...,), [(m/s²)/(N m)].

    Source: eq. (11).
    """
    inside = robot.margin_at(y) > IN_REACH
    values = np.full(inside.shape, np.nan)
    values[inside] = least_gain(decoupling_matrices(robot, parameters, robot.rest(y[inside])))
    return values


def cell_centres(low: Array, high: Array, shape: tuple[int, int]) -> Array:
    """Centres of the cells of a rectangle, shape (rows, columns, 2), [m].

    Args:
        low, high: opposite corners, shape (2,), [m].
        shape: numbers of columns and rows.
    """
    sides: list[Array] = [
        low[i] + (high[i] - low[i]) * (np.arange(shape[i]) + 0.5) / shape[i] for i in range(2)
    ]
    return np.stack(np.meshgrid(*sides), axis=-1)


def _in_reach(robot: Robot, parameters: Parameters, z: Array) -> tuple[NDArray[np.bool_], Array]:
    """Which points z, (..., 2), are in reach, (...), and D at those, (k, p, m)."""
    inside = (robot.margin(z.reshape(-1, 2)) > IN_REACH).reshape(z.shape[:-1])
    q = robot.rest(robot.frame.lift(z[inside]))
    return inside, decoupling_matrices(robot, parameters, q)
