"""The summary of a run, as text and for JSON."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from onpath.models.robot_files.guesses import Guess
from onpath.models.systems.guessed_numbers import with_mark

ROWS: tuple[tuple[str, str, Callable[[float], str]], ...] = (
    ("max_distance_m", "max distance", lambda v: f"{v * 1e3:.2f} mm"),
    ("max_distance_while_held_m", "max distance while held", lambda v: f"{v * 1e3:.2f} mm"),
    ("rms_distance_m", "rms distance", lambda v: f"{v * 1e3:.3f} mm"),
    ("final_speed_rad_s", "final speed", lambda v: f"{round(v, 3) + 0.0:.3f} rad/s"),
    ("max_torque_Nm", "max torque", lambda v: f"{v:.3f} N m"),
    ("stopped_at_s", "stopped at", lambda v: f"{v:.3f} s"),
)
STOPPED = "stopped"
"""Stands in tables for the numbers of a run that was stopped."""


def rows_of(values: Mapping[str, Any], guesses: Sequence[Guess] = ()) -> list[tuple[str, str]]:
    """Name and value of each quantity as text; quantities that a run lacks are omitted.

    Args:
        values: summary of one law, from `models.studies.experiments.summary`.
        guesses: about the robot; numbers that rest on them are marked.
    """
    return [
        (title, STOPPED if math.isinf(values[key]) else with_mark(show(values[key]), guesses, key))
        for key, title, show in ROWS
        if values[key] is not None
    ]


def summary_lines(values: Mapping[str, Any], guesses: Sequence[Guess] = ()) -> list[str]:
    """One line per quantity; see `rows_of`."""
    return [f"{title:26s} {value}" for title, value in rows_of(values, guesses)]


def finite(data: Any) -> Any:
    """Data for JSON: infinities, which it lacks, become None."""
    if isinstance(data, Mapping):
        return {name: finite(value) for name, value in data.items()}
    if isinstance(data, list):
        return [finite(value) for value in data]
    return None if isinstance(data, float) and math.isinf(data) else data
