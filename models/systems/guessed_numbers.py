"""Which numbers rest on what is guessed about a robot, and how that is said."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

from onpath.assets.messages import DEFAULT
from onpath.models.errors import Message
from onpath.models.robot_files.guesses import Guess, GuessKind

Quantity = Literal["torque", "coupling", "limit", "end_point", "start"]
"""What numbers tell: of motors and weights, of how masses answer a force, of what motors can give,
of where the end-point is, of where a run starts."""

RESTS_ON: Mapping[Quantity, tuple[GuessKind, ...]] = {
    "torque": ("mass", "inertia"),
    "coupling": ("mass", "inertia"),
    "limit": ("effort",),
    "end_point": ("tip",),
    "start": ("pose",),
}
"""Kinds of guesses that decide on each quantity."""

LONGEST_LINE = 500  # of what is told to be typed, [characters]
NAMES: Mapping[GuessKind, Message] = {
    "mass": Message("guess.mass"),
    "inertia": Message("guess.inertia"),
    "effort": Message("guess.effort"),
    "tip": Message("guess.tip"),
    "pose": Message("guess.pose"),
}
"""What is guessed, as a mark says it."""
TOLD: Mapping[str, tuple[Quantity, ...]] = {
    **dict.fromkeys(("tau", "max_torque", "rms_torque"), ("torque",)),
    **dict.fromkeys(("y", "theta", "xi", "distance", "speed", "force"), ("end_point",)),
    **dict.fromkeys(
        (
            *("max_distance", "max_distance_while_held", "mean_distance", "rms_distance"),
            *("final_speed", "overspeed", "delay", "peak_force", "impulse", "energy_given"),
        ),
        ("end_point", "coupling"),
    ),
}
"""What numbers tell, by their names in files, tables and plots, without units and counts."""
SETTINGS: Mapping[str, tuple[Quantity, ...]] = {
    "torque_limit": ("limit",),
    "error_inertia": ("coupling",),
    **dict.fromkeys(("error_gravity", "payload"), ("torque",)),
    **dict.fromkeys(("start_along", "start_across"), ("start",)),
}
"""What settings tell, by their names. One may be called like a number, as `delay` is."""
_UNIT_OR_COUNT = re.compile(r"(_(Nm|Ns|[mNJs]|m2|rad|rate|ref))+$|\d+")


def quantities_of(name: str) -> tuple[Quantity, ...]:
    """What a number tells, of what may be guessed.

    >>> quantities_of("tau2_Nm"), quantities_of("xi1_rate_m_s"), quantities_of("t_s")
    (('torque',), ('end_point',), ())
    """
    return TOLD.get(name) or TOLD.get(_UNIT_OR_COUNT.sub("", name), ())


def guessed_kinds(
    guesses: Iterable[Guess], quantities: Iterable[Quantity]
) -> tuple[GuessKind, ...]:
    """Kinds of the guesses on which a number rests, each once, in the order of the guesses.

    Args:
        quantities: what the number tells; a number may tell several of them.
    """
    decisive = {kind for quantity in quantities for kind in RESTS_ON[quantity]}
    return tuple(dict.fromkeys(guess.kind for guess in guesses if guess.kind in decisive))


def guess_mark(guesses: Iterable[Guess], quantities: Iterable[Quantity]) -> Message | None:
    """The mark of a number, such as "guessed: mass"; None if it rests on no guess."""
    kinds = guessed_kinds(guesses, quantities)
    if not kinds:
        return None
    listed, *others = (NAMES[kind] for kind in kinds)
    for other in others:
        is_last = other is others[-1]
        listed = Message(
            "guess.last" if is_last else "guess.next", {"listed": listed, "other": other}
        )
    return Message("guess.mark", {"kinds": listed})


def with_mark(text: str, guesses: Iterable[Guess], name: str = "", language: str = DEFAULT) -> str:
    """What is said of a number, with its mark in parentheses, if it has one.

    Args:
        name: of the number; see `quantities_of`; "": the text.
    """
    return _marked(text, guesses, quantities_of(name or text), language)


def setting_with_mark(
    label: str, guesses: Iterable[Guess], name: str, language: str = DEFAULT
) -> str:
    """The label of a setting, with its mark in parentheses, if it has one."""
    return _marked(label, guesses, SETTINGS.get(name, ()), language)


def _marked(
    text: str, guesses: Iterable[Guess], quantities: Iterable[Quantity], language: str
) -> str:
    mark = guess_mark(guesses, quantities)
    return text if mark is None else f"{text} ({mark.text(language)})"


def told_guess(guess: Guess) -> Message:
    """A guess with what to type to settle it, unless a name in it cannot be typed."""
    if not guess.line or not guess.line.isprintable() or len(guess.line) > LONGEST_LINE:
        return guess.message
    return Message("guess.told", {"what": guess.message, "line": guess.line})


def told_guesses(guesses: Sequence[Guess], language: str = DEFAULT) -> list[str]:
    """All guesses, each on a line of its own."""
    return [told_guess(guess).text(language) for guess in guesses]


def guess_sentences(guesses: Sequence[Guess], language: str = DEFAULT) -> list[str]:
    """All guesses as sentences of a text."""
    return [f"{text[0].upper()}{text[1:]}." for text in told_guesses(guesses, language)]
