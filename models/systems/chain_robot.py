"""A robot that is a chain of rigid bodies, such as one that a file describes.

With M(q), c(q, v) and h(q) of `rigid_chain.py`, a motor at each joint, B = I, viscous friction D
and a payload at the end-point,

    M(q) v' + c(q, v) + D v = u + J_h^T F.

The controller's model differs from the plant by a factor on all masses and inertias, by another on
all weights, and by the payload, which it does not know. M and c are linear in these three. A robot
whose tip can only move in a plane has p = 2 outputs, others p = 3. With more joints than outputs it
is redundant, and holds a posture by

    u0 = c + D v - M N (k_d v + k_p (q - q_home)),   N = 1 - A J^T (J A J^T)⁻¹ J,   A = (M + E)⁻¹,

which does not move the end-point: J N = 0. Where the spring is at rest, the joints are as near home
as the end-point allows, with the weight M + E. By M alone, the light joints of a wrist would go
farthest, and to their stops. So E, which is diagonal, makes joints heavy near the ends of their
travel, and others move instead: with the travel w, the place -1 < s < 1 in it and a gain g,

    E_ii = g μ / w_i² s_i² / (1 - s_i²)²,   μ: the mean of M_jj w_j² at home.

Forces on the end-point move the joints as before, because the motion that is commanded for it is
distributed among them by M in any case; see `linearization`. With g = 0, and for joints without
limits, E = 0, and N takes away what `linearization` does not use.

Source of the weight: Chan and Dubey, A weighted least-norm solution based scheme for avoiding joint
limits for redundant joint manipulators, IEEE Transactions on Robotics and Automation 11 (1995),
286-292.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import pairwise

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import LevelPlane, Plane
from onpath.models.robot_files.chain import Chain
from onpath.models.robot_files.xml_elements import shown
from onpath.models.systems.drawing import Depths, Drawing, Point, Spot
from onpath.models.systems.forces import Grip
from onpath.models.systems.parameter_specs import (
    dry_friction,
    model_error,
    number,
    path_rise,
    static_friction,
    torque_steps,
    unknown_payload,
    velocity_filter,
)
from onpath.models.systems.parameters import Parameters, own_parameters
from onpath.models.systems.rigid_chain import (
    ChainSource,
    bias_forces,
    chain_frames,
    chain_inertias,
    mass_matrix,
    masses_at,
    potential_energy,
    solved,
    tip_of,
)
from onpath.models.systems.robots import (
    AT_A_LIMIT,
    LEAST_REGULARITY,
    Robot,
    RobotEntry,
    StopCondition,
)
from onpath.models.systems.system import MechanicalSystem, mechanical_system

STEPS = (0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 1.0)
"""Shares of the way from home to y, each with a step of Newton's method."""
SOLVED = 1e-9  # [m], least accuracy of the inverse
NEAR_LIMIT = 1 / 8  # of a joint's range, within which the regularity falls to 0 at its end
UNLIMITED = 1e6  # [N m], for a motor whose limit the file does not state
FASTEST_DECAY = 2500.0  # [1/s], of friction, which one Runge-Kutta step of 1 ms can follow
MOST_STEPS = 2
LIGHT = 1.5  # [kg], mean effective mass of an end-point up to which the usual grip holds it
AT_END = 1e-3  # least 1 - s², beside and beyond the ends of a joint's travel
POSTURE = ("posture_stiffness", "posture_damping", "limit_avoidance")
"""Gains of the posture, of which a chain has those that are among its parameters."""
SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")


@dataclass(frozen=True, slots=True)
class ChainParameters(Parameters):
    """Additional parameters of every chain, and limits that suit an arm of a tonne, too."""

    torque_limit: float = number(
        0.0,
        "%",
        (0, 100, 1),
        "motors give no more than this share of the limits in the robot's file; 0: no limit",
        group="realism",
        label="Torque limit",
        on=50.0,
        compiles=True,
    )
    torque_step: float = torque_steps(20, scale="log")
    coulomb: float = dry_friction(500, scale="log")
    stiction: float = static_friction(500, scale="log")
    error_inertia: float = model_error(
        "Inertia error", "the controller's masses and inertias are off by this"
    )
    error_gravity: float = model_error(
        "Weight error", "the controller's weights are off by this", on=10.0
    )
    payload: float = unknown_payload((0, 500, 0.05), on=0.2, scale="log")


@dataclass(frozen=True, slots=True)
class SpatialChainParameters(ChainParameters):
    """Parameters of a chain whose tip moves in space."""

    rise: float = path_rise()


def _posture_stiffness() -> float:
    return number(
        100.0,
        "1/s²",
        (0, 400, 1),
        "spring that pulls the joints home where that does not move the end-point; 0: none",
        group="robot",
        label="Posture spring",
    )


def _posture_damping() -> float:
    return number(
        20.0,
        "1/s",
        (0, 40, 0.5),
        "damper of the joints' motion that does not move the end-point; 0: none",
        group="robot",
        label="Posture damper",
    )


@dataclass(frozen=True, slots=True)
class RedundantPlanarParameters(ChainParameters):
    """Parameters of a chain with more joints than its planar path needs."""

    posture_stiffness: float = _posture_stiffness()
    posture_damping: float = _posture_damping()


@dataclass(frozen=True, slots=True)
class RedundantSpatialParameters(SpatialChainParameters):
    """Parameters of a chain with more joints than its path in space needs.

    Its wrist turns fast, so velocities that lag by the usual 5 ms keep the posture swinging after
    about one of a hundred pulls; by 2 ms, after none of 120.
    """

    encoder_filter: float = velocity_filter(0.002)
    posture_stiffness: float = _posture_stiffness()
    posture_damping: float = _posture_damping()


def _limit_avoidance() -> float:
    return number(
        3.0,
        "",
        (0, 10, 0.1),
        "how strongly a joint is kept off the ends of its travel, where others can move instead"
        " without moving the end-point; 0: not at all",
        group="robot",
        label="Limit avoidance",
    )


@dataclass(frozen=True, slots=True)
class LimitedPlanarParameters(RedundantPlanarParameters):
    """Parameters of a redundant chain in a plane with a joint that has limits."""

    limit_avoidance: float = _limit_avoidance()


@dataclass(frozen=True, slots=True)
class LimitedSpatialParameters(RedundantSpatialParameters):
    """Parameters of a redundant chain in space with a joint that has limits."""

    limit_avoidance: float = _limit_avoidance()


def parameters_of(source: ChainSource) -> type[ChainParameters]:
    """The type of a chain's parameters."""
    planar = len(source.axes) == 2
    if not source.redundant:
        return ChainParameters if planar else SpatialChainParameters
    if source.chain.limited:
        return LimitedPlanarParameters if planar else LimitedSpatialParameters
    return RedundantPlanarParameters if planar else RedundantSpatialParameters


def _gains(kind: type[ChainParameters]) -> tuple[str, ...]:
    """The names of `POSTURE` among the parameters of a chain."""
    return tuple(name for name in POSTURE if hasattr(kind, name))


def output_axes(chain: Chain) -> tuple[Point, ...]:
    """Directions of the outputs: two in the plane of the tip's motion, or x, y and z.

    The tip moves in a plane if the joints that turn have parallel axes, and those that slide are
    across them, but for a last one that turns the tip on the spot. Of a plane that is not
    horizontal, the first direction is horizontal.
    """
    joints = chain.joints
    if not joints[-1].slides and math.hypot(*chain.tip[:2]) < 1e-6:
        joints = joints[:-1]
    frames = chain_frames(chain, ca.SX(ca.DM.zeros(chain.n)))
    lines: list[Array] = [
        ca.evalf(ca.densify(rotation[:, 2])).full()[:, 0] for rotation in frames.rotations
    ]
    turning = [a for a, joint in zip(lines, joints, strict=False) if not joint.slides]
    sliding = [a for a, joint in zip(lines, joints, strict=False) if joint.slides]
    space = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    if not turning and len(sliding) < 2:
        return space
    normal: Array = turning[0] if turning else np.cross(sliding[0], sliding[1])
    if not np.linalg.norm(normal) > 1e-6:
        return space
    normal = normal / np.linalg.norm(normal)
    parallel = all(np.linalg.norm(np.cross(normal, a)) < 1e-6 for a in turning)
    if not parallel or any(abs(normal @ a) > 1e-6 for a in sliding):
        return space
    if abs(normal[2]) > 1 - 1e-9:
        return space[:2]
    along = np.array([-normal[1], normal[0], 0.0]) / math.hypot(normal[0], normal[1])
    along *= -1.0 if along[0] < -1e-9 or (abs(along[0]) <= 1e-9 and along[1] < 0) else 1.0
    up = np.cross(normal, along)
    up *= np.sign(up[2])
    return _point(along), _point(up)


def _point(values: Array) -> Point:
    x, y, z = (float(v) for v in np.round(values, 15) + 0.0)
    return x, y, z


def chain_entry(source: ChainSource) -> RobotEntry:
    """The catalogue's entry of a chain. The robot is made when it is needed."""
    return RobotEntry(
        name=source.name,
        label=source.label,
        text=source.text,
        parameters=parameters_of(source),
        make=partial(_make, source),
        source=source,
    )


def _make(source: ChainSource, _: Parameters) -> Robot:
    return chain_robot(source)


@lru_cache(maxsize=64)
def chain_system(source: ChainSource) -> MechanicalSystem:
    """The equations of motion; see this module's docstring."""
    chain, n = source.chain, source.chain.n
    q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
    names = ("inertia", "weight", "payload", *_gains(parameters_of(source)))
    parameters = ca.SX.sym("parameters", len(names))
    p = dict(zip(names, ca.vertsplit(parameters), strict=True))
    frames = chain_frames(chain, q)
    inertias = chain_inertias(chain, p["inertia"], p["payload"])
    weights = chain_inertias(chain, p["weight"], p["payload"])
    mass = mass_matrix(chain, frames, inertias, p["inertia"])
    friction = ca.DM([joint.damping for joint in chain.joints]) * v
    bias = bias_forces(chain, frames, inertias, weights, v) + friction
    output = ca.densify(ca.DM(source.axes) @ (tip_of(chain, frames) - ca.DM(_home_of(source))))
    posture = None
    if source.redundant:
        away = p["posture_damping"] * v + p["posture_stiffness"] * (q - ca.DM(source.home))
        if "limit_avoidance" in p:
            heavier = mass + ca.diag(p["limit_avoidance"] * _spared(source, q))
            away = _beside(ca.jacobian(output, q), heavier, away)
        posture = bias - mass @ away
    efforts = [min(joint.effort, UNLIMITED) / 100 for joint in chain.joints]
    return mechanical_system(
        name=source.name,
        q=q,
        v=v,
        parameters=parameters,
        parameter_names=names,
        coordinate_names=tuple(
            f"q{i + 1}_m" if joint.slides else f"q{i + 1}_rad"
            for i, joint in enumerate(chain.joints)
        ),
        mass=mass,
        bias=bias,
        inputs=n,
        output=output,
        potential_energy=potential_energy(frames, weights),
        solve=solved,
        posture=posture,
        strength=tuple(efforts),
    )


def _beside(jacobian: ca.SX, weight: ca.SX, motion: ca.SX) -> ca.SX:
    """N a: the part of a motion that does not move the end-point, nearest to it by a weight."""
    toward = solved(weight, ca.densify(jacobian.T))
    return motion - toward @ solved(ca.densify(jacobian @ toward), jacobian @ motion)


def _spared(source: ChainSource, q: ca.SX) -> ca.SX:
    """The diagonal of E for g = 1, (n, 1); see this module's docstring."""
    (low, high), limited = source.chain.limits, source.chain.limited
    inertias, widths = np.diag(_mass_at_home(source))[limited], (high - low)[limited]
    mean = float((inertias * widths**2).mean())
    weights = ca.SX(ca.DM.zeros(source.chain.n))
    for i, width in zip(limited, widths.tolist(), strict=True):
        place = (2 * q[i] - low[i] - high[i]) / width
        weights[i] = mean / width**2 * (place / ca.fmax(1 - place**2, AT_END)) ** 2
    return weights


def _mass_at_home(source: ChainSource) -> Array:
    """M at home, (n, n)."""
    return masses_at(source.chain, np.array([source.home]))[0]


def chain_grip(source: ChainSource, slope: Array) -> Grip:
    """Hand, brake and wall, as much stronger as the end-point is heavier than `LIGHT`.

    Its effective mass at home is Λ = (J M⁻¹ Jᵀ)⁻¹. The end-point of a control law with the gain K1
    is as stiff as K1 Λ, so a heavy arm gives way to a spring as a light one does if the spring
    grows with the mean eigenvalue of Λ.

    Args:
        slope: J at home, (p, n).
    """
    effective = 1 / np.linalg.eigvalsh(slope @ np.linalg.solve(_mass_at_home(source), slope.T))
    return Grip().stronger(max(1.0, float(effective.mean()) / LIGHT), float(effective.min()))


@lru_cache(maxsize=64)
def _home_of(source: ChainSource) -> Point:
    """The end-point at home in the frame of the base, [m]."""
    frames = chain_frames(source.chain, ca.SX(ca.DM(source.home)))
    x, y, z = ca.evalf(ca.densify(tip_of(source.chain, frames))).full()[:, 0].tolist()
    return x, y, z


@lru_cache(maxsize=64)
def chain_robot(source: ChainSource) -> Robot:
    """The robot of a source."""
    system, chain = chain_system(source), source.chain
    jacobian = ca.jacobian(system.output, system.q)
    kind = parameters_of(source)
    gains = _gains(kind)
    reached = ca.Function("reached", [system.q], [system.output, ca.densify(jacobian)])

    def numbers(chosen: ChainParameters, **values: float) -> Array:
        return system.parameter_vector(values | {name: getattr(chosen, name) for name in gains})

    def plant(parameters: Parameters) -> Array:
        chosen = own_parameters(kind, parameters)
        return numbers(chosen, inertia=1.0, weight=1.0, payload=chosen.payload)

    def model(parameters: Parameters) -> Array:
        chosen = own_parameters(kind, parameters)
        inertia, weight = 1 + chosen.error_inertia / 100, 1 + chosen.error_gravity / 100
        return numbers(chosen, inertia=inertia, weight=weight, payload=0.0)

    def inverse(y: ca.SX) -> ca.SX:
        q = ca.SX(ca.DM(source.home))
        for share in STEPS:
            h, slope = reached(q)
            q = q + slope.T @ solved(slope @ slope.T, share * y - h)
        error = reached(q)[0] - y
        off = ca.dot(error, error) - SOLVED**2
        return q + ca.if_else(off < 0, 0, ca.sqrt(-ca.fabs(off)))  # NaN where it has not converged

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        frames = chain_frames(chain, q)
        points = [ca.SX(3, 1), *frames.origins, tip_of(chain, frames)]
        pairs = [(a, b) for a, b in pairwise(points) if not (b - a).is_zero()]
        return ca.densify(ca.horzcat(*[end for pair in pairs for end in pair])), ca.SX(3, 0)

    spread = ca.sqrt(ca.fmax(ca.det(ca.densify(jacobian @ jacobian.T)), 0))
    absolute = ca.Function("spread", [system.q], [spread])
    at_home = float(ca.evalf(absolute(ca.DM(source.home))))
    slope = np.array(reached(ca.DM(source.home))[1])
    regularity = spread / at_home
    for i in chain.limited:
        low, high = chain.joints[i].low, chain.joints[i].high
        left = ca.fmin(system.q[i] - low, high - system.q[i])
        regularity = ca.fmin(regularity, left / (NEAR_LIMIT * (high - low)))
    return Robot(
        system=system,
        plant=plant,
        model=model,
        inverse=inverse,
        skeleton=skeleton,
        home=_home_of(source),
        reach=_reach(chain),
        regularity=regularity,
        stops=(
            *_limit_stops(chain, system.q),
            StopCondition(spread < LEAST_REGULARITY * at_home, AT_A_LIMIT),
        ),
        frame=LevelPlane() if system.p == 3 else Plane(),
        drawing=_drawing(source),
        grip=chain_grip(source, slope),
        substeps=source.substeps,
        chain=chain,
        radius=source.radius,
    )


def _limit_stops(chain: Chain, q: ca.SX) -> tuple[StopCondition, ...]:
    """A joint passes a limit, if any has limits."""
    beyond, (low, high) = ca.SX(0), chain.limits
    for i in chain.limited:
        joint = chain.joints[i]
        beyond = ca.fmax(beyond, ca.logic_or(q[i] < joint.low, q[i] > joint.high))

    def limit_passed(q: Array | None, parameters: Parameters) -> Message:
        if q is None:
            return Message("stop.joints")
        worst = int(np.argmax(np.maximum(low - q, q - high)))
        joint = chain.joints[worst]
        limit = joint.low if q[worst] < joint.low else joint.high
        unit = f"{1e3 * limit:.0f} mm" if joint.slides else f"{math.degrees(limit):.0f}°"
        return Message("stop.joint", {"joint": shown(joint.name), "limit": unit})

    return () if beyond.is_zero() else (StopCondition(beyond, limit_passed),)


def _reach(chain: Chain) -> float:
    """A distance from the base's origin that the tip cannot exceed, [m]."""
    steps = sum(float(np.linalg.norm(body.translation)) for body in chain.bodies)
    slides = [max(abs(j.low), abs(j.high)) for j in chain.joints if j.slides]
    return steps + float(np.linalg.norm(chain.tip)) + sum(slides) + 1e-9


def _drawing(source: ChainSource) -> Drawing:
    """The drawing: from in front of its plane, or a little from above."""
    planar = len(source.axes) == 2
    level = planar and source.axes[1][2] == 0
    return Drawing(
        base="links",
        axes=source.axes if planar else None,
        depths=Depths(back=0.0, front=0.0, boss=0.0, pen=0.0),
        elevation=math.radians(60.0 if level else 9.0 if planar else 20.0),
        azimuth=math.radians(0.0 if planar else 18.0),
        spots=_spots(source.chain),
    )


def _spots(chain: Chain) -> tuple[Spot, ...]:
    """The names of the joints; those at one place, as in a wrist, have one label."""
    names, bars = dict[int, list[str]](), 0
    for i, body in enumerate(chain.bodies, 1):
        bars += bool(body.translation.any()) or body.joint.slides
        names.setdefault(max(2 * bars - 1, 0), []).append("q" + str(i).translate(SUBSCRIPTS))
    return tuple(Spot(", ".join(each), end) for end, each in names.items())
