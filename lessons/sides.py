"""Displayed names of the sides of a lab and their control laws, and their roles in the lessons."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache

from onpath.lessons.action_schema import RobotName
from onpath.lessons.words import Words
from onpath.models.control.laws.own import LABEL, OWN, is_text
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT

ROLES: dict[str, RobotName] = {LEFT: "tracker", RIGHT: "follower"}
"""Side -> name of its robot in the lessons."""
SIDE_OF: dict[RobotName, str] = {role: side for side, role in ROLES.items()}


def law_label(law: str, words: Words) -> str:
    """Displayed name of a control law, the same for all typed laws."""
    if law == OWN or is_text(law):
        return words.get("law.own.label", LABEL)
    return words.get(f"law.{law}.label", LAWS[law].label)


def law_text(law: str, words: Words) -> str:
    """A sentence about what a control law does; a typed law is its own description."""
    if is_text(law):
        return law
    return words.get(f"law.{law}.text", LAWS[law].text)


def law_titles(laws: Iterable[str], words: Words) -> dict[str, str]:
    """Displayed names of several control laws; typed ones are numbered if there are several."""
    names = list(dict.fromkeys(laws))
    typed = [law for law in names if is_text(law)]
    number = {law: f" {i + 1}" for i, law in enumerate(typed)} if len(typed) > 1 else {}
    return {law: law_label(law, words) + number.get(law, "") for law in names}


def side_titles(laws: Mapping[str, str | tuple[str, ...]], words: Words) -> dict[str, str]:
    """Displayed name of each side: that of its law, with the side if both names would be equal.

    Args:
        laws: the control law of each side, or several that it has had in turn.
    """
    return dict(_side_titles(tuple(laws.items()), words))


@lru_cache(maxsize=64)
def _side_titles(
    laws: tuple[tuple[str, str | tuple[str, ...]], ...], words: Words
) -> dict[str, str]:
    labels = {
        side: ", ".join(dict.fromkeys(law_label(law, words) for law in _all(names)))
        for side, names in laws
    }
    if len(set(labels.values())) == len(labels):
        return labels
    return {
        side: words("side.title", law=label, side=words(f"side.{side}"))
        for side, label in labels.items()
    }


def robot_names(laws: Mapping[str, str], words: Words) -> dict[RobotName, str]:
    """Displayed names of the robots of the lessons.

    A robot under the law of a new lab is named after its role, any other after its side.

    Args:
        laws: control law of each side; a side without one has that of a new lab.
    """
    every = {**DEFAULT_LAWS, **laws}
    titles = side_titles(every, words)
    return {
        role: words(f"robot.{role}") if every[side] == DEFAULT_LAWS[side] else titles[side]
        for side, role in ROLES.items()
    }


def displayed_names(laws: Mapping[str, str], words: Words) -> dict[str, str]:
    """Displayed name of each side's robot; see `robot_names`."""
    named = robot_names(laws, words)
    return {side: named[ROLES[side]] for side in laws}


def _all(laws: str | tuple[str, ...]) -> tuple[str, ...]:
    return (laws,) if isinstance(laws, str) else laws
