"""Viewing the past of a lab, continuing from it, and undoing that.

Only continuing discards history. What it discards can be restored until the next continuation,
a reset, or a change of the robot. Time continues with the present path, parameters and control
laws; a law that was not in force at that instant begins there as after any change of law.
"""

from __future__ import annotations

from copy import copy

from onpath.app.lab.events import EventLog
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.segments import Segment
from onpath.app.lab.session import Session
from onpath.app.lab.timeline import Timeline
from onpath.models.control.laws.own import short_name


def look_back(session: Session, ago: float) -> None:
    """Pause and view the state `ago` seconds before now, or the oldest one stored."""
    session.forces.release()
    session.look_at(session.time - min(ago, session.history.span()))


def forget_history(session: Session) -> None:
    """Delete the history, and do not keep arrays in memory that hold the states of other labs."""
    session.history.clear()
    for run in session.runs.values():
        run.unshare()
    session.instant()  # otherwise the session would keep the previous instant, with those arrays


def go_on(session: Session) -> tuple[float, float] | None:
    """Continue from the viewed instant; the later history is discarded.

    Returns:
        The instant and the duration discarded, [s]; None if the present was being viewed.
    """
    segment = None if session.viewing is None else session.history.at(session.viewing)
    replaced = None
    if segment is not None:
        replaced = _timeline(session)
        _take(session, _branch(session, segment))
        session.note("let_go")
        session.note("release")
        for side, drive in segment.drives.items():
            if (law := session.laws[side]) != drive.kind.law:
                session.note("law", short_name(law), (side,))
        session.undo_timeline = replaced
    session.viewing, session.running = None, True
    return None if replaced is None else (session.time, replaced.time - session.time)


def undo_going_on(session: Session) -> bool:
    """Restore the discarded history, paused at its end, and discard the current one.

    Returns:
        Whether there was a history to restore.
    """
    discarded = session.undo_timeline
    if discarded is None:
        return False
    session.forces.release()
    session.viewing = None
    session.running = False
    session.undo_timeline = _timeline(session)
    _take(session, discarded)
    return True


def _timeline(session: Session) -> Timeline:
    session.history.settle()  # its samples depend on the current parameters
    return Timeline(
        time=session.time,
        curve=session.editor.curve,
        history=session.history,
        runs=session.runs,
        forces=session.forces,
        events=session.events,
    )


def _take(session: Session, timeline: Timeline) -> None:
    """Switch to the end of a timeline, with the current path and parameters."""
    session.time, session.history = timeline.time, timeline.history
    session.runs, session.forces = timeline.runs, timeline.forces
    session.events = timeline.events
    session.forces.set_wall(session.wall)
    for run in session.runs.values():
        if run.robot is not session.robot:
            push = session.forces.pushes[run.side]
            run.change_robot(session.robot, session.parameters, session.editor.curve, push)
    if timeline.curve is not session.editor.curve:
        for run in session.runs.values():
            run.change_path(session.editor.curve)


def _branch(session: Session, segment: Segment) -> Timeline:
    """A timeline that ends where a segment of the current one begins, without external forces."""
    runs = {name: copy(run) for name, run in session.runs.items()}
    for name, run in runs.items():
        run.restore(segment.drives[name], segment.curve)
    kept = [e for e in session.events if e.run != session.run_number or e.time <= segment.time]
    return Timeline(
        time=segment.time,
        curve=segment.curve,
        history=session.history.before(segment),
        runs=runs,
        forces=ExternalForces(session.robot, runs, session.note),
        events=EventLog(kept),
    )
