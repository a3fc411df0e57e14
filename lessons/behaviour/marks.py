"""What a text says of the lab: `{{is refused = refuses fault.bends after sharp-bend}}`.

The text shows the words, and `onpath lessons check` plays what stands after the equals sign.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from typing import Literal, TypeGuard, get_args

import msgspec

from onpath.lessons.action_schema import RobotName
from onpath.lessons.measures.stated import Measure, read_measure
from onpath.lessons.problems import near
from onpath.lessons.record import PLOTS
from onpath.lessons.vocabulary.names import CONTROLS, DRAWINGS
from onpath.models.closed_loop.lab_settings import step_specs
from onpath.models.systems.catalogue import ROBOTS as MACHINES

MARK = re.compile(r"\{\{\s*([^{}=]+?)\s*=([^{}]*)\}\}")
Verb = Literal["refuses", "says", "stops", "runs", "follows", "plot", "drawing", "control", "label"]
VERBS: tuple[Verb, ...] = get_args(Verb)
OF_SCENE = ("plot", "drawing", "control")
FORM = (
    f"a mark is {{{{words = …}}}} with one of {', '.join(VERBS)}, or a measure such as"
    " max distance follower < 5"
)
"""The expected form, for messages."""


class Behaviour(msgspec.Struct, frozen=True):
    """Words of a text, and what the lab does if they are true.

    Attributes:
        line: its line in the file.
        text: the words as shown.
        verb: what is compared; empty for a measure.
        name: what is refused, said, stopped, run, followed, shown or called.
        reason: code of the message that says why a robot is stopped; may be empty.
        absent: whether it must not be so.
        measure, limit, above: a measure, and whether it lies above the limit or below it.
        after: name of a play in reference.toml; empty for the step's own run.
    """

    line: int
    text: str
    verb: Verb | Literal[""] = ""
    name: str = ""
    reason: str = ""
    absent: bool = False
    measure: Measure | None = None
    limit: float = 0.0
    above: bool = False
    after: str = ""


def take_behaviours(text: str, complain: Callable[[int, str], None]) -> tuple[str, list[Behaviour]]:
    """The text with plain words in place of the marks, and what they say."""
    found = list[Behaviour]()

    def plain(match: re.Match[str]) -> str:
        line = text.count("\n", 0, match.start()) + 1
        if text.endswith("{", 0, match.start()) or text.startswith("}", match.end()):
            complain(line, f"{{{match[0]}}}: three braces; a mark stands between two")
        try:
            found.append(read_behaviour(line, match[1], match[2]))
        except ValueError as error:
            complain(line, f"{match[0]}: {error}")
        return match[1] + "\n" * (match[0].count("\n") - match[1].count("\n"))

    return MARK.sub(plain, text), found


def read_behaviour(line: int, text: str, play: str) -> Behaviour:
    """What some words say.

    Raises:
        ValueError: it is not understood; the message suggests the nearest name.
    """
    said, after = _split_after(play.split())
    absent = said[:1] == ["no"]
    first, *rest = said[absent:] or [""]
    if _is_verb(first):
        name, reason = _object(first, rest)
        for fault in _faults(first, name, after, absent):
            raise ValueError(fault)
        return Behaviour(
            line=line,
            text=text,
            verb=first,
            name=name,
            reason=reason,
            absent=absent,
            after=after,
        )
    if len(said) < 5 or said[-2] not in ("<", ">"):
        raise ValueError(f"{' '.join(said)!r} is not understood: {FORM}{near(first, VERBS)}")
    measure, limit = read_measure(" ".join(said[:-2])), float(said[-1])
    return Behaviour(
        line=line, text=text, measure=measure, limit=limit, above=said[-2] == ">", after=after
    )


def _is_verb(word: str) -> TypeGuard[Verb]:
    return word in VERBS


def _split_after(words: list[str]) -> tuple[list[str], str]:
    """What is said, and the name of the play after which it is so."""
    if words[-2:-1] == ["after"]:
        return words[:-2], words[-1]
    return words, ""


def _object(verb: Verb, rest: list[str]) -> tuple[str, str]:
    """What a verb is about, and a reason."""
    if verb in ("stops", "runs"):
        if not 1 <= len(rest) <= 2 or rest[0] not in get_args(RobotName):
            raise ValueError(f"{verb} is followed by {' or '.join(get_args(RobotName))}")
        return rest[0], "".join(rest[1:])
    if verb != "follows" and len(rest) != 1:
        raise ValueError(f"{verb} is followed by one name")
    return " ".join(rest), ""


def _faults(verb: Verb, name: str, after: str, absent: bool) -> Iterator[str]:
    known: dict[str, Iterable[str]] = {
        "plot": PLOTS,
        "drawing": DRAWINGS,
        "control": [*CONTROLS, *_parameters()],
    }
    if verb in known and name not in known[verb]:
        yield f"no {verb} {name!r}{near(name, known[verb])}"
    if after and verb in (*OF_SCENE, "label"):
        yield f"{verb} is so from the beginning, not after a play"
    if absent and verb not in (*OF_SCENE, "says"):
        yield f"no {verb} is not understood: {FORM}"


def _parameters() -> set[str]:
    return {name for entry in MACHINES.values() for name in step_specs(entry.parameters)}
