"""Nothing that is kept is erased without a word: only going on forgets, and that can be undone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab import lesson_commands as lc
from onpath.app.lab.session import Session
from onpath.lessons.course import read_course
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import FOLLOWER, assert_sound, do, new_session, run, states, store, y
from tests.support.lesson_texts import write_lesson


@dataclass(frozen=True)
class Seen:
    """All that a lab has done, and where it stands, bit by bit."""

    time: float
    kept: dict[float, bytes]
    robots: tuple[bytes, ...]
    held: frozenset[str]
    happenings: tuple[object, ...]


def seen(session: Session) -> Seen:
    """What is to be kept. A stretch is known by its time: those that wait may still grow."""
    kept = {
        stretch.time: b"".join(
            [stretch.sample.tobytes(), *(d.state.tobytes() for d in stretch.drives.values())]
        )
        for stretch in session.history.all()
    }
    robots = tuple(
        run.state.tobytes()
        + run.row.tobytes()
        + np.array([run.distance, run.max_distance]).tobytes()
        for run in session.runs.values()
    )
    held = frozenset(session.grips.held)
    return Seen(session.time, kept, robots, held, tuple(session.happenings))


ACTIONS = [
    "run",
    "run",
    "back",
    "back",
    "forward",
    "present",
    "Run",
    "hold",
    "step",
    "go on",
    "undo",
]
COMMANDS: dict[str, c.Command] = {
    "back": c.LookBack(0.2),
    "forward": c.LookBack(-0.1),
    "present": c.LookAt(0.0),
    "Run": c.SetRunning(True),
    "hold": c.Hold(),
    "step": c.StepOnce(),
    "go on": c.GoOn(),
    "undo": c.UndoGoOn(),
}


@settings(max_examples=40, deadline=None)
@given(st.lists(st.sampled_from(ACTIONS), max_size=25))
@example(["run", "back", "Run", "run"])
@example(["run", "hold", "run", "back", "go on", "run", "undo", "undo", "hold", "back", "go on"])
def test_only_going_on_forgets_and_undo_brings_all_of_it_back(actions: list[str]) -> None:
    session = new_session(0.4)
    aside: Seen | None = None
    for action in actions:
        before, viewing = seen(session), session.viewing
        if action == "run":
            run(session, 0.1)
        else:
            do(session, COMMANDS[action])
        after = seen(session)
        assert_sound(session)
        if action == "undo" and aside is not None:
            assert after == aside
            assert session.viewing is None and not session.running
            aside = before
        elif action == "go on" and viewing is not None:
            assert session.message and session.put_aside is not None
            assert after.time <= viewing and after.kept == {
                time: bits for time, bits in before.kept.items() if time < after.time
            }
            aside = before
        else:
            assert after.kept.items() >= before.kept.items() and after.time >= before.time
            if action in ("back", "forward", "present", "Run"):
                assert after == before
            if action == "Run":
                assert session.running and session.viewing is None


def test_a_lab_brought_back_goes_on_as_if_nothing_had_been() -> None:
    session, twin = new_session(), new_session()
    for lab in (session, twin):
        do(lab, c.SetParameter("K3", 200), c.SetParameter("encoder_counts", 4000))
        run(lab, 0.5)
        do(lab, c.Hold(True))
        run(lab, 0.5)
    do(session, c.LookAt(0.7), c.GoOn())
    assert not session.grips.held
    run(session, 0.3)
    do(session, c.UndoGoOn())
    assert session.grips.held == twin.grips.held != set()
    for lab in (session, twin):
        lab.simulate(50)
        do(lab, c.Hold(False))
        lab.simulate(400)
    assert seen(session) == seen(twin)


def test_a_robot_that_had_stopped_stands_still_again_after_undo() -> None:
    session = new_session(0.5)
    session.runs[FOLLOWER].fields()["v"][:] = 500.0
    run(session, 0.3)
    stopped = session.runs[FOLLOWER].diverged
    assert stopped
    do(session, c.LookAt(0.6), c.GoOn())
    assert session.runs[FOLLOWER].diverged is None
    do(session, c.UndoGoOn())
    assert session.runs[FOLLOWER].diverged == stopped
    assert "Path following stopped" in session.message


def test_what_was_set_meanwhile_stays_when_the_past_comes_back() -> None:
    session = new_session(0.6)
    end = y(session, FOLLOWER)
    do(session, c.LookAt(0.4), c.GoOn(), c.ChoosePath("segment"), c.SetParameter("K1", 300))
    run(session, 0.8)
    do(session, c.UndoGoOn())
    assert session.time == pytest.approx(0.6, abs=0.02)
    assert np.array_equal(y(session, FOLLOWER), end)
    assert session.parameters.K1 == 300 and not session.editor.curve.closed
    do(session, c.SetRunning(True))
    run(session, 2.0)
    assert_sound(session)
    assert all(run_.distance < 1e-3 for run_ in session.runs.values())


@pytest.mark.parametrize("command", [c.Reset(), c.ChooseRobot("flexible")])
def test_a_new_beginning_leaves_nothing_to_bring_back(command: c.Command) -> None:
    session = new_session(0.5)
    do(session, c.LookAt(0.3), c.GoOn(), command)
    before = states(session)
    do(session, c.UndoGoOn())
    assert session.time == 0.0 and "nothing" in session.message
    assert all(np.array_equal(state, before[name]) for name, state in states(session).items())


def test_a_step_of_a_lesson_cannot_be_passed_by_bringing_back_what_came_before(
    tmp_path: Path,
) -> None:
    write_lesson(tmp_path)
    session = Session(store(), FIVE_BAR, read_course([tmp_path])[0])
    do(session, lc.OpenLesson("01-a"), c.SetRunning(True))
    run(session, 0.5)
    do(session, c.LookAt(0.3), c.GoOn())
    assert session.put_aside is not None
    do(session, lc.GoToStep(1))
    assert session.put_aside is None


def test_whoever_acts_on_the_lab_while_looking_back_is_told_that_it_is_the_present() -> None:
    for command in (c.Hold(True), c.MoveHand(0.01, 0.0), c.StepOnce(), c.ChoosePath("ellipse")):
        session = new_session(0.5)
        do(session, c.LookAt(0.3))
        assert "the past" in session.message
        do(session, command)
        assert "present" in session.message
    session = new_session(0.5)
    do(session, c.MoveHand(0.01, 0.0), c.LookAt(0.3))
    assert "let go" in session.message and not session.grips.hands
    session = new_session(0.5)
    do(session, c.LookAt(0.3), c.ChoosePath("figure of eight"))
    assert "refused" in session.message


def test_going_on_forgets_what_was_done_later_and_undo_brings_it_back() -> None:
    """Else a lesson's task could be passed by what never happened."""
    session = new_session(0.5)
    do(session, c.Hold(True))
    run(session, 0.5)
    do(session, c.Hold(False))
    run(session, 0.5)
    all_of_it = tuple(session.happenings)
    do(session, c.LookBack(1.2), c.GoOn())
    later = [h for h in all_of_it if h.time > session.time]
    assert {h.name for h in later} >= {"hold", "let_go"}
    assert all(h.time <= session.time for h in session.happenings)
    do(session, c.UndoGoOn())
    assert tuple(session.happenings) == all_of_it
