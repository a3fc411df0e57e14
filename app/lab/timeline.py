"""What a lab has done since its reset, as one value that can be put aside and brought back."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.events import LabEvent
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.models.paths.curves import Curve


@dataclass(frozen=True, slots=True, eq=False)
class Timeline:
    """What a lab has done since its reset, and where that has left it; the set-up is no part of it.

    Attributes:
        time: at its end, [s].
        curve: the path at its end.
        history: the last minute of it.
        runs: the two closed loops at its end, by controller.
        grips: what holds and pulls at its end.
        events: what was done and came about.
    """

    time: float
    curve: Curve
    history: History
    runs: dict[str, ClosedLoopRun]
    grips: ExternalForces
    events: deque[LabEvent]
