"""The names of controls, drawings and events, limits of numbers, and the fault of unknown names."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import get_args

from onpath.lessons.task_schema import EventName
from onpath.models.systems.parameter_specs import unknown_name

CONTROLS = (
    *("hold", "path", "editor", "gains", "plots", "past", "robot", "laws", "flexible"),
    *("identify", "show", "wall", "start", "sign"),
)
DRAWINGS = ("labels", "tube", "grid", "rank", "errors", "mass")
"""What a scene can draw besides the robots."""
EVENTS: tuple[str, ...] = get_args(EventName)
MOST_PLOTS = 2
MOST_MARKS = 12
REACH = 500.0
"""Largest coordinate of a mark, [mm]."""
HIGHEST = 1e6
"""Largest limit of a sketch's axis."""
LONGEST = 60.0
"""Longest script or sketch, [s]: the lab keeps one minute of history."""


def one_of(name: str, known: Iterable[object], what: str) -> Iterator[str]:
    """The fault of a name that is not among the known ones; it suggests the nearest."""
    names = [str(each) for each in known]
    if name not in names:
        yield str(unknown_name(name, names, what=what))
