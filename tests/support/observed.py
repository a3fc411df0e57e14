"""Robots behind encoders and noise that nobody touches, many at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from onpath.app.notebook.path_files import path_from
from onpath.models.closed_loop.faults import fault_in
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.simulation import FREE, first_state, kind_of, settings_vector
from onpath.models.paths.curves import Curve
from onpath.models.paths.distance import path_distance
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters, time_step
from tests.support.pulls import begin_at, loop_of

SENSORS = {"encoder_counts": 2000.0, "sensor_noise": 1e-4}
RATES = (100, 250, 1000)
SECONDS = 6.0
MOST = 32  # robots at a time
EVERY = 4  # ticks between the distances that are looked at


@cache
def paths() -> dict[str, Curve]:
    """The presets, and a pear from a file."""
    angle = np.linspace(-np.pi, np.pi, 400, endpoint=False)
    radius = 0.05 * (1 + 0.15 * np.cos(2 * angle) + 0.1 * np.sin(3 * angle))
    with TemporaryDirectory() as folder:
        file = Path(folder) / "pear.csv"
        points = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        np.savetxt(file, points, delimiter=",")
        pear = path_from(file, closed=True)
    return {**{name: each.curve for name, each in presets().items()}, "pear": pear}


def farthest(name: str, law: str, cases: Sequence[tuple[Curve, dict[str, Any]]]) -> list[float]:
    """The largest distance from the path in each case, [m]; infinity if the robot stopped.

    Args:
        cases: path and changes of the robot's parameters; all on the path and at rest at first.
    """
    found = [np.inf] * len(cases)
    groups = dict[tuple[Any, Kind, float], list[tuple[int, Parameters, Curve]]]()
    for number, (curve, changes) in enumerate(cases):
        parameters = replace(ROBOTS[name].parameters(), **changes)
        kind, core = kind_of(law, parameters, curve), ROBOTS[name].make(parameters).core
        key = core, kind, time_step(parameters)
        groups.setdefault(key, []).append((number, parameters, curve))
    for (_, kind, dt), members in groups.items():
        for first in range(0, len(members), MOST):
            for number, distance in _run(name, law, kind, dt, members[first : first + MOST]):
                found[number] = distance
    return found


def _run(
    name: str, law: str, kind: Kind, dt: float, members: Sequence[tuple[int, Parameters, Curve]]
) -> list[tuple[int, float]]:
    robots = [ROBOTS[name].make(parameters) for _, parameters, _ in members]
    loop = loop_of(robots[0], kind)
    layouts, found = loop.layouts, list[tuple[int, float]]()
    own = list(zip(robots, members, strict=True))
    states = [first_state(r, layouts, curve, begin_at(r, curve, 0.0)) for r, (_, _, curve) in own]
    settings = [settings_vector(r, layouts, given, curve, FREE) for r, (_, given, curve) in own]
    tables = [curve.table() for _, _, curve in members]
    _, logs = loop.run_many(states, settings, tables, round(SECONDS / dt))
    for (robot, (number, parameters, curve)), rows in zip(own, logs, strict=True):
        if fault_in(robot, layouts.log, law, rows, parameters) is None:
            y = layouts.log.unpack(rows)["y"][::EVERY]
            found.append((number, float(path_distance(robot.frame, curve, y).max())))
    return found
