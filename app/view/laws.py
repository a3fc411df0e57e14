"""Descriptions of the control laws, and of the names that a typed law may use."""

from __future__ import annotations

from collections.abc import Sequence

from onpath.app.channel.sheet_messages import LawDescription, LawSheet, NameMeaning
from onpath.lessons.sides import law_label, law_text
from onpath.lessons.words import Words
from onpath.models.closed_loop.controller_tick import INTEGRAL_REACH
from onpath.models.control.laws.expressions import FUNCTIONS, LARGEST_EXPONENT
from onpath.models.control.laws.own import MEANINGS, SPACE_MEANINGS, NamedValue
from onpath.models.control.laws.registry import LAWS
from onpath.models.systems.robots import Robot


def law_sheet(robot: Robot, words: Words) -> LawSheet:
    """The laws that suit a robot, and how to type one for it."""
    spatial = robot.system.p == 3
    functions = ", ".join(FUNCTIONS)
    own = [
        words("laws.own_text"),
        *([words("laws.own_space")] if spatial else []),
        words("laws.own_language", functions=functions, most=LARGEST_EXPONENT),
    ]
    return LawSheet(
        laws=[description(name, words) for name in suitable(robot)],
        bounds=words("laws.bounds", reach=f"{1e3 * INTEGRAL_REACH:.0f}"),
        own=own,
        names=_meanings((*MEANINGS, *(SPACE_MEANINGS if spatial else ())), words),
    )


def suitable(robot: Robot) -> list[str]:
    """The names of the laws that suit a robot."""
    return [name for name, law in LAWS.items() if law.suits(robot.system)]


def description(name: str, words: Words) -> LawDescription:
    """What a law does, its strength and weakness, what its authors would say, and its source."""
    law = LAWS[name]
    return LawDescription(
        name=name,
        label=law_label(name, words),
        does=law_text(name, words),
        good=words.get(f"law.{name}.good", law.good),
        limits=words.get(f"law.{name}.limits", law.limits),
        objection=words.get(f"law.{name}.objection", law.objection),
        source=words("laws.source", source=law.source),
    )


def _meanings(values: Sequence[NamedValue], words: Words) -> list[NameMeaning]:
    return [
        NameMeaning(
            names=", ".join(each.names),
            means=words.get(f"law.own.{each.names[0]}", each.meaning),
            unit=each.unit,
        )
        for each in values
    ]
