"""What the teachers' pages show of a class outlives a reload and the process."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markupsafe import escape

from onpath.app.classroom.class_state import from_stored, to_stored
from onpath.app.classroom.classroom import NOTHING_DONE, Classroom, ClassState, Display
from onpath.app.classroom.concept_test_results import question_at
from onpath.app.classroom.results import asked_at
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.setups.setup import Setup
from onpath.app.server.built_in_course import built_in_course
from onpath.lessons.concept_test.concept_test import SITTINGS
from onpath.lessons.progress import Progress
from onpath.lessons.schema import Choice, Quiz
from onpath.lessons.words import ENGLISH, Words, languages

switches = st.booleans()
displays = st.builds(Display, st.text(max_size=20), st.integers(0, 99), switches, switches)


@given(displays)
def test_what_is_displayed_survives_the_way_through_the_database(display: Display) -> None:
    stored = to_stored(ClassState(display=display), 0.0)
    assert from_stored(stored, lambda _: NOTHING_DONE, 0.0).display == display


@pytest.mark.parametrize("broken", [None, "x", {"step": -1}, {"shown": "yes"}])
def test_a_broken_display_does_not_end_the_class(broken: object) -> None:
    room = Classroom()
    room.join("a" * 12, room.code, "Ada")
    stored = {**to_stored(room.state, 0.0), "display": broken}
    read = from_stored(stored, lambda _: NOTHING_DONE, 0.0)
    assert read.display == Display() and len(read.members) == 1


def test_a_class_stored_by_an_older_version_shows_nothing_yet() -> None:
    stored = to_stored(ClassState(display=Display("01-a", 3, shown=True)), 0.0)
    del stored["display"]
    assert from_stored(stored, lambda _: NOTHING_DONE, 0.0).display == Display()


@pytest.mark.thorough
@given(displays, st.booleans())
def test_a_step_that_is_sent_is_displayed_without_its_answers(shown: Display, again: bool) -> None:
    room = Classroom()
    room.show(shown)
    room.push(TakeStep("01-a", 2, again=again))
    assert room.display == Display("01-a", 2, shown=False, revealed=False)


@pytest.mark.thorough
@given(displays)
def test_a_setup_that_is_sent_changes_nothing_that_is_displayed(shown: Display) -> None:
    room = Classroom()
    room.show(shown)
    room.push(TakeSetup(Setup()))
    room.freeze(True)
    assert room.display == shown
    room.end()
    assert room.display == Display()


@pytest.mark.parametrize("language", languages())
def test_every_question_of_a_lesson_is_shown_with_its_options_before_its_answers(
    language: str,
) -> None:
    course, room, words = built_in_course(), Classroom(), Words(language)
    teaching: Any = SimpleNamespace(classroom=room, chosen=TeacherChoices(), progress=Progress)
    answers = ClassAnswers(course, words, teaching)
    for name in course.lessons:
        lesson = course.lesson(name, language)
        for index, step in enumerate(lesson.steps):
            room.show(Display(name, index))
            view, asked = answers.view(True), asked_at(lesson, index).values()
            told = [block.question for block in asked] or [step.title]
            for block in asked:
                if isinstance(block, Choice | Quiz):
                    told += [option.text for option in block.options]
            assert all(str(escape(text)) in view for text in told), (name, index)
            assert "background:" not in view and "✓" not in view


@pytest.mark.parametrize("test", SITTINGS)
def test_answers_to_a_concept_test_are_hidden_until_they_are_shown(test: str) -> None:
    course, room = built_in_course(), Classroom()
    room.join("a" * 12, room.code, "Ada")
    teaching: Any = SimpleNamespace(classroom=room, chosen=TeacherChoices(), progress=Progress)
    answers = ClassAnswers(course, ENGLISH, teaching)
    room.push(TakeStep(test, 0))
    options = [each for form in course.forms("en") for each in question_at(form, 0).options]
    for shown, bars in ((False, 0), (True, 2 * len(options))):  # before and after
        room.show(replace(room.display, shown=shown))
        view = answers.view(True)
        assert all(str(escape(option.text)) in view for option in options)
        assert view.count("background:") == bars
