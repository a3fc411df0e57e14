"""The class's answers to the concept test without names, for the teacher and the record."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from hashlib import sha256
from types import MappingProxyType

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
    test: Lesson, index: int, name: str, students: Sequence[Progress]
) -> Distribution:
    """The class's answers to a question in one of the tests; only tests handed in count.

    Args:
        index: index of the question.
        name: name of the test.
    """
    block = question_at(test, index)
    handed = [notes for each in students if (notes := notes_of(each, name)) is not None]
    chosen = [chosen_in(test, notes)[index] for notes in handed]
    counts = tuple(chosen.count(option) for option in range(len(block.options)))
    return Distribution(
        counts=counts,
        sketches=(),
        skipped=chosen.count(None),
        waiting=len(students) - len(handed),
        here=len(students),
        answered=sum(counts),
    )


def gain_view(
    test: Lesson, students: Sequence[Progress], revealed: bool, words: Words, large: bool = False
) -> str:
    """The class's normalised gain and, if revealed, the right answers to each question, [%]."""
    found = class_gain(test, students)
    handed = [sum(notes_of(each, name) is not None for each in students) for name in TESTS]
    rows = [
        (number, block.misconception, *shares)
        for number, (block, *shares) in enumerate(
            zip(questions(test).values(), found.before, found.after, strict=False), 1
        )
    ]
    return render(
        "class/test.html",
        handed=words("test.waiting", part=handed[0], all=len(students), after=handed[1]),
        found=found,
        rows=rows if revealed else [],
        words=words,
        large=large,
    )


def sheets_without_names(
    test: Lesson,
    students: Sequence[tuple[str, Progress]],
    code: str,
    linked: Mapping[str, str] = MappingProxyType({}),
) -> list[Sheet]:
    """Sheets of the record: the class, and every student who has handed in, without names.

    A student has the same pseudonym in both tests. It does not reveal who the student is. `word` is
    the hash of a word that the student made up. It is the same in the records of other months, and
    of the student's other labs.

    Args:
        students: lab code and progress of each student.
        code: the class code.
        linked: hashes of words, by lab code.
    """
    hidden = {
        sha256(f"{code} {lab}".encode()).hexdigest()[:8]: (linked.get(lab, ""), progress)
        for lab, progress in students
    }
    gain = class_gain(test, [progress for _, progress in students])
    columns = ("pseudonym", "word", "test", "question", "item", "result", "chosen", "right")
    return [
        Sheet("Concept test", columns, _test_rows(test, sorted(hidden.items()))),
        Sheet("Concept test, class", ("test", "of", "students", "value"), _class_rows(gain)),
    ]


def _test_rows(test: Lesson, students: Iterable[tuple[str, tuple[str, Progress]]]) -> Iterator[Row]:
    for pseudonym, (word, progress) in students:
        for name in TESTS:
            if (notes := notes_of(progress, name)) is None:
                continue
            asked = zip(test.steps, chosen_in(test, notes), right_in(test, notes), strict=True)
            for number, (step, option, right) in enumerate(asked, 1):
                row = {"pseudonym": pseudonym, "word": word, "test": name, "question": number}
                row |= {"item": step.title, "right": int(right)}
                if option is None:
                    yield {**row, "result": "open"}
                else:
                    yield {**row, "result": "answered", "chosen": LETTERS[option]}


def _class_rows(found: ClassGain) -> Iterator[Row]:
    """The class's results; nothing if no student has handed in both tests."""
    if not found.students:
        return
    values = {
        (BEFORE, "mean [%]"): found.mean_before,
        (AFTER, "mean [%]"): found.mean_after,
        ("", "normalised gain"): found.gain,
    }
    for (name, item), value in values.items():
        row = {"test": name, "of": item, "students": found.students}
        yield row if value is None else {**row, "value": value}


def question_at(test: Lesson, index: int) -> Quiz:
    """The question of a step of a test."""
    return list(questions(test).values())[index]
