"""Predictions and results of a class: as numbers for the projector and as CSV."""

from __future__ import annotations

import csv
import io
import unicodedata
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from onpath.app.classroom.classroom import Member
from onpath.app.common.visible_text import is_visible
from onpath.lessons.course import Course
from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Answer, Notes, Progress, Truth
from onpath.lessons.schema import (
    Choice,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
    Step,
)

HEADER = (
    *("number", "nickname", "lesson", "step", "kind", "item", "result", "right", "value"),
    *("sure", "why"),
)
UNKNOWN = "unknown", "", ""
"""Result, correctness and value of a choice of which the options have changed since."""
QUESTIONS = Quiz, NumberQuestion, OpenQuestion
FORMULA = frozenset("=+-@|%\u2212\u2795\u2796\ua78a\U0001f7f0")
"""Beginnings of a formula, also as minus, heavy or short sign; other widths and sizes by NFKC."""


@dataclass(frozen=True, slots=True)
class Distribution:
    """The answers of a class to a prediction.

    Attributes:
        counts: number of answers per option; empty for a sketch.
        sketches: the sketched curves.
        skipped: number of students who skipped it.
        unknown: number of answers that cannot be known, since the lesson has changed.
        waiting: number of students who have not answered.
    """

    counts: tuple[int, ...]
    sketches: tuple[Answer, ...]
    skipped: int
    waiting: int
    unknown: int = 0


def prediction_at(lesson: Lesson, index: int) -> tuple[int, Prediction] | None:
    """The prediction that a step asks or whose truth it shows, and the step that asks it."""
    before = index - 1 if lesson.steps[index].kind == "run" else index
    for at in dict.fromkeys((index, before)):
        if at >= 0:
            for prediction in lesson.steps[at].predictions():
                return at, prediction
    return None


def distribution(
    prediction: Prediction,
    lesson: str,
    step: int,
    ways: Sequence[Progress],
    again: bool = False,
) -> Distribution:
    """Count the answers of the class.

    Args:
        step: index of the step that asks the prediction.
        ways: progress of all students.
        again: whether to count the second answers, after a discussion, instead of the first ones.
    """
    notes, key = [_notes(way, lesson) for way in ways], str(step)
    lost = sum((second_key(key) if again else key) in own.unknown for own in notes)
    answers = [(own.second if again else own.answers).get(key) for own in notes]
    given = [answer for answer in answers if answer is not None]
    options = range(len(prediction.options)) if isinstance(prediction, Choice) else ()
    return Distribution(
        counts=tuple(sum(answer.option == option for answer in given) for option in options),
        sketches=tuple(answer for answer in given if answer.times),
        skipped=sum(answer.skipped for answer in given) - lost,
        waiting=len(answers) - len(given),
        unknown=lost,
    )


def is_asked_again(lesson: str, step: int, ways: Iterable[Progress]) -> bool:
    """Whether a prediction has been asked a second time in the class."""
    return any(str(step) in _notes(way, lesson).asked_again for way in ways)


def truth_of(lesson: str, step: int, ways: Iterable[Progress]) -> Truth | None:
    """The truth, taken from the first lab in which it has been measured."""
    found = (_notes(way, lesson).truths.get(str(step)) for way in ways)
    return next((truth for truth in found if truth is not None and truth.times), None)


def tasks_passed(way: Progress, lesson: Lesson) -> tuple[int, int]:
    """Number of passed tasks of a lesson, and number of its tasks, without the optional ones."""
    tasks, passed = lesson.required_tasks(), _notes(way, lesson.name).tasks
    return sum(task.id in passed for task in tasks), len(tasks)


def class_csv(
    members: Iterable[Member],
    course: Course,
    language: str,
    without_names: Iterable[tuple[object, ...]] = (),
) -> bytes:
    """One row per student and prediction, task or question of the opened lessons.

    A student who has opened none has one row, with number and name alone.
    Text that a spreadsheet would interpret as a formula is prefixed with an apostrophe.

    Args:
        without_names: more rows, which follow the others; see `rows_without_names`.
    """
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    writer.writerow(HEADER)
    for member in members:
        opened = {n: notes for n, notes in member.progress.notes.items() if n in course.lessons}
        for name, notes in opened.items():
            for row in _rows(course.lesson(name, language), notes):
                writer.writerow(_cells(member.number, member.name, name, *row))
        if not opened:
            writer.writerow(_cells(member.number, member.name))
    for row in without_names:
        writer.writerow(_cells(*row))
    return b"\xef\xbb\xbf" + file.getvalue().encode()  # UTF-8 mark for spreadsheets


def _cells(*cells: object) -> list[object]:
    """A row of the CSV, with empty cells at its end."""
    return [_harmless(cell) for cell in (*cells, *("",) * (len(HEADER) - len(cells)))]


def _rows(lesson: Lesson, notes: Notes) -> Iterator[tuple[object, ...]]:
    """Rows of step, kind, item, result, correctness and value; of predictions also the last two."""
    for index, step in enumerate(lesson.steps):
        for prediction in step.predictions():
            answer = notes.answers.get(str(index))
            told, unknown = _told(prediction, answer), str(index) in notes.unknown
            result = UNKNOWN if unknown else _answered(prediction, answer)
            yield index + 1, "prediction", step.title, *result, *told
            if str(index) in notes.asked_again:
                second = notes.second.get(str(index))
                told, unknown = _told(prediction, second), second_key(str(index)) in notes.unknown
                result = UNKNOWN if unknown else _answered(prediction, second)
                yield index + 1, "second", step.title, *result, *told
        for task in step.tasks():
            best = notes.tasks.get(task.id)
            passed, value = best is not None, best if task.best and best is not None else ""
            yield index + 1, "task", task.id, "passed" if passed else "open", int(passed), value
        yield from _question_rows(index, step, notes)


def _question_rows(index: int, step: Step, notes: Notes) -> Iterator[tuple[object, ...]]:
    """Rows of the questions of a step, numbered if there are several."""
    asked = [at for at, block in enumerate(step.blocks) if isinstance(block, QUESTIONS)]
    for count, at in enumerate(asked, 1):
        block, key = step.blocks[at], f"{index}.{at}"
        item = f"{step.title} ({count})" if len(asked) > 1 else step.title
        if isinstance(block, Quiz):
            chosen = _chosen(block, notes.quiz.get(key))
            chosen = UNKNOWN if key in notes.unknown else chosen
            yield index + 1, "question", item, *chosen
        elif isinstance(block, NumberQuestion):
            given = notes.numbers.get(key)
            right = "" if given is None else int(block.accepts(given))
            result = "open" if given is None else "number"
            yield index + 1, "number", item, result, right, "" if given is None else given
        elif isinstance(block, OpenQuestion):
            text = notes.written.get(key, "")
            yield index + 1, "words", item, "words" if text else "open", "", text


def _answered(prediction: Prediction, answer: Answer | None) -> tuple[object, object, object]:
    if answer is None:
        return "open", "", ""
    if answer.skipped:
        return "skipped", "", ""
    if isinstance(prediction, Sketch):
        points = zip(answer.times, answer.values, strict=True)
        return "sketch", "", " ".join(f"{t:g}:{v:g}" for t, v in points)
    return _chosen(prediction, answer.option)


def _told(prediction: Prediction, answer: Answer | None) -> tuple[object, object]:
    """How sure the student is, and the chosen reason by its letter, or one in own words."""
    if answer is None or answer.skipped:
        return "", ""
    if answer.reason is not None and answer.reason < len(prediction.reasons):
        return answer.sure, LETTERS[answer.reason]
    return answer.sure, answer.why


def _chosen(block: Choice | Quiz, option: int | None) -> tuple[object, object, object]:
    if option is None or option >= len(block.options):
        return "open", "", ""
    return LETTERS[option], int(block.options[option].right), ""


def _harmless(cell: object) -> object:
    if isinstance(cell, str):
        seen = next(filter(is_visible, cell), "")
        if unicodedata.normalize("NFKC", seen)[:1] in FORMULA:
            return f"'{cell}"
    return cell


def _notes(way: Progress, lesson: str) -> Notes:
    return way.notes.get(lesson, Notes())
