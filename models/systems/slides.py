"""Slides whose travel ends at buffers, at which they stand as at a wall."""

from __future__ import annotations

import casadi as ca

from onpath.models.errors import Message
from onpath.models.systems.forces import SpringLimits, wall
from onpath.models.systems.robots import StopCondition

BUFFER = SpringLimits(stiffness=20_000.0, damping=100.0, largest=1000.0)
DEPTH = 0.02  # [m], by which a buffer yields at most
CRUSHED = Message("stop.crushed")


def buffers(x: ca.SX, rate: ca.SX, travel: float) -> ca.SX:
    """The forces of a buffer at both ends of each slide, (k, 1), [N]; each is a `wall`.

    Args:
        x: places of the slides from the middle of their travel, (k, 1), [m].
        rate: their velocities, (k, 1), [m/s].
        travel: to either side, where the buffers begin, [m].
    """
    forces = ca.SX.zeros(x.numel())
    for i in range(x.numel()):
        for inward in (1, -1):
            end = ca.SX(-inward * travel)
            forces[i] += wall(x[i], rate[i], end, ca.SX(inward), ca.SX(1), BUFFER)
    return forces


def crushed(x: ca.SX, travel: float) -> StopCondition:
    """A slide has come to its buffer with more than that can bear; see `buffers`."""
    return StopCondition(ca.mmax(ca.fabs(x)) > travel + DEPTH, CRUSHED)


def room(x: ca.SX, travel: float) -> ca.SX:
    """A regularity that falls from 1 at three quarters of the travel to 0 at its end, (1, 1)."""
    return ca.fmin(1, 4 * (1 - ca.mmax(ca.fabs(x)) / travel))
