"""The rigid five-bar for the lab and the experiments: limits, model errors, drawing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.systems import five_bar
from onpath.models.systems.drawing import Angle, Drawing, Length
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.rigid_robots import PlanarRobot
from onpath.models.systems.robots import ArmGeometry, BalancedLinkage, RobotEntry, first_fault
from onpath.models.systems.system import MechanicalSystem

COLLAPSE = Message("stop.collapsed")
COLLAPSED = 0.02  # |sin(q1 - q2)| below which the linkage counts as collapsed
SHORT = 20  # ticks
SLOW, FAR = (
    20.0,
    0.5,
)  # [rad/s], |sin(q1 - q2)|: too far from a fault to have had one in SHORT ticks
ANGLES = (Angle("q₁", bar=0), Angle("q₂", bar=1, near=math.pi, at=0.72))
LENGTHS = (
    Length("ℓ₁", 0, 1, at=0.6, right=True),
    Length("ℓ₂", 2, 3),
    Length("ℓ₄", 1, 7, at=0.3),
)
DRAWING = Drawing(
    box=((-0.16, -0.03, -0.19), (0.31, 0.03, 0.425)),
    angles=ANGLES,
    lengths=LENGTHS,
)


@dataclass(frozen=True, slots=True, eq=False)
class RigidFiveBar(PlanarRobot):
    """The planar five-bar linkage of section III of the paper."""

    links: five_bar.FiveBarLinks = field(default_factory=five_bar.load_links)
    system: MechanicalSystem = field(default_factory=five_bar.five_bar, repr=False)
    name: str = "five_bar"
    label: str = "Five-bar linkage"
    coordinate_names: tuple[str, ...] = ("q1_rad", "q2_rad")

    @property
    def _lengths(self) -> tuple[float, float]:
        return self.links.link1.length, self.links.link4.length

    @property
    def home(self) -> tuple[float, float]:
        """See `PlanarRobot.home`: link 1 upright, link 4 horizontal."""
        l1, l4 = self._lengths
        return l4, l1

    @property
    def reach(self) -> tuple[float, float]:
        """See `Robot.reach`."""
        l1, l4 = self._lengths
        return abs(l1 - l4), l1 + l4

    @property
    def drawing(self) -> Drawing:
        """See `Robot.drawing`."""
        return DRAWING

    @property
    def linkage(self) -> BalancedLinkage:
        """See `Robot.linkage`."""
        return BalancedLinkage(*self._lengths, self.links.lumped())

    def plant(self, parameters: Parameters) -> Array:
        """See `Robot.plant`."""
        own = own_parameters(FiveBarParameters, parameters)
        return _plant(self, own.counterweights_removed / 100, own.payload)

    def model(self, parameters: Parameters) -> Array:
        """See `Robot.model`: the balanced robot of (12), with the chosen model errors."""
        own = own_parameters(FiveBarParameters, parameters)
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

    def is_calm(self, q: Array, v: Array) -> bool:
        """See `Robot.is_calm`."""
        if q.shape[1] > SHORT or not np.abs(v[:, -1]).max() < SLOW:  # false for NaN
            return False
        return bool(np.abs(np.sin(q[:, -1, 0] - q[:, -1, 1])).min() > FAR)

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
        """See `Robot.fault`."""
        return first_fault(q, v, collapse(q))

    def broken(self, q: ca.SX, v: ca.SX) -> ca.SX:
        """See `Robot.broken` and `collapse`."""
        return ca.fabs(ca.sin(q[0] - q[1])) < COLLAPSED

    def reasons(self, q: Array | None, parameters: Parameters) -> tuple[Message, ...]:
        """See `Robot.reasons`."""
        return (COLLAPSE,)

    @property
    def geometry(self) -> ArmGeometry:
        """See `Robot.geometry`."""
        return ArmGeometry(self._margin, self._rest)

    def _margin(self, z: ca.SX) -> ca.SX:
        """As `margin`."""
        l1, l4 = self._lengths
        cosine = (l1**2 + l4**2 - (z[0] + l4) ** 2 - (z[1] + l1) ** 2) / (2 * l1 * l4)
        return ca.sqrt(ca.fmax(1 - cosine**2, 0))

    def _rest(self, y: ca.SX) -> ca.SX:
        """As `five_bar.inverse_kinematics`."""
        l1, l4 = self._lengths
        x, z = y[0] + l4, y[1] + l1
        reach = ca.sqrt(x**2 + z**2)
        q1 = ca.atan2(z, x) + ca.acos((l1**2 + reach**2 - l4**2) / (2 * l1 * reach))
        q2 = ca.atan2(l1 * ca.sin(q1) - z, l1 * ca.cos(q1) - x)
        return ca.vertcat(q1, q2 - 2 * np.pi * ca.floor(q2 / (2 * np.pi)))

    def skeleton(self, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """See `Robot.skeleton`; rigid links have no deflection to exaggerate."""
        l1, l4 = self._lengths
        return five_bar.skeleton(q, l1, self.links.link2.length, l4)


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
    """The same array, made read-only because it is shared."""
    array.flags.writeable = False
    return array


@lru_cache(maxsize=1)
def rigid_five_bar() -> RigidFiveBar:
    """The only instance, so that its kernels are built once."""
    return RigidFiveBar()


def collapse(q: Array) -> tuple[NDArray[np.bool_], Message]:
    """A check for `first_fault`: |sin(q1 - q2)| < COLLAPSED, and the reason.

    Args:
        q: shape (rows, at least 2), [rad].

    Source: eq. (14).
    """
    with np.errstate(invalid="ignore"):  # `first_fault` finds numbers that are not finite
        collapsed = five_bar.singularity_margin(q) < COLLAPSED
    return collapsed, COLLAPSE


ROBOT = RobotEntry(
    name="five_bar",
    label="Five-bar linkage",
    text="Two motors, rigid links, a pen in a vertical plane.",
    picture="five_bar.png",
    parameters=FiveBarParameters,
    make=lambda _: rigid_five_bar(),
)
