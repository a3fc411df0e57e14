"""A student's way through a lesson, without a browser."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app import commands as c
from app import lesson_commands as lc
from app.lesson_run import LessonRun, sketched
from app.session import Session
from lessons.course import Course, read_course
from lessons.progress import Answer, Progress, read_progress
from lessons.schema import Action, Sketch
from models.catalogue import FIVE_BAR
from tests.lab import do, run, store
from tests.lesson_texts import write_lesson

NAME = "01-a"


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    """Of one small lesson."""
    folder: Path = tmp_path_factory.mktemp("course")
    write_lesson(folder)
    found, problems = read_course([folder])
    assert problems == []
    return found


@pytest.fixture
def session(course: Course) -> Session:
    """A lab with that lesson open."""
    session = Session(store(), FIVE_BAR, course)
    do(session, lc.OpenLesson(NAME))
    return session


def test_a_scene_sets_the_lab_up_and_the_free_lab_comes_back(course: Course) -> None:
    session = Session(store(), FIVE_BAR, course)
    do(session, c.SetParameter("K2", 33), c.ChoosePath("clover"))
    do(session, lc.OpenLesson(NAME))
    assert session.parameters.K1 == 300 and session.parameters.K2 == FIVE_BAR.lab.K2
    assert session.editor.design.name == "circle" and session.running
    do(session, lc.CloseLesson())
    assert session.parameters.K2 == 33 and session.editor.design.name == "clover"
    assert session.lessons.lesson is None and session.locked == ""


def test_nothing_happens_before_a_prediction(session: Session) -> None:
    do(session, lc.GoToStep(1))
    for command in (c.SetRunning(True), c.Step(), c.GoOn(), lc.PlayStep()):
        do(session, command)
        run(session, 0.2)
        assert session.time == 0.0 and not session.running
    assert session.message == session.locked != ""
    do(session, lc.Predict(times=(0.0, 1.0, 2.0), values=(0.0, 40.0, 0.0)))
    assert session.locked == ""
    do(session, c.SetRunning(True))
    run(session, 0.2)
    assert session.time > 0.1


def test_skipping_is_one_step_and_locks_nothing(session: Session) -> None:
    do(session, lc.GoToStep(1), lc.GoToStep(1))
    assert session.lessons.index == 2 and session.locked == ""
    answer = session.lessons.answer()
    assert answer is not None and answer.skipped


def test_prediction_and_truth_are_kept_side_by_side(session: Session) -> None:
    do(session, lc.GoToStep(1), lc.Predict(times=(0.0, 2.0), values=(5.0, 99.0)), lc.GoToStep(1))
    do(session, lc.PlayStep())
    run(session, 0.3)
    assert session.lessons.playing and session.lessons.truth(session) is not None
    run(session, 2.0)
    assert not session.lessons.playing and not session.running
    notes = session.lessons.notes
    truth, answer = notes.truths["1"], notes.answers["1"]
    assert answer.values[0] == 5.0 and answer.values[-1] == 60.0  # its axis ends there
    assert max(truth.tracker) > 10 * max(truth.follower) > 0
    assert truth.times[-1] == pytest.approx(2.0, abs=0.1)
    assert np.all(np.diff(truth.times) > 0)


def test_a_task_fails_then_passes_and_stays_passed(session: Session) -> None:
    do(session, lc.GoToStep(3), lc.GoToStep(3))
    assert session.lessons.step_is("task") and session.editor.design.name == "ellipse"
    do(session, c.Hold(True))
    run(session, 0.5)
    do(session, c.Hold(False))
    run(session, 1.0)
    verdicts = session.lessons.verdicts["hold"]
    assert not verdicts[0].passed and "0.5 of 1 s" in verdicts[0].words
    assert "hold" not in session.lessons.notes.tasks
    do(session, c.Hold(True))
    run(session, 1.5)
    assert "hold" in session.lessons.notes.tasks
    do(session, c.Reset())
    run(session, 1.0)
    assert "hold" in session.lessons.notes.tasks


def test_hints_come_one_at_a_time(session: Session) -> None:
    do(session, lc.ShowHint("hold"))
    assert session.lessons.notes.hints == {"hold": 1}


def test_links_act_on_the_lab(session: Session) -> None:
    do(session, lc.Act((Action(set={"K3": 100.0}), Action(path="clover"), Action(hold=True))))
    assert session.parameters.K3 == 100.0 and session.editor.design.name == "clover"
    assert session.grips.held
    do(session, lc.Act((Action(set={"K3": 1e9}),)))
    assert session.parameters.K3 == 100.0 and "K3" in session.message


def test_resetting_by_hand_ends_what_is_shown(session: Session) -> None:
    do(session, lc.GoToStep(2), lc.Predict(), lc.PlayStep())
    run(session, 0.5)
    do(session, c.Reset())
    run(session, 0.2)
    assert session.script is None and not session.lessons.playing


def test_progress_comes_back_from_json(session: Session, course: Course) -> None:
    do(session, lc.GoToStep(1), lc.Predict(times=(0.0, 1.0), values=(1.0, 2.0)), lc.GoToStep(1))
    do(session, lc.SetPresenting(True), lc.ShowHint("hold"))
    kept = msgspec.json.encode(session.lessons.progress)
    again = LessonRun(course, read_progress(msgspec.json.decode(kept)))
    assert again.progress == session.lessons.progress
    assert again.index == 2 and again.answer() == session.lessons.answer()


@pytest.mark.parametrize(
    "data",
    [
        {"lesson": 3},
        {"lesson": "x" * 100},
        {"notes": {"a": {"answers": {"1": {"times": [0, 1], "values": [1]}}}}},
        {"notes": {"a": {"step": -1}}},
        {"surprise": 1},
        {"notes": {"a": {"tasks": {"t": 1e999}}}},
        [],
        None,
    ],
)
def test_what_is_no_progress_is_refused(data: object) -> None:
    with pytest.raises(ValueError):
        read_progress(data)


def test_a_lesson_that_is_gone_is_not_open(course: Course) -> None:
    assert LessonRun(course, Progress(lesson="99-gone")).lesson is None


@given(st.lists(st.tuples(st.floats(-5, 15), st.floats(-100, 100)), min_size=1, max_size=400))
def test_any_stroke_becomes_a_curve_on_its_axes_or_is_refused(
    stroke: list[tuple[float, float]],
) -> None:
    axes = Sketch("?", "distance", seconds=8.0, top=60.0)
    times, values = zip(*stroke, strict=True)
    try:
        curve = sketched(axes, Answer(times=times, values=values))
    except ValueError:
        assert len(set(np.clip(times, 0, 8))) < 2
        return
    assert np.all(np.diff(curve.times) >= 0) and len(curve.times) <= 200
    assert min(curve.times) >= 0 and max(curve.times) <= 8
    assert min(curve.values) >= 0 and max(curve.values) <= 60
