"""The state of a lab at one instant, serialised to be shown in another process.

Unlike a setup it includes the exact states of the robots and the pushes on them, so that a lab that
adopts it continues exactly as the original does.
"""

from __future__ import annotations

from dataclasses import astuple, replace
from typing import Annotated, Any

import msgspec
import numpy as np

from onpath.app.lab.closed_loop_run import ClosedLoopRun, Diverged
from onpath.app.lab.lab import Lab
from onpath.app.lab.path_editor import Blend, PathEditor
from onpath.app.lab.plot_samples import places
from onpath.app.lab.session import Session
from onpath.app.lab.setups.setup import EXAGGERATIONS, RATES, LawName, Word
from onpath.app.lab.typed_loops import Key
from onpath.app.simulation.simulation_thread import ScheduledLab
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_vectors import log_layout, state_layout
from onpath.models.closed_loop.obstacles import Wall
from onpath.models.closed_loop.simulation import Push, kind_of
from onpath.models.control.benches import BENCHES, checked_laws
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.paths.curve_faults import Fault
from onpath.models.paths.curves import TERMS, Curve, from_terms, terms_of
from onpath.models.paths.path_design import MOST_POINTS, PathDesign
from onpath.models.systems.catalogue import ROBOTS, RobotEntry
from onpath.models.systems.parameters import Parameters, changed, specs

MOST_MARKS = 2000  # numbers, two for each marked point
INSTANT = 1e-6  # [s], shorter than any tick
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


def tell(scheduled: ScheduledLab) -> Moment:
    """The state of a lab. Fast; call it on the simulation thread."""
    lab, session = scheduled.lab, scheduled.session
    past = None if session.viewing is None else session.history.at(session.viewing)
    instant = session.instant() if past is None else past.instant()
    own, base = session.parameters, session.entry.lab
    values = {name: getattr(own, name) for name in specs(own)}
    robots = tuple(
        _robot(
            session.runs[bench],
            session.grips.pushes[bench],
            instant.laws[number],
            instant.states[number],
            instant.sample[number],
            instant.max_distances[number],
        )
        for number, bench in enumerate(BENCHES)
    )
    return Moment(
        robot=session.entry.name,
        parameters={n: value for n, value in values.items() if value != getattr(base, n)},
        run=session.run_number,
        time=instant.time if session.viewing is None else session.viewing,
        running=session.running,
        moves=session.running and not lab.frozen,
        rate=session.rate,
        exaggeration=session.exaggeration,
        held=tuple(session.grips.held),
        grabbed=session.grips.grabbed,
        message=lab.message[:2000],
        level=lab.message_level,
        language=lab.words.language,
        path=_path(session.editor, past and past.curve),
        robots=robots,
        is_seen=scheduled.is_seen,
        achieved=scheduled.achieved,
        wall=() if session.wall is None else astuple(session.wall),
    )


def _robot(
    run: ClosedLoopRun, push: Push, law: str, state: Array, sample: Array, most: float
) -> RobotMoment:
    anchor, tangent = push.hold or (np.zeros(0), np.zeros(0))
    return RobotMoment(
        law=law,
        state=tuple(state.tolist()),
        sample=tuple(np.nan_to_num(sample).tolist()),
        max_distance=float(most),
        diverged=run.diverged and _stopped(run.diverged),
        hand=() if push.hand is None else tuple(push.hand.tolist()),
        anchor=tuple(anchor.tolist()),
        tangent=tuple(tangent.tolist()),
        normal=() if push.hold_normal is None else tuple(push.hold_normal.tolist()),
    )


def _stopped(diverged: Diverged) -> Stopped:
    reason = diverged.reason
    arguments = {name: str(value) for name, value in reason.arguments.items()}
    return Stopped(diverged.time, reason.code, arguments)


def _path(editor: PathEditor, past: Curve | None) -> PathMoment:
    followed = editor.blend if past is None else Blend(past)
    points, faults = (editor.points(), editor.faults) if past is None else (np.zeros(0), ())
    marks = [number for fault in faults for number in fault.points[:, :2].ravel().tolist()]
    return PathMoment(
        name=(editor.proposed or editor.design).name,
        target=_line(followed.target),
        before=None if followed.before is None else _line(followed.before),
        progress=followed.progress,
        points=tuple(points.ravel().tolist()),
        selected=editor.selected,
        marks=tuple(marks[:MOST_MARKS]),
    )


def _line(curve: Curve) -> Line:
    return Line(curve.closed, tuple(curve.terms().ravel().tolist()))


def read_moment(text: str) -> Moment:
    """The state in JSON, validated.

    Raises:
        ValueError: it is not a valid state of a known robot.
    """
    moment = msgspec.json.decode(text, type=Moment)
    if moment.robot not in ROBOTS:
        raise ValueError(f"no robot {moment.robot!r}")
    entry = ROBOTS[moment.robot]
    robot = entry.make(parameters_of(moment))
    samples = places(robot)
    for line in (moment.path.target, moment.path.before):
        if line is not None:
            in_space = robot.frame.space is not None and len(line.terms) == 3 * terms_of(
                line.closed
            )
            _numbers(line.terms, (3 if in_space else 2) * terms_of(line.closed))
    for numbers in (moment.path.points, moment.path.marks):
        _numbers(numbers, 2 * (len(numbers) // 2))
    if checked_laws(laws_of(moment), entry) != laws_of(moment):
        raise ValueError("a typed law is on one line")
    for each, law in zip(moment.robots, laws_of(moment).values(), strict=True):
        _numbers(each.state, state_layout(robot.system, law_named(law).memory).size)
        _numbers(each.sample, len(samples))
        for pull in (each.hand, each.anchor, each.tangent, each.normal):
            _numbers(pull, robot.system.p if pull else 0)
        if each.diverged is not None:
            _sayable(each.diverged.reason())
        if bool(each.anchor) != bool(each.tangent) or (each.normal and not each.anchor):
            raise ValueError("half a brake")
    if moment.wall:
        _numbers(moment.wall, 3)
        wall_of(moment)
    most = [each.max_distance for each in moment.robots]
    _numbers((moment.time, moment.achieved, *most), 4)
    if not {*moment.held, moment.grabbed} <= {*BENCHES, None}:
        raise ValueError("somebody else is held")
    return moment


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
    parameters, curve = parameters_of(moment), _curve(moment.path.target)
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


def _numbers(numbers: tuple[float, ...], size: int) -> None:
    if len(numbers) != size or not np.isfinite(numbers).all():
        raise ValueError(f"expected {size} finite numbers, got {len(numbers)}")


def _sayable(message: Message) -> None:
    try:
        str(message)
    except KeyError:
        raise ValueError(f"no message {message.code!r} with these arguments") from None


def take_over(lab: Lab, new: Moment, old: Moment | None) -> None:
    """Put a lab into a received state. Call it on the simulation thread.

    Args:
        lab: whose state is replaced.
        new: the received state, from `read_moment`.
        old: the one adopted before; only differences are applied.
    """
    session = lab.session
    entry: RobotEntry = ROBOTS[new.robot]
    session.choose_robot(entry)
    other_path = old is None or (new.robot, new.path) != (old.robot, old.path)
    if old is None or (new.robot, new.parameters) != (old.robot, old.parameters):
        if other_path:  # the path of before may be out of reach in another plane
            _take_path(session.editor, new.path)
        session.set_parameters(parameters_of(new))
    if other_path:
        _take_path(session.editor, new.path)
    if old is None or new.run != old.run or new.time < session.time - INSTANT:
        session.history.clear()
    if new.language != lab.words.language:
        lab.lessons.set_language(new.language)
    session.time, session.running, session.rate = new.time, new.running, new.rate
    session.exaggeration, grips = new.exaggeration, session.grips
    grips.grabbed, grips.held = new.grabbed, {*new.held}
    session.set_wall(wall_of(new))
    lab.show_message(new.message, new.level)
    for bench, robot in zip(BENCHES, new.robots, strict=True):
        grips.pushes[bench] = replace(grips.pushes[bench], **_pull(robot))
        session.change_law(bench, laws_of(new)[bench])
        _take_robot(session, session.runs[bench], robot)


def _take_path(editor: PathEditor, path: PathMoment) -> None:
    target, before = _curve(path.target), path.before and _curve(path.before)
    points = np.array(path.points).reshape(-1, 2)
    marked = np.array(path.marks).reshape(-1, 2)
    marks = [Fault(Message("fault.outside"), marked)] if path.marks else []
    shown = PathDesign(path.name, target.plan, points)
    editor.show(shown, Blend(target, before, path.progress), marks)
    editor.select(path.selected)


def _curve(line: Line) -> Curve:
    return from_terms(line.closed, np.array(line.terms).reshape(terms_of(line.closed), -1))


def _pull(robot: RobotMoment) -> dict[str, Any]:
    """The fields of `Push` of a hand and a brake."""
    return {
        "hand": np.array(robot.hand) if robot.hand else None,
        "hold": (np.array(robot.anchor), np.array(robot.tangent)) if robot.anchor else None,
        "hold_normal": np.array(robot.normal) if robot.normal else None,
    }


def _take_robot(session: Session, run: ClosedLoopRun, robot: RobotMoment) -> None:
    fields, log = session.sample_layout.slices, log_layout(session.robot.system)
    run.state = np.array(robot.state)
    now, row = run.fields(), np.zeros(log.size)
    sample, known = np.array(robot.sample), places(session.robot)
    row[known[known > 0]] = sample[known > 0]
    log.unpack(row)["q"][:], log.unpack(row)["v"][:] = now["q"], now["v"]
    run.row, run.distance = row, float(sample[fields["distance"].start])
    run.max_distance = robot.max_distance
    run.diverged = (
        None if robot.diverged is None else Diverged(robot.diverged.reason(), robot.diverged.time)
    )
