"""What a whole page shows of one lab at one instant: the scene, the plots and the panels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.lessons.checks import Verdict
from onpath.lessons.progress import Progress, Truth
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

ParameterValues = dict[str, float | int | str]
"""Values of parameters by name."""


@dataclass(frozen=True, slots=True)
class RunState:
    """The clock and the switches of a lab.

    Attributes:
        now: simulated time, also while the past is looked at, [s].
        viewing: the past instant being looked at, [s], or None.
        can_undo_going_on: whether what going on from the past has forgotten can be brought back.
        rate: simulated seconds per second, as wanted.
        copy: whether hand and hold act on both robots.
        exaggeration: how many times larger a deflection is drawn.
    """

    now: float
    viewing: float | None
    can_undo_going_on: bool
    rate: float
    copy: bool
    exaggeration: float


@dataclass(frozen=True, slots=True)
class PathEdit:
    """The path as it is edited, in its own plane.

    Attributes:
        version: changes whenever anything here does.
        name: of the last valid design.
        sampled: points of the last valid design, shape (n, 2), [m].
        points: control points as shown, shape (k, 2), [m].
        selected: index of the selected control point, or None.
    """

    version: int
    name: str
    sampled: np.ndarray
    points: np.ndarray
    selected: int | None


@dataclass(frozen=True, slots=True)
class LessonSnapshot:
    """The way through the lessons; texts are in the course, which whoever draws has.

    Attributes:
        version: changes whenever the lesson's page must be drawn anew.
        progress: what is kept.
        playing: whether the lab does by itself what the step shows.
        verdicts: on the checks of the open step's tasks, by task.
        truth: what has happened of the quantity that the open step predicts, or None.
    """

    version: int
    progress: Progress
    playing: bool
    verdicts: dict[str, list[Verdict]]
    truth: Truth | None


@dataclass(frozen=True, slots=True)
class PlotSamples:
    """What there is to plot of the last seconds.

    Attributes:
        times: shape (n,), [s].
        values: shape (n, robots, fields), fields as in `PageKey.fields`, in SI units.
    """

    times: np.ndarray
    values: np.ndarray


@dataclass(frozen=True, slots=True, kw_only=True)
class PageSnapshot(Snapshot):
    """A lab at one instant: all that its page shows.

    Attributes:
        parameters: of the robot and its controllers.
        joints: the follower's joint coordinates, shape (n,), [rad].
        run, edit, lesson, plots: see there.
        shared: the share code asked for last.
        nickname: the student's in the class; empty for none.
    """

    parameters: ParameterValues
    joints: np.ndarray
    run: RunState
    edit: PathEdit
    lesson: LessonSnapshot
    plots: PlotSamples
    shared: str
    nickname: str


def parameters_of(snapshot: PageSnapshot) -> Parameters:
    """The parameters as an object."""
    return ROBOTS[snapshot.key.robot].parameters(**snapshot.parameters)  # pyright: ignore[reportArgumentType]


def robot_of(snapshot: PageSnapshot) -> Robot:
    """The robot's model."""
    return ROBOTS[snapshot.key.robot].make(parameters_of(snapshot))
