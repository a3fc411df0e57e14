"""Numbers that a text states about a run: `{{47 = max distance tracker during held}}`.

The text shows the number, and `onpath lessons check` plays the run and compares.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from difflib import get_close_matches
from typing import Any, get_args

import msgspec
import numpy as np

from onpath.lessons.action_schema import RobotName
from onpath.lessons.record import QUANTITIES
from onpath.lessons.task_schema import During, Stat

STATED = re.compile(r"\{\{\s*([−+-]?\d+(?:[.,]\d+)?)\s*(?:±\s*(\d+(?:[.,]\d+)?)\s*)?=([^{}]*)\}\}")
FORM = "{{47 = max distance tracker}}, and if needed: during held, from 3 to 5"
"""The expected form, for messages."""
KNOWN: dict[str, tuple[str, ...]] = {
    "stat": get_args(Stat),
    "quantity": tuple(QUANTITIES),
    "robot": get_args(RobotName),
    "during": get_args(During),
}


class Measure(msgspec.Struct, frozen=True):
    """A number that a run gives.

    Attributes:
        begin, end: part of the script, [s].
    """

    stat: Stat
    quantity: str
    robot: RobotName
    during: During = "always"
    begin: float = 0.0
    end: float = float("inf")

    @property
    def words(self) -> str:
        """What is measured, for messages."""
        return f"{self.stat} {self.quantity} {self.robot}"


class Stated(msgspec.Struct, frozen=True):
    """A number in a text, and the measure of a run that it states.

    Attributes:
        line: its line in the file.
        text: the number as shown.
        tolerance: in the unit of the quantity.
    """

    line: int
    text: str
    value: float
    tolerance: float
    measure: Measure

    def agrees(self, measured: float) -> bool:
        """Whether a measured value agrees with the number."""
        return bool(abs(measured - self.value) <= self.tolerance + 1e-9)


def take_stated(text: str, complain: Callable[[int, str], None]) -> tuple[str, list[Stated]]:
    """The text with plain numbers in place of the stated ones, and the stated ones."""
    found = list[Stated]()

    def plain(match: re.Match[str]) -> str:
        line = text.count("\n", 0, match.start()) + 1
        if text.endswith("{", 0, match.start()) or text.startswith("}", match.end()):
            complain(line, f"{{{match[0]}}}: three braces; a number stands between two")
        try:
            found.append(_read(line, *match.groups()))
        except ValueError as error:
            complain(line, f"{match[0]}: {error}")
        return match[1] + "\n" * match[0].count("\n")

    return STATED.sub(plain, text), found


def _read(line: int, number: str, tolerance: str | None, what: str) -> Stated:
    """A stated number.

    Raises:
        ValueError: it is not understood; the message suggests the nearest name.
    """
    measure = read_measure(what)
    value = _value(number)
    digits = len(re.split("[.,]", number)[1]) if re.search("[.,]", number) else 0
    allowed = 0.5 * 10.0**-digits if tolerance is None else _value(tolerance)
    for fault in zero_faults(value, allowed):
        raise ValueError(fault)
    return Stated(line, number, value, allowed, measure)


def read_measure(what: str) -> Measure:
    """The measure that some words describe, such as "max distance tracker during held".

    Raises:
        ValueError: it is not understood; the message suggests the nearest name.
    """
    words = what.split()
    if len(words) < 3:
        raise ValueError(f"write it as {FORM}")
    named = dict(zip(("stat", "quantity", "robot"), words[:3], strict=True))
    read: dict[str, Any] = {name: _one_of(word, name) for name, word in named.items()}
    rest = words[3:]
    if rest[:1] == ["during"] and len(rest) >= 2:
        read["during"], rest = _one_of(rest[1], "during"), rest[2:]
    if len(rest) == 4 and (rest[0], rest[2]) == ("from", "to"):
        read["begin"], read["end"], rest = float(rest[1]), float(rest[3]), []
        if not 0 <= read["begin"] < read["end"]:
            raise ValueError("it ends before it begins")
    if rest:
        raise ValueError(f"{' '.join(rest)!r} is not understood; write it as {FORM}")
    return Measure(**read)


def zero_faults(number: float, tolerance: float) -> Iterator[str]:
    """The fault of a tolerance so large that 0 would be accepted instead of a number."""
    if number and tolerance >= abs(number):
        yield f"tolerance = {tolerance:g}: 0 would be accepted as {number:g}"


def _value(number: str) -> float:
    return float(number.replace("−", "-").replace(",", "."))


def _one_of(word: str, what: str) -> str:
    if word in KNOWN[what]:
        return word
    near = get_close_matches(word, KNOWN[what], 1)
    hint = f"did you mean {near[0]}?" if near else f"one of {', '.join(KNOWN[what])}"
    raise ValueError(f"{what} {word!r}: {hint}")


def in_span(times: np.ndarray, measure: Measure) -> np.ndarray:
    """The instants to which a measure refers, as a mask, shape (n,)."""
    return (times >= measure.begin - 1e-9) & (times <= measure.end + 1e-9)
