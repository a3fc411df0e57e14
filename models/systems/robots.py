"""What a robot is for the lab and the experiments: one interface around each model.

A module of this folder that has a `ROBOT`, a `RobotEntry`, is found by the catalogue: one file
with M, c, B, h, parameters and reach makes a robot. What bars and joints do not tell of its
drawing is in `drawing.py`, and every field there has a default.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.paths.frames import Frame, Plane
from onpath.models.systems.drawing import Drawing
from onpath.models.systems.forces import Grip
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.system import MechanicalSystem

FASTEST_JOINT = 100.0  # [rad/s], beyond it a run counts as diverged


@dataclass(frozen=True, slots=True)
class BalancedLinkage:
    """What the identification needs to know of a balanced five-bar.

    Attributes:
        l1, l4: lengths of links 1 and 4, [m].
        built: M11, M22, b1 and b2 as built, (SI).
    """

    l1: float
    l4: float
    built: Mapping[str, float]


class Robot(Protocol):
    """A model with all that surrounds it. Planar coordinates z are those of the path's plane."""

    @property
    def name(self) -> str:
        """As on the command line."""
        ...

    @property
    def label(self) -> str:
        """As shown."""
        ...

    @property
    def system(self) -> MechanicalSystem:
        """The equations."""
        ...

    @property
    def frame(self) -> Frame:
        """Where the path's plane lies."""
        ...

    @property
    def substeps(self) -> int:
        """Runge-Kutta steps per tick."""
        ...

    @property
    def grip(self) -> Grip:
        """How a hand and a brake take hold of its end-point."""
        ...

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """Names of q with units, for file headers."""
        ...

    def plant(self, parameters: Parameters) -> Array:
        """The system's parameters as they are, shape (k,)."""
        ...

    def model(self, parameters: Parameters) -> Array:
        """The system's parameters as the controller believes them, shape (k,)."""
        ...

    def rest(self, y: Array) -> Array:
        """A configuration at rest with the end-point at y, (p,) -> (n,).

        Raises:
            ValueError: out of reach.
        """
        ...

    def endpoint(self, q: Array) -> Array:
        """The actual end-point, (..., n) -> (..., p), [m]."""
        ...

    def margin(self, z: Array) -> Array:
        """How far points of the path's plane are from singular, (n, 2) -> (n,); 0: out of reach."""
        ...

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, str] | None:
        """First row at which a run is no longer to be believed, and why. q, v: (rows, n)."""
        ...

    def place(self, y: Array) -> Array:
        """Points of the output space in the robot's frame for drawing, (..., p) -> (..., 3)."""
        ...

    def unplace(self, point: Array) -> Array:
        """The inverse of `place`, (..., 3) -> (..., p)."""
        ...

    def skeleton(self, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Bars (3, 2 n), begin and end as columns, and joints (3, m) in the robot's frame, [m].

        The last bar ends at the end-point. A deflection is drawn so many times larger than it is.
        """
        ...

    def marks(self, q: ca.SX) -> ca.SX:
        """Further points worth a mark, (n,) -> (3, k) in the robot's frame, [m]."""
        ...

    @property
    def extra_fields(self) -> tuple[tuple[str, int], ...]:
        """Names and sizes of what is worth a plot besides what every robot has."""
        ...

    def extras(self, q: Array, v: Array, parameters: Parameters) -> dict[str, Array]:
        """Their values, shape (size,) each, by name; q and v: (n,)."""
        ...

    @property
    def reach(self) -> tuple[float, float]:
        """Smallest and largest distance of the end-point from the base pivot, [m].

        At either the robot is singular; a hand's target stays within the larger one of home.
        """
        ...

    @property
    def drawing(self) -> Drawing:
        """What bars and joints do not tell of how it is drawn."""
        ...

    @property
    def linkage(self) -> BalancedLinkage | None:
        """What can be identified from a record of its motion; None: nothing."""
        ...


class PlanarRobot:
    """Most of `Robot` for rigid links that move in the vertical plane y = 0.

    The end-point is y = 0 at `home`; the output space is the plane itself.
    """

    __slots__ = ()

    @property
    def home(self) -> tuple[float, float]:
        """Where the end-point y = 0 lies in the robot's frame, (x, z), [m]."""
        raise NotImplementedError

    @property
    def frame(self) -> Frame:
        """See `Robot.frame`."""
        return _PLANE

    @property
    def substeps(self) -> int:
        """See `Robot.substeps`."""
        return 1

    @property
    def grip(self) -> Grip:
        """See `Robot.grip`."""
        return _GRIP

    @property
    def drawing(self) -> Drawing:
        """See `Robot.drawing`: all from the bars."""
        return _DRAWING

    @property
    def linkage(self) -> BalancedLinkage | None:
        """See `Robot.linkage`."""
        return None

    @property
    def extra_fields(self) -> tuple[tuple[str, int], ...]:
        """See `Robot.extra_fields`: none."""
        return ()

    def extras(self, q: Array, v: Array, parameters: Parameters) -> dict[str, Array]:
        """See `Robot.extras`: none."""
        return {}

    def marks(self, q: ca.SX) -> ca.SX:
        """See `Robot.marks`: none."""
        return ca.SX(3, 0)

    def place(self, y: Array) -> Array:
        """See `Robot.place`."""
        x, z = self.home
        points = np.zeros((*y.shape[:-1], 3))
        points[..., 0], points[..., 2] = y[..., 0] + x, y[..., 1] + z
        return points

    def unplace(self, point: Array) -> Array:
        """See `Robot.unplace`."""
        x, z = self.home
        return np.stack([point[..., 0] - x, point[..., 2] - z], axis=-1)


_PLANE, _GRIP, _DRAWING = Plane(), Grip(), Drawing()  # one each: what is built is kept by them


@dataclass(frozen=True, slots=True)
class RobotEntry:
    """One robot to choose.

    Attributes:
        name: as on the command line and in files.
        label: as shown.
        text: a sentence about it.
        parameters: the type of its parameters, with the defaults of the experiments.
        lab: what the lab starts with.
        make: the instance for some parameters; structural ones select it, others do not matter.
        picture: name of an asset; without one the bars are sketched.
    """

    name: str
    label: str
    text: str
    parameters: type[Parameters]
    lab: Parameters
    make: Callable[[Parameters], Robot]
    picture: str = ""


def first_fault(
    q: Array, v: Array, *checks: tuple[NDArray[np.bool_], str]
) -> tuple[int, str] | None:
    """The earliest of: numbers that are not finite, joints too fast, and the given checks.

    Args:
        checks: (bad rows as booleans, reason).
    """
    quiet = np.abs(v).max() <= FASTEST_JOINT and np.isfinite(q).all()  # not so if v has a NaN
    if quiet and not any(bad.any() for bad, _ in checks):
        return None
    finite = np.isfinite(q).all(-1) & np.isfinite(v).all(-1)
    fast = np.abs(np.where(np.isfinite(v), v, 0)).max(-1) > FASTEST_JOINT
    every = [
        (~finite, "the numbers have left the range of a computer"),
        (fast, f"a joint turns faster than {FASTEST_JOINT:.0f} rad/s: the motion has diverged"),
        *checks,
    ]
    found = [(int(bad.argmax()), why) for bad, why in every if bad.any()]
    return min(found, default=None)
