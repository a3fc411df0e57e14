"""Looking at the past of a lab: returning from it, going on from it, and undoing that.

Only going on forgets anything, and what it forgets is put aside until it is done again, the robots
are reset or another robot is chosen.
"""

from __future__ import annotations

from collections import deque
from copy import copy

from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.segments import Segment
from onpath.app.lab.session import Session
from onpath.app.lab.timeline import Timeline


def look_back(session: Session, ago: float) -> None:
    """Pause and look at how it was, [s] before now, or at the oldest instant that is kept."""
    session.running = False
    session.grips.release()
    session.viewing = session.time - min(ago, session.history.span())


def go_on(session: Session) -> tuple[float, float] | None:
    """Run on from the instant being looked at; what came after it is put aside.

    Returns:
        That instant and how much was put aside, [s]; None if nothing was being looked at.
    """
    stretch = None if session.viewing is None else session.history.at(session.viewing)
    left = None
    if stretch is not None:
        left = _timeline(session)
        _take(session, _branch(session, stretch))
        session.note("let_go")
        session.note("release")
        session.put_aside = left
    session.viewing, session.running = None, True
    return None if left is None else (session.time, left.time - session.time)


def undo_going_on(session: Session) -> bool:
    """Bring back what was put aside, paused at its end; what was done instead is put aside.

    Returns:
        Whether there was anything.
    """
    back = session.put_aside
    if back is None:
        return False
    session.grips.release()
    session.viewing = None
    session.running = False
    session.put_aside = _timeline(session)
    _take(session, back)
    return True


def _timeline(session: Session) -> Timeline:
    session.history.settle()  # its samples are of the parameters of now
    return Timeline(
        session.time,
        session.editor.curve,
        session.history,
        session.runs,
        session.grips,
        session.events,
    )


def _take(session: Session, timeline: Timeline) -> None:
    """Be at the end of a timeline, with the path and the parameters of now."""
    session.time, session.history = timeline.time, timeline.history
    session.runs, session.grips = timeline.runs, timeline.grips
    session.events = timeline.events
    if timeline.curve is not session.editor.curve:
        for run in session.runs.values():
            run.change_path(session.editor.curve)


def _branch(session: Session, stretch: Segment) -> Timeline:
    """A timeline that ends where a stretch of this one begins; nobody holds or pulls there."""
    runs = {name: copy(run) for name, run in session.runs.items()}
    for name, run in runs.items():
        run.restore(stretch.drives[name], stretch.curve)
    events = session.events
    kept = [e for e in events if e.run != session.run_number or e.time <= stretch.time]
    return Timeline(
        stretch.time,
        stretch.curve,
        session.history.before(stretch),
        runs,
        ExternalForces(session.robot, runs, session.note),
        deque(kept, events.maxlen),
    )
