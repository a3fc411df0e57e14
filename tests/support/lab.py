"""Helpers for the tests of the lab: a lab that is stepped manually."""

from __future__ import annotations

from concurrent.futures import CancelledError
from contextlib import suppress
from functools import lru_cache

import numpy as np

from onpath.app.exports.replay import replay
from onpath.app.lab.commands import Command
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.snapshot import Snapshot
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.models.closed_loop.trajectory import Trajectory, join
from onpath.models.control.settable import specs, value_of
from onpath.models.control.sides import LEFT, RIGHT, SIDES
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.systems.parameter_specs import checked

FRAME = 1 / 60
FOLLOWER, TRACKER = RIGHT, LEFT


@lru_cache(maxsize=1)
def loop_cache() -> LoopCache:
    """The loops, built once for all tests in this process."""
    return LoopCache(at_once=True)


def new_lab(seconds: float = 0.0) -> Lab:
    """Make a lab that has run for some seconds."""
    lab = Lab(loop_cache())
    run(lab, seconds)
    return lab


def finish(loop_cache: LoopCache) -> None:
    """Wait until all loops that were asked for are compiled, or given up."""
    pool = loop_cache._pool
    if pool is not None:
        with suppress(CancelledError):
            pool.submit(lambda: None).result(60.0)  # it does one thing after the other


def run(lab: Lab, seconds: float) -> None:
    """Run frame by frame, as the simulation thread does."""
    for _ in range(round(seconds / FRAME)):
        lab.drain()
        lab.advance(lab.simulation.settings.rate * FRAME)


def do(lab: Lab, *commands: Command) -> None:
    """Apply commands immediately."""
    for command in commands:
        lab.post(command)
    lab.drain()


def replayed(simulation: Simulation) -> dict[str, Trajectory]:
    """What both robots did in the last minute, millisecond by millisecond, by side."""
    runs = replay(simulation.robot, simulation.history.all())
    return {side: join("", parts) for side, parts in runs.items()}


def states(simulation: Simulation) -> dict[str, np.ndarray]:
    """Copies of both robots' states."""
    return {name: run.state.copy() for name, run in simulation.runs.items()}


def y(simulation: Simulation, name: str) -> np.ndarray:
    """Position of an end-point, (p,), [m]."""
    return simulation.robot.endpoint(simulation.runs[name].fields()["q"])


def assert_sound(lab: Lab) -> None:
    """Assert that all numbers are finite, settings are in range and the path is valid."""
    for run_ in lab.simulation.runs.values():
        assert np.isfinite(run_.state).all()
        assert np.isfinite(run_.row).all()
        assert run_.diverged is None or run_.diverged.reason
    for name, spec in specs(lab.simulation.parameters).items():
        value = value_of(lab.simulation.parameters, name)
        assert checked(spec, name, value) == value
    editor = lab.simulation.editor
    assert curve_faults(lab.simulation.robot.margin, editor.design.curve) == []
    assert np.isfinite(editor.table).all() and np.isfinite(editor.points()).all()
    assert editor.selected is None or 0 <= editor.selected < len(editor.design.points)
    assert 0.125 <= lab.simulation.settings.rate <= 4
    assert lab.simulation.forces.held <= set(SIDES) and set(lab.simulation.forces.hands) <= set(
        SIDES
    )
    assert lab.simulation.viewing is None or not lab.simulation.running
    assert_drawable(take_snapshot(lab, 1.0))


def assert_drawable(snapshot: Snapshot) -> None:
    for view in snapshot.robots.values():
        for part in (view.bars, view.joints, view.tip, view.marker, view.force, view.trace):
            assert np.isfinite(part).all()
        assert np.isfinite([view.distance, view.max_distance, view.speed, *view.torque]).all()
    assert np.isfinite(snapshot.path.points).all() and np.isfinite(snapshot.time)
