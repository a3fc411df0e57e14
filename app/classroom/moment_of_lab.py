"""The state of a lab as a moment, to be sent to those who watch it."""

from __future__ import annotations

from dataclasses import astuple

import numpy as np

from onpath.app.classroom.moment import MOST_MARKS, Line, Moment, PathMoment, RobotMoment, Stopped
from onpath.app.lab.closed_loop_run import ClosedLoopRun, Diverged
from onpath.app.lab.path_editor import Blend, PathEditor
from onpath.app.simulation.simulation_thread import ScheduledLab
from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import Push
from onpath.models.control.benches import BENCHES
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import specs


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
