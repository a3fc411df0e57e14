"""The laws of the registry that suit a robot of the catalogue."""

from __future__ import annotations

from onpath.models.control.laws.registry import LAWS
from onpath.models.systems.catalogue import ROBOTS


def laws_for(robot: str = "five_bar") -> list[str]:
    """Their names, in the order of the registry."""
    entry = ROBOTS[robot]
    system = entry.make(entry.parameters()).system
    return [name for name, law in LAWS.items() if law.suits(system)]
