"""Modules that are slow to import are not needed for the first picture."""

from __future__ import annotations

import logging
import subprocess
import sys
from importlib import import_module

import pytest

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.simulation import Simulation
from onpath.app.server import warm_up
from onpath.lessons.course import NO_LESSONS
from onpath.models.closed_loop.loops import CompiledLoop
from onpath.models.systems.catalogue import ROBOTS

FIRST_PICTURE = """
import sys
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server import lab_server
from onpath.app.scene.stage_catalogue import stage_of

lab = Lab(LoopCache())
take_page_snapshot(lab, 1.0)
stage_of(lab.simulation.robot).parts()
print(*sorted({"scipy", "trimesh", "matplotlib"} & sys.modules.keys()))
"""


@pytest.mark.thorough
def test_the_first_picture_needs_no_slow_module() -> None:
    run = subprocess.run([sys.executable, "-c", FIRST_PICTURE], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert run.stdout.split() == []


SKETCH = """
import sys
import numpy as np
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.warm_up import warm_up
from onpath.app.viser_adapter.secure_server import make_server
from onpath.lessons.course import NO_LESSONS

server = make_server(port=0)
warm_up(LoopCache(), NO_LESSONS, rest=0.0).join()
known = set(sys.modules)
server.scene.add_image("/sheet", np.zeros((9, 16, 3), np.uint8), 1.0, 1.0, format="png")
print("new:", *sorted(set(sys.modules) - known))
"""


@pytest.mark.thorough
def test_a_board_to_sketch_on_imports_nothing_after_the_start() -> None:
    """All labs would wait for the imports."""
    run = subprocess.run([sys.executable, "-c", SKETCH], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert "new:" in run.stdout.splitlines()


def test_what_fails_is_tried_again(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []
    failures = [OSError(24, "Too many open files")] * 2

    def loaded(name: str) -> object:
        if failures:
            raise failures.pop()
        done.append(name)
        return import_module(name)

    monkeypatch.setattr(warm_up, "import_module", loaded)
    warm_up.warm_up(LoopCache(), NO_LESSONS, rest=0.0).join()
    assert {*warm_up.LATER} <= {*done}


BUILT_BEFORE = """
from threading import Thread
import casadi as ca
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.warm_up import build_robot
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.catalogue import ROBOTS

made = []

class Function(ca.Function):
    def __init__(self, name, *rest):
        made.append(name)
        super().__init__(name, *rest)

def use_robots():
    for name, entry in ROBOTS.items():
        made.clear()
        lab = Lab(cache, entry)
        simulation, state = lab.simulation, next(iter(lab.simulation.runs.values())).state
        n = simulation.robot.system.n
        simulation.robot.margin(simulation.editor.design.points)
        simulation.robot.fault(state[None, :n], state[None, n : 2 * n], simulation.parameters)
        take_page_snapshot(lab, 1.0)
        if made:
            print(name, made)

cache = LoopCache()
for entry in ROBOTS.values():
    build_robot(cache, entry)
ca.Function = Function
thread = Thread(target=use_robots)
thread.start()
thread.join()
"""


@pytest.mark.thorough
def test_another_thread_builds_no_function_of_a_robot_again() -> None:
    run = subprocess.run([sys.executable, "-c", BUILT_BEFORE], capture_output=True, text=True)
    assert (run.stdout, run.stderr) == ("", "")


@pytest.mark.thorough
def test_the_loops_of_a_robots_first_lab_are_compiled_with_progress(
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level(logging.INFO)
    cache, entry = LoopCache(), ROBOTS["planar_arm"]
    warm_up.compile_loops(cache, entry)
    told = [record.getMessage() for record in caplog.records]
    assert told == [f"compiling {entry.label}: {i} of 4" for i in range(1, 5)]
    for run in Simulation(cache, entry).runs.values():
        assert isinstance(run.loop(), CompiledLoop)
