"""The flexible five-bar for the lab and the experiments: limits, model errors, drawing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import lru_cache
from weakref import WeakValueDictionary

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import Frame, SlantedPlane
from onpath.models.systems import five_bar, flexible_five_bar
from onpath.models.systems.beam import MOST_MODES, BeamModes, beam_modes
from onpath.models.systems.drawing import (
    BACK_LAYER,
    BOSS,
    FRONT_LAYER,
    Depths,
    Drawing,
    Length,
    Waist,
)
from onpath.models.systems.five_bar_robot import ANGLES, COLLAPSE, COLLAPSED, LENGTHS, collapse
from onpath.models.systems.flexible_five_bar import RIGID
from onpath.models.systems.flexible_links import FlexibleLinks, load_links
from onpath.models.systems.flexible_parameters import PLANE, FlexibleParameters
from onpath.models.systems.forces import Grip, SpringLimits
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import BalancedLinkage, FlexibleLink, RobotEntry, first_fault
from onpath.models.systems.system import MechanicalSystem, conditioning, decoupling_matrix
from onpath.models.systems.zero_dynamics import flexible_zero_dynamics

MOST_BENT = 0.3  # largest deflection over beam length; far outside the small-deflection model
FASTEST_TIP = 20.0  # [m/s], largest rate of the deflection
BENT = Message("stop.bent")
UNSTABLE = Message("stop.unstable")
BENT_OR_UNSTABLE = Message("stop.bent_or_unstable")
# The tip is light and soft (15 N/m): stiff springs, with forces held over a tick, would chatter.
_SOFT = SpringLimits(500.0, 4.0, 5.0)
SOFT_GRIP = Grip(SpringLimits(100.0, 2.0, 1.0), _SOFT, _SOFT)
SLOWEST = {"composite": (200, 500), "redefined": (500, 500)}
"""Lowest control rates at which the robot runs along its circle with the default gains, [Hz]:
with exact sensing, and with encoders or noise."""
PIECES = 10  # straight bars by which the bent link is drawn
_SHARES = np.linspace(0.0, 1.0, PIECES + 1)
DRAWING = Drawing(
    strip=PIECES,
    base="pedestal",
    away=(-1.0, 0.0),
    depths=Depths(back=BACK_LAYER - FRONT_LAYER, front=0.0, boss=BOSS - FRONT_LAYER, pen=0.0),
    elevation=math.radians(30.0),
    azimuth=math.radians(24.0),
    box=((-0.12, -0.54, -0.17), (0.12, 0.12, 0.47)),
    apart=0.56,
    title=(0.0, 0.0, 0.475),
    note=(0.0, -0.5, 0.08),
    force_scale=0.04,
    sheet=((-0.24, 0.1), (0.24, 0.5), -0.56),
    angles=ANGLES,
    waist=Waist("q₃", bar=3),
    lengths=(LENGTHS[0], Length("ℓ", 1, -1, at=0.6)),
)


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class FlexibleFiveBar:
    """The five-bar on a waist with a flexible last link, of section IV of the paper.

    The frame for drawing has x right, y away from the viewer, z up, and its origin at the foot of
    the waist. The arm points towards the viewer, who faces the plane of the path: (y1, y2, y3) is
    drawn at (y2, -y1, l1 + y3).
    """

    modes: int = 3
    plant_name: str = "lagrangian"
    loaded: bool = False
    links: FlexibleLinks = field(default_factory=load_links)
    system: MechanicalSystem = field(init=False, repr=False)
    beam: BeamModes = field(init=False, repr=False)
    shapes: Array = field(init=False, repr=False)  # at the ends of the pieces, (PIECES + 1, N)
    frame: Frame = PLANE
    name: str = "flexible"
    label: str = "Five-bar with a flexible link"
    substeps: int = 2
    grip: Grip = SOFT_GRIP
    drawing: Drawing = DRAWING
    linkage: BalancedLinkage | None = None

    def __post_init__(self) -> None:
        system = flexible_five_bar.flexible_five_bar(self.modes, self.plant_name, self.loaded)
        object.__setattr__(self, "system", system)
        beam = beam_modes(self.modes, self.links.beam)
        object.__setattr__(self, "beam", beam)
        object.__setattr__(self, "shapes", beam.shapes(beam.length * _SHARES))

    @property
    def core(self) -> FlexibleFiveBar:
        """See `Robot.core`: with the default plane."""
        return flexible_five_bar_robot(self.modes, self.plant_name, self.loaded)

    @property
    def start(self) -> Array:
        """A configuration at rest, 10 mm off the default path, shape (n,)."""
        return np.concatenate([[np.pi / 2, np.pi - 0.12, 0.0], np.zeros(self.modes)])

    @property
    def reach(self) -> tuple[float, float]:
        """See `Robot.reach`: of the linkage in its vertical plane."""
        l1, beam = self.links.link1, self.links.beam
        return abs(l1 - beam), l1 + beam

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """See `Robot.coordinate_names`; f is in m^1.5, because φ is in m^-0.5."""
        modal = (f"f{j + 1}_m1.5" for j in range(self.modes))
        return ("q1_rad", "q2_rad", "q3_rad", *modal)

    def plant(self, parameters: Parameters) -> Array:
        """See `Robot.plant`."""
        own = own_parameters(FlexibleParameters, parameters)
        links = self.links.changed(own.rho, own.frequency, own.zeta)
        return self.system.parameter_vector(links.lumped(own.alpha, own.payload))

    def model(self, parameters: Parameters) -> Array:
        """See `Robot.model`: the plant without payload, with the chosen model errors."""
        own = replace(own_parameters(FlexibleParameters, parameters), payload=0.0)
        values = dict(zip(self.system.parameter_names, self.plant(own).tolist(), strict=True))
        for name in ("M11", "M22", "J0", "rho", "omega1"):
            values[name] *= 1 + getattr(own, f"error_{name}") / 100
        return self.system.parameter_vector(values)

    def rest(self, y: Array) -> Array:
        """See `Robot.rest`, with the beam straight; shape (..., 3) -> (..., n)."""
        planar = np.stack([np.hypot(y[..., 0], y[..., 1]) - self.links.beam, y[..., 2]], axis=-1)
        angles = five_bar.inverse_kinematics(planar, self.links.link1, self.links.beam)
        waist = np.arctan2(y[..., 1], y[..., 0])[..., None]
        return np.concatenate([angles, waist, np.zeros((*waist.shape[:-1], self.modes))], axis=-1)

    def endpoint(self, q: Array) -> Array:
        """See `Robot.endpoint`."""
        return flexible_five_bar.end_point(q, self.links.link1, self.beam)

    def rigid_endpoint(self, q: Array) -> Array:
        """Tip of the straight link, shape (..., n) -> (..., 3), [m]."""
        return flexible_five_bar.end_point(q, self.links.link1, self.beam, alpha=0.0)

    def deflection(self, q: Array) -> Array:
        """Deflection w(l) = Σ φ_j(l) f_j of the tip, shape (..., n) -> (...), [m]."""
        return q[..., RIGID:] @ self.beam.tip

    def internal_energy(self, q: Array, v: Array, parameters: Parameters) -> Array:
        """Energy of the modes ½ ρ Σ (f_j'² + ω_j² f_j²), shapes (..., n) -> (...), [J]."""
        own = own_parameters(FlexibleParameters, parameters)
        frequencies = 2 * np.pi * own.frequency * self.beam.overtones
        f, f_rate = q[..., RIGID:], v[..., RIGID:]
        return own.rho / 2 * (f_rate**2 + (frequencies * f) ** 2).sum(-1)

    def margin(self, z: Array) -> Array:
        """See `Robot.margin`: the rank number (11), beam straight, relative to that at home."""
        l1, beam = self.links.link1, self.links.beam
        y = np.vstack([self.frame.lift(z), PLANE.lift(np.zeros((1, 2)))])
        reach = np.linalg.norm(y + np.array([0.0, 0.0, l1]), axis=-1)
        inside = (abs(l1 - beam) < reach) & (reach < l1 + beam)
        numbers = np.zeros(len(y))
        numbers[inside] = conditioning(self._decoupling(self.rest(y[inside])))
        return numbers[:-1] / numbers[-1]

    def _decoupling(self, q: Array) -> Array:
        """The decoupling matrix with default parameters, shape (k, n) -> (k, 3, 3)."""
        columns = _decoupling(self.core)(q.T, self.plant(FlexibleParameters())).full()
        return columns.reshape(RIGID, len(q), RIGID).transpose(1, 0, 2)

    def is_calm(self, q: Array, v: Array) -> bool:
        """See `Robot.is_calm`."""
        return False

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
        """See `Robot.fault`."""
        with np.errstate(invalid="ignore"):  # `first_fault` finds numbers that are not finite
            bent = np.abs(self.deflection(q)) > MOST_BENT * self.links.beam
            bent |= np.abs(self.deflection(v)) > FASTEST_TIP
            found = first_fault(q, v, (bent, BENT), collapse(q))
        if found is None or found[1] != BENT or not np.isfinite(q[0, :RIGID]).all():
            return found
        return found[0], UNSTABLE if self.is_unstable_inside(q[0], parameters) else BENT

    def is_unstable_inside(self, q: Array, parameters: Parameters) -> bool:
        """Whether the zero dynamics at rest are unstable, at the joint angles in q, shape (n,).

        Without payload, which the controller does not know.
        """
        straight = np.concatenate([q[:RIGID], np.zeros(self.modes)])
        zero = flexible_zero_dynamics(self.modes, self.plant_name)
        plant = flexible_five_bar_robot(self.modes, self.plant_name).plant(parameters)
        return bool(zero.exponents(straight, plant)[0, 0].real > 0)

    def broken(self, q: ca.SX, v: ca.SX) -> ca.SX:
        """See `Robot.broken`."""
        bent, rate = (ca.fabs(ca.dot(x[RIGID:], ca.DM(self.beam.tip))) for x in (q, v))
        bad = ca.fmax(bent > MOST_BENT * self.links.beam, rate > FASTEST_TIP)
        return ca.vertcat(bad, ca.fabs(ca.sin(q[0] - q[1])) < COLLAPSED)

    def reasons(self, q: Array | None, parameters: Parameters) -> tuple[Message, ...]:
        """See `Robot.reasons`."""
        if q is None:
            return BENT_OR_UNSTABLE, COLLAPSE
        return (UNSTABLE if self.is_unstable_inside(q, parameters) else BENT), COLLAPSE

    @property
    def geometry(self) -> None:
        """See `Robot.geometry`: its margin is a ratio of singular values."""
        return None

    def place(self, y: Array) -> Array:
        """See `Robot.place`."""
        return np.stack([y[..., 1], -y[..., 0], y[..., 2] + self.links.link1], axis=-1)

    def unplace(self, point: Array) -> Array:
        """See `Robot.unplace`."""
        return np.stack([-point[..., 1], point[..., 0], point[..., 2] - self.links.link1], axis=-1)

    def marks(self, q: ca.SX) -> ca.SX:
        """See `Robot.marks`: the tip of the straight link."""
        return self.skeleton(q, ca.SX(0))[0][:, -1]

    @property
    def extra_fields(self) -> tuple[tuple[str, int], ...]:
        """See `Robot.extra_fields`: deflection [m], its share of each mode [m], energy [J]."""
        return (("deflection", 1), ("modes", self.modes), ("internal_energy", 1))

    def extras(self, q: Array, v: Array, parameters: Parameters) -> dict[str, Array]:
        """See `Robot.extras`."""
        modes = q[RIGID:] * self.beam.tip
        energy = self.internal_energy(q, v, parameters)[None]
        return {"deflection": modes.sum()[None], "modes": modes, "internal_energy": energy}

    def skeleton(self, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        """See `Robot.skeleton`: links 1 to 3, then link 4 in pieces from its joint with link 3.

        Returns:
            bars, (3, 8 + 2 PIECES): link 1, 2, 3, link 4 behind its joint with link 1, the beam's
            pieces; joints, (3, 4): base, link 1-4, link 2-3, link 3-4, [m].
        """
        bars, joints = five_bar.skeleton(q, self.links.link1, self.links.link2, 0.0)
        along = -ca.vertcat(ca.cos(q[1]), 0, ca.sin(q[1]))
        bent = exaggeration * (ca.DM(self.shapes) @ q[RIGID:])
        line = joints[:, 1] + self.links.beam * along @ ca.DM(_SHARES).T
        line += ca.vertcat(0, 1, 0) @ bent.T
        ends = [end for i in range(PIECES) for end in (line[:, i], line[:, i + 1])]
        return self._turned(ca.horzcat(bars, *ends), q[2]), self._turned(joints, q[2])

    def _turned(self, points: ca.SX, waist: ca.SX) -> ca.SX:
        """From (radius, w, height) to the frame for drawing, (3, k), [m]."""
        radius, w, height = points[0, :], points[1, :], points[2, :]
        c, s = ca.cos(waist), ca.sin(waist)
        return ca.vertcat(radius * s + w * c, w * s - radius * c, height)


def flexible_five_bar_robot(
    modes: int = 3, plant: str = "lagrangian", loaded: bool = False
) -> FlexibleFiveBar:
    """The only instance for its arguments, so that its kernels are built once.

    Raises:
        ValueError: an unknown plant or number of modes.
    """
    return _robot(modes, plant, loaded)


@lru_cache(maxsize=4 * MOST_MODES)
def _robot(modes: int, plant: str, loaded: bool) -> FlexibleFiveBar:
    return FlexibleFiveBar(modes, plant, loaded)


_elsewhere: WeakValueDictionary[tuple[int, str, bool, SlantedPlane], FlexibleFiveBar] = (
    WeakValueDictionary()
)
"""The robots with paths in other planes, as long as they are used."""


@lru_cache(maxsize=4 * MOST_MODES)
def _decoupling(robot: FlexibleFiveBar) -> ca.Function:
    return decoupling_matrix(robot.system)


def robot_for(parameters: Parameters) -> FlexibleFiveBar:
    """The instance for these parameters."""
    own = own_parameters(FlexibleParameters, parameters)
    core, frame = (own.modes, own.plant, own.payload > 0), SlantedPlane(own.b, own.d, own.centre)
    if frame == PLANE:
        return flexible_five_bar_robot(*core)
    made = _elsewhere.get((*core, frame))
    return _elsewhere.setdefault((*core, frame), made or FlexibleFiveBar(*core, frame=frame))


def critical_alpha(parameters: Parameters, joints: Array) -> float:
    """See `FlexibleLink.critical_alpha`: without payload, which the controller does not know."""
    own = own_parameters(FlexibleParameters, parameters)
    robot = flexible_five_bar_robot(own.modes, own.plant)
    q = np.concatenate([joints, np.zeros(robot.modes)])
    zero = flexible_zero_dynamics(robot.modes, robot.plant_name)
    return zero.critical_alpha(q, robot.plant(parameters), highest=1.0)


def caution(parameters: Parameters) -> Message | None:
    """See `RobotEntry.caution`: the control may be too slow for the link's vibration."""
    own = own_parameters(FlexibleParameters, parameters)
    exact, measured = SLOWEST[own.law]
    slowest = measured if own.encoder_counts > 0 or own.sensor_noise > 0 else exact
    if own.control_rate >= slowest:
        return None
    return Message("caution.flexible", {"rate": own.control_rate, "slowest": slowest})


ROBOT = RobotEntry(
    name="flexible",
    label="Five-bar with a flexible link",
    text="Three motors, a last link that bends: the tip is not where the motors put it.",
    picture="flexible_five_bar.png",
    parameters=FlexibleParameters,
    make=robot_for,
    goes_on=("payload",),
    caution=caution,
    flexible_link=FlexibleLink(
        joints=RIGID,
        beam=("plant", "modes", "rho", "frequency", "zeta"),
        composite=("tip_damping", "tip_prediction", "tip_shaping", "tip_yielding"),
        critical_alpha=critical_alpha,
    ),
)
