"""The record of a class: a workbook (.xlsx) with one row for each answer of each student.

Every spreadsheet, in any language, opens it in columns. CSV has no such form, since its separator
and decimal mark depend on the language. A column holds one type, and text stays text: no cell is a
formula, even if a student has typed one.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from functools import partial
from typing import Any

from onpath.app.classroom.classroom import Member
from onpath.app.common.product import product_version
from onpath.lessons.course import Course
from onpath.lessons.given import Given
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Notes, given_to
from onpath.lessons.schema import (
    Block,
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    Sketch,
)
from onpath.lessons.second_try import second_at, second_item
from onpath.lessons.votes import Vote, is_late, vote_on

Row = Mapping[str, str | int | float]
QUESTIONS = Quiz, NumberQuestion, OpenQuestion, Derivation
KINDS_ASKED: dict[type[Block], str] = {
    Quiz: "question",
    NumberQuestion: "number",
    OpenQuestion: "words",
    Derivation: "derivation",
}
WIDTH = 14  # [characters], width of a column
_STUDENT = ("number", "nickname")
_WHERE = ("lesson", "title", "step", "kind")
ANSWERS = (
    *(*_STUDENT, *_WHERE, "item", "attempt", "given (UTC)", "late"),
    *("result", "chosen", "right", "value", "text", "sure", "reason", "why", "hints"),
    *("lesson version", "OnPath"),
)
SKETCHES = (*_STUDENT, *_WHERE, "attempt", "time", "drawn")


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
    votes: Sequence[Vote] = (),
) -> bytes:
    """The workbook.

    The sheet Answers has a row for each answer to a prediction, a question or a task of every
    lesson that a student has begun, made of its `lessons.given.Given`, and one for each of these
    that is not answered. `attempt` is 1 for the first answer to an item; of later ones, the second
    is kept where it is judged, and the last, also after a discussion. `given (UTC)` is empty for
    answers from before times were kept. `late` is 1 for an answer after the vote was closed, and
    empty if there was none. `result` is
    "answered", "skipped", "open" (neither), "passed" (a task), or "unknown" (the options have
    changed since). `right` is 1 or 0; `chosen` and `reason` are the letters of options; `value` is
    a number, and `text` the student's own words, or the rows of a derivation, which is right if
    each line was so at once. `hints` is the number of a task's hints that were shown. `right` is
    empty for what counts nothing: a task that is meant to be found by trying, and a warm-up
    question. A "second try", which is asked after a wrong choice, has a row if it was made. The
    sheet Sketches has the points of drawn curves, in the units of their axes.

    Args:
        made: time of the record, in UTC.
        more: further sheets; see `app.classroom.concept_test_results`.
        votes: of the class.
    """
    members = list(members)
    answers = partial(_answers, votes=votes)
    about = {
        "made (UTC)": f"{made:%Y-%m-%d %H:%M:%S}",
        "OnPath": product_version(),
        "language": language,
    }
    sheets = [
        Sheet("Answers", ANSWERS, _of_all(members, course, language, answers)),
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


def _answers(lesson: Lesson, notes: Notes, votes: Sequence[Vote]) -> Iterator[Row]:
    for item, kind, prediction, given in _predictions(lesson, notes):
        index, second = int(item), kind == "second"
        where = {"step": index + 1, "kind": kind, "item": lesson.steps[index].title}
        when = _when(given, vote_on(votes, lesson.name, item, second))
        yield {**where, **when, **_predicted(prediction, given)}
    for index, step in enumerate(lesson.steps):
        for task in step.tasks():
            for given in given_to(notes, task.id) or [None]:
                row: dict[str, str | int | float] = {
                    "step": index + 1,
                    "kind": "task",
                    "item": task.id,
                    "result": "open" if given is None else "passed",
                    "hints": notes.hints.get(task.id, 0) if given is None else given.hints,
                    **_when(given, None),
                }
                if not task.exploratory:
                    row["right"] = int(given is not None)
                if task.best and given is not None and given.number is not None:
                    row["value"] = given.number
                yield row
        yield from _questions(lesson, index, notes, votes)
        yield from _second_tries(lesson, index, notes)


def _when(given: Given | None, vote: Vote | None) -> Row:
    """Which of the answers to an item it is, of which lesson, when it was given, and whether that
    was late."""
    if given is None:
        return {}
    row: dict[str, str | int] = {"attempt": given.attempt}
    row |= {"lesson version": given.lesson, "OnPath": given.product}
    if given.time:
        row["given (UTC)"] = f"{datetime.fromtimestamp(given.time, UTC):%Y-%m-%d %H:%M:%S}"
        row |= {} if vote is None else {"late": int(is_late(vote, given))}
    return row


def _predictions(
    lesson: Lesson, notes: Notes
) -> Iterator[tuple[str, str, Prediction, Given | None]]:
    """Item, kind and event of each answer to a prediction, or none if it is open; those of the last
    time it was asked again are of the kind "second"."""
    for index, step in enumerate(lesson.steps):
        for prediction in step.predictions():
            item, asked = str(index), notes.asked_again.count(str(index))
            given = given_to(notes, item)
            for each in [each for each in given if not each.round] or [None]:
                yield item, "prediction", prediction, each
            again = [each for each in given if asked and each.round == asked]
            for each in again or [None] * bool(asked):
                yield item, "second", prediction, each


def _sketches(lesson: Lesson, notes: Notes) -> Iterator[Row]:
    for item, kind, _, given in _predictions(lesson, notes):
        if given is not None and given.answer is not None:
            where = {"step": int(item) + 1, "kind": kind, "attempt": given.attempt}
            for time, drawn in zip(given.answer.times, given.answer.values, strict=True):
                yield {**where, "time": time, "drawn": drawn}


def _questions(lesson: Lesson, index: int, notes: Notes, votes: Sequence[Vote]) -> Iterator[Row]:
    """The rows of a step's questions, which are numbered if there are several."""
    step = lesson.steps[index]
    asked = [at for at, block in enumerate(step.blocks) if isinstance(block, QUESTIONS)]
    for count, at in enumerate(asked, 1):
        block, item = step.blocks[at], f"{index}.{at}"
        title = f"{step.title} ({count})" if len(asked) > 1 else step.title
        place = {"step": index + 1, "item": title, "kind": KINDS_ASKED[type(block)]}
        vote = vote_on(votes, lesson.name, item)
        for given in given_to(notes, item) or [None]:
            yield {**place, **_when(given, vote), **_answered(block, given)}


def _second_tries(lesson: Lesson, index: int, notes: Notes) -> Iterator[Row]:
    """The rows of a step's second tries that were made."""
    step = lesson.steps[index]
    for at, asked in enumerate(step.blocks):
        item = second_item(index, at)
        if (block := second_at(lesson.steps, item)) is None:
            continue
        uncounted = isinstance(asked, Quiz) and asked.warm_up
        for given in given_to(notes, item):
            row = _answered(block, given)
            row = {name: cell for name, cell in row.items() if name != "right" or not uncounted}
            place = {"step": index + 1, "item": step.title, "kind": "second try"}
            yield {**place, **_when(given, None), **row}


def _answered(block: Block, given: Given | None) -> Row:
    """The answer to a question."""
    if given is None:
        return {"result": "open"}
    if given.lost:
        return _unknown()
    right = {} if given.right is None else {"right": int(given.right)}
    if isinstance(block, NumberQuestion) and given.number is not None:
        return {"result": "answered", "value": given.number, **right}
    if isinstance(block, Quiz) and given.answer is not None:
        return {**_chosen(block, given.answer.option), **({} if block.warm_up else right)}
    return {"result": "answered" if given.text else "open", "text": given.text, **right}


def _predicted(prediction: Prediction, given: Given | None) -> Row:
    """What was predicted, how sure the student is, and why."""
    answer = None if given is None else given.answer
    if given is None or answer is None:
        return {"result": "open"}
    if answer.skipped and not given.lost:
        return {"result": "skipped"}
    row = _unknown() if given.lost else dict[str, Any](result="answered")
    if not isinstance(prediction, Sketch) and not given.lost:
        row |= _chosen(prediction, answer.option)
        row |= {} if given.right is None else {"right": int(given.right)}
    known = answer.reason is not None and answer.reason < len(prediction.reasons)
    reason = {"reason": LETTERS[answer.reason]} if known and answer.reason is not None else {}
    return {**row, "sure": answer.sure, **reason, "why": answer.why}


def _chosen(block: Choice | Quiz, option: int | None) -> dict[str, Any]:
    if option is None or option >= len(block.options):
        return {"result": "open"}
    return {"result": "answered", "chosen": LETTERS[option]}


def _unknown() -> dict[str, Any]:
    return {"result": "unknown", "chosen": "", "right": ""}
