"""The speed reference of a tick, which ramps to the wanted speed."""

from __future__ import annotations

import casadi as ca

from onpath.models.closed_loop.loop_vectors import LoopLayouts
from onpath.models.control.bend_limit import allowed_turning
from onpath.models.control.laws.law import PathReference
from onpath.models.layout import Fields


def kept_speed(settings: Fields) -> ca.SX:
    """The wanted speed of θ, [rad/s].

    That of a drawing is for its usual duration, and at most what its bends allow, see
    `bend_limit`.
    """
    if "turning" not in settings:
        return settings["speed"]
    interval = settings["hold_ticks"] * settings["dt"]
    limit = allowed_turning(settings["K1"], interval) / settings["turning"]
    return ca.fmin(ca.fmax(settings["speed"] / settings["duration"], -limit), limit)


def speed_function(layouts: LoopLayouts) -> ca.Function:
    """The function settings -> `kept_speed`."""
    settings, fields = layouts.settings.symbols("settings")
    return ca.Function("kept_speed", [settings], [kept_speed(fields)])


def wanted_speed(state: Fields, settings: Fields) -> tuple[ca.SX, ca.SX]:
    """The speed reference ω at the beginning of a tick [rad/s], and its rate [rad/s²].

    It approaches the wanted speed at the rate `ramp`, or is equal to it if that is 0.
    """
    speed, ramp, now = kept_speed(settings), settings["ramp"], state["speed_ref"]
    rate = ca.fmin(ca.fmax((speed - now) / settings["dt"], -ramp), ramp)
    return ca.if_else(ramp > 0, now, speed), rate


def next_speed(state: Fields, settings: Fields) -> ca.SX:
    """The speed reference after the tick, [rad/s]."""
    speed, rate = wanted_speed(state, settings)
    return speed + settings["dt"] * rate


def task_at(state: Fields, settings: Fields, h: ca.SX) -> PathReference:
    """The wanted motion along the path, the time h [s] ahead."""
    speed, rate = wanted_speed(state, settings)
    ahead = speed + h * rate
    return PathReference(
        position=settings["position"],
        target=settings["target"],
        speed=ahead,
        limit=settings["speed_limit"],
        acceleration=rate,
    )
