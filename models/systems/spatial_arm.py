"""The spatial three-link arm: a base that turns about the vertical, a shoulder and an elbow.

Coordinates q = (q1, q2, q3), [rad]: q1 turns the arm about the vertical, q2 is the angle of the
upper arm from the horizontal, q3 that of the forearm relative to it, so that φ = q2 + q3 is the
forearm's angle from the horizontal. A motor at each joint makes B = I. Links are slender: length l,
mass m, centre of mass at r from their joint, and inertia I about it across the link. The elbow's
motor has the mass mR. With c2 = cos q2, cφ = cos φ,

    a2 = I2 + m2 r2² + (mR + m3) l2²,   a3 = I3 + m3 r3²,   k = m3 r3 l2,
    g2 = g (m2 r2 + (mR + m3) l2),      g3 = g m3 r3,
    D  = a1 + a2 c2² + 2 k c2 cφ + a3 cφ²   (about the vertical; a1 is that of the base),

    M(q) = diag(D, [[a2 + a3 + 2 k cos q3, a3 + k cos q3], [a3 + k cos q3, a3]]),
    V(q) = g2 sin q2 + g3 sin φ,
    h(q) = (ρ cos q1 - x0, ρ sin q1, l2 sin q2 + l3 sin φ - z0),   ρ = l2 c2 + l3 cφ, [m].

c(q, v) follows from these; viscous friction has the coefficients b1, b2, b3. The determinant of the
Jacobian is l2 l3 ρ sin q3: the arm is singular when it is stretched or folded (sin q3 = 0) and with
its end-point above its base (ρ = 0). Of the poses at a point, the one with the elbow up and ρ > 0
is used.

Paths lie in the horizontal plane y3 = 0, or rise above it as space curves.

Source: Spong and Vidyasagar, Robot Dynamics and Control, 6.4, for the method.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.paths.frames import LevelPlane
from onpath.models.systems.drawing import Angle, Depths, Drawing, Length, Waist
from onpath.models.systems.parameter_specs import model_error, path_rise, unknown_payload
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import SINGULAR, Robot, RobotEntry, StopCondition
from onpath.models.systems.system import GRAVITY, MechanicalSystem, mechanical_system
from onpath.models.systems.two_links import elbow_up

NAMES = ("a1", "a2", "a3", "k", "g2", "g3", "b1", "b2", "b3", "l2", "l3")
MIDDLE = (0.25, 0.0, 0.08)  # the end-point y = 0 in the robot's frame, (x0, 0, z0), [m]
STRETCHED = 0.02  # -sin q3 below which the arm counts as stretched or folded
ABOVE_BASE = 0.02  # ρ below which the end-point counts as above the base, [m]
DRAWING = Drawing(
    motors=(1,),
    base="pedestal",
    depths=Depths(back=0.016, front=0.0, boss=0.008, pen=0.0),
    elevation=math.radians(30.0),
    azimuth=math.radians(18.0),
    box=((-0.1, -0.12, -0.115), (0.36, 0.12, 0.37)),
    title=(0.12, 0.0, 0.35),
    note=(0.25, -0.12, -0.1),
    sheet=((0.02, 0.34), (-0.14, 0.32), -0.16),
    angles=(Angle("q₂", bar=0), Angle("q₃", bar=1, after=0, near=-math.pi / 2)),
    waist=Waist("q₁"),
    lengths=(Length("ℓ₂", 0, 1, at=0.6), Length("ℓ₃", 2, 3, right=True)),
    elbow=1,
)


@dataclass(frozen=True, slots=True)
class SpatialLinks:
    """Illustrative values, not those of a particular arm. Units: m, kg, kg m², N m s."""

    l2: float = 0.2
    l3: float = 0.22
    r2: float = 0.07
    r3: float = 0.08
    m2: float = 0.4
    m3: float = 0.25
    motor: float = 0.12  # of the elbow, [kg]
    I1: float = 0.004
    I2: float = 0.0015
    I3: float = 0.0015
    b1: float = 0.05
    b2: float = 0.05
    b3: float = 0.03

    def lumped(self, payload: float = 0.0) -> dict[str, float]:
        """The parameters of the equations of motion by name (SI), with a mass at the end-point.

        Args:
            payload: [kg].
        """
        moment = self.m3 * self.r3 + payload * self.l3
        beyond = self.motor + self.m3 + payload  # mass that the upper arm carries at the elbow
        return {
            "a1": self.I1,
            "a2": self.I2 + self.m2 * self.r2**2 + beyond * self.l2**2,
            "a3": self.I3 + self.m3 * self.r3**2 + payload * self.l3**2,
            "k": moment * self.l2,
            "g2": GRAVITY * (self.m2 * self.r2 + beyond * self.l2),
            "g3": GRAVITY * moment,
            "b1": self.b1,
            "b2": self.b2,
            "b3": self.b3,
            "l2": self.l2,
            "l3": self.l3,
        }


LINKS = SpatialLinks()


@dataclass(frozen=True, slots=True)
class SpatialParameters(Parameters):
    """Additional parameters of the arm: the path's height, model errors and payload."""

    rise: float = path_rise()
    error_inertias: float = model_error(
        "Inertia error", "the controller's inertias a1, a2, a3 and k are off by this"
    )
    error_weights: float = model_error(
        "Weight error", "the controller's weights g2 and g3 are off by this", on=10.0
    )
    payload: float = unknown_payload((0, 0.3, 0.01), on=0.1)


def spatial_arm() -> MechanicalSystem:
    """The arm's equations of motion, given in this module's docstring."""
    parameters = ca.SX.sym("parameters", len(NAMES))
    p = dict(zip(NAMES, ca.vertsplit(parameters), strict=True))
    q, v = ca.SX.sym("q", 3), ca.SX.sym("v", 3)
    c2, cf = ca.cos(q[1]), ca.cos(q[1] + q[2])
    s2, sf = ca.sin(q[1]), ca.sin(q[1] + q[2])
    bend = p["k"] * ca.cos(q[2])
    about = p["a1"] + p["a2"] * c2**2 + 2 * p["k"] * c2 * cf + p["a3"] * cf**2
    across = p["a3"] + bend
    mass = ca.diag(ca.vertcat(about, p["a2"] + across + bend, p["a3"]))
    mass[1, 2] = mass[2, 1] = across
    potential = p["g2"] * s2 + p["g3"] * sf
    friction = ca.vertcat(p["b1"], p["b2"], p["b3"]) * v
    radius, height = p["l2"] * c2 + p["l3"] * cf, p["l2"] * s2 + p["l3"] * sf
    output = ca.vertcat(radius * ca.cos(q[0]), radius * ca.sin(q[0]), height) - ca.DM(MIDDLE)
    return mechanical_system(
        name="spatial_arm",
        q=q,
        v=v,
        parameters=parameters,
        parameter_names=NAMES,
        mass=mass,
        inputs=3,
        output=output,
        potential_energy=potential,
        friction=friction,
    )


def plant(parameters: Parameters) -> Array:
    """The numbers of the plant, `Robot.plant`."""
    chosen = own_parameters(SpatialParameters, parameters)
    return EQUATIONS.parameter_vector(LINKS.lumped(chosen.payload))


def model(parameters: Parameters) -> Array:
    """The numbers of the model, `Robot.model`: without payload, with the chosen errors."""
    chosen, values = own_parameters(SpatialParameters, parameters), LINKS.lumped()
    for name in ("a1", "a2", "a3", "k"):
        values[name] *= 1 + chosen.error_inertias / 100
    for name in ("g2", "g3"):
        values[name] *= 1 + chosen.error_weights / 100
    return EQUATIONS.parameter_vector(values)


def inverse(y: ca.SX) -> ca.SX:
    """The pose at rest with the elbow up, `Robot.inverse`."""
    ahead, aside, height = ca.vertsplit(y + ca.DM(MIDDLE))
    both = elbow_up(ca.sqrt(ahead**2 + aside**2), height, LINKS.l2, LINKS.l3)
    return ca.vertcat(ca.atan2(aside, ahead), both)


def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Bars of upper arm and forearm, joints at both ends of the upper arm: `Robot.skeleton`."""
    ahead = ca.vertcat(ca.cos(q[0]), ca.sin(q[0]), 0)
    up = ca.DM([0, 0, 1])
    upper, fore = (
        length * (ca.cos(angle) * ahead + ca.sin(angle) * up)
        for length, angle in ((LINKS.l2, q[1]), (LINKS.l3, q[1] + q[2]))
    )
    base = 0 * upper
    return ca.horzcat(base, upper, upper, upper + fore), ca.horzcat(base, upper)


def broken(q: ca.SX) -> ca.SX:
    """Whether the arm is nearly stretched or folded, or beyond, or above its base."""
    radius = LINKS.l2 * ca.cos(q[1]) + LINKS.l3 * ca.cos(q[1] + q[2])
    return ca.fmax(ca.sin(q[2]) > -STRETCHED, radius < ABOVE_BASE)


EQUATIONS = spatial_arm()
SPATIAL_ARM = Robot(
    system=EQUATIONS,
    plant=plant,
    model=model,
    inverse=inverse,
    skeleton=skeleton,
    home=MIDDLE,
    reach=LINKS.l2 + LINKS.l3,
    stops=(StopCondition(broken(EQUATIONS.q), SINGULAR),),
    frame=LevelPlane(),
    drawing=DRAWING,
)
"""The origin of its frame is the shoulder, which lies on the base's axis."""
ROBOT = RobotEntry(
    name="spatial_arm",
    label="Spatial arm",
    text="Three motors, a turning base: its path may leave the plane.",
    picture="spatial_arm.webp",
    parameters=SpatialParameters,
    make=lambda _: SPATIAL_ARM,
)
