"""What a user can ask of a session: callbacks make these, the simulation thread applies them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from onpath.app.lab.lesson_commands import LessonCommand

EXAGGERATIONS = (1.0, 20.0)  # the least and the most
RATES = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0)  # simulated seconds per second


@dataclass(frozen=True, slots=True)
class SetParameter:
    """Set one field of the parameters."""

    name: str
    value: Any


@dataclass(frozen=True, slots=True)
class ResetParameters:
    """All parameters to their defaults."""


@dataclass(frozen=True, slots=True)
class Identify:
    """Give the controllers the model that the follower's last seconds tell."""


@dataclass(frozen=True, slots=True)
class ChooseRobot:
    """Another robot; path and parameters are those that it had before, or its defaults."""

    name: str


@dataclass(frozen=True, slots=True)
class SetRunning:
    """Run or pause; None toggles."""

    running: bool | None = None


@dataclass(frozen=True, slots=True)
class StepOnce:
    """One step of simulated time while paused."""


@dataclass(frozen=True, slots=True)
class Reset:
    """Both robots to the start, at rest; path and parameters stay."""


@dataclass(frozen=True, slots=True)
class SetRate:
    """Simulated seconds per second."""

    rate: float


@dataclass(frozen=True, slots=True)
class LookAt:
    """Pause and look at how it was, [s] before now; 0 is now."""

    ago: float


@dataclass(frozen=True, slots=True)
class LookBack:
    """Look further back, or forward, [s]."""

    by: float


@dataclass(frozen=True, slots=True)
class GoOn:
    """Go on from the instant being looked at; what came after it is put aside."""


@dataclass(frozen=True, slots=True)
class UndoGoOn:
    """Bring back what was put aside last, and put aside what was done instead."""


@dataclass(frozen=True, slots=True)
class Hold:
    """Hold the end-points back, or let go; None toggles. Which robots: see `SetCopy`."""

    on: bool | None = None
    controller: str | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Grab:
    """Pull a robot's end-point towards a target in the robot's frame, shape (3,), [m]."""

    controller: str
    target: np.ndarray


@dataclass(frozen=True, slots=True)
class Release:
    """Let the end-points go; with a name, only if that robot's is the one being pulled."""

    controller: str | None = None


@dataclass(frozen=True, slots=True)
class MoveHand:
    """Move the hand by a little in the path's plane, [m]; it takes hold first if need be."""

    right: float
    up: float


@dataclass(frozen=True, slots=True)
class SetCopy:
    """Whether hand and hold act on both robots."""

    on: bool


@dataclass(frozen=True, slots=True)
class SetExaggeration:
    """How many times larger a deflection is drawn; the simulation knows nothing of it."""

    factor: float


@dataclass(frozen=True, slots=True)
class ChoosePath:
    """Follow a preset."""

    name: str


@dataclass(frozen=True, slots=True)
class SelectPoint:
    """Select a control point."""

    index: int | None


@dataclass(frozen=True, slots=True, eq=False)
class MovePoint:
    """Move a control point to a place in the robot's frame, shape (3,), [m].

    Attributes:
        finished: whether the drag ends here; only then can it be undone as one edit.
    """

    index: int
    target: np.ndarray
    finished: bool = True


@dataclass(frozen=True, slots=True)
class EndMove:
    """The control point being dragged is let go where it is."""


@dataclass(frozen=True, slots=True)
class SelectNext:
    """Select the control point after the selected one, or the first."""


@dataclass(frozen=True, slots=True)
class Arrow:
    """Move the selected control point by a little, [m]; to the right with none: one step."""

    right: float
    up: float


@dataclass(frozen=True, slots=True)
class PlacePoint:
    """Put the selected control point at coordinates of the path's plane, [m]; None keeps one."""

    first: float | None = None
    second: float | None = None


@dataclass(frozen=True, slots=True)
class AddPoint:
    """A control point more, after the selected one."""


@dataclass(frozen=True, slots=True)
class RemovePoint:
    """The selected control point away."""


@dataclass(frozen=True, slots=True, eq=False)
class DrawPath:
    """Follow a freehand stroke, shape (n, 3), in the robot's frame, [m]."""

    stroke: np.ndarray


@dataclass(frozen=True, slots=True)
class Undo:
    """The path as before the last edit."""


@dataclass(frozen=True, slots=True)
class Redo:
    """The path as before the last undo."""


@dataclass(frozen=True, slots=True)
class Share:
    """Make a share code of the lab as it is."""


@dataclass(frozen=True, slots=True)
class UseShared:
    """Set the lab up as a share code says."""

    text: str


Command = (
    SetParameter
    | ResetParameters
    | Identify
    | ChooseRobot
    | SetRunning
    | StepOnce
    | Reset
    | SetRate
    | LookAt
    | LookBack
    | GoOn
    | UndoGoOn
    | Hold
    | Grab
    | Release
    | MoveHand
    | SetCopy
    | SetExaggeration
    | ChoosePath
    | SelectPoint
    | MovePoint
    | EndMove
    | SelectNext
    | Arrow
    | PlacePoint
    | AddPoint
    | RemovePoint
    | DrawPath
    | Undo
    | Redo
    | Share
    | UseShared
    | LessonCommand
)

LETS_TIME_RUN = (SetRunning, StepOnce, GoOn)
"""What a locked session refuses."""
