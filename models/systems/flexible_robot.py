"""The flexible five-bar for the lab and the experiments: limits, model errors, drawing."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache, partial
from weakref import WeakValueDictionary

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import SlantedPlane
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
from onpath.models.systems.five_bar_robot import ANGLES, LENGTHS, collapse
from onpath.models.systems.flexible_five_bar import RIGID
from onpath.models.systems.flexible_links import load_links
from onpath.models.systems.flexible_parameters import PLANE, FlexibleParameters
from onpath.models.systems.forces import Grip, SpringLimits
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.robots import FlexibleLink, Robot, RobotEntry, StopCondition
from onpath.models.systems.system import MechanicalSystem, conditioning_of
from onpath.models.systems.zero_dynamics import flexible_zero_dynamics

LINKS = load_links()
MOST_BENT = 0.3  # largest deflection over beam length; far outside the small-deflection model
FASTEST_TIP = 20.0  # [m/s], largest rate of the deflection
BENT = Message("stop.bent")
UNSTABLE = Message("stop.unstable")
BENT_OR_UNSTABLE = Message("stop.bent_or_unstable")
# The tip is light and soft (15 N/m): stiff springs, with forces held over a tick, would chatter.
_SOFT = SpringLimits(500.0, 4.0, 5.0)
SOFT_GRIP = Grip(hand=SpringLimits(100.0, 2.0, 1.0), hold=_SOFT, wall=_SOFT)
SLOWEST = {"composite": 200, "redefined": 500}
"""Lowest control rates at which the robot follows its circle with the default gains, [Hz]."""
SLOWEST_FILTERED = 500
"""The same with encoders or noise and without an observer."""
LEAST_LIMIT = 1.2
"""Smallest torque limit with which composite control does so behind encoders of 2000 steps, noise
of 1e-4 rad and an observer, [N m]; behind a filter even 4 N m are not enough. With exact
measurements it takes 0.1 N m."""
PIECES = 10  # straight bars that represent the bent link
_SHARES = np.linspace(0.0, 1.0, PIECES + 1)
DRAWING = Drawing(
    strip=PIECES,
    base="pedestal",
    axes=((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    away=(-1.0, 0.0),
    depths=Depths(back=BACK_LAYER - FRONT_LAYER, front=0.0, boss=BOSS - FRONT_LAYER, pen=0.0),
    elevation=math.radians(30.0),
    azimuth=math.radians(24.0),
    box=((-0.11, -0.53, -0.115), (0.11, 0.1, 0.45)),
    apart=0.48,
    title=(0.0, 0.0, 0.44),
    note=(0.0, -0.5, 0.08),
    force_scale=0.04,
    sheet=((-0.24, 0.1), (0.24, 0.5), -0.56),
    angles=ANGLES,
    waist=Waist("q₃", bar=3),
    lengths=(LENGTHS[0], Length("ℓ", 1, -1, at=0.6)),
    elbow=1,
)


def start_of(modes: int = 3) -> Array:
    """A configuration at rest, 10 mm off the default path, shape (n,)."""
    return np.concatenate([[np.pi / 2, np.pi - 0.12, 0.0], np.zeros(modes)])


def plant_of(system: MechanicalSystem, parameters: Parameters) -> Array:
    """The numbers of the plant, `Robot.plant`."""
    chosen = own_parameters(FlexibleParameters, parameters)
    links = LINKS.changed(chosen.rho, chosen.frequency, chosen.zeta)
    return system.parameter_vector(links.lumped(chosen.alpha, chosen.payload))


def model_of(system: MechanicalSystem, parameters: Parameters) -> Array:
    """The numbers of the model, `Robot.model`: without payload, with the chosen errors."""
    chosen = replace(own_parameters(FlexibleParameters, parameters), payload=0.0)
    values = dict(zip(system.parameter_names, plant_of(system, chosen).tolist(), strict=True))
    for name in ("M11", "M22", "J0", "rho", "omega1"):
        values[name] *= 1 + getattr(chosen, f"error_{name}") / 100
    return system.parameter_vector(values)


def inverse(modes: int, y: ca.SX) -> ca.SX:
    """The configuration at rest with the beam straight, `Robot.inverse`."""
    planar = ca.vertcat(ca.sqrt(y[0] ** 2 + y[1] ** 2) - LINKS.beam, y[2])
    angles = five_bar.inverse_kinematics(planar, LINKS.link1, LINKS.beam)
    return ca.vertcat(angles, ca.atan2(y[1], y[0]), ca.SX.zeros(modes))


def skeleton(beam: BeamModes, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
    """Links 1 to 3, then link 4 in pieces from its joint with link 3: `Robot.skeleton`.

    Returns:
        bars, (3, 8 + 2 PIECES): link 1, 2, 3, link 4 behind its joint with link 1, the beam's
        pieces; joints, (3, 4): base, link 1-4, link 2-3, link 3-4, [m].
    """
    bars, joints = five_bar.skeleton(q, LINKS.link1, LINKS.link2, 0.0)
    along = -ca.vertcat(ca.cos(q[1]), 0, ca.sin(q[1]))
    bent = exaggeration * (ca.DM(beam.shapes(beam.length * _SHARES)) @ q[RIGID:])
    line = joints[:, 1] + LINKS.beam * along @ ca.DM(_SHARES).T
    line += ca.vertcat(0, 1, 0) @ bent.T
    ends = [end for i in range(PIECES) for end in (line[:, i], line[:, i + 1])]
    return _turned(ca.horzcat(bars, *ends), q[2]), _turned(joints, q[2])


def _turned(points: ca.SX, waist: ca.SX) -> ca.SX:
    """From (radius, w, height) to the robot's frame, (3, k), [m]."""
    radius, w, height = points[0, :], points[1, :], points[2, :]
    c, s = ca.cos(waist), ca.sin(waist)
    return ca.vertcat(radius * s + w * c, w * s - radius * c, height)


def _rank_number(system: MechanicalSystem) -> ca.SX:
    """σ_min / σ_max of the matrix of the rank test (11), with default parameters."""
    plant = ca.DM(plant_of(system, FlexibleParameters()))
    matrix = ca.densify(ca.jacobian(system.controlled_output, system.q) @ system.input_gain)
    return conditioning_of(ca.substitute(matrix, system.parameters, ca.SX(plant)))


def _extras(system: MechanicalSystem, beam: BeamModes) -> dict[str, ca.SX]:
    """Deflection w(l) = Σ φ_j(l) f_j of the tip [m], its share of each mode [m], and the energy of
    the modes ½ ρ Σ (f_j'² + ω_j² f_j²) [J]."""
    p = dict(zip(system.parameter_names, ca.vertsplit(system.parameters), strict=True))
    modes = system.q[RIGID:] * ca.DM(beam.tip)
    swing = p["omega1"] * (ca.DM(beam.overtones) * system.q[RIGID:])
    energy = p["rho"] / 2 * (ca.sumsqr(system.v[RIGID:]) + ca.sumsqr(swing))
    return {"deflection": ca.sum1(modes), "modes": modes, "internal_energy": energy}


def _stops(
    system: MechanicalSystem, beam: BeamModes, modes: int, plant: str
) -> tuple[StopCondition, ...]:
    """Stops for a link that bends or vibrates too much, and for a collapsed linkage."""
    bent, rate = (ca.fabs(ca.dot(x[RIGID:], ca.DM(beam.tip))) for x in (system.q, system.v))
    bad = ca.fmax(bent > MOST_BENT * LINKS.beam, rate > FASTEST_TIP)

    def reason(q: Array | None, parameters: Parameters) -> Message:
        if q is None:
            return BENT_OR_UNSTABLE
        return UNSTABLE if is_unstable_inside(modes, plant, q, parameters) else BENT

    return StopCondition(bad, reason), collapse(system.q)


def is_unstable_inside(modes: int, plant: str, q: Array, parameters: Parameters) -> bool:
    """Whether the zero dynamics at rest are unstable, at the joint angles in q, shape (n,).

    Without payload, which the controller does not know.
    """
    straight = np.concatenate([q[:RIGID], np.zeros(modes)])
    numbers = flexible_five_bar_robot(modes, plant).plant(parameters)
    exponents = flexible_zero_dynamics(modes, plant).exponents(straight, numbers)
    return bool(exponents[0, 0].real > 0)


def flexible_five_bar_robot(
    modes: int = 3, plant: str = "lagrangian", loaded: bool = False
) -> Robot:
    """The five-bar on a waist with a flexible last link, of section IV of the paper.

    The origin of its frame is the foot of the waist. The arm points towards the viewer, who faces
    the plane of the path. Equal arguments give the same object, so that its kernels are built once.

    Raises:
        ValueError: an unknown plant or number of modes.
    """
    return _robot(modes, plant, loaded)


def _made(modes: int, plant: str, loaded: bool) -> Robot:
    system = flexible_five_bar.flexible_five_bar(modes, plant, loaded)
    beam = beam_modes(modes, LINKS.beam)
    return Robot(
        system=system,
        plant=partial(plant_of, system),
        model=partial(model_of, system),
        inverse=partial(inverse, modes),
        skeleton=partial(skeleton, beam),
        home=(0.0, 0.0, LINKS.link1),
        reach=LINKS.link1 + LINKS.beam,
        regularity=_rank_number(system),
        stops=_stops(system, beam, modes, plant),
        extras=_extras(system, beam),
        frame=PLANE,
        drawing=DRAWING,
        substeps=2,
        grip=SOFT_GRIP,
    )


_robot = lru_cache(maxsize=4 * MOST_MODES)(_made)
_elsewhere: WeakValueDictionary[tuple[Robot, SlantedPlane], Robot] = WeakValueDictionary()
"""The robots with paths in other planes, while they are in use."""


def robot_for(parameters: Parameters) -> Robot:
    """The instance for these parameters."""
    chosen = own_parameters(FlexibleParameters, parameters)
    core = flexible_five_bar_robot(chosen.modes, chosen.plant, chosen.payload > 0)
    frame = SlantedPlane(chosen.b, chosen.d, chosen.centre)
    if frame == PLANE:
        return core
    made = _elsewhere.get((core, frame)) or replace(core, frame=frame, shared=core)
    return _elsewhere.setdefault((core, frame), made)


def critical_alpha(parameters: Parameters, joints: Array) -> float:
    """`FlexibleLink.critical_alpha`, without the payload, which the controller does not know."""
    chosen = own_parameters(FlexibleParameters, parameters)
    numbers = flexible_five_bar_robot(chosen.modes, chosen.plant).plant(parameters)
    q = np.concatenate([joints, np.zeros(chosen.modes)])
    zero = flexible_zero_dynamics(chosen.modes, chosen.plant)
    return zero.critical_alpha(q, numbers, highest=1.0)


def caution(parameters: Parameters) -> Message | None:
    """`RobotEntry.caution`: control too slow, or motors too weak, for the link's vibration."""
    chosen = own_parameters(FlexibleParameters, parameters)
    measured = chosen.encoder_counts > 0 or chosen.sensor_noise > 0
    filtered = measured and chosen.observer_time == 0
    slowest = SLOWEST_FILTERED if filtered else SLOWEST[chosen.output]
    if chosen.control_rate < slowest:
        return Message("caution.flexible", {"rate": chosen.control_rate, "slowest": slowest})
    least = np.inf if filtered else LEAST_LIMIT
    if measured and chosen.output == "composite" and 0 < chosen.torque_limit < least:
        return Message("caution.flexible_weak", {"limit": f"{chosen.torque_limit:g}"})
    return None


ROBOT = RobotEntry(
    name="flexible",
    label="Five-bar with a flexible link",
    text="Three motors, a last link that bends: the tip is not where the motors put it.",
    picture="flexible_five_bar.webp",
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
