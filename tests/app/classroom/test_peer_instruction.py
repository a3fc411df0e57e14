"""Peer instruction: a prediction is answered, discussed, and answered again."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import msgspec
import pytest

from onpath.app.classroom import class_html as page
from onpath.app.classroom.class_state import push_data, read_push
from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import Classroom, Member
from onpath.app.classroom.results import distribution
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer
from onpath.lessons.progress import Progress, read_progress
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import write_lesson
from tests.support.record import record

LESSON, CHOICE, SKETCH = "01-a", 3, 1  # steps
CURVE = c.Predict(times=(0.0, 1.0), values=(1.0, 2.0))


@pytest.fixture
def course(tmp_path: Path) -> Course:
    write_lesson(tmp_path)
    return read_course([tmp_path])[0]


def asked(course: Course, first: int | None, second: int | None) -> Lab:
    """A lab that was asked twice; None where the student has not answered."""
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, TakeStep(LESSON, CHOICE))
    if first is not None:
        do(lab, c.Predict(option=first))
    do(lab, TakeStep(LESSON, CHOICE, again=True))
    if second is not None:
        do(lab, c.Predict(option=second))
    return lab


def test_time_waits_for_the_second_answer_and_the_first_is_kept(course: Course) -> None:
    lab = asked(course, 0, None)
    assert lab.lessons.waits and lab.locked is not None and not lab.simulation.running
    assert lab.lessons.answer() is None and lab.lessons.first_answer() == Answer(0)
    do(lab, c.Predict(option=1, sure="certain"))
    assert not lab.lessons.waits and lab.locked is None
    assert lab.lessons.answer() == Answer(1, sure="certain")
    assert lab.lessons.notes.answers == {str(CHOICE): Answer(0)}
    stored = msgspec.to_builtins(lab.lessons.progress)
    assert read_progress(stored) == lab.lessons.progress


def test_who_has_not_answered_before_answers_the_second_time_only(course: Course) -> None:
    notes = asked(course, None, 1).lessons.notes
    assert notes.answers == {} and notes.second == {str(CHOICE): Answer(1)}  # not: skipped


def test_it_can_be_asked_again_and_again_and_skipped(course: Course) -> None:
    lab = asked(course, 0, 1)
    do(lab, TakeStep(LESSON, CHOICE, again=True))
    assert lab.lessons.waits and lab.lessons.notes.asked_again == (str(CHOICE),) * 2
    do(lab, c.GoToStep(1))  # skips it
    assert not lab.lessons.waits and lab.lessons.notes.second[str(CHOICE)].skipped


def test_a_step_without_prediction_is_only_opened(course: Course) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, TakeStep(LESSON, 0, again=True))
    assert lab.lessons.index == 0 and not lab.lessons.notes.asked_again


def test_what_is_sent_survives_the_way_through_the_database() -> None:
    for push in (TakeStep("a", 1), TakeStep("a", 1, again=True)):
        assert read_push(push_data(push)) == push
    assert read_push({"lesson": "a", "step": 1, "route": ""}) == TakeStep("a", 1)  # an older one


def members(course: Course) -> list[Member]:
    labs = [asked(course, *both) for both in ((0, 1), (0, 0), (1, 1), (0, None))]
    return [Member(n, f"Nick {n}", lab.lessons.progress) for n, lab in enumerate(labs, 1)]


def bars(shown: str) -> list[int]:
    return [int(count) for count in re.findall(r"<b>(\d+)</b>", shown)]


def test_both_distributions_stand_side_by_side(course: Course) -> None:
    block = course.lesson(LESSON, "en").steps[CHOICE].predictions()[0]
    ways = [member.progress for member in members(course)]
    first, second = (
        distribution(block, LESSON, str(CHOICE), ways, again=again) for again in (False, True)
    )
    assert (first.counts, first.waiting) == ((3, 1), 0)
    assert (second.counts, second.waiting) == ((1, 2), 1)
    shown = page.prediction_view(block, first, None, False, ENGLISH, second=second)
    assert bars(shown) == [3, 1, 1, 2]  # by option, before and after
    assert shown.index(ENGLISH("class.first")) < shown.index(ENGLISH("class.second"))
    assert page.given_line(second, ENGLISH) in shown and "Nick" not in shown
    once = page.prediction_view(block, first, None, False, ENGLISH)
    assert bars(once) == [3, 1] and ENGLISH("class.first") not in once


def test_sketches_of_both_rounds_have_a_plot_each(course: Course) -> None:
    block = course.lesson(LESSON, "en").steps[SKETCH].predictions()[0]
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, TakeStep(LESSON, SKETCH), CURVE, TakeStep(LESSON, SKETCH, again=True))
    do(lab, CURVE)
    both = [
        distribution(block, LESSON, str(SKETCH), [lab.lessons.progress], again=a)
        for a in (False, True)
    ]
    shown = page.prediction_view(block, both[0], None, False, ENGLISH, second=both[1])
    assert shown.count("<svg") == 2 and shown.count("<polyline") == 2


class Teaching:
    """What the teacher's page knows of a class."""

    def __init__(self, room: Classroom) -> None:
        self.classroom, self.chosen = room, TeacherChoices()

    def progress(self) -> Progress:
        return Progress()


def test_the_teacher_sees_them_or_only_how_many_there_are(course: Course) -> None:
    room = Classroom(lambda: 0.0)
    lab = Lab(loop_cache(), FIVE_BAR, course)
    room.join("lab", room.code, "Ada")
    sync = ClassSync(room, {"lab": (lab, True)}.get)
    do(lab, TakeStep(LESSON, CHOICE), c.Predict(option=0))
    room.push(TakeStep(LESSON, CHOICE, again=True))
    sync.check()
    do(lab, c.Predict(option=1))
    sync.check()
    teaching: Any = Teaching(room)
    answers = ClassAnswers(course, ENGLISH, teaching)
    hidden = answers.view(False)
    assert bars(hidden) == [] and ENGLISH("class.given", given=1, here=1, away=0) in hidden
    room.show(replace(room.display, shown=True))
    assert bars(answers.view(False)) == [1, 0, 0, 1]


def test_the_records_have_both_answers(course: Course) -> None:
    rows = [row for row in record(members(course), course)["Answers"] if row["step"] == CHOICE + 1]
    kinds = {
        kind: [r["chosen"] or r["result"] for r in rows if r["kind"] == kind]
        for kind in ("prediction", "second")
    }
    assert kinds == {"prediction": ["A", "A", "B", "A"], "second": ["B", "A", "B", "open"]}
    lab = asked(course, 0, 1)
    made = report(lab.lessons, "", datetime(2026, 1, 1, tzinfo=UTC)).decode()
    options = course.lesson(LESSON, "en").steps[CHOICE].predictions()[0].options  # type: ignore[union-attr]
    assert re.search(rf"{ENGLISH('lesson.second')}\s*</b>\s*{options[1].text}", made)
