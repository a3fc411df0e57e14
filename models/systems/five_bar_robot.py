"""The rigid five-bar for the lab and the experiments: limits, model errors, drawing."""

from __future__ import annotations

import math
from functools import lru_cache

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.systems import five_bar
from onpath.models.systems.drawing import Angle, Drawing, Length
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import BalancedLinkage, Robot, RobotEntry, StopCondition

COLLAPSE = Message("stop.collapsed")
COLLAPSED = 0.02  # |sin(q1 - q2)| below which the linkage counts as collapsed
ANGLES = (Angle("q₁", bar=0), Angle("q₂", bar=1, near=math.pi, at=0.72))
LENGTHS = (
    Length("ℓ₁", 0, 1, at=0.6, right=True),
    Length("ℓ₂", 2, 3),
    Length("ℓ₄", 1, 7, at=0.3),
)
DRAWING = Drawing(
    box=((-0.21, -0.03, -0.13), (0.31, 0.03, 0.36)),
    title=(0.07, 0.0, 0.335),
    angles=ANGLES,
    lengths=LENGTHS,
    elbow=1,
)


@lru_cache(maxsize=64)
def _plant(removed: float, payload: float) -> Array:
    return _constant(EQUATIONS.parameter_vector(LINKS.spoiled(removed, payload).lumped()))


@lru_cache(maxsize=64)
def _model(*percent: float) -> Array:
    values = LINKS.lumped()
    for name, error in zip(("M11", "M22", "b1", "b2"), percent, strict=True):
        values[name] *= 1 + error / 100
    return _constant(EQUATIONS.parameter_vector(values))


def _constant(array: Array) -> Array:
    """The same array, read-only because it is shared."""
    array.flags.writeable = False
    return array


def plant(parameters: Parameters) -> Array:
    """The numbers of the plant, `Robot.plant`."""
    chosen = own_parameters(FiveBarParameters, parameters)
    return _plant(chosen.counterweights_removed / 100, chosen.payload)


def model(parameters: Parameters) -> Array:
    """The numbers of the model, `Robot.model`: the robot of (12) with the chosen model errors."""
    chosen = own_parameters(FiveBarParameters, parameters)
    return _model(chosen.error_M11, chosen.error_M22, chosen.error_b1, chosen.error_b2)


def collapse(q: ca.SX) -> StopCondition:
    """Stops a run near a collapsed parallelogram, |sin(q1 - q2)| = 0.

    Source: eq. (14).
    """
    return StopCondition(ca.fabs(ca.sin(q[0] - q[1])) < COLLAPSED, COLLAPSE)


LINKS = five_bar.load_links()
_L1, _L2, _L4 = (link.length for link in (LINKS.link1, LINKS.link2, LINKS.link4))
EQUATIONS = five_bar.five_bar()
RIGID_FIVE_BAR = Robot(
    system=EQUATIONS,
    plant=plant,
    model=model,
    inverse=lambda y: five_bar.inverse_kinematics(y, _L1, _L4),
    skeleton=lambda q, _: five_bar.skeleton(q, _L1, _L2, _L4),
    home=(_L4, 0.0, _L1),
    reach=_L1 + _L4,
    stops=(collapse(EQUATIONS.q),),
    drawing=DRAWING,
)
"""The planar five-bar linkage of section III of the paper."""
ROBOT = RobotEntry(
    name="five_bar",
    label="Five-bar linkage",
    text="Two motors, rigid links, a pen in a vertical plane.",
    picture="five_bar.webp",
    parameters=FiveBarParameters,
    make=lambda _: RIGID_FIVE_BAR,
    linkage=BalancedLinkage(_L1, _L4, LINKS.lumped()),
)
