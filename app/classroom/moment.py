"""The state of a lab at one instant, serialised to be shown in another process.

Unlike a setup it includes the exact states of the robots and the pushes on them, so that a lab that
adopts it continues exactly as the original does. moment_of_lab.py makes it, moment_check.py reads
and checks it, moment_to_lab.py adopts it.
"""

from __future__ import annotations

from typing import Annotated

import msgspec
import numpy as np

from onpath.app.lab.loops.typed_loops import Key
from onpath.app.lab.setups.setup import EXAGGERATIONS, RATES, LawName, Word
from onpath.models.closed_loop.obstacles import Wall
from onpath.models.closed_loop.simulation import kind_of
from onpath.models.control.benches import BENCHES
from onpath.models.control.laws.own import is_text
from onpath.models.errors import Message
from onpath.models.paths.curves import TERMS, Curve, from_terms, terms_of
from onpath.models.paths.path_design import MOST_POINTS
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters, changed

MOST_MARKS = 2000  # numbers, two for each marked point
Text = Annotated[str, msgspec.Meta(max_length=2000)]
Vector = Annotated[tuple[float, ...], msgspec.Meta(max_length=200)]
Series = Annotated[tuple[float, ...], msgspec.Meta(max_length=3 * TERMS)]
Points = Annotated[tuple[float, ...], msgspec.Meta(max_length=2 * MOST_POINTS)]
Marks = Annotated[tuple[float, ...], msgspec.Meta(max_length=MOST_MARKS)]


class Line(msgspec.Struct, frozen=True):
    """A curve by its coefficients, point by point, in two or three dimensions, [m]."""

    closed: bool
    terms: Series


class PathMoment(msgspec.Struct, frozen=True):
    """The edited and the followed path; see `app.lab.path_editor`."""

    name: Word
    target: Line
    before: Line | None
    progress: Annotated[float, msgspec.Meta(ge=0, le=1)]
    points: Points
    selected: int | None
    marks: Marks


class Stopped(msgspec.Struct, frozen=True):
    """That a robot stands still: since when, [s], and the `Message` that says why."""

    time: float
    code: Text
    arguments: Annotated[dict[Word, Text], msgspec.Meta(max_length=10)]

    def reason(self) -> Message:
        return Message(self.code, self.arguments)


class RobotMoment(msgspec.Struct, frozen=True):
    """One robot.

    Attributes:
        law: name of its control law, or a typed law.
        state: see `models.closed_loop.loop_vectors.state_layout`.
        sample: see `app.lab.plot_samples`.
        max_distance: largest distance to the path so far, [m].
        diverged: why and when its simulation was stopped [s], or None.
        hand, anchor, tangent, normal: the push on it, in output coordinates; empty if there is
            none. The brake acts along the tangent, and along the normal, too, if there is one.
    """

    law: LawName
    state: Vector
    sample: Vector
    max_distance: float
    diverged: Stopped | None
    hand: Vector
    anchor: Vector
    tangent: Vector
    normal: Vector = ()


class Moment(msgspec.Struct, frozen=True):
    """A lab as it is shown: now, or at the past instant that the student looks at.

    Attributes:
        run: number of resets so far.
        moves: whether simulated time runs.
        is_seen: whether the student's tab is drawing.
        achieved: simulated seconds per second.
        wall: z1, z2 and angle of the wall; empty if there is none.
    """

    robot: Word
    parameters: Annotated[dict[Word, int | float | Word], msgspec.Meta(max_length=100)]
    run: int
    time: float
    running: bool
    moves: bool
    rate: Annotated[float, msgspec.Meta(ge=RATES[0], le=RATES[-1])]
    exaggeration: Annotated[float, msgspec.Meta(ge=EXAGGERATIONS[0], le=EXAGGERATIONS[-1])]
    held: Annotated[tuple[Word, ...], msgspec.Meta(max_length=2)]
    grabbed: Word | None
    message: Text
    level: Word
    language: Word
    path: PathMoment
    robots: Annotated[tuple[RobotMoment, ...], msgspec.Meta(min_length=2, max_length=2)]
    is_seen: bool
    achieved: float
    wall: Annotated[tuple[float, ...], msgspec.Meta(max_length=3)] = ()


def laws_of(moment: Moment) -> dict[str, str]:
    """Control law of each bench."""
    return {bench: own.law for bench, own in zip(BENCHES, moment.robots, strict=True)}


def wall_of(moment: Moment) -> Wall | None:
    """The wall of the lab.

    Raises:
        ValueError: it is out of range.
    """
    return Wall(*moment.wall) if moment.wall else None


def typed_loops_of(moment: Moment) -> list[Key]:
    """The loops of typed laws that a lab needs to take it over.

    Raises:
        ValueError: see `parameters_of`.
    """
    parameters, curve = parameters_of(moment), curve_of(moment.path.target)
    robot = ROBOTS[moment.robot].make(parameters)
    typed = [each.law for each in moment.robots if is_text(each.law)]
    return [(robot, kind_of(law, parameters, curve)) for law in typed]


def parameters_of(moment: Moment) -> Parameters:
    """The parameters of the lab.

    Raises:
        ValueError: an unknown name or a bad value.
    """
    parameters = ROBOTS[moment.robot].lab
    for name, value in moment.parameters.items():
        parameters = changed(parameters, name, value)
    return parameters


def curve_of(line: Line) -> Curve:
    """The curve with these coefficients."""
    return from_terms(line.closed, np.array(line.terms).reshape(terms_of(line.closed), -1))
