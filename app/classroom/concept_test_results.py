"""The class's answers to the concept test, without names: for the teacher and as CSV rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from hashlib import sha256

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


def rows_without_names(
    test: Lesson, ways: Sequence[tuple[str, Progress]], code: str
) -> Iterator[tuple[object, ...]]:
    """Rows of the CSV: of every student who has handed in, without name, then those of the class.

    A student is the same pseudonym in both tests. The pseudonym does not reveal who that is.

    Args:
        ways: session code and progress of each student.
        code: of the class.
    """
    hidden = {sha256(f"{code} {session}".encode()).hexdigest()[:8]: way for session, way in ways}
    for pseudonym, way in sorted(hidden.items()):
        for name in TESTS:
            if (notes := notes_of(way, name)) is None:
                continue
            asked = zip(test.steps, chosen_in(test, notes), right_in(test, notes), strict=True)
            for number, (step, option, right) in enumerate(asked, 1):
                result = "open" if option is None else LETTERS[option]
                yield "", pseudonym, name, number, "test", step.title, result, int(right), ""
    yield from _class_rows(class_gain(test, [way for _, way in ways]))


def _class_rows(found: ClassGain) -> Iterator[tuple[object, ...]]:
    """The class's results; nothing if no student has handed in both tests."""
    if not found.students:
        return
    told = {
        (BEFORE, "mean [%]"): found.mean_before,
        (AFTER, "mean [%]"): found.mean_after,
        ("", "normalised gain"): found.gain,
    }
    for (name, item), value in told.items():
        shown = "" if value is None else f"{value:.4g}"
        yield "", "", name, "", "class", item, found.students, "", shown


def question_at(test: Lesson, index: int) -> Quiz:
    """The question of a step of a test."""
    return list(questions(test).values())[index]
