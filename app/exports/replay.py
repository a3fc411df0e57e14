"""Recomputation of the last minute of a simulation, tick by tick."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import lru_cache
from itertools import groupby

import numpy as np

from onpath.app.lab.segments import Segment
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.trajectory import Trajectory, join, record
from onpath.models.closed_loop.translated_loop import fastest_loop
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot


def replay(robot: Robot, history: list[Segment]) -> dict[str, list[Trajectory]]:
    """Recompute the history, tick by tick, from its checkpoints and inputs.

    A robot that is stopped after a divergence has no data for that time.

    Returns:
        The trajectories of each side, by side: one for each period under one control law.

    Raises:
        ValueError: all robots were stopped throughout.
    """
    found = {side: _replayed(robot, side, history) for side in history[0].drives}
    runs = {
        side: [join(law, list(same)) for law, same in groupby(parts, lambda p: p.law)]
        for side, parts in found.items()
        if parts
    }
    if not runs:
        raise ValueError("both robots stood still: there is nothing to show")
    return runs


def _replayed(robot: Robot, side: str, history: list[Segment]) -> list[Trajectory]:
    parts: list[Trajectory] = []
    variants = (s.drives[side].parameters for s in history)
    robots = {id(parameters): _made(robot, parameters) for parameters in variants}

    def key(s: Segment) -> tuple[int, float, Kind, int]:
        drive = s.drives[side]
        return id(s.curve), s.dt, drive.kind, id(robots[id(drive.parameters)])

    for (_, dt, kind, _), group in groupby(history, key=key):
        segments = [s for s in group if not s.drives[side].frozen]
        if not segments:
            continue
        loop = _fast_loop(robots[id(segments[0].drives[side].parameters)], kind)
        logged = [(rows, s.curve, held) for s, rows, held in _rows(loop, side, segments)]
        times = np.concatenate([s.time + dt * np.arange(s.ticks, dtype=float) for s in segments])
        log, law = loop.layouts.log, kind.law
        part = record(robot, log, law, merged(logged), dt, times).thinned()
        parts.append(replace(part, level_set=kind.level_set))
    return _of_one_unit(parts)


def _made(robot: Robot, parameters: Parameters | None) -> Robot:
    """The robot as it was with these parameters; see `RobotEntry.goes_on`."""
    return robot if parameters is None else ROBOTS[robot.name].make(parameters)


def _of_one_unit(parts: list[Trajectory]) -> list[Trajectory]:
    """The same parts, without ξ where its unit is not that of the last part."""

    def kept(part: Trajectory) -> Trajectory:
        if part.level_set == parts[-1].level_set:
            return part
        without = {name: np.full_like(part.fields[name], np.nan) for name in ("xi", "xi_rate")}
        return replace(part, fields=part.fields | without, level_set=parts[-1].level_set)

    return list(map(kept, parts))


@lru_cache(maxsize=8)
def _fast_loop(robot: Robot, kind: Kind) -> Loop:
    """The compiled loop, if available, which computes a minute in less than a second."""
    return fastest_loop(kernel_of(robot, kind))


def _rows(loop: Loop, side: str, segments: list[Segment]) -> Iterable[tuple[Segment, Array, bool]]:
    for segment in segments:
        drive = segment.drives[side]
        table = segment.curve.table()
        rows = loop.run(drive.state, drive.settings, table, segment.ticks)[1]
        held = loop.layouts.settings.unpack(drive.settings)["hold_active"][0] > 0
        yield segment, rows, bool(held)


def merged(logged: list) -> list:
    """Merge consecutive log rows with the same curve and hold, so that one call gives distances."""
    result: list = []
    for (_, held), group in groupby(logged, key=lambda s: (id(s[1]), s[2])):
        members = list(group)
        result.append((np.concatenate([rows for rows, _, _ in members]), members[0][1], held))
    return result
