"""Tables of the lab's speed: closed loops, frames under load, start-up, mouse to picture."""

from __future__ import annotations

import asyncio
import os
import platform
import signal
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stdout
from dataclasses import replace
from functools import partial
from io import StringIO
from pathlib import Path

import numpy as np

from onpath.app.common.chromium import find_browser
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.models.closed_loop.loops import InterpretedLoop, Loop, ManyLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import (
    most_lanes,
    translate_batch,
    translate_loop,
)
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import RobotEntry
from tests.bench.crowd import HEAD, ClientLoad, folders, measured
from tests.bench.drawing_cost import drawing_cost
from tests.bench.mouse_latency import mouse_latency
from tests.bench.reference import LANES, reference_loop
from tests.bench.server_process import serving
from tests.bench.simulated_browser import first_poses
from tests.bench.soak import HEAD as SOAK_HEAD
from tests.bench.soak import SoakRow, soak, verdict

TICKS = 160  # per timed call
KEEP_BYTECODE = {"PYTHONDONTWRITEBYTECODE": ""}  # as for a user, whatever this process was told


def bench(quick: bool = False) -> None:
    """Print all tables; `quick` leaves out what needs clients or a browser."""
    _begin()
    with tempfile.TemporaryDirectory() as folder:
        _loops(20 if quick else 60)
        _yardstick(Path(folder), 20 if quick else 60)
        _modes(10 if quick else 30)
    _making(3 if quick else 9)
    if not quick:
        _crowds([ClientLoad(1), ClientLoad(20)])
        _start_up()
        _pictures()
        _mouse()


def _loops(repeats: int) -> None:
    """Median microseconds per simulated millisecond, and the ratio to path following.

    The compiled loops of all laws are measured in turn, while nothing acts from outside and with
    forces; then the interpreted loop of path following.
    """
    print(
        f"{'robot':12s} {'law':20s} {'µs/ms':>8s} {'ratio':>6s} {'with forces':>12s} {'ratio':>6s}"
    )
    for entry in ROBOTS.values():
        parameters = entry.parameters()
        system = entry.make(parameters).system
        laws = [name for name, law in LAWS.items() if law.suits(system)]
        free, pushed = (_compared(entry, parameters, laws, lean, repeats) for lean in (True, False))
        for name in laws:
            print(f"{entry.name:12s} {name:20s} {free[name]} {pushed[name]:>19s}")
        call = _prepared(entry, parameters, "path_following", True)["interpreted"]
        took = _per_tick({"interpreted": call}, repeats)["interpreted"]
        print(f"{entry.name:12s} {'  interpreted':20s} {took:8.2f}")
    print()


def _compared(
    entry: RobotEntry, parameters: Parameters, laws: list[str], lean: bool, repeats: int
) -> dict[str, str]:
    """Time of each law's compiled loop, and its ratio to path following."""
    calls = {name: _prepared(entry, parameters, name, lean)["compiled"] for name in laws}
    times = _per_tick(calls, repeats)
    return {n: f"{t:8.2f} {t / times['path_following']:6.2f}" for n, t in times.items()}


def _yardstick(folder: Path, repeats: int) -> None:
    """The compiled loop of the follower against C written by hand, for the same robots."""
    entry, robots = FIVE_BAR, max(LANES)
    parameters, curve = entry.parameters(), circle(0.05)
    robot = entry.make(parameters)
    kernel = kernel_of(robot, kind_of("path_following", parameters, curve))
    start = robot.rest(robot.frame.lift(curve.at(np.array(0.0))))
    state = first_state(robot, kernel, curve, start)
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    call = [state] * robots, [settings] * robots, [curve.table()] * robots, TICKS
    known = {lanes: reference_loop(kernel, folder, lanes) for lanes in LANES}
    loops: dict[str, ManyLoop] = {"compiled": translate_loop(kernel)}
    own = [lanes for lanes in LANES if 1 < lanes <= most_lanes()]
    loops |= {f"a batch, {lanes} at a time": translate_batch(kernel, lanes) for lanes in own}
    loops |= {f"C, {n} at a time": loop for n, loop in known.items() if loop is not None}
    calls = {name: partial(loop.run_many, *call) for name, loop in loops.items()}
    times = {name: each / robots for name, each in _per_tick(calls, repeats).items()}
    print(f"{robots} robots of kind {entry.name}   µs/ms each   compiled loop takes")
    for name, value in times.items():
        print(f"{name:24s} {value:14.3f} {times['compiled'] / value:14.1f} times")
    print()


def _prepared(
    entry: RobotEntry, parameters: Parameters, law: str, lean: bool
) -> dict[str, Callable[[], object]]:
    """The calls to time, of `TICKS` ticks."""
    robot, curve = entry.make(parameters), circle(0.05)
    kernel = kernel_of(robot, kind_of(law, parameters, curve, FREE if lean else None))
    start = robot.rest(robot.frame.lift(curve.at(np.array(0.0))))
    loops: dict[str, Loop] = {
        "interpreted": InterpretedLoop(kernel),
        "compiled": translate_loop(kernel),
    }
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    state = first_state(robot, kernel, curve, start)
    call = state, settings, curve.table(), TICKS
    return {name: partial(loop.run, *call) for name, loop in loops.items()}


def _per_tick(calls: Mapping[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """Median microseconds."""
    return {name: 1e6 / TICKS * took for name, took in _interleaved(calls, repeats).items()}


def _interleaved(calls: Mapping[str, Callable[[], object]], repeats: int) -> dict[str, float]:
    """Median processor seconds of each call; in turn, so that drift affects all equally."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(repeats):
        for name, call in calls.items():
            begin = time.thread_time()
            call()
            times[name].append(time.thread_time() - begin)
    return {name: float(np.median(values)) for name, values in times.items()}


def _modes(repeats: int) -> None:
    """Cost of the flexible follower against the number of modes."""
    for modes in range(1, 7):
        parameters = replace(FlexibleParameters(), modes=modes)
        calls = _prepared(FLEXIBLE, parameters, "path_following", True)
        times = _per_tick(calls, repeats)
        shown = ", ".join(f"{tier} {value:.2f} µs" for tier, value in times.items())
        print(f"flexible, {modes} modes: {shown}")
    print()


def _making(repeats: int) -> None:
    """Time to compile a follower's loop to machine code."""
    for entry in ROBOTS.values():
        parameters = entry.parameters()
        kind = kind_of("path_following", parameters, circle(0.05))
        kernel = kernel_of(entry.make(parameters), kind)
        took = _interleaved({"compiled": partial(translate_loop, kernel)}, repeats)["compiled"]
        print(f"{entry.name}, a loop is compiled in {1e3 * took:.0f} ms")
    print()


@contextmanager
def _quiet_lab() -> Iterator[LabServer]:
    """Start a server in this process, without viser's banner."""
    with redirect_stdout(StringIO()):
        lab = LabServer("127.0.0.1", 0, LoopCache())
    try:
        yield lab
    finally:
        with redirect_stdout(StringIO()):
            lab.stop()


def bench_crowds(crowds: list[ClientLoad]) -> None:
    """Print the table of loads, with the requested number of rows for each."""
    _begin()
    _crowds(crowds)


def bench_soak(honest: int, minutes: int) -> int:
    """Print the table of a soak and its verdict; return 1 if a bound was broken, else 0."""
    _begin()
    print(SOAK_HEAD, flush=True)
    rows: list[SoakRow] = []
    with tempfile.TemporaryDirectory() as folder:
        for row in soak(honest, minutes, folders(Path(folder), "data")):
            rows.append(row)
            print(row, flush=True)
    broken = verdict(rows, honest)
    print("", *broken or ["all bounds are kept"], sep="\n")
    return 1 if broken else 0


def _begin() -> None:
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that the servers end, too
    load = os.getloadavg()[0]
    print(f"{platform.platform()}, {os.cpu_count()} cores, load {load:.1f}\n", flush=True)


def _crowds(crowds: list[ClientLoad]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        print(HEAD, flush=True)
        for number, crowd in enumerate(crowds):
            for row in measured(crowd, folders(Path(folder), f"data{number}")):
                print(row, flush=True)
    print()


def _start_up() -> None:
    """Time from the start of the process to the first picture."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("the first time", "again"):
            with serving(folders(Path(folder), "data") | KEEP_BYTECODE) as server:
                asyncio.run(asyncio.wait_for(first_poses(server.port), 30.0))
                took = time.monotonic() - server.begun
                print(f"start-up, {name}: {took:.2f} s to the first picture")


def _pictures() -> None:
    """What drawing costs in Chromium without a GPU."""
    browser = find_browser()
    if browser is None:
        print("pictures in software: not measured, they need Chromium and Playwright")
        return
    with _quiet_lab() as lab:
        cost = drawing_cost(lab, browser)
    print(
        f"drawn in software, 1280 x 800: {cost.pictures:.1f} pictures/s, each {cost.draw_ms:.0f} ms"
        f" of the drawing process and {cost.main_ms:.0f} ms of the page's main thread"
    )


def _mouse() -> None:
    """Time from a mouse move in Chromium to the changed pose that comes back."""
    browser = find_browser()
    if browser is None:
        print("mouse to picture: not measured, it needs Chromium and Playwright")
        return
    for draws, how in ((False, "drawing no triangles, as if there were a GPU"), (True, "drawing")):
        with _quiet_lab() as lab:
            delays = mouse_latency(lab, browser, 20, draws) * 1e3
        shown = f"median {np.median(delays):.0f} ms, worst {delays.max():.0f} ms"
        print(f"mouse to changed pose, {how}: {shown}")
