"""From a user's parameters to the inputs of a closed loop: kind, settings vector, initial state."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel, build_kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import GAINS
from onpath.models.control import composite_control
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import TICK, Parameters, time_step
from onpath.models.systems.robots import Robot

NO_LIMIT = 1000.0  # [N m], the limit when there is none: far above any motor, but finite


@dataclass(frozen=True, slots=True, eq=False)
class Push:
    """External action on the end-point, in output coordinates.

    Attributes:
        hand: position of the hand, shape (p,), [m], or None.
        hold: anchor [m] and unit tangent of the brake, each shape (p,), or None.
    """

    hand: Array | None = None
    hold: tuple[Array, Array] | None = None


FREE = Push()  # nothing acts
_conic = lru_cache(maxsize=64)(Curve.conic)  # needed at every change of a setting


def kind_of(
    controller: str, parameters: Parameters, curve: Curve, push: Push | None = None
) -> Kind:
    """The kind of loop that these parameters need.

    Args:
        controller: one of `laws.NAMES`.
        curve: the path.
        push: what acts from outside. If given and nothing acts, the kind may be a `free` one.
    """
    plain = parameters.torque_limit == 0 == parameters.coulomb
    every_tick = parameters.control_rate * TICK >= 1
    untouched = push is not None and push.hand is None and push.hold is None
    return Kind(
        controller=controller,
        closed=curve.closed,
        level_set=parameters.across == "level_set" and _conic(curve) is not None,
        encoder=parameters.encoder_counts > 0,
        law=getattr(parameters, "law", "redefined"),
        free=plain and every_tick and untouched,
    )


@lru_cache(maxsize=64)
def kernel_of(robot: Robot, kind: Kind) -> Kernel:
    """The kernel for a robot and a kind, built once."""
    return build_kernel(robot.system, robot.frame, kind, robot.substeps, robot.grip)


def settings_vector(
    robot: Robot, kernel: Kernel, parameters: Parameters, curve: Curve, push: Push
) -> Array:
    """The settings of a closed loop as a flat vector: everything but the state and the curve.

    Args:
        curve: for its level set only.
        push: what acts from outside.

    Returns:
        Shape (kernel.settings.size,).
    """
    p, dt = robot.system.p, time_step(parameters)
    centre, weights, constant = _conic(curve) or (np.zeros(2), np.ones(2), 1.0)
    counts = parameters.encoder_counts
    return kernel.settings.pack(
        {name: getattr(parameters, name) for name in GAINS}
        | {
            "position": float(parameters.task == "position"),
            "target": parameters.target,
            "speed": parameters.speed,
            "level_centre": centre,
            "level_weights": weights,
            "level_constant": constant,
            "torque_limit": parameters.torque_limit or NO_LIMIT,
            "coulomb": parameters.coulomb,
            "encoder_step": 2 * np.pi / counts if counts else 1.0,
            "encoder_filter": parameters.encoder_filter,
            "hold_ticks": round(1 / (parameters.control_rate * dt)),
            "dt": dt,
            **_push_fields(push, p),
            **_composite_gains(kernel, parameters),
            "plant": robot.plant(parameters),
            "model": robot.model(parameters),
        }
    )


def pushed(kernel: Kernel, settings: Array, push: Push) -> Array:
    """The same settings with another push.

    Much cheaper than `settings_vector`, because it runs for every movement of a hand.
    """
    result, slices = settings.copy(), kernel.settings.slices
    for name, value in _push_fields(push, result[slices["hand_target"]].size).items():
        result[slices[name]] = value
    return result


def _push_fields(push: Push, p: int) -> dict[str, float | Array]:
    anchor, tangent = push.hold or (np.zeros(p), np.zeros(p))
    return {
        "hand_active": float(push.hand is not None),
        "hand_target": np.zeros(p) if push.hand is None else push.hand,
        "hold_active": float(push.hold is not None),
        "hold_anchor": anchor,
        "hold_tangent": tangent,
    }


def _composite_gains(kernel: Kernel, parameters: Parameters) -> dict[str, float]:
    """The gains of composite control, if the robot has a flexible link."""
    names = kernel.settings.slices.keys() & composite_control.GAINS.keys()
    return {name: getattr(parameters, name) for name in names}


def _empty_memory(kernel: Kernel) -> dict[str, Array]:
    """The memory of composite control at the start of a run."""
    fields = composite_control.MEMORY.fields
    return {name: np.zeros(size) for name, size in fields if name in kernel.state.slices}


def first_state(
    robot: Robot, kernel: Kernel, curve: Curve, q: Array, v: Array | None = None
) -> Array:
    """The state at the start of a run, with θ and θ_r at the closest point, by global search.

    Args:
        curve: the path.
        q: configuration, shape (n,).
        v: velocity, shape (n,); None: at rest.

    Returns:
        Shape (kernel.state.size,).
    """
    velocity = np.zeros_like(q) if v is None else v
    y = robot.endpoint(q)
    theta = curve.nearest(robot.frame.planar(y)[None])[0][0]
    m = robot.system.m
    return kernel.state.pack(
        {
            "q": q,
            "v": velocity,
            "theta": theta,
            "theta_rate": 0.0,
            "theta_ref": theta,
            "integral": np.zeros(robot.system.p),
            "encoder": q[:m],
            "encoder_rate": velocity[:m],
            "u": np.zeros(m),
            "phase": 0.0,
            **_empty_memory(kernel),
        }
    )


def brake_at(robot: Robot, curve: Curve, y: Array, theta: float) -> tuple[Array, Array]:
    """Anchor and unit tangent of a brake that is applied at the end-point y, each shape (p,).

    Args:
        y: shape (p,), [m].
        theta: of the closest point, whose tangent is taken, [rad].
    """
    first = robot.frame.lift(curve.at(np.array(theta), 1)) - robot.frame.lift(np.zeros(2))
    return np.array(y), first / np.linalg.norm(first)
