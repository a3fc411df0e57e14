"""Snapshot for a whole page: the scene, the plots and the fields of one lab at one instant."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from onpath.app.lab.plant_state import PlantState
from onpath.app.lab.shown_log import ShownLog
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.lessons.checks import Verdict
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress, Truth
from onpath.lessons.votes import Vote
from onpath.models.closed_loop.lab_settings import LabSettings
from onpath.models.control.place import Place
from onpath.models.control.settable import parameters_from
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import Frame
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

ParameterValues = dict[str, float | int | str]
"""Values of parameters by name."""


@dataclass(frozen=True, slots=True)
class RunState:
    """The clock and the laws of a lab.

    Attributes:
        now: simulated time, also while the past is viewed, [s].
        viewing: the past instant being viewed, [s], or None.
        frozen: whether the teacher has stopped the lab.
        waits: whether time waits for loops that are being made, or for a long command.
        can_undo_going_on: whether a discarded timeline can be restored.
        laws: control law of each side, also while the past is viewed or its loop is being made.
    """

    now: float
    viewing: float | None
    frozen: bool
    waits: bool
    can_undo_going_on: bool
    laws: dict[str, str]


@dataclass(frozen=True, slots=True, eq=False)
class LogSnapshot:
    """The log of a real arm over the plots, and what its curves depend on.

    Attributes:
        log: of the lab's robot.
        frame: of the robot's path.
        curve: the path; while it changes, the one before.
        is_level_set: whether ξ₁ is an area.
    """

    log: ShownLog
    frame: Frame
    curve: Curve
    is_level_set: bool


@dataclass(frozen=True, slots=True, eq=False)
class LawPlaces:
    """Places on the path at which the poles of some laws are shown.

    Attributes:
        time: when the robots were there, [s].
        version: changes whenever the robot, the path or a law does.
        of: places, by side; sides whose laws have the same poles everywhere are missing.
    """

    time: float
    version: tuple[str | int, ...]
    of: dict[str, Place]


@dataclass(frozen=True, slots=True)
class PathEdit:
    """The path being edited, in its own plane.

    Attributes:
        version: changes whenever anything here does.
        name: of the last valid design.
        sampled: points of the last valid design, shape (n, 2), [m].
        points: control points as shown, shape (k, 2), [m].
        selected: index of the selected control point, or None.
        can_undo, can_redo: whether there is an edit to undo, or one that was undone.
        fastest: the largest speed that is wanted along a drawing, [m/s]; 0 on other paths.
    """

    version: int
    name: str
    sampled: np.ndarray
    points: np.ndarray
    selected: int | None
    can_undo: bool
    can_redo: bool
    fastest: float = 0.0


@dataclass(frozen=True, slots=True)
class LessonSnapshot:
    """Progress through the lessons; the texts are in the course.

    Attributes:
        version: changes whenever the lesson's page must be redrawn.
        progress: the part that is saved.
        playing: whether the lab is playing the step's demonstration.
        verdicts: on the checks of the open step's tasks, by task.
        truth: actual curves of the quantity that the open step predicts, or None.
        pace: the steps within which the teacher lets the student go; None if anywhere.
        votes: what the class is asked now.
        presenting: whether it is shown to a class, with large type.
    """

    version: int
    progress: Progress
    playing: bool
    verdicts: dict[str, list[Verdict]]
    truth: Truth | None
    pace: Pace | None = None
    votes: tuple[Vote, ...] = ()
    presenting: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class PageSnapshot(Snapshot):
    """A lab at one instant: everything that its page shows.

    Attributes:
        parameters: of the robot and its controllers.
        joints: the right robot's joint coordinates, shape (n,), [rad].
        run, edit, lesson: state of these parts of the page.
        settings: the lab's own settings.
        refused: see `Lab.refused`.
        wall_forces: between each end-point and the wall, by side, [N]; empty without a wall.
        places: of the robots on the path, for the poles of their laws.
        shared: the last share code made.
        sent: keys of answers that are stored; see `LessonState.sent`.
        nickname: the student's nickname in the class, or empty.
        log: of a real arm, or None.
        plant: see `Lab.plant`.
    """

    parameters: ParameterValues
    joints: np.ndarray
    run: RunState
    edit: PathEdit
    lesson: LessonSnapshot
    shared: str
    sent: tuple[str, ...]
    nickname: str
    settings: LabSettings
    refused: dict[str, str]
    wall_forces: dict[str, float]
    places: LawPlaces
    log: LogSnapshot | None
    plant: PlantState | None = None

    @property
    def values(self) -> dict[str, Any]:
        """The values of all settings by name: parameters, gains, the lab's own; laws by side."""
        return {**self.parameters, **self.settings.values, **self.run.laws}


def parameters_of(snapshot: PageSnapshot) -> Parameters:
    """The parameters as an object."""
    return parameters_from(ROBOTS[snapshot.key.robot].parameters, snapshot.parameters)


def robot_of(snapshot: PageSnapshot) -> Robot:
    """The robot's model."""
    return ROBOTS[snapshot.key.robot].make(parameters_of(snapshot))
