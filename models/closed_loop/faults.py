"""Why and when a run has diverged."""

from __future__ import annotations

import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.laws.expressions import LARGEST_NUMBER
from onpath.models.control.laws.own import is_text
from onpath.models.errors import Message
from onpath.models.layout import Layout
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import NOT_FINITE, Robot

TYPED_LAW = Message("stop.typed_law", {"most": f"{LARGEST_NUMBER:g}"})


def not_finite(law: str) -> Message:
    """Why a state that is not finite stops a run under this law."""
    return TYPED_LAW if is_text(law) else NOT_FINITE


def fault_in(
    robot: Robot, log: Layout, law: str, rows: Array, parameters: Parameters
) -> tuple[int, Message] | None:
    """The first row in which a run has diverged, and why; None if in none.

    Args:
        log: layout of the rows.
        law: name of the control law. A typed one shows by the reference point that its numbers
            were not finite; see models/control/laws/own.py.
        rows: of the log, shape (ticks, log.size).
    """
    fields = log.unpack(rows)
    fault = robot.fault(fields["q"], fields["v"], parameters)
    bad = np.isnan(fields["theta_ref"][:, 0])
    if bad.any() and (fault is None or bad.argmax() < fault[0]):
        return int(bad.argmax()), not_finite(law)
    return fault
