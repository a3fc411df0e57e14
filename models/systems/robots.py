"""The interface of robots, as the lab and the experiments use them.

A module of this folder that defines a `ROBOT`, a `RobotEntry`, is found by the catalogue: one file
with M, c, B, h, parameters and reach is a robot. Details of its drawing that do not follow from
bars and joints are in `drawing.py`, with a default for each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Protocol

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import Frame
from onpath.models.systems.drawing import Drawing
from onpath.models.systems.forces import Grip
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.system import MechanicalSystem

FASTEST_JOINT = 100.0  # [rad/s]; a run with faster joints counts as diverged
NOT_FINITE = Message("stop.range")


@dataclass(frozen=True, slots=True)
class BalancedLinkage:
    """Data of a balanced five-bar for the identification.

    Attributes:
        l1, l4: lengths of links 1 and 4, [m].
        built: true values of M11, M22, b1 and b2 (SI).
    """

    l1: float
    l4: float
    built: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class ArmGeometry:
    """Kinematics of a robot in symbols, for pages that compute without Python.

    Attributes:
        margin: as `Robot.margin`, of a point of the path's plane, (2, 1) -> (1, 1).
        rest: as `Robot.rest`, of an end-point within reach, (p, 1) -> (n, 1).
    """

    margin: Callable[[ca.SX], ca.SX]
    rest: Callable[[ca.SX], ca.SX]


@dataclass(frozen=True, slots=True)
class FlexibleLink:
    """What the page needs to know about a robot whose last link bends.

    Attributes:
        joints: number of joint angles, which come before the link's coordinates in q.
        beam: names of the parameters that describe the link.
        composite: names of the gains of composite control.
        critical_alpha: α up to 1 from which the internal dynamics are unstable, at rest at joint
            angles, shape (joints,), with the link straight; infinity if there is none. It depends
            on the parameters in `beam` only.
    """

    joints: int
    beam: tuple[str, ...]
    composite: tuple[str, ...]
    critical_alpha: Callable[[Parameters, Array], float]


class Robot(Protocol):
    """A robot: equations of motion, parameters, kinematics, limits and drawing.

    Planar coordinates z are those of the path's plane.
    """

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
        """The equations of motion."""
        ...

    @property
    def frame(self) -> Frame:
        """How the plane of the path lies in the output space."""
        ...

    @property
    def core(self) -> Robot:
        """The robot that differs from it at most in where its path lies, and shares its loops."""
        ...

    @property
    def substeps(self) -> int:
        """Runge-Kutta steps per tick."""
        ...

    @property
    def grip(self) -> Grip:
        """The springs by which a hand and a brake act on its end-point."""
        ...

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """Names of q with units, for file headers."""
        ...

    def plant(self, parameters: Parameters) -> Array:
        """The system's parameters as they are, shape (k,)."""
        ...

    def model(self, parameters: Parameters) -> Array:
        """The system's parameters as the controller assumes them, shape (k,)."""
        ...

    def rest(self, y: Array) -> Array:
        """A configuration at rest with the end-point at y, shape (p,) -> (n,).

        Raises:
            ValueError: y is out of reach.
        """
        ...

    def endpoint(self, q: Array) -> Array:
        """The actual end-point, shape (..., n) -> (..., p), [m]."""
        ...

    def margin(self, z: Array) -> Array:
        """Distance of points of the path's plane from singular configurations, (n, 2) -> (n,).

        If `frame.space` is a frame, also of points (z, ζ) above the plane, (n, 3) -> (n,).

        Dimensionless: 1 at home, and 0 where the robot is singular or the point out of reach.
        """
        ...

    def is_calm(self, q: Array, v: Array) -> bool:
        """Whether runs are so far from any fault at their ends that none had one on the way.

        A cheap answer for most frames; false may mean that it is not known.

        Args:
            q, v: shape (runs, ticks, n). NaN and infinity persist to the last tick.
        """
        ...

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
        """The first row in which the simulation has diverged, and why; None if in none.

        Whether a row has diverged depends on that row alone, so that the rows of several robots can
        be searched together; the reason may depend on the parameters.

        Args:
            q, v: shape (rows, n).
        """
        ...

    def broken(self, q: ca.SX, v: ca.SX) -> ca.SX:
        """1 for each check of `fault` that fails, besides those of every robot, else 0, (k, 1)."""
        ...

    def reasons(self, q: Array | None, parameters: Parameters) -> tuple[Message, ...]:
        """What `fault` says if each of these checks fails: k reasons.

        Args:
            q: the configuration, shape (n,). None if the output may change during the run; the
                reasons then hold for every output.
        """
        ...

    @property
    def geometry(self) -> ArmGeometry | None:
        """Parts of its kinematics in symbols; None if there are none."""
        ...

    def place(self, y: Array) -> Array:
        """Points of the output space in the frame for drawing, (..., p) -> (..., 3), [m]."""
        ...

    def unplace(self, point: Array) -> Array:
        """The inverse of `place`, (..., 3) -> (..., p), [m]."""
        ...

    def skeleton(self, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """Bars (3, 2 n), begin and end as columns, and joints (3, m) in the robot's frame, [m].

        The last bar ends at the end-point. Deflections are multiplied by `exaggeration`.
        """
        ...

    def marks(self, q: ca.SX) -> ca.SX:
        """Further points to mark, in the robot's frame, (3, k), [m]."""
        ...

    @property
    def extra_fields(self) -> tuple[tuple[str, int], ...]:
        """Names and sizes of quantities to plot, besides those of every robot."""
        ...

    def extras(self, q: Array, v: Array, parameters: Parameters) -> dict[str, Array]:
        """The values of `extra_fields`, shape (size,) each; q and v: (n,)."""
        ...

    @property
    def reach(self) -> tuple[float, float]:
        """Smallest and largest distance of the end-point from the base pivot, [m].

        The robot is singular at both. The hand's target stays within the larger one of home.
        """
        ...

    @property
    def drawing(self) -> Drawing:
        """Details of its drawing that do not follow from bars and joints."""
        ...

    @property
    def linkage(self) -> BalancedLinkage | None:
        """Data for identification from a record of its motion, or None."""
        ...


@dataclass(frozen=True, slots=True)
class RobotEntry:
    """An entry of the catalogue.

    Attributes:
        name: as on the command line and in files.
        label: as shown.
        text: one sentence about the robot.
        parameters: the type of its parameters; its defaults are those of the robot everywhere.
        make: the instance for given parameters; only structural parameters select it.
        picture: name of an asset; if empty, the bars are sketched.
        goes_on: parameters that may select another instance with the same states and kinematics, so
            that a run goes on from the present state.
        caution: why the robot would not even run untouched with these parameters; None if nothing
            is known against it.
        flexible_link: of a robot with parameters `law` and `alpha` and an extra field "deflection";
            None: all links are rigid.
    """

    name: str
    label: str
    text: str
    parameters: type[Parameters]
    make: Callable[[Parameters], Robot]
    picture: str = ""
    flexible_link: FlexibleLink | None = None
    goes_on: tuple[str, ...] = ()
    caution: Callable[[Parameters], Message | None] = lambda _: None

    def keeps_states(self, before: Parameters, now: Parameters) -> bool:
        """Whether the robots of two sets of parameters differ at most by those in `goes_on`."""
        same = {name: getattr(before, name) for name in self.goes_on}
        return self.make(replace(now, **same)) is self.make(before)


def first_fault(
    q: Array, v: Array, *checks: tuple[NDArray[np.bool_], Message]
) -> tuple[int, Message] | None:
    """The first row with a fault, and the reason: too fast, one of the checks, or not finite.

    Of several in one row, the first in this order.

    Args:
        q, v: shape (rows, n).
        checks: (bad rows as booleans, reason).
    """
    quiet = np.abs(v).max() <= FASTEST_JOINT and np.isfinite(q).all()  # false if v has a NaN
    if quiet and not any(bad.any() for bad, _ in checks):
        return None
    finite = np.isfinite(q).all(-1) & np.isfinite(v).all(-1)
    fast = np.abs(np.where(np.isfinite(v), v, 0)).max(-1) > FASTEST_JOINT
    every = [
        (fast, Message("stop.fast", {"limit": f"{FASTEST_JOINT:.0f}"})),
        *checks,
        (~finite, NOT_FINITE),
    ]
    found = [(int(bad.argmax()), why) for bad, why in every if bad.any()]
    return min(found, default=None, key=itemgetter(0))
