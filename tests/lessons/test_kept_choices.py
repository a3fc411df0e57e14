"""A choice that was kept is shown as the student's only if it is known which option it was."""

from __future__ import annotations

import json
import re
from datetime import UTC, datetime
from itertools import permutations
from pathlib import Path
from typing import Any

import msgspec
import pytest

from onpath.app.classroom.class_html import given_line
from onpath.app.classroom.classroom import Member
from onpath.app.classroom.results import distribution
from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.setup import Setup
from onpath.app.lab.setups.stored import to_data
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.storage.lab_state import keep, put_back
from onpath.app.view.lesson_message import lesson_message
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer
from onpath.lessons.kept.known_choices import of_today
from onpath.lessons.progress import Progress, read_progress
from onpath.lessons.words import ENGLISH, Words
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.record import record

NAME, ASKED, QUIZ = "01-a", "3", "7.0"
THIS = '  { text = "this", answer = "no" },\n'
THAT = '  { text = "that", answer = "yes", right = true },\n'
QUIZ_A = '  { text = "a", answer = "A", right = true },\n'
QUIZ_B = '  { text = "b", answer = "B" },\n'
OLDER = """{"lesson": "01-a", "language": "en", "presenting": false, "route": "", "ended": false,
"notes": {"01-a": {"step": 3, "seen": 8, "played": ["4"], "tasks": {"hold": 0.0}, "hints": {},
 "answers": {"3": {"option": 1, "times": [], "values": [], "sure": "", "reason": null, "why": ""},
             "1": {"option": null, "times": [0.0, 1.0], "values": [1.0, 2.0]}},
 "truths": {"3": {"quantity": "distance", "times": [0.0, 1.0], "tracker": [0.0, 1.0],
                  "follower": [0.0, 0.0]}}, "quiz": {"7.0": 1}}}}"""
"""Lessons as simulation 18 stored them: a choice is the place of an option at that time."""


def course_of(folder: Path, text: str = LESSON, **others: str) -> Course:
    """A course of one lesson, in English and other languages."""
    file = write_lesson(folder, text)
    for language, translated in others.items():
        file.with_name(f"{language}.md").write_text(translated, "utf-8")
    course, problems = read_course([folder])
    assert not problems
    return course


def changed(old: str, new: str) -> str:
    assert LESSON.count(old) == 1
    return LESSON.replace(old, new)


def returned(course: Course, lessons: object) -> Lab:
    """A lab with stored lessons."""
    lab = Lab(loop_cache(), FIVE_BAR, course)
    put_back(lab, {"setup": to_data(Setup()), "lessons": lessons, "before": None})
    return lab


def chosen(course: Course) -> dict[str, Any]:
    """What a lab of a course stores in which the second option was chosen twice."""
    lab, states = Lab(loop_cache(), FIVE_BAR, course), list[dict[str, Any]]()
    do(lab, TakeStep(NAME, 3), c.Predict(option=1), TakeStep(NAME, 7), c.AnswerQuiz(0, 1))
    do(lab, TakeStep(NAME, 3))
    keep(lab, lambda state: states.append(json.loads(msgspec.json.encode(state()))))
    return states[0]["lessons"]


def shown(lab: Lab) -> tuple[str, dict[str, Any]]:
    """The HTML of the open step, and the answers that the page is told."""
    run, lesson = lab.lessons, take_page_snapshot(lab, 1.0).lesson
    message = lesson_message(LessonView(run.course, run.words, lesson), lab.simulation.robot)
    assert message.notes is not msgspec.UNSET
    given = [each for each in message.notes["given"] if each["item"].isdecimal()]
    return "".join(message.sections.values()), {each["item"]: each["answer"] for each in given}


# Stored by an older version.


def test_a_choice_of_an_older_version_is_not_shown_and_it_says_so(tmp_path: Path) -> None:
    lab = returned(course_of(tmp_path), json.loads(OLDER))
    notes, run = lab.lessons.notes, lab.lessons
    assert notes.unknown == {ASKED, QUIZ} and QUIZ not in notes.quiz
    answer = run.answer()
    assert answer is not None and answer.option is None and not run.waits  # the result was seen
    said, answers = shown(lab)
    assert ENGLISH("lesson.unknown") in said
    assert answers == {ASKED: {}}  # no option is marked as the student's
    assert notes.answers["1"].times == (0.0, 1.0)  # the curve is as it was
    assert notes.tasks == {"hold": 0.0} and notes.seen == 8


def test_the_records_of_an_older_version_say_so(tmp_path: Path) -> None:
    course = course_of(tmp_path)
    lab = returned(course, json.loads(OLDER))
    made = report(lab.lessons, "", datetime(2026, 1, 1, tzinfo=UTC)).decode()
    assert made.count(ENGLISH("lesson.unknown")) == 2
    assert ENGLISH("report.chosen") not in made and ENGLISH("lesson.skipped") not in made
    rows = record([Member(1, "Ada", lab.lessons.progress)], course)["Answers"]
    results = [row["result"] for row in rows]
    assert results.count("unknown") == 2 and "skipped" not in results
    block = course.lesson(NAME, "en").steps[3].predictions()[0]
    found = distribution(block, NAME, "3", [lab.lessons.progress])
    assert (found.counts, found.skipped, found.waiting, found.unknown) == ((0, 0), 0, 0, 1)
    assert ENGLISH("class.unknown", count=1) in given_line(found, ENGLISH)


def test_a_new_answer_is_known_again(tmp_path: Path) -> None:
    lab = returned(course_of(tmp_path), json.loads(OLDER))
    do(lab, TakeStep(NAME, 7), c.AnswerQuiz(0, 0))
    assert lab.lessons.notes.unknown == {ASKED} and lab.lessons.notes.quiz == {QUIZ: 0}
    assert not lab.lessons.is_unknown(QUIZ)


# Stored by this version; the lesson changes.


def test_options_in_another_order_are_found_again(tmp_path: Path) -> None:
    kept = chosen(course_of(tmp_path / "before"))
    other = changed(THIS + THAT, THAT + THIS).replace(QUIZ_A + QUIZ_B, QUIZ_B + QUIZ_A)
    lab = returned(course_of(tmp_path / "after", other), kept)
    answer = lab.lessons.answer()
    assert answer is not None and answer.option == 0 and lab.lessons.notes.quiz == {QUIZ: 0}
    assert not lab.lessons.notes.unknown and shown(lab)[1] == {ASKED: {"option": 0}}


@pytest.mark.parametrize("text", ["that one", "something else"])
def test_an_option_of_another_text_is_another_one(tmp_path: Path, text: str) -> None:
    kept = chosen(course_of(tmp_path / "before"))
    lab = returned(course_of(tmp_path / "after", changed('"that"', f'"{text}"')), kept)
    assert lab.lessons.notes.unknown == {ASKED}
    assert lab.lessons.notes.quiz == {QUIZ: 1}  # the quiz is the same
    assert ENGLISH("lesson.unknown") in shown(lab)[0]


def test_an_option_with_a_key_may_be_reworded(tmp_path: Path) -> None:
    with_key = changed('text = "that"', 'key = "waits", text = "that"')
    kept = chosen(course_of(tmp_path / "before", with_key))
    reworded = with_key.replace('text = "that"', 'text = "quite another text"')
    lab = returned(course_of(tmp_path / "after", reworded), kept)
    answer = lab.lessons.answer()
    assert answer is not None and answer.option == 1 and not lab.lessons.notes.unknown


def test_a_translation_has_the_keys_of_the_first_language(tmp_path: Path) -> None:
    german = changed('"this"', '"dies"').replace('"that"', '"jenes"').replace('"b"', '"be"')
    kept = chosen(course_of(tmp_path / "before", de=german))
    kept["language"] = "de"
    reworded = german.replace('"jenes"', '"das da"')
    lab = returned(course_of(tmp_path / "after", de=reworded), kept)
    answer = lab.lessons.answer()
    assert answer is not None and answer.option == 1 and not lab.lessons.notes.unknown
    assert Words("de")("lesson.unknown") not in shown(lab)[0]


def test_a_step_that_asks_for_a_curve_now_shows_no_choice(tmp_path: Path) -> None:
    kept = chosen(course_of(tmp_path / "before"))
    start, end = LESSON.index('kind = "choice"'), LESSON.index("# run: See")
    curve = LESSON[LESSON.index('kind = "sketch"') : LESSON.index("# run: And now")]
    curve = curve.replace("seconds = 2.0", "seconds = 1.0")  # as long as the run
    lab = returned(course_of(tmp_path / "after", LESSON[:start] + curve + LESSON[end:]), kept)
    assert lab.lessons.notes.unknown == {ASKED}


def test_a_curve_of_other_axes_is_not_shown(tmp_path: Path) -> None:
    course = course_of(tmp_path / "before")
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, TakeStep(NAME, 1), c.Predict(times=(0.0, 1.0), values=(1.0, 2.0)))
    stored = msgspec.to_builtins(lab.lessons.progress)
    same = returned(course, stored)
    assert same.lessons.notes.answers["1"].times and same.lessons.progress == lab.lessons.progress
    speed = course_of(tmp_path / "after", changed('"distance"\nseconds', '"speed"\nseconds'))
    other = returned(speed, stored)
    assert not other.lessons.notes.answers["1"].times and other.lessons.is_unknown()


def test_the_answer_after_a_discussion_and_the_reason_are_found_again(tmp_path: Path) -> None:
    reasons = changed('kind = "choice"\n', 'kind = "choice"\nreasons = ["late", "early"]\n')
    lab = Lab(loop_cache(), FIVE_BAR, course_of(tmp_path / "before", reasons))
    do(lab, TakeStep(NAME, 3), c.Predict(option=1, reason=0), TakeStep(NAME, 3, again=True))
    do(lab, c.Predict(option=0, reason=1))
    other = reasons.replace(THIS + THAT, THAT + THIS).replace('"late", "early"', '"early", "late"')
    stored = msgspec.to_builtins(lab.lessons.progress)
    notes = returned(course_of(tmp_path / "after", other), stored).lessons.notes
    assert notes.answers[ASKED] == Answer(0, reason=1)
    assert notes.second[ASKED] == Answer(1, reason=0) and not notes.unknown


# Laws.


def test_nothing_changes_while_the_lessons_do_not(tmp_path: Path) -> None:
    course = course_of(tmp_path)
    lab = returned(course, chosen(course))
    assert of_today(course, lab.lessons.progress) is lab.lessons.progress
    once = of_today(course, read_progress(msgspec.json.decode(OLDER)))
    assert of_today(course, once) is once


def test_every_order_of_the_options_gives_the_option_that_was_chosen(tmp_path: Path) -> None:
    lines = [THIS, THAT, '  { text = "third", answer = "3" },\n']
    texts = [re.findall('text = "(.*?)"', line)[0] for line in lines]
    original = course_of(tmp_path / "0", changed(THIS + THAT, "".join(lines)))
    marks = original.lesson(NAME, "en").keys[ASKED]
    for number, order in enumerate(permutations(range(3)), 1):
        text = changed(THIS + THAT, "".join(lines[i] for i in order))
        course = course_of(tmp_path / str(number), text)
        for at, mark in enumerate(marks):
            notes = notes_with(answers={ASKED: Answer(at)}, marks={ASKED: mark})
            found = of_today(course, Progress(notes={NAME: notes})).notes[NAME].answers[ASKED]
            block = course.lesson(NAME, "en").steps[3].predictions()[0]
            assert block.options[found.option].text == texts[at]  # type: ignore[union-attr, index]


def test_keys_of_a_question_differ_and_are_the_same_in_all_languages() -> None:
    course = built_in_course()[0]
    for versions in (*course.lessons.values(), *course.tests.values()):
        first, *others = versions.values()
        assert first.keys and all(other.keys == first.keys for other in others)
        assert all(len(set(keys)) == len(keys) for keys in first.keys.values())
