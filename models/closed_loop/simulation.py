"""From what a user sets to what the compiled loop takes: kinds, settings vectors, first states."""

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

NO_LIMIT = 1000.0  # [N m], a bound far beyond any motor, so that torques stay finite


@dataclass(frozen=True, slots=True, eq=False)
class Push:
    """Who acts on the end-point from outside, in output coordinates.

    Attributes:
        hand: where the hand is, shape (p,), or None.
        hold: anchor and unit tangent of the brake, each shape (p,), or None.
    """

    hand: Array | None = None
    hold: tuple[Array, Array] | None = None


FREE = Push()
_conic = lru_cache(maxsize=64)(Curve.conic)  # asked for at every change of a setting


def kind_of(
    controller: str, parameters: Parameters, curve: Curve, push: Push | None = None
) -> Kind:
    """Which loop serves this choice.

    Args:
        push: what acts from outside, where a leaner loop may serve while nothing does.
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
    """The kernel of a robot and kind, built once."""
    return build_kernel(robot.system, robot.frame, kind, robot.substeps, robot.grip)


def settings_vector(
    robot: Robot, kernel: Kernel, parameters: Parameters, curve: Curve, push: Push
) -> Array:
    """Everything but state and curve, as the loop takes it."""
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
    """The same settings with another push: much less work, and done for every move of a hand."""
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
    """Those of composite control, where the robot has a use for them."""
    names = kernel.settings.slices.keys() & composite_control.GAINS.keys()
    return {name: getattr(parameters, name) for name in names}


def _empty_memory(kernel: Kernel) -> dict[str, Array]:
    """Composite control's, at the start of a run."""
    fields = composite_control.MEMORY.fields
    return {name: np.zeros(size) for name, size in fields if name in kernel.state.slices}


def first_state(
    robot: Robot, kernel: Kernel, curve: Curve, q: Array, v: Array | None = None
) -> Array:
    """State at the start of a run: closest point found globally, reference point there too.

    Args:
        q, v: configuration and velocity (None: at rest), shape (n,).
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
    """Anchor and unit tangent of a hold that begins at the end-point y, near theta."""
    first = robot.frame.lift(curve.at(np.array(theta), 1)) - robot.frame.lift(np.zeros(2))
    return np.array(y), first / np.linalg.norm(first)
