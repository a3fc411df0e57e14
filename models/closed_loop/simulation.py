"""From a user's parameters to the inputs of a closed loop: kind, settings vector, initial state."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.delay import LONGEST
from onpath.models.closed_loop.kernel import Kernel, build_kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import GAINS, LoopLayouts
from onpath.models.closed_loop.speed_profile import Leg
from onpath.models.control import composite_control
from onpath.models.control.bend_limit import most_turning
from onpath.models.control.implicit_level import check_level, implicit_level
from onpath.models.control.laws.law import PLAN
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import OWN_GAINS, law_named
from onpath.models.control.speed_limit import NO_SPEED_LIMIT, speed_limit
from onpath.models.errors import CodedError
from onpath.models.paths.curve_faults import ambiguities
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import closest_parameter
from onpath.models.paths.space_curves import saddle
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.law_parameters import LEVEL_SET
from onpath.models.systems.parameters import TICK, Parameters, look_ahead_time, rise_of, time_step
from onpath.models.systems.robots import Robot

MOST = 8  # kernels that are kept, and as many of typed laws; 0.2 MB each
MOST_STARTS = 64  # starts and settings that are kept, with their robots and paths
NO_LIMIT = 1e300  # of `torque_limit`: cuts no torque, and is finite, as numbers in JSON must be


@dataclass(frozen=True, slots=True, eq=False)
class Push:
    """External action on the end-point, in output coordinates.

    Attributes:
        hand: position of the hand, shape (p,), [m], or None.
        hold: anchor [m] and unit tangent of the brake, each shape (p,), or None.
        hold_normal: a second direction in which the brake acts, shape (p,), or None.
        wall: a point of a wall's surface [m] and its unit normal, each shape (p,), or None.
        share: of the hand's force that acts.
    """

    hand: Array | None = None
    hold: tuple[Array, Array] | None = None
    hold_normal: Array | None = None
    wall: tuple[Array, Array] | None = None
    share: float = 1.0

    @property
    def acts(self) -> bool:
        """Whether there is anything that may exert a force."""
        return not (self.hand is None and self.hold is None and self.wall is None)


FREE = Push()  # nothing acts
_kind = lru_cache(maxsize=64)(Kind)  # one object for all loops of a kind, and their histories


@lru_cache(maxsize=64)
def _conic(curve: Curve) -> tuple[Array, Array, float] | None:
    """`Curve.conic`, which every change of a setting needs."""
    return curve.conic()


def has_level_set(curve: Curve) -> bool:
    """Whether a path is an ellipse, so that it has the level set of eq. (15), or an equation."""
    return curve.equation is not None or _conic(curve) is not None


def check_level_set(parameters: Parameters, curve: Curve) -> None:
    """Refuse across = level_set on a path that has no level set, or none in all of its tube.

    Raises:
        CodedError: it has none.
    """
    if parameters.across != LEVEL_SET:
        return
    if not has_level_set(curve):
        raise CodedError("error.no_level_set")
    if any(each.check == "crosses" for each in ambiguities(curve)):
        raise CodedError("error.level_set_crosses")
    if curve.equation is not None:
        check_level(curve)


def kind_of(law: str, parameters: Parameters, curve: Curve, push: Push | None = None) -> Kind:
    """The kind of loop that these parameters need.

    Args:
        law: name of a law of `models/control/laws`.
        curve: the path. While one path blends into another, which may have no level set, λ is the
            signed distance; elsewhere `check_level_set` refuses such a path.
        push: the external action. If it is given and nothing acts, the kind may be `free`, except
            under a typed law, which would have to be compiled twice.
    """
    plain = parameters.torque_limit == 0 == parameters.coulomb
    exact = parameters.torque_step == parameters.delay == parameters.stiction == 0
    encoder = parameters.encoder_counts > 0
    noise = parameters.sensor_noise > 0 or getattr(parameters, "strain_noise", 0.0) > 0
    every_tick = parameters.control_rate * TICK >= 1
    untouched = push is not None and not push.acts and not is_text(law)
    return _kind(
        law=law,
        closed=curve.closed,
        level_set=(level_set := parameters.across == LEVEL_SET and has_level_set(curve)),
        level=implicit_level(curve) if level_set else None,
        encoder=encoder,
        observer=(encoder or noise) and parameters.observer_time > 0,
        output=getattr(parameters, "output", "redefined"),
        space=curve.dimension == 3,
        spline=isinstance(curve, SplineCurve),
        free=plain and exact and every_tick and untouched,
        across_first=_gives_way(law, parameters),
        delay=parameters.delay > 0,
        stiction=parameters.stiction > 0,
        noise=noise,
    )


def _gives_way(law: str, parameters: Parameters) -> bool:
    """Whether a law gives up speed along the path at a torque limit."""
    if parameters.torque_limit == 0 or parameters.at_limit == "cut":
        return False
    follows = is_text(law) or law == "path_following"
    return follows or parameters.at_limit_for == "all"


def kernel_of(robot: Robot, kind: Kind) -> Kernel:
    """The kernel for a robot and a kind, built once for all robots with the same `core`.

    Only the latest ones are kept: a compiled loop no longer needs its kernel.
    """
    return (_typed_kernel if is_text(kind.law) else _kernel)(robot.core, kind)


def _built(robot: Robot, kind: Kind) -> Kernel:
    return build_kernel(robot.system, robot.frame, kind, robot.substeps, robot.grip)


_kernel, _typed_kernel = lru_cache(maxsize=MOST)(_built), lru_cache(maxsize=MOST)(_built)
"""Separate caches, so that typed laws cannot displace the kernels of the registry's laws."""


def forget_kernels() -> None:
    """Build kernels and plans again: a law's name means another law now."""
    _kernel.cache_clear()
    _free_settings.cache_clear()


def settings_vector(
    robot: Robot, layouts: LoopLayouts, parameters: Parameters, curve: Curve, push: Push
) -> Array:
    """The settings of a closed loop as a flat vector: everything but the state and the curve.

    Args:
        curve: for its level set, the speed limit, and the plan of a law.
        push: the external action.

    Returns:
        Shape (layouts.settings.size,).
    """
    return pushed(layouts, _free_settings(robot, layouts, parameters, curve), push)


@lru_cache(maxsize=MOST_STARTS)
def _free_settings(
    robot: Robot, layouts: LoopLayouts, parameters: Parameters, curve: Curve
) -> Array:
    """The settings where nothing acts; computed once for the labs of a class."""
    p, dt = robot.system.p, time_step(parameters)
    centre, weights, constant = _conic(curve) or (np.zeros(2), np.array([1.0, 1.0, 0.0]), 1.0)
    counts = parameters.encoder_counts
    known = layouts.settings.slices
    return layouts.settings.pack(
        {name: getattr(parameters, name) for name in GAINS}
        | {name: gain.of(parameters) for name, gain in OWN_GAINS.items() if name in known}
        | {
            "tracker_integral": float(parameters.tracker_integral == "on"),
            "position": float(parameters.task == "position"),
            "target": parameters.target,
            "speed": parameters.speed,
            "ramp": parameters.ramp,
            "speed_limit": _speed_limit(robot, parameters, curve),
            "plane": robot.frame.numbers,
            "level_centre": centre,
            "level_weights": weights,
            "level_constant": constant,
            "plan": _plan(robot, layouts.law, parameters, curve),
            "torque_limit": parameters.torque_limit or NO_LIMIT,
            "coulomb": parameters.coulomb,
            "encoder_step": 2 * np.pi / counts if counts else 1.0,
            "encoder_filter": parameters.encoder_filter,
            "observer_time": parameters.observer_time,
            "hold_ticks": (interval := round(1 / (parameters.control_rate * dt))),
            "dt": dt,
            **{name: getattr(parameters, name) for name in ("stiction", "torque_step")},
            "look_ahead": look_ahead_time(parameters),
            "delay_ticks": parameters.delay * interval,
            "sensor_noise": parameters.sensor_noise,
            "seed": round(parameters.seed),
            **_push_fields(FREE, p),
            **_composite_gains(layouts, parameters),
            "plant": robot.plant(parameters),
            "model": robot.model(parameters),
            **_drawn(curve),
        }
    )


def _drawn(curve: Curve) -> dict[str, float]:
    """The settings that only a drawing has."""
    if not isinstance(curve, SplineCurve):
        return {}
    turning = most_turning(curve)
    return {"pieces": curve.pieces, "duration": curve.duration, "turning": turning}


def _plan(robot: Robot, law: str, parameters: Parameters, curve: Curve) -> Array:
    """The plan of a law, padded with zeros, (PLAN,)."""
    plan, numbers = law_named(law).plan, np.zeros(PLAN)
    if plan is not None:
        found = plan(robot, parameters, curve)
        numbers[: len(found)] = found
    return numbers


def _speed_limit(robot: Robot, parameters: Parameters, curve: Curve) -> float:
    """The largest speed that path following asks for, [rad/s]."""
    if parameters.torque_limit == 0 or parameters.at_limit != "slow_down":
        return NO_SPEED_LIMIT
    model = tuple(robot.model(parameters).tolist())
    return speed_limit(robot, model, curve, parameters.torque_limit, parameters.speed < 0)


def pushed(layouts: LoopLayouts, settings: Array, push: Push) -> Array:
    """The same settings with another push.

    It runs for every movement of a hand and is much cheaper than `settings_vector`.
    """
    result, slices = settings.copy(), layouts.settings.slices
    for name, value in _push_fields(push, result[slices["hand_target"]].size).items():
        result[slices[name]] = value
    return result


def paced(layouts: LoopLayouts, settings: Array, leg: Leg) -> Array:
    """The same settings with the wanted speed of a part of a speed profile."""
    result, slices = settings.copy(), layouts.settings.slices
    result[slices["speed"]], result[slices["ramp"]] = leg.last, leg.rate
    return result


def _push_fields(push: Push, p: int) -> dict[str, float | Array]:
    none = np.zeros(p), np.zeros(p)
    (anchor, tangent), (place, normal) = push.hold or none, push.wall or none
    return {
        "hand_active": 0.0 if push.hand is None else push.share,
        "hand_target": np.zeros(p) if push.hand is None else push.hand,
        "hold_active": float(push.hold is not None),
        "hold_anchor": anchor,
        "hold_tangent": tangent,
        "hold_normal": none[0] if push.hold_normal is None else push.hold_normal,
        "wall_active": float(push.wall is not None),
        "wall_place": place,
        "wall_normal": normal,
    }


def _composite_gains(layouts: LoopLayouts, parameters: Parameters) -> dict[str, float]:
    """Gains of composite control and the gauges' noise, if the robot has a flexible link."""
    known = composite_control.GAINS.keys() | {"strain_noise"}
    names = layouts.settings.slices.keys() & known
    return {name: getattr(parameters, name) for name in names}


def first_state(
    robot: Robot, layouts: LoopLayouts, curve: Curve, q: Array, v: Array | None = None
) -> Array:
    """The state at the start of a run, with θ and θ_r at the closest point, by global search.

    Args:
        curve: the path.
        q: configuration, shape (n,).
        v: velocity, shape (n,); None: at rest.

    Returns:
        Shape (layouts.state.size,).
    """
    velocity = np.zeros_like(q) if v is None else v
    y = robot.endpoint(q)
    theta = closest_parameter(robot.frame, curve, y)
    m, joints = robot.system.m, robot.system.joints
    memory = {name: np.zeros(size) for name, size in layouts.state.fields}
    return layouts.state.pack(
        memory
        | {
            "q": q,
            "v": velocity,
            "theta": theta,
            "theta_rate": 0.0,
            "theta_ref": theta,
            "speed_ref": 0.0,
            "integral": np.zeros(robot.system.p),
            "encoder": q[:joints],
            "encoder_rate": velocity[:joints],
            "estimate": q,
            "estimate_rate": velocity,
            "u": np.zeros(m),
            "phase": 0.0,
        }
    )


def primed(layouts: LoopLayouts, state: Array) -> Array:
    """The state for a loop with delay from that of one without: the torque has been constant."""
    result, slices = state.copy(), layouts.state.slices
    result[slices["queue"]] = np.tile(state[slices["u"]], LONGEST)
    return result


def raised(curve: Curve, parameters: Parameters) -> Curve:
    """The path that a robot follows: a curve with the rise of its parameters, if it has one."""
    return saddle(curve, rise_of(parameters))


def brake_at(robot: Robot, curve: Curve, y: Array, theta: float) -> tuple[Array, Array]:
    """Anchor and unit tangent of a brake that is applied at the end-point y, each shape (p,).

    Args:
        y: shape (p,), [m].
        theta: of the closest point, at which the tangent is taken, [rad].
    """
    first = robot.frame.lift(curve.at(np.array(theta), 1)) - robot.frame.lift(np.zeros(2))
    return np.array(y), first / np.linalg.norm(first)
