"""Judges what a student has typed in a derivation, line by line.

All answers to a derivation are one text, a row for each, in the order in which they were typed: two
wrong ones close a line, as a right one does. A wrong value of the student's own is carried on: a
line that is right with it is right, and is not marked twice. assets/web/lessons/derivation.ts
judges alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from onpath.lessons.derivation.typed import Formula, evaluated, read_formula, spellings
from onpath.lessons.schema import Derivation, DerivedLine
from onpath.models.arrays import Array
from onpath.models.errors import CodedError

POINTS = 20
SAME = 1e-6  # largest difference of equal formulas, relative to the largest value
TRIES = 2
MOST_LINES = 6
"""So that all answers fit into one text of `MOST_TEXT` characters."""

Verdict = Literal["right", "carried", "wrong"]


@dataclass(frozen=True, slots=True)
class Try:
    """One answer to a line.

    Attributes:
        typed: as the student typed it.
        verdict: "carried" is right with a wrong value of an earlier line.
        known: index of the known mistake that it comes from, or None.
    """

    typed: str
    verdict: Verdict
    known: int | None = None


@dataclass(frozen=True, slots=True)
class LineState:
    """What has become of a line.

    Attributes:
        closed: whether it is not asked any more, so that its answer may be told.
    """

    tries: tuple[Try, ...]
    closed: bool

    @property
    def replies(self) -> list[int]:
        """The known mistakes that were made."""
        return [each.known for each in self.tries if each.known is not None]

    @property
    def good(self) -> bool:
        """Whether its first answer was right."""
        return bool(self.tries) and self.tries[0].verdict != "wrong"


def judged(block: Derivation, text: str) -> list[LineState]:
    """What has become of each line.

    Args:
        text: the rows that were typed, see above, in any language; one that cannot be read is
            passed over.
    """
    values = points_of(block)
    true, own, states, missed = dict(values), dict(values), list[LineState](), False
    rows = _rows(text, spellings(block.names))
    for line in block.line:
        tries, latest = list[Try](), None
        while not _closed(tries) and (row := next(rows, None)) is not None:
            if tries and tries[-1].typed == row[0]:
                continue
            latest = evaluated(row[1], values, POINTS)
            tries.append(_judged(line, row[0], latest, true, own, missed))
        states.append(LineState(tuple(tries), _closed(tries)))
        missed |= not tries or tries[-1].verdict == "wrong"
        if line.name:
            true[line.name] = value_of(line.formula, true)
            own[line.name] = true[line.name] if latest is None else latest
    return states


def points_of(block: Derivation) -> dict[str, Array]:
    """Name -> its values at the random points at which formulas are compared, (POINTS,)."""
    random = np.random.default_rng(len(block.names))
    return {name: random.uniform(*ends, POINTS) for name, ends in block.names.items()}


def value_of(formula: str, values: Mapping[str, Array]) -> Array:
    """The values of an author's formula at the points, (POINTS,).

    Args:
        values: of its names.

    Raises:
        CodedError: it cannot be read.
    """
    return evaluated(read_formula(formula, spellings(values)), values, POINTS)


def is_same(given: Array, right: Array, tolerance: float) -> bool:
    """Whether values are equal: numbers within a tolerance, formulas, with none, to `SAME`."""
    largest = tolerance or SAME * float(np.abs(right).max())
    return bool((np.abs(given - right) <= largest * (1 + 1e-9)).all())


def _closed(tries: Sequence[Try]) -> bool:
    return bool(tries) and (len(tries) == TRIES or tries[-1].verdict != "wrong")


def _rows(text: str, known: Mapping[str, str]) -> Iterator[tuple[str, Formula]]:
    for row in text.split("\n"):
        try:
            yield row, read_formula(row, known, ",")
        except CodedError:
            continue


def _judged(
    line: DerivedLine,
    typed: str,
    given: Array,
    true: Mapping[str, Array],
    own: Mapping[str, Array],
    missed: bool,
) -> Try:
    """The verdict on one answer.

    Args:
        true, own: values of names and earlier lines; `own` has what the student found.
        missed: whether any of that is wrong.
    """

    def gives(formula: str, values: Mapping[str, Array]) -> bool:
        right = value_of(formula, values)
        size = np.abs(right).max() / (np.abs(value_of(line.formula, true)).max() or 1.0)
        return is_same(given, right, line.tolerance * max(1.0, float(size)))

    if gives(line.formula, true):
        return Try(typed, "right")
    if gives(line.formula, own):
        return Try(typed, "carried" if missed else "right")
    mistakes = enumerate(line.wrong)
    known = next((i for i, w in mistakes if gives(w.formula, true) or gives(w.formula, own)), None)
    return Try(typed, "wrong", known)
