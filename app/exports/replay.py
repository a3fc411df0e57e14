"""Recomputation of the last minute of a session, tick by tick."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from itertools import groupby

import numpy as np

from onpath.app.lab.segments import Segment
from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.trajectory import Trajectory, join, record
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.systems.robots import Robot


def replay(robot: Robot, history: list[Segment]) -> dict[str, Trajectory]:
    """Recompute the history, tick by tick, from its checkpoints and inputs.

    A robot that is stopped after a divergence has no data for that time.

    Raises:
        ValueError: all robots were stopped all the time.
    """
    found = {name: _replayed(robot, name, history) for name in history[0].drives}
    runs = {name: join(name, parts) for name, parts in found.items() if parts}
    if not runs:
        raise ValueError("both robots stood still: there is nothing to show")
    return runs


def _replayed(robot: Robot, name: str, history: list[Segment]) -> list[Trajectory]:
    parts: list[Trajectory] = []
    runs = groupby(history, key=lambda s: (id(s.curve), s.dt, s.drives[name].kind))
    for (_, dt, kind), group in runs:
        segments = [s for s in group if not s.drives[name].frozen]
        if not segments:
            continue
        loop = _fast_loop(robot, kind)
        logged = [(rows, s.curve, held) for s, rows, held in _rows(loop, name, segments)]
        times = np.concatenate([s.time + dt * np.arange(s.ticks, dtype=float) for s in segments])
        parts.append(record(robot, loop.kernel.log, name, merged(logged), dt, times).thinned())
    return parts


@lru_cache(maxsize=8)
def _fast_loop(robot: Robot, kind: Kind) -> Loop:
    """The compiled loop if available; it computes a minute in less than a second."""
    kernel = kernel_of(robot, kind)
    try:
        return translate_loop(kernel)
    except (NotImplementedError, RuntimeError):
        return InterpretedLoop(kernel)


def _rows(loop: Loop, name: str, segments: list[Segment]) -> Iterable[tuple[Segment, Array, bool]]:
    for segment in segments:
        drive = segment.drives[name]
        table = segment.curve.table()
        rows = loop.run(drive.state, drive.settings, table, segment.ticks)[1]
        held = loop.kernel.settings.unpack(drive.settings)["hold_active"][0] > 0
        yield segment, rows, bool(held)


def merged(logged: list) -> list:
    """Merge consecutive log rows of one curve and hold, so that distances take a single call."""
    result: list = []
    for (_, held), group in groupby(logged, key=lambda s: (id(s[1]), s[2])):
        members = list(group)
        result.append((np.concatenate([rows for rows, _, _ in members]), members[0][1], held))
    return result
