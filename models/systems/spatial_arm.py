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
    h(q) = (ρ cos q1 - x0, ρ sin q1, l2 sin q2 + l3 sin φ - z0),   ρ = l2 c2 + l3 cφ, [m];

c(q, v) follows from them, with viscous friction b1, b2, b3. The determinant of the Jacobian is l2
l3 ρ sin q3: the arm is singular when it is stretched or folded (sin q3 = 0) and with its end-point
above its base (ρ = 0). Of the poses at a point, the one with the elbow up and ρ > 0 is taken.

Paths lie in the horizontal plane y3 = 0, or rise above it as space curves.

Source: Spong and Vidyasagar, Robot Dynamics and Control, 6.4, for the method.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import Frame, LevelPlane
from onpath.models.systems.drawing import Angle, Depths, Drawing, Length, Waist
from onpath.models.systems.parameter_specs import model_error, number, unknown_payload
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.rigid_robots import RigidRobot
from onpath.models.systems.robots import ArmGeometry, RobotEntry, first_fault
from onpath.models.systems.system import GRAVITY, MechanicalSystem, lagrange_bias, mechanical_system
from onpath.models.systems.two_links import elbow_sine, elbow_sine_of, elbow_up, elbow_up_of

NAMES = ("a1", "a2", "a3", "k", "g2", "g3", "b1", "b2", "b3", "l2", "l3")
MIDDLE = (0.25, 0.0, 0.08)  # the end-point y = 0 in the robot's frame, (x0, 0, z0), [m]
STRETCHED = 0.02  # -sin q3 below which the arm counts as stretched or folded
ABOVE_BASE = 0.02  # ρ below which the end-point counts as above the base, [m]
SINGULAR = Message("stop.singular")
_FRAME = LevelPlane()
DRAWING = Drawing(
    motors=(1,),
    base="pedestal",
    depths=Depths(back=0.016, front=0.0, boss=0.008, pen=0.0),
    elevation=math.radians(30.0),
    azimuth=math.radians(18.0),
    box=((-0.13, -0.14, -0.17), (0.4, 0.14, 0.4)),
    title=(0.12, 0.0, 0.37),
    note=(0.25, -0.12, -0.1),
    sheet=((0.02, 0.34), (-0.14, 0.32), -0.16),
    angles=(Angle("q₂", bar=0), Angle("q₃", bar=1, after=0, near=-math.pi / 2)),
    waist=Waist("q₁"),
    lengths=(Length("ℓ₂", 0, 1, at=0.6), Length("ℓ₃", 2, 3, right=True)),
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


@dataclass(frozen=True, slots=True)
class SpatialParameters(Parameters):
    """Additional parameters of the arm: the path's height, model errors and payload."""

    rise: float = number(
        0.0,
        "m",
        (-0.05, 0.05, 0.001),
        "the path rises and falls by this, twice around: a saddle",
        group="path",
        label="Rise of the path",
    )
    error_inertias: float = model_error(
        "Error in inertia", "the controller's inertias a1, a2, a3 and k are off by this"
    )
    error_weights: float = model_error(
        "Error in gravity", "the controller's weights g2 and g3 are off by this", on=10.0
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
        bias=lagrange_bias(q, v, ca.dot(v, mass @ v) / 2, potential, friction),
        inputs=3,
        output=output,
        potential_energy=potential,
    )


@dataclass(frozen=True, slots=True, eq=False)
class SpatialArm(RigidRobot):
    """The arm for the lab and the experiments.

    The frame for drawing has its origin at the shoulder, which lies on the base's axis; y is drawn
    at y + MIDDLE.
    """

    links: SpatialLinks = field(default_factory=SpatialLinks)
    system: MechanicalSystem = field(default_factory=spatial_arm, repr=False)
    name: str = "spatial_arm"
    label: str = "Spatial arm"
    coordinate_names: tuple[str, ...] = ("q1_rad", "q2_rad", "q3_rad")
    frame: Frame = _FRAME
    drawing: Drawing = DRAWING

    @property
    def reach(self) -> tuple[float, float]:
        """See `Robot.reach`: folded and stretched."""
        return abs(self.links.l2 - self.links.l3), self.links.l2 + self.links.l3

    def plant(self, parameters: Parameters) -> Array:
        """See `Robot.plant`."""
        return self.system.parameter_vector(
            self.links.lumped(own_parameters(SpatialParameters, parameters).payload)
        )

    def model(self, parameters: Parameters) -> Array:
        """See `Robot.model`: without payload, with the chosen model errors."""
        own, values = own_parameters(SpatialParameters, parameters), self.links.lumped()
        for name in ("a1", "a2", "a3", "k"):
            values[name] *= 1 + own.error_inertias / 100
        for name in ("g2", "g3"):
            values[name] *= 1 + own.error_weights / 100
        return self.system.parameter_vector(values)

    def rest(self, y: Array) -> Array:
        """See `Robot.rest`: the pose with the elbow up, (..., 3) -> (..., 3)."""
        radius, height = self._in_its_plane(y)
        q2, q3 = elbow_up(radius, height, self.links.l2, self.links.l3, "shoulder")
        x, y2, _ = np.moveaxis(self.place(y), -1, 0)
        return np.stack([np.arctan2(y2, x), q2, q3], axis=-1)

    def _in_its_plane(self, y: Array) -> tuple[Array, Array]:
        """ρ and the height above the shoulder of end-points y, (..., 3) -> (...), [m]."""
        x, y2, height = np.moveaxis(self.place(y), -1, 0)
        return np.hypot(x, y2), height

    def endpoint(self, q: Array) -> Array:
        """See `Robot.endpoint`."""
        l2, l3 = self.links.l2, self.links.l3
        q1, q2, both = q[..., 0], q[..., 1], q[..., 1] + q[..., 2]
        radius = l2 * np.cos(q2) + l3 * np.cos(both)
        height = l2 * np.sin(q2) + l3 * np.sin(both)
        return self.unplace(np.stack([radius * np.cos(q1), radius * np.sin(q1), height], axis=-1))

    def margin(self, z: Array) -> Array:
        """See `Robot.margin`: |det J| = l2 l3 ρ |sin q3| in parts of that at home."""
        lifted = self.frame.lift(np.vstack([z, np.zeros((1, z.shape[1]))]))
        radius, height = self._in_its_plane(lifted)
        size = radius * elbow_sine(radius**2 + height**2, self.links.l2, self.links.l3)
        return size[:-1] / size[-1]

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
        """See `Robot.fault`: too near a singular configuration, or beyond it."""
        l2, l3 = self.links.l2, self.links.l3
        with np.errstate(invalid="ignore"):  # non-finite numbers are caught elsewhere
            radius = l2 * np.cos(q[:, 1]) + l3 * np.cos(q[:, 1] + q[:, 2])
            singular = (np.sin(q[:, 2]) > -STRETCHED) | (radius < ABOVE_BASE)
        return first_fault(q, v, (singular, SINGULAR))

    def broken(self, q: ca.SX, v: ca.SX) -> ca.SX:
        """See `Robot.broken`."""
        radius = self.links.l2 * ca.cos(q[1]) + self.links.l3 * ca.cos(q[1] + q[2])
        return ca.fmax(ca.sin(q[2]) > -STRETCHED, radius < ABOVE_BASE)

    def reasons(self, q: Array | None, parameters: Parameters) -> tuple[Message, ...]:
        """See `Robot.reasons`."""
        return (SINGULAR,)

    @property
    def geometry(self) -> ArmGeometry:
        """See `Robot.geometry`."""
        return ArmGeometry(self._margin, self._rest)

    def _margin(self, z: ca.SX) -> ca.SX:
        """As `margin`, in the plane of the path."""

        def size(z: ca.SX) -> ca.SX:
            x, y2, height = ca.vertsplit(self.frame.join(z, ca.SX.zeros(1)) + ca.DM(list(MIDDLE)))
            squared = x**2 + y2**2
            sine = elbow_sine_of(squared + height**2, self.links.l2, self.links.l3)
            return ca.sqrt(squared) * sine

        return size(z) / size(ca.SX.zeros(2))

    def _rest(self, y: ca.SX) -> ca.SX:
        """As `rest`."""
        x, y2, height = ca.vertsplit(y + ca.DM(list(MIDDLE)))
        both = elbow_up_of(ca.sqrt(x**2 + y2**2), height, self.links.l2, self.links.l3)
        return ca.vertcat(ca.atan2(y2, x), both)

    def place(self, y: Array) -> Array:
        """See `Robot.place`."""
        return y + np.array(MIDDLE)

    def unplace(self, point: Array) -> Array:
        """See `Robot.unplace`."""
        return point - np.array(MIDDLE)

    def skeleton(self, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """See `Robot.skeleton`: bars of the upper arm and the forearm; joints at both ends of the
        upper arm."""
        ahead = ca.vertcat(ca.cos(q[0]), ca.sin(q[0]), 0)
        up = ca.DM([0, 0, 1])
        upper, fore = (
            length * (ca.cos(angle) * ahead + ca.sin(angle) * up)
            for length, angle in ((self.links.l2, q[1]), (self.links.l3, q[1] + q[2]))
        )
        base = 0 * upper
        return ca.horzcat(base, upper, upper, upper + fore), ca.horzcat(base, upper)


@lru_cache(maxsize=1)
def spatial_arm_robot() -> SpatialArm:
    """The only instance, so that its kernels are built once."""
    return SpatialArm()


ROBOT = RobotEntry(
    name="spatial_arm",
    label="Spatial arm",
    text="Three motors, a turning base: its path may leave the plane.",
    picture="spatial_arm.png",
    parameters=SpatialParameters,
    make=lambda _: spatial_arm_robot(),
)
