"""The rank test (11): where the virtual output has a well-defined relative degree.

The test asks whether J g_v, with J = dh/dq, has rank p. As a number it is σ_min / σ_max, the ratio
of the smallest to the largest singular value: 1 at best, and 0 where the control laws do not exist.
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import conditioning, decoupling_matrix


@lru_cache(maxsize=16)
def _matrix(robot: Robot) -> ca.Function:
    """J g_v as a function, built once for each robot."""
    return decoupling_matrix(robot.system)


def rank_number(robot: Robot, parameters: Parameters, q: Array) -> float:
    """σ_min / σ_max of J g_v at one configuration, in [0, 1].

    Args:
        parameters: of the plant.
        q: shape (n,).

    Source: eq. (11).
    """
    matrix = np.array(_matrix(robot)(q, robot.plant(parameters)))
    return float(conditioning(matrix))


def rank_map(robot: Robot, parameters: Parameters, z: Array) -> Array:
    """The rank number with the end-point at rest at points of the path's plane; NaN out of reach.

    Args:
        parameters: of the plant.
        z: planar coordinates, shape (..., 2), [m].

    Returns:
        Shape (...,), in [0, 1].

    Source: eq. (11).
    """
    points = z.reshape(-1, 2)
    values = np.full(len(points), np.nan)
    for i, point in enumerate(points):
        try:
            q = robot.rest(robot.frame.lift(point))
        except ValueError:
            continue
        values[i] = rank_number(robot, parameters, q)
    return values.reshape(z.shape[:-1])
