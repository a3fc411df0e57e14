"""A student's lesson report as one page: predictions, results and progress.

The page is rendered from the templates in assets/templates/report.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from onpath.app.common.access_codes import shown
from onpath.app.common.templates import render
from onpath.app.exports.report_plot import draw_prediction
from onpath.app.lab.lesson_state import LessonState
from onpath.app.view.concept_test_facts import results_of
from onpath.app.view.curve_words import curve_words
from onpath.app.view.report_facts import (
    Chapter,
    chapters,
    numbers,
    open_questions,
    predictions,
    quizzes,
)
from onpath.lessons.action_schema import RobotName
from onpath.lessons.given import Answer
from onpath.lessons.progress import Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import (
    Derivation,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
)
from onpath.lessons.sides import robot_names
from onpath.lessons.task_schema import Task
from onpath.lessons.words import DEFAULT, Words


@dataclass(frozen=True, slots=True)
class SketchFigure:
    """A sketched prediction compared with the result.

    Attributes:
        picture: the image as a data URI.
        caption: text that states the peaks.
    """

    name: str
    picture: str
    caption: str


@dataclass(frozen=True, slots=True)
class AskedPrediction:
    """A prediction that a step asks for.

    Attributes:
        step: index of the step.
        chosen: index of the option chosen, if any.
        second: the answer after a discussion, if it was asked again.
        unknown: whether the answer cannot be recovered, since the lesson has changed.
        figure: the figure of a sketch, if there is anything to draw.
    """

    step: int
    block: Prediction
    answer: Answer | None
    truth: Truth | None
    chosen: int | None
    figure: SketchFigure | None
    second: Answer | None = None
    unknown: bool = False


@dataclass(frozen=True, slots=True)
class ChapterRecord:
    """Contents of the report for one lesson.

    Attributes:
        counts: completed and total steps, tasks, predictions, correct choices.
        foreign: whether the lesson is unavailable in the student's language.
        tasks: each with its message if it is passed, otherwise with an empty text.
        questions: each with the index of the option chosen, if any, and whether it is unknown.
        numbers: questions for a number, each with the answer, if any.
        written: open questions, each with the student's words; empty if there are none.
    """

    chapter: Chapter
    counts: tuple[tuple[int, int], ...]
    foreign: bool
    predictions: list[AskedPrediction]
    tasks: list[tuple[Task, str]]
    questions: list[tuple[Quiz, int | None, bool]]
    numbers: list[tuple[NumberQuestion, float | None]]
    written: list[tuple[OpenQuestion | Derivation, str]]


def report(run: LessonState, code: str, made: datetime) -> bytes:
    """The report as a standalone page; the same record gives the same bytes.

    Args:
        code: lab code as stored; empty for none.
        made: the date shown on the report.
    """
    words = Words(run.progress.language)
    page = render(
        "report/page.html",
        code=shown(code) if code else "",
        made=made.strftime(words("report.date")),
        records=[_record(chapter, words) for chapter in chapters(run)],
        gone=sorted(name for name in run.progress.notes if not run.course.has(name)),
        results=results_of(run),
        words=words,
    )
    return (page + "\n").encode("utf-8", "replace")


def _record(chapter: Chapter, words: Words) -> ChapterRecord:
    lesson, notes, chosen = chapter.lesson, chapter.notes, chapter.chosen()
    made = sum(not a.skipped or key in notes.unknown for key, a in notes.answers.items())
    asked, tasks = predictions(lesson), lesson.tasks()
    return ChapterRecord(
        chapter=chapter,
        counts=(
            (notes.seen, len(lesson.steps)),
            (len(notes.tasks), len(tasks)),
            (made, len(asked)),
            (sum(chosen.values()), len(chosen)),
        ),
        foreign=lesson.language == DEFAULT != words.language,
        predictions=[_asked(chapter, key, block, words) for key, block in asked.items()],
        tasks=[(task, _passed(task, notes.tasks.get(task.id), words)) for task in tasks],
        questions=[
            (quiz, notes.quiz.get(key), key in notes.unknown)
            for key, quiz in quizzes(lesson, notes).items()
        ],
        numbers=[(block, notes.numbers.get(key)) for key, block in numbers(lesson, notes).items()],
        written=[
            (block, notes.written.get(key, "")) for key, block in open_questions(lesson).items()
        ],
    )


def _asked(chapter: Chapter, key: str, block: Prediction, words: Words) -> AskedPrediction:
    answer, truth = chapter.notes.answers.get(key), chapter.notes.truths.get(key)
    names = robot_names(chapter.lesson.laws_shown(int(key)), words)
    figure = _figure(block, answer, truth, words, names) if isinstance(block, Sketch) else None
    return AskedPrediction(
        step=int(key),
        block=block,
        answer=answer,
        truth=truth,
        chosen=answer.option if answer else None,
        figure=figure,
        second=chapter.notes.second.get(key),
        unknown=key in chapter.notes.unknown,
    )


def _passed(task: Task, best: float | None, words: Words) -> str:
    if best is None:
        return ""
    if not task.best:
        return words("lesson.passed")
    unit = QUANTITIES.get(task.best, "")
    return words("lesson.passed_best", best=words.number(best, 3), unit=unit)


def _figure(
    block: Sketch,
    answer: Answer | None,
    truth: Truth | None,
    words: Words,
    names: dict[RobotName, str],
) -> SketchFigure | None:
    """Figure of the sketch and the result on the same axes, with the peaks as text.

    Args:
        names: names of the robots.
    """
    caption = curve_words(block, answer, truth, words, names)
    if not caption:
        return None
    robot, quantity = names[block.robot], words(f"quantity.{block.quantity}")
    name = words("report.curve", robot=robot, quantity=quantity)
    picture = draw_prediction(block, answer, truth, words, names)
    return SketchFigure(name, picture, caption)
