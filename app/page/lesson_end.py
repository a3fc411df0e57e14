"""The end of a lesson or of a route: predictions and results, and where to go next."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import viser

from onpath.app.common.palette import BORDER
from onpath.app.common.templates import render
from onpath.app.exports.curve_words import curve_words
from onpath.app.exports.report_facts import (
    Chapter,
    chapters,
    numbers,
    open_questions,
    predictions,
    quizzes,
)
from onpath.app.lab import commands as c
from onpath.app.page.lesson_chart import PredictionChart
from onpath.app.page.panels.widgets import Post, add_buttons, on_press
from onpath.lessons.concept_test.on_route import last_test
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.progress import Answer
from onpath.lessons.schema import Choice, Prediction, Sketch
from onpath.lessons.sides import robot_names

if TYPE_CHECKING:
    from onpath.app.page.lesson_view import LessonView


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
        asked, answers = self.predictions(), self.chapter.notes.answers
        return [
            block.options[answers[key].option or 0].right
            for key, block in asked.items()
            if isinstance(block, Choice) and self.chapter.happened(key)
            if key in answers and answers[key].option is not None
        ]

    def drawn(self) -> list[bool]:
        """For each curve that was asked for, whether the student has drawn it."""
        nothing, answers = Answer(), self.chapter.notes.answers
        asked = [key for key, block in self.predictions().items() if isinstance(block, Sketch)]
        return [bool(answers.get(key, nothing).times) for key in asked]

    def passed(self) -> list[bool]:
        """For each required task of these steps, whether it is passed."""
        steps = [self.chapter.lesson.steps[index] for index in self.steps]
        steps = [step for step in steps if not step.optional]
        return [task.id in self.chapter.notes.tasks for step in steps for task in step.tasks()]


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


class LessonEnd:
    """The widgets of the end, added to the open container.

    Args:
        report: requests the record of all lessons.

    Attributes:
        handles: all of them, each with `remove`.
    """

    def __init__(
        self, gui: viser.GuiApi, run: LessonView, post: Post, report: Callable[[], None]
    ) -> None:
        self._gui, self._run, self._words, self._post = gui, run, run.words, post
        self.handles: list[Any] = []
        parts = ended_parts(run)
        fronts = {part.chapter.lesson.name: part.chapter.lesson.front for part in parts}
        learnt = [front for front in fronts.values() if front.takeaway]
        self._html("lesson/end.html", run=run, counts=self._counts(parts))
        self._add_navigation(report)
        self._html("lesson/takeaway.html", learnt=learnt)
        for part in parts:
            self._add_predictions(part)
        self._html(
            "lesson/end_rest.html",
            parts=parts,
            run=run,
            quizzes=quizzes,
            numbers=numbers,
            open_questions=open_questions,
        )

    def _add_navigation(self, report: Callable[[], None]) -> None:
        """Buttons: the next lesson, the record, back, and the free lab."""
        words, after = self._words, next_lesson(self._run)
        if after is not None:
            name, title = after
            label = words("end.next", lesson=title)
            forward = self._gui.add_button(label, icon=viser.Icon.ARROW_RIGHT)
            on_press(forward, lambda: self._post(c.OpenLesson(name)))
            self.handles.append(forward)
        run = self._run
        if test := last_test(run.route, run.course, run.progress):
            title = titles_of_tests(run.course, words)[test]
            label = words("test.open_name", title=title)
            last = self._gui.add_button(label, icon=viser.Icon.ARROW_RIGHT)
            on_press(last, lambda: self._post(c.OpenLesson(test)))
            self.handles.append(last)
        actions: dict[str, Callable[[], None]] = {
            words("lesson.back"): lambda: self._post(c.GoToStep(-1)),
            words("end.record"): report,
            words("lesson.close"): lambda: self._post(c.CloseLesson()),
        }
        self.handles.append(add_buttons(self._gui, "", actions, lambda act: act()))

    def _add_predictions(self, part: EndedPart) -> None:
        """Each prediction with its result: the curves, or the chosen and the right option."""
        chapter = part.chapter
        notes, lesson = chapter.notes, chapter.lesson
        for key, block in part.predictions().items():
            answer, truth = notes.answers.get(key), notes.truths.get(key)
            laws, description = lesson.laws_shown(int(key)), ""
            if isinstance(block, Sketch):
                names = robot_names(laws, self._words)
                description = curve_words(block, answer, truth, self._words, names)
            self._html(
                "lesson/end_prediction.html",
                title=lesson.steps[int(key)].title,
                colour=BORDER.hex,
                block=block,
                answer=answer,
                truth=truth,
                description=description,
                second=notes.second.get(key),
                unknown=key in notes.unknown,
            )
            if isinstance(block, Sketch) and description:
                chart = PredictionChart(
                    gui=self._gui,
                    sketch=block,
                    answer=answer,
                    laws=laws,
                    words=self._words,
                    truth=truth,
                )
                self.handles.append(chart)

    def _counts(self, parts: list[EndedPart]) -> list[str]:
        """The student's results as short phrases: choices right, curves drawn, tasks passed."""
        words, phrases = self._words, list[str]()
        if right := [right for part in parts for right in part.chosen()]:
            phrases.append(words("end.right", part=sum(right), all=len(right)))
        if drawn := [drawn for part in parts for drawn in part.drawn()]:
            phrases.append(words("end.drawn", part=sum(drawn), all=len(drawn)))
        if passed := [passed for part in parts for passed in part.passed()]:
            phrases.append(words("end.tasks", part=sum(passed), all=len(passed)))
        return phrases

    def _html(self, template: str, **values: object) -> None:
        content = render(template, words=self._words, **values)
        self.handles.append(self._gui.add_html(content))
