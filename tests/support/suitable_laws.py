"""The laws that suit the robots of the catalogue."""

from __future__ import annotations

from collections.abc import Iterable

from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.systems.catalogue import ROBOTS


def laws_for(robot: str = "five_bar") -> list[str]:
    """Names of the registry's laws that suit a robot, in the order of the registry."""
    return _suitable(robot, LAWS)


def suitable_pairs(*typed: str) -> list[tuple[str, str]]:
    """Every robot with every law that suits it, of the registry's and of typed ones."""
    laws = *LAWS, *typed
    return [(robot, law) for robot in ROBOTS for law in _suitable(robot, laws)]


def _suitable(robot: str, laws: Iterable[str]) -> list[str]:
    entry = ROBOTS[robot]
    system = entry.make(entry.parameters()).system
    return [law for law in laws if law_named(law).suits(system)]
