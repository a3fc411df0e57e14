"""What a class has predicted and done: as numbers for the projector, and as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from onpath.app.classroom.classroom import Member
from onpath.lessons.course import Course
from onpath.lessons.progress import Answer, Notes, Progress, Truth
from onpath.lessons.schema import Choice, Lesson, Prediction, Quiz, Sketch

HEADER = ("number", "nickname", "lesson", "step", "kind", "item", "result", "right", "value")
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "|", "%")
LETTERS = "ABCDEFGH"


@dataclass(frozen=True, slots=True)
class Distribution:
    """How a class has answered a prediction.

    Attributes:
        counts: by option; empty for a sketch.
        sketches: the curves.
        skipped: how many have skipped it.
        waiting: how many have not answered.
    """

    counts: tuple[int, ...]
    sketches: tuple[Answer, ...]
    skipped: int
    waiting: int


def prediction_at(lesson: Lesson, index: int) -> tuple[int, Prediction] | None:
    """The prediction of a step, or the one whose truth the step shows, and the step it is in."""
    before = index - 1 if lesson.steps[index].kind == "run" else index
    for at in dict.fromkeys((index, before)):
        if at >= 0:
            for prediction in lesson.steps[at].predictions():
                return at, prediction
    return None


def distribution(
    prediction: Prediction, lesson: str, step: int, ways: Sequence[Progress]
) -> Distribution:
    """How the class has answered.

    Args:
        step: the prediction's.
        ways: of all students.
    """
    answers = [_notes(way, lesson).answers.get(str(step)) for way in ways]
    given = [answer for answer in answers if answer is not None]
    options = range(len(prediction.options)) if isinstance(prediction, Choice) else ()
    return Distribution(
        counts=tuple(sum(answer.option == option for answer in given) for option in options),
        sketches=tuple(answer for answer in given if answer.times),
        skipped=sum(answer.skipped for answer in given),
        waiting=len(answers) - len(given),
    )


def truth_of(lesson: str, step: int, ways: Iterable[Progress]) -> Truth | None:
    """What really happens, from the first lab in which it has happened."""
    found = (_notes(way, lesson).truths.get(str(step)) for way in ways)
    return next((truth for truth in found if truth is not None and truth.times), None)


def tasks_passed(way: Progress, lesson: Lesson) -> tuple[int, int]:
    """How many tasks of a lesson are passed, and how many there are."""
    tasks, passed = lesson.tasks(), _notes(way, lesson.name).tasks
    return sum(task.id in passed for task in tasks), len(tasks)


def class_csv(members: Iterable[Member], course: Course, language: str) -> bytes:
    """One row per student and prediction, task or question of the lessons that were opened.

    Text that a spreadsheet would take for a formula begins with an apostrophe.
    """
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    writer.writerow(HEADER)
    for member in members:
        for name, notes in member.progress.notes.items():
            if name in course.lessons:
                for row in _rows(course.lesson(name, language), notes):
                    cells = (member.number, member.name, name, *row)
                    writer.writerow([_harmless(cell) for cell in cells])
    return b"\xef\xbb\xbf" + file.getvalue().encode()  # so that spreadsheets see it is UTF-8


def _rows(lesson: Lesson, notes: Notes) -> Iterator[tuple[object, ...]]:
    """Step, kind, item, result, whether it is right, value."""
    for index, step in enumerate(lesson.steps):
        for prediction in step.predictions():
            answer = notes.answers.get(str(index))
            yield index + 1, "prediction", step.title, *_answered(prediction, answer)
        for task in step.tasks():
            best = notes.tasks.get(task.id)
            passed, value = best is not None, best if task.best and best is not None else ""
            yield index + 1, "task", task.id, "passed" if passed else "open", int(passed), value
        for number, block in enumerate(step.blocks):
            chosen = notes.quiz.get(f"{index}.{number}")
            if isinstance(block, Quiz):
                yield index + 1, "question", step.title, *_chosen(block, chosen)


def _answered(prediction: Prediction, answer: Answer | None) -> tuple[object, object, object]:
    if answer is None:
        return "open", "", ""
    if answer.skipped:
        return "skipped", "", ""
    if isinstance(prediction, Sketch):
        points = zip(answer.times, answer.values, strict=True)
        return "sketch", "", " ".join(f"{t:g}:{v:g}" for t, v in points)
    return _chosen(prediction, answer.option)


def _chosen(block: Choice | Quiz, option: int | None) -> tuple[object, object, object]:
    if option is None or option >= len(block.options):
        return "open", "", ""
    return LETTERS[option], int(block.options[option].right), ""


def _harmless(cell: object) -> object:
    if isinstance(cell, str) and cell.lstrip().startswith(FORMULA):
        return f"'{cell}"
    return cell


def _notes(way: Progress, lesson: str) -> Notes:
    return way.notes.get(lesson, Notes())
