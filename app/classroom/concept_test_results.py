"""The class's answers to the concept test, without names: for the teacher and the record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from hashlib import sha256

from onpath.app.classroom.class_record import Row, Sheet
from onpath.app.classroom.results import Distribution
from onpath.app.common.templates import render
from onpath.lessons.concept_test.concept_test import (
    AFTER,
    BEFORE,
    TESTS,
    chosen_in,
    notes_of,
    questions,
    right_in,
)
from onpath.lessons.concept_test.gain import ClassGain, class_gain
from onpath.lessons.option_order import LETTERS
from onpath.lessons.progress import Progress
from onpath.lessons.schema import Lesson, Quiz
from onpath.lessons.words import Words


def item_distribution(
    test: Lesson, index: int, name: str, ways: Sequence[Progress]
) -> Distribution:
    """How the class has answered a question in one of the tests; only what is handed in counts.

    Args:
        index: of the question.
        name: of the test.
    """
    block = list(questions(test).values())[index]
    handed = [notes for way in ways if (notes := notes_of(way, name)) is not None]
    chosen = [chosen_in(test, notes)[index] for notes in handed]
    counts = tuple(chosen.count(option) for option in range(len(block.options)))
    return Distribution(counts, (), chosen.count(None), len(ways) - len(handed))


def gain_view(
    test: Lesson, ways: Sequence[Progress], revealed: bool, words: Words, large: bool = False
) -> str:
    """The class's normalised gain, and once revealed the right answers to each question, [%]."""
    found = class_gain(test, ways)
    handed = [sum(notes_of(way, name) is not None for way in ways) for name in TESTS]
    rows = [
        (number, block.misconception, *shares)
        for number, (block, *shares) in enumerate(
            zip(questions(test).values(), found.before, found.after, strict=False), 1
        )
    ]
    return render(
        "class/test.html",
        handed=words("test.waiting", part=handed[0], all=len(ways), after=handed[1]),
        found=found,
        rows=rows if revealed else [],
        words=words,
        large=large,
    )


def sheets_without_names(
    test: Lesson, ways: Sequence[tuple[str, Progress]], code: str
) -> list[Sheet]:
    """Sheets of the record: every student who has handed in, without name, and the class.

    A student is the same pseudonym in both tests. The pseudonym does not reveal who that is.

    Args:
        ways: session code and progress of each student.
        code: of the class.
    """
    hidden = {sha256(f"{code} {session}".encode()).hexdigest()[:8]: way for session, way in ways}
    gain = class_gain(test, [way for _, way in ways])
    columns = ("pseudonym", "test", "question", "item", "result", "chosen", "right")
    return [
        Sheet("Concept test", columns, _test_rows(test, sorted(hidden.items()))),
        Sheet("Concept test, class", ("test", "of", "students", "value"), _class_rows(gain)),
    ]


def _test_rows(test: Lesson, ways: Iterable[tuple[str, Progress]]) -> Iterator[Row]:
    for pseudonym, way in ways:
        for name in TESTS:
            if (notes := notes_of(way, name)) is None:
                continue
            asked = zip(test.steps, chosen_in(test, notes), right_in(test, notes), strict=True)
            for number, (step, option, right) in enumerate(asked, 1):
                row = {"pseudonym": pseudonym, "test": name, "question": number}
                row |= {"item": step.title, "right": int(right)}
                if option is None:
                    yield {**row, "result": "open"}
                else:
                    yield {**row, "result": "answered", "chosen": LETTERS[option]}


def _class_rows(found: ClassGain) -> Iterator[Row]:
    """The class's results; nothing if no student has handed in both tests."""
    if not found.students:
        return
    told = {
        (BEFORE, "mean [%]"): found.mean_before,
        (AFTER, "mean [%]"): found.mean_after,
        ("", "normalised gain"): found.gain,
    }
    for (name, item), value in told.items():
        row = {"test": name, "of": item, "students": found.students}
        yield row if value is None else {**row, "value": value}


def question_at(test: Lesson, index: int) -> Quiz:
    """The question of a step of a test."""
    return list(questions(test).values())[index]
