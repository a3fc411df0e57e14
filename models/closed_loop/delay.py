"""Computing delay: the torque that is computed from a measurement takes effect some time later.

The law is evaluated at times t_k, every `hold_ticks` ticks; its torque u_k takes effect at t_k + d.
d may be any multiple of the control interval up to `LONGEST`, also a fractional one. Within a tick
the plant is integrated in two parts, before and after the torque changes. The control law does not
know about the delay.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.layout import Fields

LONGEST = 8  # control intervals


@dataclass(frozen=True, slots=True)
class DelayedTorque:
    """The motors' torques in a tick.

    Attributes:
        parts: (torque (m, 1) [N m], share of the tick) of its consecutive parts.
        mean: over the tick, (m, 1), [N m].
        memory: "u", the torque at its end, and "queue", the torques computed earlier.
    """

    parts: tuple[tuple[ca.SX, ca.SX], ...]
    mean: ca.SX
    memory: Fields


def driven(kind: Kind, state: Fields, settings: Fields, fresh: ca.SX, acts: ca.SX) -> DelayedTorque:
    """The torques in a tick.

    With p ticks since the latest evaluation k, H = `hold_ticks`, and d in ticks, u_{k-j} takes
    effect in this tick, or has done so before, if p + j H + 1 > d; the smallest such j counts.

    Args:
        state: with "u", the torque in effect at the beginning of the tick.
        fresh: torque that the law computes in this tick, (m, 1), [N m].
        acts: whether it is evaluated in this tick.
    """
    if not kind.delay:
        return DelayedTorque(((fresh, ca.SX(1)),), fresh, {"u": fresh})
    m, before = fresh.numel(), state["u"]
    shifted, unchanged = ca.vertcat(fresh, state["queue"]), ca.vertcat(state["queue"], before)
    known = ca.if_else(acts, shifted, unchanged)
    interval, wait = settings["hold_ticks"], settings["delay_ticks"] - state["phase"]
    latest = ca.fmax(ca.floor((wait - 1) / interval) + 1, 0)
    after = known[-m:]
    for j in range(LONGEST):
        after = ca.if_else(latest == j, known[j * m : (j + 1) * m], after)
    share = ca.fmin(ca.fmax(wait - latest * interval, 0), 1)
    mean = after + share * (before - after)
    parts = (before, share), (after, 1 - share)
    return DelayedTorque(parts, mean, {"u": after, "queue": known[:-m]})
