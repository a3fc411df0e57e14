"""The mass that a hand feels at the end-point, which depends on the direction.

A force f on the end-point of a robot at rest, without motors, accelerates it by J M⁻¹ Jᵀ f. For a
force along a unit vector n, the acceleration along n is f / m(n), with the effective mass m(n) = 1
/ (nᵀ J M⁻¹ Jᵀ n). The points sqrt(m(n)) n are an ellipse.

Source: O. Khatib, Inertial properties in robotic manipulation, Int. J. Robotics Research 14 (1995).
"""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


def effective_masses(robot: Robot, q: Array, parameters: Parameters, directions: Array) -> Array:
    """Effective masses at a configuration in several directions of the path's plane, (k,), [kg].

    Args:
        q: shape (n,).
        directions: unit vectors of the plane, shape (k, 2).
    """
    frame = robot.frame
    lifted = frame.lift(directions) - frame.lift(np.zeros(2))
    mobility = mobility_of(robot)(q, robot.plant(parameters)).full()
    return 1.0 / np.einsum("ki,ij,kj->k", lifted, mobility, lifted)


@lru_cache(maxsize=16)
def mobility_of(robot: Robot) -> ca.Function:
    """The function (q, parameters) -> J M⁻¹ Jᵀ of the actual end-point, (p, p)."""
    system = robot.system
    jacobian = ca.jacobian(system.output, system.q)
    matrix = ca.densify(jacobian @ ca.solve(system.mass, jacobian.T))
    return ca.Function("mobility", [system.q, system.parameters], [matrix])
