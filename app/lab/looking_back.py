"""Looking at the past of a lab: returning from it, going on from it, and undoing that.

Only going on forgets anything, and what it forgets is put aside until it is done again, the robots
are reset or another robot is chosen.
"""

from __future__ import annotations

from collections import deque
from copy import copy
from dataclasses import dataclass
from typing import TYPE_CHECKING

from onpath.app.lab.closed_loop_run import ClosedLoopRun
from onpath.app.lab.external_forces import ExternalForces
from onpath.app.lab.history import History
from onpath.app.lab.segments import Segment
from onpath.lessons.record import Happening
from onpath.models.paths.curves import Curve

if TYPE_CHECKING:
    from onpath.app.lab.session import Session


@dataclass(frozen=True, slots=True, eq=False)
class Timeline:
    """What a lab has done since its reset, and where that has left it; the set-up is no part of it.

    Attributes:
        time: at its end, [s].
        curve: the path at its end.
        history: the last minute of it.
        runs: the two closed loops at its end, by controller.
        grips: what holds and pulls at its end.
        happenings: what was done and came about.
    """

    time: float
    curve: Curve
    history: History
    runs: dict[str, ClosedLoopRun]
    grips: ExternalForces
    happenings: deque[Happening]


def look_back(session: Session, ago: float) -> None:
    """Pause and look at how it was, [s] before now; 0 is now."""
    if ago <= 0 or not len(session.history):
        return_to_present(session)
        return
    words = session.lessons.words
    if session.viewing is None:
        session.show_message(words("say.looking_back"))
    if session.grips.hands:
        session.show_message(words("say.looking_back") + " " + words("say.let_go"))
    session.running = False
    session.grips.release()
    session.viewing = session.time - min(ago, session.history.span())


def return_to_present(session: Session) -> None:
    """Look at the present again, if not already; nothing is forgotten."""
    if session.viewing is not None:
        session.viewing = None
        _say(session, session.lessons.words("say.present"))


def go_on(session: Session) -> None:
    """Run on from the instant being looked at; what came after it is put aside."""
    stretch = None if session.viewing is None else session.history.at(session.viewing)
    if stretch is None:
        session.viewing, session.running = None, True
        session.clear_message()
        return
    left = _timeline(session)
    _take(session, _branch(session, stretch))
    session.note("let_go")
    session.note("release")
    session.put_aside, session.script = left, None
    session.viewing, session.running = None, True
    time, seconds = f"{stretch.time:.1f}", f"{left.time - stretch.time:.1f}"
    _say(session, session.lessons.words("say.went_on", time=time, seconds=seconds))


def undo_going_on(session: Session) -> None:
    """Bring back what was put aside, paused at its end; what was done instead is put aside."""
    words, back = session.lessons.words, session.put_aside
    if back is None:
        session.show_message(words("say.nothing_to_undo"))
        return
    session.grips.release()
    session.viewing = None
    session.running = False
    session.put_aside = _timeline(session)
    _take(session, back)
    _say(session, words("say.brought_back", time=f"{back.time:.1f}"))


def _say(session: Session, message: str) -> None:
    """Something less important than that a robot stands still."""
    session.clear_message()
    if not session.message:
        session.show_message(message)


def _timeline(session: Session) -> Timeline:
    session.history.settle()  # its samples are of the parameters of now
    return Timeline(
        session.time,
        session.editor.curve,
        session.history,
        session.runs,
        session.grips,
        session.happenings,
    )


def _take(session: Session, timeline: Timeline) -> None:
    """Be at the end of a timeline, with the path and the parameters of now."""
    session.time, session.history = timeline.time, timeline.history
    session.runs, session.grips = timeline.runs, timeline.grips
    session.happenings = timeline.happenings
    if timeline.curve is not session.editor.curve:
        for run in session.runs.values():
            run.change_path(session.editor.curve)


def _branch(session: Session, stretch: Segment) -> Timeline:
    """A timeline that ends where a stretch of this one begins; nobody holds or pulls there."""
    runs = {name: copy(run) for name, run in session.runs.items()}
    for name, run in runs.items():
        run.restore(stretch.drives[name], stretch.curve)
    happenings = session.happenings
    kept = [h for h in happenings if h.run != session.run_number or h.time <= stretch.time]
    return Timeline(
        stretch.time,
        stretch.curve,
        session.history.before(stretch),
        runs,
        ExternalForces(session.robot, runs, session.note),
        deque(kept, happenings.maxlen),
    )
