"""The events and state of a lab since its last reset, as one value."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.events import EventLog
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.models.paths.curves import Curve


@dataclass(frozen=True, slots=True, eq=False)
class Timeline:
    """The events and state of a lab since its last reset, without its set-up.

    Attributes:
        time: at its end, [s].
        curve: the path at its end.
        history: the last minute.
        runs: the two closed loops at its end, by side.
        forces: external forces at its end.
        events: user actions and incidents.
    """

    time: float
    curve: Curve
    history: History
    runs: dict[str, ClosedLoopRun]
    forces: ExternalForces
    events: EventLog
