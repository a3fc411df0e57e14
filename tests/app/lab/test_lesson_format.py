"""Slow motion, starts, branches, comparisons and the student's own numbers, without a browser."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from markupsafe import Markup

from onpath.app.lab import commands as c
from onpath.app.lab.dry_runs.course_check import lab_at, play
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.action_schema import Action, Script
from onpath.lessons.adaptive.branches import answers_meant, is_shown
from onpath.lessons.adaptive.own_numbers import filled
from onpath.lessons.checks import verdict
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer
from onpath.lessons.measures.earlier_run import EarlierRun
from onpath.lessons.progress import Notes
from onpath.lessons.record import Record
from onpath.lessons.schema import Choice, NumberQuestion, Option, Quiz, Step, Text
from onpath.lessons.task_schema import Better, Task
from onpath.lessons.words import Words
from onpath.models.closed_loop.lab_settings import RATES
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.format_texts import FORMAT_LESSON, FORMAT_REFERENCE
from tests.support.given import notes_with
from tests.support.lab import FOLLOWER, FRAME, do, loop_cache, run
from tests.support.lesson_texts import write_lesson

NAME = "01-a"
EXPLAIN, FOR_SOME, TASK = 5, 6, 7  # steps


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    folder: Path = tmp_path_factory.mktemp("course")
    write_lesson(folder, FORMAT_LESSON, FORMAT_REFERENCE)
    found, problems = read_course([folder])
    assert problems == []
    return found


@pytest.fixture
def lab(course: Course) -> Lab:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, c.OpenLesson(NAME))
    return lab


def test_a_step_starts_where_it_says_and_the_next_one_on_the_path(lab: Lab) -> None:
    start = lab.simulation.start
    assert (start.theta, start.beside, start.along, start.across) == (0.5, 0.01, 0.05, -0.02)
    run(lab, 3 * FRAME)
    first = lab.simulation.history.samples(0.0, 1.0, 100)[1][2]
    own = lab.simulation.sample_layout.unpack(first)
    assert own["xi"][:, 0] == pytest.approx([0.01, 0.01], abs=2e-3)
    do(lab, c.CloseLesson())
    assert lab.simulation.start.beside == 0.0


def test_slow_motion_shows_the_same_motion_more_slowly(lab: Lab) -> None:
    """Time goes at a quarter of the chosen rate from 0.2 s on, and at that rate after the end."""
    do(lab, c.GoToStep(1), c.Predict(), c.GoToStep(1))
    lab.simulation.set(rate=2.0)
    do(lab, c.PlayStep())
    seen = list[tuple[float, float]]()
    while lab.lessons.playing:
        before = lab.simulation.time
        lab.drain()
        lab.advance(lab.simulation.settings.rate * FRAME)
        if lab.simulation.time > before:
            seen.append((before, lab.simulation.time - before))
        assert len(seen) < 2000
    early = [step for time, step in seen[:5]]
    late = [step for time, step in seen[-20:-1]]
    assert max(early) == pytest.approx(2 * FRAME, abs=1.1e-3)
    assert max(late) == pytest.approx(FRAME / 2, abs=1.1e-3) and lab.simulation.settings.rate == 2.0
    assert lab.simulation.run_number >= 1  # it began anew at its third action


def test_what_is_measured_does_not_depend_on_the_rate(course: Course) -> None:
    lesson = course.lesson(NAME, "en")
    ends = []
    for rate in (1.0, 0.25):
        lab = lab_at(lesson, lesson.steps[0], loop_cache())
        do_ = (Action(at=0.1, rate=rate), Action(at=0.3, pull=(10.0, 0.0)))
        for _ in play(lab, Script(do_, until=1.0)):
            pass
        ends.append(lab.simulation.runs[FOLLOWER].state.copy())
    np.testing.assert_allclose(ends[0], ends[1], atol=2e-3)


@given(st.lists(st.tuples(st.floats(0, 5), st.sampled_from(RATES)), max_size=6))
def test_a_script_takes_as_long_as_its_rates_say(changes: list[tuple[float, float]]) -> None:
    changes = sorted({at: rate for at, rate in changes}.items())
    script = Script(tuple(Action(at=at, rate=rate) for at, rate in changes), until=5.0)
    grid = np.linspace(0, 5, 20001)
    rates = np.ones_like(grid)
    for at, rate in changes:
        rates[grid >= at] = rate
    assert script.seconds == pytest.approx(np.trapezoid(1 / rates, grid), rel=1e-2)


def test_a_branch_is_passed_over_by_those_whom_it_does_not_concern(lab: Lab) -> None:
    for option, wanted in ((0, TASK), (1, FOR_SOME)):
        do(lab, c.OpenLesson(NAME))
        lab.lessons.open_at(NAME, 3, lab)
        lab.lessons.note(given=())
        do(lab, c.Predict(option=option), c.GoToStep(1), c.GoToStep(1))
        assert lab.lessons.index == EXPLAIN
        shown = _texts(lab)
        assert ("It was" in shown) == (option == 0)
        do(lab, c.GoToStep(1))
        assert lab.lessons.index == wanted
        do(lab, c.GoToStep(-1))
        assert lab.lessons.index == (EXPLAIN if wanted == TASK else wanted - 1)


OPTIONS = (Option("a", "A", key="first"), Option("b", "B", right=True), Option("c", "C"))
CHOICE, QUIZ = Choice("?", OPTIONS), Quiz("?", OPTIONS)
NUMBER = NumberQuestion("?", 60.0, 0.5, "60")


@pytest.mark.parametrize(
    ("asked", "notes", "answer"),
    [
        *((CHOICE, notes_with(answers={"0": Answer(option=i)}), i) for i in range(3)),
        (CHOICE, notes_with(answers={"0": Answer()}), -1),
        *((QUIZ, notes_with(quiz={"0.0": i}), i) for i in range(3)),
        *(
            (NUMBER, notes_with(numbers={"0.0": x}), int(x in (60.0, 59.5)))
            for x in (60.0, 59.5, 59.4)
        ),
    ],
)
@pytest.mark.parametrize("when", ["right", "wrong", "skipped", "first"])
def test_a_page_without_a_lab_knows_for_which_answers_a_text_is_meant(
    asked: Choice | Quiz | NumberQuestion, notes: Notes, answer: int, when: str
) -> None:
    steps = [Step("explain", "", 1, (asked, Text(Markup(""), when=when)))]
    meant = answers_meant(when, steps, 0, 1)
    key = "0" if asked is CHOICE else "0.0"
    assert meant is not None and meant[0] == key
    assert (answer in meant[1]) == is_shown(when, steps, notes, 0, 1)
    assert answers_meant(when, steps, 0, 0) is None


def _texts(lab: Lab) -> str:
    snapshot = take_page_snapshot(lab, 1.0)
    view = LessonView(lab.lessons.course, lab.words, snapshot.lesson)
    assert view.step is not None
    texts = [view.text(i, b) for i, b in enumerate(view.step.blocks) if isinstance(b, Text)]
    return "".join(text for text in texts if text is not None)


def test_the_student_s_own_numbers_are_in_the_text(lab: Lab) -> None:
    lab.lessons.open_at(NAME, EXPLAIN, lab)
    assert "You drew <em>nothing</em>, and chose: –." in _texts(lab)
    answers = {"1": Answer(times=(0.0, 1.0), values=(3.0, 12.34)), "3": Answer(option=0)}
    lab.lessons.note(given=notes_with(answers=answers).given)
    assert "You drew 12.3, and chose: this." in _texts(lab)


@given(st.text(max_size=30))
def test_what_is_not_a_student_s_number_stays_as_it_is(text: str) -> None:
    html = Markup.escape(text)
    assert filled(html, (), 0, Notes(), Words()) == html


values = st.lists(st.floats(0.01, 100), min_size=2, max_size=20)


@given(values, values, st.sampled_from([0.5, 0.9, 1.0]))
def test_a_run_is_better_exactly_if_its_value_is_less(
    before: list[float], now: list[float], share: float
) -> None:
    check = Better(quantity="distance", share=share, least=0.0)
    task, earlier = Task("t", "", (check,)), EarlierRun()
    assert not verdict(check, _record(before, 0, earlier), Words()).passed
    earlier.follow(_record(before[:1], 0, earlier), [task])
    earlier.follow(_record(before, 0, earlier), [task])
    earlier.follow(_record(now, 1, earlier), [task])
    passed = verdict(check, _record(now, 1, earlier), Words()).passed
    assert passed == (max(now) < share * max(before))


def test_a_run_that_was_too_short_is_not_compared_with() -> None:
    check = Better(quantity="distance", least=1.0)
    task, earlier = Task("t", "", (check,)), EarlierRun()
    earlier.follow(_record([5.0] * 200, 0, earlier), [task])
    earlier.follow(_record([0.1] * 3, 1, earlier), [task])
    earlier.follow(_record([4.0] * 200, 2, earlier), [task])
    assert verdict(check, _record([4.0] * 200, 2, earlier), Words()).passed


def _record(distance: list[float], run: int, earlier: EarlierRun) -> Record:
    times = np.arange(len(distance)) * 0.01
    column = {"distance": np.array(distance)}
    end = float(len(distance) * 0.01)
    values = {"tracker": column, "follower": column}
    return Record(times, values, (), run, FIVE_BAR.parameters(), end, before=earlier.values)  # type: ignore[arg-type]


def test_the_lab_compares_a_run_with_the_one_before(lab: Lab) -> None:
    lab.lessons.open_at(NAME, TASK, lab)
    do(lab, c.Hold(True))
    run(lab, 2.0)
    do(lab, c.Hold(False), c.Set("K1", 1600), c.Set("K2", 80), c.Reset())
    assert "hold" not in lab.lessons.notes.tasks
    do(lab, c.Hold(True))
    run(lab, 2.0)
    assert "hold" in lab.lessons.notes.tasks, lab.lessons.verdicts


@pytest.mark.parametrize(
    ("there", "back", "name"),
    [
        (c.Set("stiction", 0.1), c.Set("stiction", 0.0), "stiction"),
        (c.Set("wall", True), c.Set("wall", False), "wall"),
        (c.Set("start_theta", 1.0), None, "start"),
        (c.ChooseLaw("left", "waiting_clock"), c.ChooseLaw("left", "trajectory_tracking"), "left"),
        (c.ChoosePath("circle"), c.ChoosePath("ellipse"), "path"),
    ],
)
def test_what_differs_from_the_set_up_is_known_until_it_is_set_back(
    lab: Lab, there: c.Command, back: c.Command | None, name: str
) -> None:
    lab.lessons.open_at(NAME, TASK, lab)
    begin = Beginning.now(lab.simulation)
    assert record_of(lab.simulation, begin).changed() == ()
    do(lab, there)
    assert record_of(lab.simulation, begin).changed() == (name,)
    if back is not None:
        do(lab, back, c.Reset())
        assert record_of(lab.simulation, begin).changed() == ()
