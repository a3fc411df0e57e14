"""Numbers about the run of a lesson's step: one part for each instant at which its script acts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import msgspec
import numpy as np

from onpath.lessons.action_schema import Action, Laws, RobotName, RunStart, Script
from onpath.lessons.record import ROBOTS
from onpath.models.arrays import Array

NEAR = 1.0
"""Distance to the path within which a robot counts as settled, [mm]."""


@dataclass(frozen=True, slots=True)
class Numbers:
    """Statistics of a quantity of a robot in one part of a run, in the unit of the quantity.

    Attributes:
        max_at: time of the largest value, [s] since the script began.
        final: the last value.
    """

    max: float
    max_at: float
    min: float
    mean: float
    rms: float
    final: float


@dataclass(frozen=True, slots=True)
class ScriptPart:
    """What happened between two actions of a script.

    Attributes:
        begin, end: [s] since the script began.
        actions: the actions at `begin`.
        numbers: robot -> quantity -> statistics.
        settled: robot -> time after `begin` from which it stays within NEAR of the path, [s]; None
            if it is not there at the end.
    """

    begin: float
    end: float
    actions: tuple[Action, ...]
    numbers: dict[RobotName, dict[str, Numbers]]
    settled: dict[RobotName, float | None]


def parts_of(
    script: Script, times: Array, values: dict[RobotName, dict[str, Array]]
) -> list[ScriptPart]:
    """The parts of a script's run, followed by the whole run if there are several.

    Args:
        times: shape (n,), [s] since the script began, increasing.
        values: robot -> quantity -> shape (n,); NaN where it is undefined.
    """
    limits = sorted({0.0, *(action.at for action in script.do)} - {script.until})
    ends = [*limits[1:], script.until]
    spans = list(zip(limits, ends, strict=True))
    parts = [
        _part(begin, end, [a for a in script.do if a.at == begin], times, values)
        for begin, end in spans
    ]
    whole = [_part(0.0, script.until, (), times, values)] if len(spans) > 1 else []
    return [*parts, *whole]


def action_text(action: Action) -> str:
    """An action as in a script, such as `set K1 = 900`."""
    what, only = action.what, f" ({action.only})" if action.only else ""
    given = getattr(action, what)
    if what in ("set", "laws"):
        values = (action.set or {}) if what == "set" else (action.laws or Laws()).named
        given = ", ".join(f"{name} = {value}" for name, value in values.items())
    if isinstance(given, RunStart):
        values = msgspec.to_builtins(given).items()
        given = ", ".join(f"{name} = {value:g}" for name, value in values if value) or "on the path"
    if isinstance(given, bool):
        return (what if given else f"{what} off") + only
    return f"{what} {given}{only}"


def _part(
    begin: float,
    end: float,
    actions: Iterable[Action],
    times: Array,
    values: dict[RobotName, dict[str, Array]],
) -> ScriptPart:
    chosen = (times >= begin - 1e-9) & (times <= end + 1e-9)
    numbers: dict[RobotName, dict[str, Numbers]] = {robot: {} for robot in ROBOTS}
    settled: dict[RobotName, float | None] = dict.fromkeys(ROBOTS)
    for robot in ROBOTS:
        for quantity, column in values[robot].items():
            defined = chosen & np.isfinite(column)
            if defined.any():
                numbers[robot][quantity] = _numbers(times[defined], column[defined])
        if "distance" in numbers[robot]:
            settled[robot] = _settled(times[chosen] - begin, values[robot]["distance"][chosen])
    return ScriptPart(
        begin=begin, end=end, actions=tuple(actions), numbers=numbers, settled=settled
    )


def _numbers(times: Array, column: Array) -> Numbers:
    at = int(column.argmax())
    return Numbers(
        max=float(column[at]),
        max_at=float(times[at]),
        min=float(column.min()),
        mean=float(column.mean()),
        rms=float(np.sqrt(np.mean(column**2))),
        final=float(column[-1]),
    )


def _settled(times: Array, distances: Array) -> float | None:
    """The time from which all distances are small; None if the last one is not."""
    far: Sequence[int] = np.flatnonzero(~(distances <= NEAR)).tolist()
    if not far:
        return 0.0
    return float(times[far[-1] + 1]) if far[-1] + 1 < len(times) else None
