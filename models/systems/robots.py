"""The robots as the lab and the experiments use them: one interface around each model."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from operator import itemgetter
from typing import Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import Frame, Plane
from onpath.models.systems import five_bar
from onpath.models.systems.forces import Grip
from onpath.models.systems.parameters import FiveBarParameters, Parameters
from onpath.models.systems.system import MechanicalSystem

FASTEST_JOINT = 100.0  # [rad/s], beyond it a run counts as diverged
COLLAPSED = 0.02  # |sin(q1 - q2)| below which the linkage counts as collapsed
NOT_FINITE = Message("diverged.range")
COLLAPSE = Message(
    "stop.collapsed",
    english="the linkage has collapsed (all links in one line): the controller cannot see its way"
    " out of a singular configuration",
)
SHORT = 20  # rows
SLOW, FAR = 20.0, 0.5  # [rad/s] and of sin(q1 - q2): nowhere near a fault, nor since some ms


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

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
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


@dataclass(frozen=True, slots=True, eq=False)
class RigidFiveBar:
    """The planar five-bar linkage of section III."""

    links: five_bar.FiveBarLinks = field(default_factory=five_bar.load_links)
    system: MechanicalSystem = field(default_factory=five_bar.five_bar, repr=False)
    frame: Frame = field(default_factory=Plane)
    name: str = "five_bar"
    label: str = "Five-bar linkage"
    substeps: int = 1
    grip: Grip = field(default_factory=Grip)
    coordinate_names: tuple[str, ...] = ("q1_rad", "q2_rad")
    extra_fields: tuple[tuple[str, int], ...] = ()

    @property
    def _lengths(self) -> tuple[float, float]:
        return self.links.link1.length, self.links.link4.length

    def plant(self, parameters: Parameters) -> Array:
        """See `Robot.plant`."""
        own = _own(parameters)
        return _plant(self, own.counterweights_removed / 100, own.payload)

    def model(self, parameters: Parameters) -> Array:
        """See `Robot.model`: the balanced robot of (12), each entry wrong as asked."""
        own = _own(parameters)
        return _model(self, own.error_M11, own.error_M22, own.error_b1, own.error_b2)

    def rest(self, y: Array) -> Array:
        """See `Robot.rest`."""
        return five_bar.inverse_kinematics(y, *self._lengths)

    def endpoint(self, q: Array) -> Array:
        """See `Robot.endpoint`."""
        return five_bar.end_point(q, *self._lengths)

    def margin(self, z: Array) -> Array:
        """See `Robot.margin`: |sin(q1 - q2)|, eq. (14)."""
        l1, l4 = self._lengths
        squared = (z[..., 0] + l4) ** 2 + (z[..., 1] + l1) ** 2
        cosine = (l1**2 + l4**2 - squared) / (2 * l1 * l4)
        return np.sqrt(np.maximum(1 - cosine**2, 0.0))

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
        """See `Robot.fault`."""
        return None if is_calm(q, v) else first_fault(q, v, collapse(q))

    def place(self, y: Array) -> Array:
        """See `Robot.place`."""
        l1, l4 = self._lengths
        points = np.zeros((*y.shape[:-1], 3))
        points[..., 0], points[..., 2] = y[..., 0] + l4, y[..., 1] + l1
        return points

    def unplace(self, point: Array) -> Array:
        """See `Robot.unplace`."""
        l1, l4 = self._lengths
        return np.stack([point[..., 0] - l4, point[..., 2] - l1], axis=-1)

    def skeleton(self, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """See `Robot.skeleton`: nothing bends."""
        l1, l4 = self._lengths
        return five_bar.skeleton(q, l1, self.links.link2.length, l4)

    def marks(self, q: ca.SX) -> ca.SX:
        """See `Robot.marks`: none."""
        return ca.SX(3, 0)

    def extras(self, q: Array, v: Array, parameters: Parameters) -> dict[str, Array]:
        """See `Robot.extras`: none."""
        return {}


@lru_cache(maxsize=64)
def _plant(robot: RigidFiveBar, removed: float, payload: float) -> Array:
    links = robot.links.spoiled(removed, payload)
    return _constant(robot.system.parameter_vector(links.lumped()))


@lru_cache(maxsize=64)
def _model(robot: RigidFiveBar, *percent: float) -> Array:
    values = robot.links.lumped()
    for name, error in zip(("M11", "M22", "b1", "b2"), percent, strict=True):
        values[name] *= 1 + error / 100
    return _constant(robot.system.parameter_vector(values))


def _constant(array: Array) -> Array:
    """The same, for all who ask."""
    array.flags.writeable = False
    return array


@lru_cache(maxsize=1)
def rigid_five_bar() -> RigidFiveBar:
    """The one instance: its kernels are built once."""
    return RigidFiveBar()


def collapse(q: Array) -> tuple[NDArray[np.bool_], Message]:
    """Where a five-bar has collapsed, for `first_fault`. q: (rows, at least 2). Eq. (14)."""
    with np.errstate(invalid="ignore"):  # numbers that are not finite are caught apart
        collapsed = five_bar.singularity_margin(q) < COLLAPSED
    return collapsed, COLLAPSE


def is_calm(q: Array, v: Array) -> bool:
    """Whether the last row is so far from any fault that those before it were none, either.

    Args:
        q, v: of some milliseconds, at most `SHORT` rows, (rows, 2). A NaN or an infinity stays.
    """
    (first, second), (fast, faster) = q[-1].tolist(), v[-1].tolist()
    apart = abs(math.sin(first - second))  # false for NaN, as all comparisons with it are
    return len(q) <= SHORT and abs(fast) < SLOW and abs(faster) < SLOW and apart > FAR


def first_fault(
    q: Array, v: Array, *checks: tuple[NDArray[np.bool_], Message]
) -> tuple[int, Message] | None:
    """The earliest of: joints too fast, the given checks, and numbers that are not finite.

    Of several in one row, the first in this order.

    Args:
        checks: (bad rows as booleans, reason).
    """
    quiet = np.abs(v).max() <= FASTEST_JOINT and np.isfinite(q).all()  # not so if v has a NaN
    if quiet and not any(bad.any() for bad, _ in checks):
        return None
    finite = np.isfinite(q).all(-1) & np.isfinite(v).all(-1)
    fast = np.abs(np.where(np.isfinite(v), v, 0)).max(-1) > FASTEST_JOINT
    every = [
        (fast, Message("diverged.fast", {"limit": f"{FASTEST_JOINT:.0f}"})),
        *checks,
        (~finite, NOT_FINITE),
    ]
    found = [(int(bad.argmax()), why) for bad, why in every if bad.any()]
    return min(found, default=None, key=itemgetter(0))


def _own(parameters: Parameters) -> FiveBarParameters:
    if not isinstance(parameters, FiveBarParameters):
        raise TypeError(f"the five-bar takes FiveBarParameters, got {type(parameters).__name__}")
    return parameters
