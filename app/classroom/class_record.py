"""The record of a class: a workbook (.xlsx) with one row for each student and each item asked.

Every spreadsheet, in any language, opens it in columns. CSV has no such form, since its separator
and decimal mark depend on the language. A column holds one type, and text stays text: no cell is a
formula, even if a student has typed one.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from onpath.app.classroom.classroom import Member
from onpath.lessons.course import Course
from onpath.lessons.kept.option_keys import second_key
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Answer, Notes
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

Row = Mapping[str, str | int | float]
QUESTIONS = Quiz, NumberQuestion, OpenQuestion
WIDTH = 14  # [characters], width of a column
_STUDENT = ("number", "nickname")
_WHERE = ("lesson", "title", "step", "kind")
ANSWERS = (
    *(*_STUDENT, *_WHERE, "item", "result", "chosen", "right", "value", "text"),
    *("sure", "reason", "why", "hints"),
)
SKETCHES = (*_STUDENT, *_WHERE, "time", "drawn")


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table of the workbook.

    Attributes:
        columns: headings, in order.
        rows: cells by heading; missing ones are empty.
    """

    name: str
    columns: Sequence[str]
    rows: Iterable[Row]


def class_record(
    members: Iterable[Member],
    course: Course,
    language: str,
    made: datetime,
    more: Iterable[Sheet] = (),
) -> bytes:
    """The workbook.

    The sheet Answers has a row for each prediction, task and question of every lesson that a
    student has begun. `result` is "answered", "skipped", "open" (neither), "passed" (a task), or
    "unknown" (the options have changed since). `right` is 1 or 0; `chosen` and `reason` are the
    letters of options; `value` is a number, and `text` the student's own words. `hints` is the
    number of a task's hints that were shown. `right` is empty for a task that is meant to be found
    by trying, and so counts nothing. The sheet Sketches
    has the points of drawn curves, in the units of their axes.

    Args:
        made: time of the record, in UTC.
        more: further sheets; see `app.classroom.concept_test_results`.
    """
    members = list(members)
    about = {"made (UTC)": f"{made:%Y-%m-%d %H:%M:%S}", "OnPath": _version(), "language": language}
    sheets = [
        Sheet("Answers", ANSWERS, _of_all(members, course, language, _answers)),
        Sheet("Sketches", SKETCHES, _of_all(members, course, language, _sketches)),
        Sheet("Students", _STUDENT, map(_student, members)),
        *more,
        Sheet("About", ("of", "is"), ({"of": name, "is": value} for name, value in about.items())),
    ]
    return workbook(sheets, made)


def workbook(sheets: Iterable[Sheet], made: datetime) -> bytes:
    """The sheets as an .xlsx file."""
    from xlsxwriter import Workbook

    file = io.BytesIO()
    with Workbook(file, {"in_memory": True}) as book:
        book.set_properties({"created": made.replace(tzinfo=None)})
        head = book.add_format({"bold": True})
        text = book.add_format({"quote_prefix": True})  # stays text when somebody edits it
        for sheet in sheets:
            page = book.add_worksheet(sheet.name)
            page.freeze_panes(1, 0)
            page.set_column(0, len(sheet.columns) - 1, WIDTH)
            for at, heading in enumerate(sheet.columns):
                page.write_string(0, at, heading, head)
            for number, row in enumerate(sheet.rows, 1):
                _write(page, number, sheet.columns, row, text)
    return file.getvalue()


def _write(page: Any, number: int, columns: Sequence[str], row: Row, text: Any) -> None:
    for at, heading in enumerate(columns):
        cell = row.get(heading, "")
        if isinstance(cell, str):
            if cell:
                page.write_string(number, at, cell, text)
        else:
            page.write_number(number, at, cell)


def _version() -> str:
    try:
        return version("onpath")
    except PackageNotFoundError:  # a checkout that is not installed
        return ""


def _student(member: Member) -> dict[str, str | int | float]:
    return {"number": member.number, "nickname": member.name}


def _of_all(members: Iterable[Member], course: Course, language: str, rows: Any) -> Iterator[Row]:
    """The rows of the lessons that each student has begun."""
    for member in members:
        for name, notes in member.progress.notes.items():
            if name in course.lessons:
                lesson = course.lesson(name, language)
                where = {**_student(member), "lesson": name, "title": lesson.front.title}
                for row in rows(lesson, notes):
                    yield {**where, **row}


def _answers(lesson: Lesson, notes: Notes) -> Iterator[Row]:
    for key, kind, prediction, answer in _predictions(lesson, notes):
        index = int(key)
        where = {"step": index + 1, "kind": kind, "item": lesson.steps[index].title}
        unknown = (second_key(key) if kind == "second" else key) in notes.unknown
        yield {**where, **_predicted(prediction, answer), **(_unknown() if unknown else {})}
    for index, step in enumerate(lesson.steps):
        for task in step.tasks():
            best = notes.tasks.get(task.id)
            row: dict[str, str | int | float] = {
                "step": index + 1,
                "kind": "task",
                "item": task.id,
                "result": "open" if best is None else "passed",
                "hints": notes.hints.get(task.id, 0),
            }
            if not task.exploratory:
                row["right"] = int(best is not None)
            yield {**row, **({"value": best} if task.best and best is not None else {})}
        yield from _questions(index, step, notes)


def _predictions(
    lesson: Lesson, notes: Notes
) -> Iterator[tuple[str, str, Prediction, Answer | None]]:
    """Key, kind and answer of each prediction, with the second answer if it was asked again."""
    for index, step in enumerate(lesson.steps):
        for prediction in step.predictions():
            key = str(index)
            yield key, "prediction", prediction, notes.answers.get(key)
            if key in notes.asked_again:
                yield key, "second", prediction, notes.second.get(key)


def _sketches(lesson: Lesson, notes: Notes) -> Iterator[Row]:
    for key, kind, _, answer in _predictions(lesson, notes):
        if answer is not None:
            for time, drawn in zip(answer.times, answer.values, strict=True):
                yield {"step": int(key) + 1, "kind": kind, "time": time, "drawn": drawn}


def _questions(index: int, step: Step, notes: Notes) -> Iterator[Row]:
    """The rows of a step's questions, numbered if there are several."""
    asked = [at for at, block in enumerate(step.blocks) if isinstance(block, QUESTIONS)]
    for count, at in enumerate(asked, 1):
        block, key = step.blocks[at], f"{index}.{at}"
        item = f"{step.title} ({count})" if len(asked) > 1 else step.title
        place = {"step": index + 1, "item": item}
        if isinstance(block, Quiz):
            row = _unknown() if key in notes.unknown else _chosen(block, notes.quiz.get(key))
            yield {**place, "kind": "question", **row}
        elif isinstance(block, NumberQuestion):
            given = notes.numbers.get(key)
            row = {"result": "open"} if given is None else {"result": "answered", "value": given}
            right = {} if given is None else {"right": int(block.accepts(given))}
            yield {**place, "kind": "number", **row, **right}
        elif isinstance(block, OpenQuestion):
            text = notes.written.get(key, "")
            yield {**place, "kind": "words", "result": "answered" if text else "open", "text": text}


def _predicted(prediction: Prediction, answer: Answer | None) -> Row:
    """What was predicted, how sure the student is, and why."""
    if answer is None:
        return {"result": "open"}
    if answer.skipped:
        return {"result": "skipped"}
    row = {"result": "answered"}
    if not isinstance(prediction, Sketch):
        row |= _chosen(prediction, answer.option)
    known = answer.reason is not None and answer.reason < len(prediction.reasons)
    reason = {"reason": LETTERS[answer.reason]} if known and answer.reason is not None else {}
    return {**row, "sure": answer.sure, **reason, "why": answer.why}


def _chosen(block: Choice | Quiz, option: int | None) -> dict[str, Any]:
    if option is None or option >= len(block.options):
        return {"result": "open"}
    right = int(block.options[option].right)
    return {"result": "answered", "chosen": LETTERS[option], "right": right}


def _unknown() -> dict[str, Any]:
    return {"result": "unknown", "chosen": "", "right": ""}
