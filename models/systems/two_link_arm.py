"""The planar two-link arm in a vertical plane, with a motor at each joint.

Coordinates q = (q1, q2), [rad]: q1 is the angle of link 1 from the horizontal, q2 that of link 2
relative to link 1. The motor of joint 2 sits on link 1 at the elbow and acts between the links, so
that B = I and the motors' power is u1 q1' + u2 q2'. Links have length l, mass m, centre of mass at
r from their joint, and inertia I about it; mR is the mass of the elbow motor. With

    a1 = I1 + m1 r1² + mR l1² + I2 + m2 (l1² + r2²),  a2 = m2 l1 r2,  a3 = I2 + m2 r2²,
    g1 = g (m1 r1 + mR l1 + m2 l1),  g2 = g m2 r2,  s = a2 sin q2,

    M(q)    = [[a1 + 2 a2 cos q2, a3 + a2 cos q2], [a3 + a2 cos q2, a3]],
    c(q, v) = (-s (2 v1 v2 + v2²) + g1 cos q1 + g2 cos(q1 + q2) + b1 v1,
               s v1² + g2 cos(q1 + q2) + b2 v2),
    h(q)    = (l1 cos q1 + l2 cos(q1 + q2) - l2, l1 sin q1 + l2 sin(q1 + q2) - l1), [m].

At y = 0 link 1 is upright and link 2 horizontal, q = (π/2, -π/2). The determinant of the Jacobian
is l1 l2 sin q2: the arm is singular when stretched (q2 = 0, at the distance l1 + l2 from its base)
and when folded (q2 = ±π, at |l1 - l2|). Every other point in reach has two poses. The one with the
elbow up is used, -π < q2 < 0; no path leads continuously from one to the other.

Source: Spong and Vidyasagar, Robot Dynamics and Control, 6.4, the planar elbow manipulator.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.systems.drawing import Angle, Drawing, Length
from onpath.models.systems.parameter_specs import model_error, unknown_payload
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import SINGULAR, Robot, RobotEntry, StopCondition
from onpath.models.systems.system import GRAVITY, MechanicalSystem, mechanical_system
from onpath.models.systems.two_links import elbow_up

NAMES = ("a1", "a2", "a3", "g1", "g2", "b1", "b2", "l1", "l2")
STRETCHED = 0.02  # -sin q2 below which the arm counts as stretched or folded
DRAWING = Drawing(
    motors=(1,),
    angles=(Angle("q₁", bar=0), Angle("q₂", bar=1, after=0, near=-math.pi / 2)),
    lengths=(Length("ℓ₁", 0, 1, at=0.6), Length("ℓ₂", 2, 3, right=True)),
    elbow=1,
)


@dataclass(frozen=True, slots=True)
class ArmLinks:
    """Illustrative values, not those of a particular arm. Units: m, kg, kg m², N m s.

    Link 2 carries a pen at its end and a counterweight behind the elbow.
    """

    l1: float = 0.22
    l2: float = 0.20
    r1: float = 0.08
    r2: float = 0.06
    m1: float = 0.4
    m2: float = 0.25
    motor: float = 0.1  # of the elbow, [kg]
    I1: float = 0.002
    I2: float = 0.006
    b1: float = 0.05
    b2: float = 0.03

    def lumped(self, payload: float = 0.0) -> dict[str, float]:
        """The parameters of the equations of motion by name (SI), with a mass at the end-point.

        Args:
            payload: [kg].
        """
        moment = self.m2 * self.r2 + payload * self.l2
        a3 = self.I2 + self.m2 * self.r2**2 + payload * self.l2**2
        beyond = self.motor + self.m2 + payload  # mass that link 1 carries at the elbow
        return {
            "a1": self.I1 + self.m1 * self.r1**2 + beyond * self.l1**2 + a3,
            "a2": self.l1 * moment,
            "a3": a3,
            "g1": GRAVITY * (self.m1 * self.r1 + beyond * self.l1),
            "g2": GRAVITY * moment,
            "b1": self.b1,
            "b2": self.b2,
            "l1": self.l1,
            "l2": self.l2,
        }


LINKS = ArmLinks()


@dataclass(frozen=True, slots=True)
class TwoLinkParameters(Parameters):
    """Additional parameters of the arm: model errors and payload."""

    error_inertia: float = model_error(
        "Inertia error", "the controller's inertias a1, a2 and a3 are off by this"
    )
    error_gravity: float = model_error(
        "Weight error", "the controller's weights g1 and g2 are off by this", on=10.0
    )
    payload: float = unknown_payload((0, 0.3, 0.01), on=0.1)


def two_link_arm() -> MechanicalSystem:
    """The arm's equations of motion, given in this module's docstring."""
    parameters = ca.SX.sym("parameters", len(NAMES))
    p = dict(zip(NAMES, ca.vertsplit(parameters), strict=True))
    q, v = ca.SX.sym("q", 2), ca.SX.sym("v", 2)
    both, coupling = q[0] + q[1], p["a2"] * ca.cos(q[1])
    turning, weight = p["a2"] * ca.sin(q[1]), p["g2"] * ca.cos(both)
    across = p["a3"] + coupling
    bias = ca.vertcat(
        p["g1"] * ca.cos(q[0]) + weight + p["b1"] * v[0] - turning * (2 * v[0] + v[1]) * v[1],
        weight + p["b2"] * v[1] + turning * v[0] ** 2,
    )
    x = p["l1"] * ca.cos(q[0]) + p["l2"] * ca.cos(both)
    z = p["l1"] * ca.sin(q[0]) + p["l2"] * ca.sin(both)
    return mechanical_system(
        name="two_link_arm",
        q=q,
        v=v,
        parameters=parameters,
        parameter_names=NAMES,
        mass=ca.blockcat([[p["a1"] + 2 * coupling, across], [across, p["a3"]]]),
        bias=bias,
        inputs=2,
        output=ca.vertcat(x - p["l2"], z - p["l1"]),
        potential_energy=p["g1"] * ca.sin(q[0]) + p["g2"] * ca.sin(both),
    )


def plant(parameters: Parameters) -> Array:
    """The numbers of the plant, `Robot.plant`."""
    chosen = own_parameters(TwoLinkParameters, parameters)
    return EQUATIONS.parameter_vector(LINKS.lumped(chosen.payload))


def model(parameters: Parameters) -> Array:
    """The numbers of the model, `Robot.model`: without payload, with the chosen errors."""
    chosen, values = own_parameters(TwoLinkParameters, parameters), LINKS.lumped()
    for name in ("a1", "a2", "a3"):
        values[name] *= 1 + chosen.error_inertia / 100
    for name in ("g1", "g2"):
        values[name] *= 1 + chosen.error_gravity / 100
    return EQUATIONS.parameter_vector(values)


def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Bars of links 1 and 2, joints at base and elbow: `Robot.skeleton`."""
    one, two = (
        length * ca.vertcat(ca.cos(angle), 0, ca.sin(angle))
        for length, angle in ((LINKS.l1, q[0]), (LINKS.l2, q[0] + q[1]))
    )
    base = 0 * one
    return ca.horzcat(base, one, one, one + two), ca.horzcat(base, one)


EQUATIONS = two_link_arm()
TWO_LINK_ARM = Robot(
    system=EQUATIONS,
    plant=plant,
    model=model,
    inverse=lambda y: elbow_up(y[0] + LINKS.l2, y[1] + LINKS.l1, LINKS.l1, LINKS.l2),
    skeleton=skeleton,
    home=(LINKS.l2, 0.0, LINKS.l1),
    reach=LINKS.l1 + LINKS.l2,
    stops=(
        StopCondition(ca.sin(EQUATIONS.q[1]) > -STRETCHED, SINGULAR),
    ),  # or beyond, the elbow down
    drawing=DRAWING,
)
ROBOT = RobotEntry(
    name="two_link_arm",
    label="Two-link arm",
    text="Two motors, one at the shoulder and one at the elbow, against gravity.",
    picture="two_link_arm.webp",
    parameters=TwoLinkParameters,
    make=lambda _: TWO_LINK_ARM,
)
