"""The rank test (11) over the workspace: where the virtual output has a relative degree.

The test asks whether dh/dq g_v(q) has rank p; as a number it is that matrix's smallest over its
largest singular value, 0 where the controllers cannot work.
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
    return decoupling_matrix(robot.system)


def rank_number(robot: Robot, parameters: Parameters, q: Array) -> float:
    """The test at one configuration, shape (n,), in [0, 1]. Source: eq. (11)."""
    matrix = np.array(_matrix(robot)(q, robot.plant(parameters)))
    return float(conditioning(matrix))


def rank_map(robot: Robot, parameters: Parameters, z: Array) -> Array:
    """The test with the end-point at rest at points of the path's plane; NaN out of reach.

    Args:
        z: planar coordinates, shape (..., 2), [m].

    Returns:
        shape (...,), in [0, 1].

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
