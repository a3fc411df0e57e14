"""What a lab has done since its reset: its events, and all of it as one value to be put aside."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.models.paths.curves import Curve


@dataclass(frozen=True, slots=True)
class LabEvent:
    """Something that was done, or that came about.

    Attributes:
        run: how often the robots had been set back to the start before.
        time: simulated, [s].
        name: "set", "path", "robot", "reset", "hold", "let_go", "pull", "release", "identify" or
            "diverged".
        detail: the parameter, the path, the robot; or empty.
        controllers: whom it concerns.
    """

    run: int
    time: float
    name: str
    detail: str
    controllers: tuple[str, ...]


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
