"""Obstacles in the path's plane: a one-sided wall, and the directions in which a brake acts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import brake_at
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import Frame
from onpath.models.systems.forces import wall
from onpath.models.systems.parameter_specs import out_of_range
from onpath.models.systems.robots import Robot

ALONG = "along"
DIRECTIONS = (ALONG, "across", "both")
"""Directions in which a brake may act: the path's tangent, across it in its plane, or both."""
FARTHEST = 0.4  # [m], from the middle of the path's plane, along each axis


def in_plane(frame: Frame, z: Array) -> Array:
    """A vector of the path's plane, (2,), as a unit vector of the output space, (p,)."""
    vector = frame.lift(z) - frame.lift(np.zeros(2))
    return vector / np.linalg.norm(vector)


def brake_in(
    robot: Robot, curve: Curve, y: Array, theta: float, direction: str
) -> tuple[tuple[Array, Array], Array | None]:
    """`Push.hold` and `Push.hold_normal` of a brake that is applied at the end-point y.

    Args:
        y: shape (p,), [m].
        theta: of the closest point, at which the tangent is taken, [rad].
        direction: one of `DIRECTIONS`.
    """
    anchor, tangent = brake_at(robot, curve, y, theta)
    if direction == ALONG:
        return (anchor, tangent), None
    first = curve.at(np.array(theta), 1)
    normal = in_plane(robot.frame, np.array([-first[1], first[0]]))
    return ((anchor, normal), None) if direction == "across" else ((anchor, tangent), normal)


@dataclass(frozen=True, slots=True)
class Wall:
    """A straight wall of infinite length in the path's plane, solid on one side.

    Attributes:
        z1, z2: a point of its surface, [m].
        angle: of its normal, which points to the free side, with the first axis, [rad].

    Raises:
        CodedError: a number is out of range or not finite.
    """

    z1: float
    z2: float
    angle: float

    def __post_init__(self) -> None:
        for name, most in (("z1", FARTHEST), ("z2", FARTHEST), ("angle", 2 * np.pi)):
            value = getattr(self, name)
            if not -most <= value <= most:  # NaN fails too
                raise out_of_range(f"wall {name}", f"{value:g}", f"{-most:g}", f"{most:g}")

    @property
    def place(self) -> Array:
        """A point of its surface, shape (2,), [m]."""
        return np.array([self.z1, self.z2])

    @property
    def normal(self) -> Array:
        """Its unit normal, towards the free side, shape (2,)."""
        return np.array([np.cos(self.angle), np.sin(self.angle)])

    def lifted(self, frame: Frame) -> tuple[Array, Array]:
        """`Push.wall`: the point [m] and the unit normal in the output space, each shape (p,)."""
        return frame.lift(self.place), in_plane(frame, self.normal)


def wall_force(
    robot: Robot, plant: Array, q: Array, v: Array, lifted: tuple[Array, Array]
) -> float:
    """Magnitude of the force between an end-point and a wall, [N]; see `forces.wall`.

    Args:
        plant: the system's parameters, shape (k,).
        q, v: shape (n,).
        lifted: point and normal of the wall, see `Wall.lifted`.
    """
    place, normal = lifted
    return float(np.linalg.norm(_wall_force(robot)(q, v, plant, place, normal).full()))


@lru_cache(maxsize=64)
def _wall_force(robot: Robot) -> ca.Function:
    system = robot.system
    place, normal = ca.SX.sym("place", system.p), ca.SX.sym("normal", system.p)
    inputs = [system.q, system.v, system.parameters]
    y, y_rate = system.with_rate(system.output)(*inputs)
    force = wall(y, y_rate, place, normal, ca.SX(1), robot.grip.wall)
    return ca.Function("wall_force", [*inputs, place, normal], [force])
