"""The events and state of a lab since its last reset, as one value."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from msgspec import Struct

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.models.paths.curves import Curve


class LabEvent(Struct, frozen=True, gc=False):
    """A user action or an incident. Not examined for garbage, since labs have many.

    Attributes:
        run: number of resets before it.
        time: simulated time, [s].
        name: "set", "path", "robot", "law", "reset", "hold", "let_go", "pull", "release",
            "identify" or "diverged".
        detail: the parameter, the path, the robot, or the `short_name` of the law; or empty.
        benches: the benches concerned.
    """

    run: int
    time: float
    name: str
    detail: str
    benches: tuple[str, ...]

    def repeats(self, earlier: LabEvent) -> bool:
        """Whether it sets the same parameter again, less than a second after an earlier event."""
        return (
            self.name == earlier.name == "set"
            and (self.run, self.detail) == (earlier.run, earlier.detail)
            and 0.0 <= self.time - earlier.time < 1.0
        )


@dataclass(frozen=True, slots=True, eq=False)
class Timeline:
    """The events and state of a lab since its last reset, without its set-up.

    Attributes:
        time: at its end, [s].
        curve: the path at its end.
        history: the last minute.
        runs: the two closed loops at its end, by bench.
        grips: external forces at its end.
        events: user actions and incidents, oldest first.
    """

    time: float
    curve: Curve
    history: History
    runs: dict[str, ClosedLoopRun]
    grips: ExternalForces
    events: deque[LabEvent]
