"""The concept test in a lab: opened, answered, handed in, and what the student is told."""

from __future__ import annotations

import json
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import msgspec
import pytest

from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.storage.lab_state import keep, put_back
from onpath.app.view.concept_test_facts import results_of
from onpath.app.view.lesson_end import lesson_end
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, name_of, questions
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.concept_key import found_in, key_of
from tests.support.lab import do, loop_cache, run

COURSE = built_in_course()[0]
FORMS = COURSE.forms("en")
ASKED = questions(FORMS[0])
LESSON = "01-path-or-timetable"


def lab_with_lessons() -> Lab:
    return Lab(loop_cache(), FIVE_BAR, COURSE)


def sit(lab: Lab, name: str, option: int = 0) -> None:
    """Open a test in the student's own form, choose the same option everywhere, and hand in."""
    do(lab, c.OpenLesson(name))
    assert lab.lessons.lesson is not None
    for index, key in enumerate(questions(lab.lessons.lesson)):
        if index:
            do(lab, c.GoToStep(1))
        do(lab, c.AnswerQuiz(int(key.partition(".")[2]), option))
    do(lab, c.FinishLesson())


def test_nothing_moves_while_a_test_is_open() -> None:
    lab = lab_with_lessons()
    do(lab, c.OpenLesson(BEFORE), c.SetRunning(True))
    assert "test" in lab.message
    run(lab, 0.5)
    assert lab.simulation.time == 0 and not lab.simulation.running
    do(lab, c.CloseLesson())
    run(lab, 0.5)
    assert lab.simulation.time > 0


def test_an_answer_can_be_changed_until_the_test_is_handed_in_and_not_after_it() -> None:
    lab = lab_with_lessons()
    do(lab, c.OpenLesson(BEFORE), c.AnswerQuiz(1, 2), c.AnswerQuiz(1, 0))
    assert lab.lessons.notes.quiz == {"0.1": 0}
    do(lab, c.FinishLesson(), c.AnswerQuiz(1, 2))
    assert lab.lessons.notes.quiz == {"0.1": 0} and "handed in" in lab.message
    do(lab, c.CloseLesson(), c.OpenLesson(BEFORE))
    assert lab.lessons.ended and lab.lessons.notes.handed_in
    do(lab, c.GoToStep(-1), c.BeginStepAnew())
    assert lab.lessons.ended


def test_the_keys_do_not_hand_in() -> None:
    lab = lab_with_lessons()
    do(lab, c.OpenLesson(BEFORE), *[c.GoToStep(1)] * 20)
    assert lab.lessons.index == 11 and not lab.lessons.ended and not lab.lessons.notes.handed_in


def right_in_form(form: int, option: int) -> int:
    return sum(block.options[option].right for block in questions(FORMS[form]).values())


@pytest.mark.parametrize("first", [0, 1])
def test_what_is_right_is_told_after_the_second_test_only(first: int) -> None:
    lab = lab_with_lessons()
    do(lab, c.DealForm(first))
    assert results_of(lab.lessons) is None
    sit(lab, BEFORE)
    told = results_of(lab.lessons)
    before, after = right_in_form(first, 0), right_in_form(1 - first, 1)
    assert told is not None and told.scores == (before, None) and told.questions == []
    page = report(lab.lessons, "", datetime(2026, 1, 1, tzinfo=UTC)).decode()
    assert found_in(key_of(FORMS), page) == [] and " of 12" not in page
    do(lab, c.CloseLesson())
    sit(lab, AFTER, 1)
    told = results_of(lab.lessons)
    assert told is not None and told.scores == (before, after) and len(told.questions) == 24
    assert all(list(asked.chosen.values()) in ([0], [1]) for asked in told.questions)
    page = report(lab.lessons, "", datetime(2026, 1, 1, tzinfo=UTC)).decode()
    for block in (block for form in FORMS for block in questions(form).values()):
        assert str(next(o.answer for o in block.options if o.right)) in page
    assert f"{before} of 12" in page and f"{after} of 12" in page
    assert page.count("More about it: lesson ") == 24


def test_one_form_is_asked_twice_and_told_once() -> None:
    tests = {name: COURSE.tests[name] for name in (BEFORE, AFTER)}
    lab = Lab(loop_cache(), FIVE_BAR, replace(COURSE, tests=tests))
    do(lab, c.DealForm(1))
    sit(lab, BEFORE, 0)
    do(lab, c.CloseLesson())
    sit(lab, AFTER, 1)
    told = results_of(lab.lessons)
    assert told is not None and told.scores == (right_in_form(0, 0), right_in_form(0, 1))
    assert [asked.chosen for asked in told.questions] == [{0: 0, 1: 1}] * 12


def test_a_test_that_is_dealt_later_stays_the_one_that_was_opened() -> None:
    lab = lab_with_lessons()
    do(lab, c.DealForm(1), c.OpenLesson(AFTER))
    assert lab.lessons.progress.lesson == AFTER
    do(lab, c.DealForm(0), c.OpenLesson(BEFORE))
    assert lab.lessons.progress.lesson == name_of(BEFORE, 1)


@pytest.mark.parametrize("language", COURSE.languages())
def test_the_end_of_a_test_tells_no_score_before_the_second(language: str) -> None:
    lab, shown = lab_with_lessons(), list[str]()
    do(lab, c.SetLanguage(language))
    for name in (BEFORE, AFTER):
        sit(lab, name)
        lesson = take_page_snapshot(lab, 1.0).lesson
        shown.append(lesson_end(LessonView(COURSE, Words(language), lesson))[0])
    right = [
        str(next(o.answer for o in b.options if o.right))
        for form in COURSE.forms(language)
        for b in questions(form).values()
    ]
    assert not any(text in shown[0] for text in right)
    assert all(text in shown[1] for text in right)


def test_the_teacher_sends_a_test_and_a_route_goes_on_after_it() -> None:
    lab = lab_with_lessons()
    do(lab, c.FollowRoute("1-lab-90-minutes"), TakeStep(BEFORE, 0))
    assert lab.lessons.is_test and lab.lessons.route is None
    do(lab, c.GoToStep(1))
    assert lab.lessons.index == 1
    do(lab, TakeStep(LESSON, 0))
    assert lab.lessons.route is not None and lab.lessons.locked is None


def test_an_open_test_and_one_that_is_handed_in_are_kept() -> None:
    lab, states = lab_with_lessons(), list[Any]()
    sit(lab, BEFORE)
    do(lab, c.OpenLesson(AFTER), c.AnswerQuiz(1, 2))
    keep(lab, lambda state: states.append(json.loads(msgspec.json.encode(state()))))
    other = lab_with_lessons()
    put_back(other, states[0])
    assert other.lessons.progress == lab.lessons.progress
    assert other.lessons.locked is not None and not other.simulation.running
