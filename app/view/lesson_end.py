"""The end of a lesson or of a route: predictions and results, and where to go next."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from onpath.app.common.templates import Markup, part_of_page
from onpath.app.steps.block_data import answer_data, curves_data, script_data, sketch_data
from onpath.app.view.concept_test_facts import results_of
from onpath.app.view.curve_words import curve_words
from onpath.app.view.lesson_view import LessonView
from onpath.app.view.report_facts import (
    Chapter,
    chapters,
    numbers,
    open_questions,
    predictions,
    quizzes,
)
from onpath.app.view.step_navigation import RECORD, LessonButton, Sent
from onpath.lessons.concept_test.concept_test import BEFORE, sitting_of
from onpath.lessons.concept_test.on_route import last_test
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.given import Answer
from onpath.lessons.progress import Truth
from onpath.lessons.schema import Prediction, Sketch
from onpath.lessons.sides import robot_names
from onpath.lessons.words import Words


@dataclass(frozen=True, slots=True)
class EndedPart:
    """One lesson at the end: the student's work on it, and the indices of the steps shown."""

    chapter: Chapter
    steps: range

    def has(self, key: str) -> bool:
        """Whether a key of the notes, a step or a step and a block, belongs to these steps."""
        return int(key.partition(".")[0]) in self.steps

    def predictions(self) -> dict[str, Prediction]:
        """The predictions of these steps, by key."""
        return {k: block for k, block in predictions(self.chapter.lesson).items() if self.has(k)}

    def chosen(self) -> list[bool]:
        """For each choice whose result has been seen, whether it was right."""
        return [right for key, right in self.chapter.chosen().items() if self.has(key)]

    def drawn(self) -> list[bool]:
        """For each curve that was asked for, whether the student has drawn it."""
        nothing, answers = Answer(), self.chapter.notes.answers
        asked = [key for key, block in self.predictions().items() if isinstance(block, Sketch)]
        return [bool(answers.get(key, nothing).times) for key in asked]

    def passed(self) -> list[bool]:
        """For each required task of these steps, whether it is passed."""
        steps = [self.chapter.lesson.steps[index] for index in self.steps]
        here = {task.id for step in steps for task in step.tasks()}
        required = [task.id for task in self.chapter.lesson.required_tasks() if task.id in here]
        return [task in self.chapter.notes.tasks for task in required]


def ended_parts(run: LessonView) -> list[EndedPart]:
    """The open lesson, or the stops of the route that is followed to its end."""
    known = {chapter.lesson.name: chapter for chapter in chapters(run)}
    if run.lesson is None:
        return []
    if run.route is None:
        return [EndedPart(known[run.lesson.name], range(len(run.lesson.steps)))]
    stops = [stop for stop in run.route.stop if stop.lesson in known]
    return [EndedPart(known[s.lesson], range(s.steps[0] - 1, s.steps[1])) for s in stops]


def next_lesson(run: LessonView) -> tuple[str, str] | None:
    """Name and title of the lesson after the open one; None after the last one, or on a route."""
    numbers = run.course.numbers()
    names = list(numbers)
    if run.lesson is None or run.route is not None:
        return None
    after = names[names.index(run.lesson.name) + 1 :]
    if not after:
        return None
    title = run.course.lesson(after[0], run.progress.language).front.title
    return after[0], f"{numbers[after[0]]}: {title}"


def lesson_end(run: LessonView) -> tuple[Markup, list[dict[str, Any]]]:
    """The end of a lesson, a route or a test, and the charts of its sketches, in order."""
    if run.is_test:
        return _test_end(run), []
    parts = ended_parts(run)
    return _end_html(run, parts), _ended_charts(run, parts)


def _end_html(run: LessonView, parts: list[EndedPart]) -> Markup:
    fronts = {part.chapter.lesson.name: part.chapter.lesson.front for part in parts}
    return part_of_page(
        "lesson/end.html",
        run=run,
        counts=_counts(parts, run.words),
        onward=_onward(run),
        learnt=[front for front in fronts.values() if front.takeaway],
        predicted=[each for part in parts for each in _predicted(part, run.words)],
        parts=parts,
        quizzes=quizzes,
        numbers=numbers,
        open_questions=open_questions,
        words=run.words,
    )


def _ended_charts(run: LessonView, parts: list[EndedPart]) -> list[dict[str, Any]]:
    """The charts of sketches at the end, in the order of their places in its HTML."""
    charts = list[dict[str, Any]]()
    for part in parts:
        lesson = part.chapter.lesson
        for predicted in _predicted(part, run.words):
            block, answer, truth = predicted.block, predicted.answer, predicted.truth
            if not isinstance(block, Sketch) or not predicted.description:
                continue
            at = int(predicted.key)
            played = lesson.steps[at if lesson.steps[at].kind == "run" else at + 1].script
            charts.append(
                {
                    "data": sketch_data(block, lesson.laws_shown(at), run.words),
                    "script": None if played is None else script_data(played),
                    "answer": {} if answer is None else answer_data(answer),
                    "truth": None if truth is None else curves_data(truth),
                }
            )
    return charts


@dataclass(frozen=True, slots=True)
class Predicted:
    """A prediction with its result.

    Attributes:
        key: of its step in the notes.
        description: of the curves in words; empty if there are none, or for a choice.
    """

    key: str
    title: str
    block: Prediction
    answer: Answer | None
    truth: Truth | None
    second: Answer | None
    unknown: bool
    description: str


def _predicted(part: EndedPart, words: Words) -> Iterator[Predicted]:
    notes, lesson = part.chapter.notes, part.chapter.lesson
    for key, block in part.predictions().items():
        answer, truth, description = notes.answers.get(key), notes.truths.get(key), ""
        if isinstance(block, Sketch):
            names = robot_names(lesson.laws_shown(int(key)), words)
            description = curve_words(block, answer, truth, words, names)
        yield Predicted(
            key=key,
            title=lesson.steps[int(key)].title,
            block=block,
            answer=answer,
            truth=truth,
            second=notes.second.get(key),
            unknown=key in notes.unknown,
            description=description,
        )


def _onward(run: LessonView) -> list[LessonButton]:
    """The buttons that lead on: to the next lesson, the test of a route, and the record."""
    words, buttons = run.words, list[LessonButton]()
    if (after := next_lesson(run)) is not None:
        name, title = after
        buttons.append(LessonButton(words("end.next", lesson=title), [_opened(name)], main=True))
    if test := last_test(run.route, run.course, run.progress):
        title = titles_of_tests(run.course, words)[test]
        buttons.append(
            LessonButton(words("test.open_name", title=title), [_opened(test)], main=True)
        )
    return [*buttons, LessonButton(words("end.record"), [RECORD])]


def _opened(name: str) -> Sent:
    return {"do": "OpenLesson", "name": name}


def _test_end(run: LessonView) -> Markup:
    """Thanks and, after the second test, the right answers and why."""
    words, route = run.words, run.progress.route
    buttons = [LessonButton(words("end.record"), [RECORD])]
    sitting = sitting_of(run.progress.lesson)
    if sitting == BEFORE and route in run.course.routes:
        follow: Sent = {"do": "FollowRoute", "name": route}
        buttons = [LessonButton(words("route.follow"), [follow], main=True), *buttons]
    return part_of_page(
        "lesson/test_end.html",
        title=titles_of_tests(run.course, words)[sitting],
        results=results_of(run),
        buttons=buttons,
        words=words,
    )


def _counts(parts: list[EndedPart], words: Words) -> list[str]:
    """The student's results as short phrases: choices right, curves drawn, tasks passed."""
    phrases = list[str]()
    if right := [right for part in parts for right in part.chosen()]:
        phrases.append(words("end.right", part=sum(right), all=len(right)))
    if drawn := [drawn for part in parts for drawn in part.drawn()]:
        phrases.append(words("end.drawn", part=sum(drawn), all=len(drawn)))
    if passed := [passed for part in parts for passed in part.passed()]:
        phrases.append(words("end.tasks", part=sum(passed), all=len(passed)))
    return phrases
