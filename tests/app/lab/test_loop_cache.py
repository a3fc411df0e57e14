"""Loops are available at once; compiled ones replace them when ready, without visible effect."""

from __future__ import annotations

import gc
import logging
import sys
import threading
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import count, islice, product
from weakref import WeakSet

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops import compile_queue
from onpath.app.lab.loops import loop_cache as loop_store
from onpath.app.lab.loops.loop_cache import MOST, LoopCache
from onpath.app.server.warm_up import LATER, warm_up
from onpath.lessons.course import NO_LESSONS
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.control import speed_limit
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, SIDES
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from tests.support.lab import FRAME, do, finish, run, states
from tests.support.lab import store as store_of_other_tests
from tests.support.suitable_laws import laws_for
from tests.support.waiting import wait_for

PATIENCE = 60.0  # [s]


@pytest.fixture
def store() -> Iterator[LoopCache]:
    finish(store_of_other_tests())  # it would use what these tests replace
    made = LoopCache()
    pool = made._pool
    yield made
    made.close()
    assert pool is not None
    pool.shutdown()  # it makes nothing while the next test runs


class Gate(threading.Event):
    """Nothing is translated for a store before it is open; `passed` has what was."""

    def __init__(self, translate: Callable[[Kernel], CompiledLoop], store: LoopCache) -> None:
        super().__init__()
        assert store._pool is not None
        self._threads = store._pool._threads
        self.reached = threading.Event()
        self.passed: list[Kernel] = []
        self._translate = translate

    def __call__(self, kernel: Kernel) -> CompiledLoop:
        if threading.current_thread() not in self._threads:  # another test's store
            return self._translate(kernel)
        self.reached.set()
        assert self.wait(PATIENCE)
        self.passed.append(kernel)
        return self._translate(kernel)


@pytest.fixture
def gate(store: LoopCache, monkeypatch: pytest.MonkeyPatch) -> Iterator[Gate]:
    """It is opened before the store waits for what is being made."""
    made = Gate(loop_store.translate_loop, store)
    monkeypatch.setattr(loop_store, "translate_loop", made)
    yield made
    made.set()


def loops(lab: Lab, store: LoopCache) -> list[Loop]:
    return [store.get(run.robot, run.kind) for run in lab.session.runs.values()]


def test_loops_are_interpreted_at_once_and_compiled_later(store: LoopCache, gate: Gate) -> None:
    never = LoopCache()
    never.close()
    lab, reference = Lab(store), Lab(never)
    for tier in (InterpretedLoop, CompiledLoop):
        for _ in range(30):
            lab.advance(FRAME)
            reference.advance(FRAME)
        now = loops(lab, store)
        assert all(isinstance(loop, tier) for loop in now) and loops(lab, store) == now
        assert all(isinstance(loop, InterpretedLoop) for loop in loops(reference, never))
        gate.set()
        finish(store)
    for name, state in states(lab.session).items():
        assert np.array_equal(state, reference.session.runs[name].state)
        assert lab.session.runs[name].diverged is None
    assert len(gate.passed) == len(SIDES)


def test_a_failed_compilation_is_logged_once_for_each_kind_and_the_lab_continues(
    store: LoopCache, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setitem(sys.modules, "llvmlite.binding", None)
    lab = Lab(store)
    with caplog.at_level(logging.WARNING):
        lab.advance(FRAME)
        finish(store)
        for _ in range(20):
            lab.advance(FRAME)
        do(lab, c.Hold(on=True))
        lab.advance(FRAME)  # a loop that nobody has asked for before
        finish(store)
        for _ in range(20):
            lab.advance(FRAME)
        finish(store)
    warnings = [r for r in caplog.records if r.name == "onpath.app.lab.loops.loop_cache"]
    assert all("interpreted" in warning.getMessage() for warning in warnings)
    assert len(warnings) == 2 * len(SIDES)  # free, and held
    assert lab.session.time == pytest.approx(42 * FRAME, abs=2e-3)
    assert all(isinstance(loop, InterpretedLoop) for loop in loops(lab, store))


def test_closing_gives_up_what_is_waiting(store: LoopCache, gate: Gate) -> None:
    kinds = [
        Kind(DEFAULT_LAWS[LEFT], closed, encoder=e)
        for closed in (True, False)
        for e in (True, False)
    ]
    for kind in kinds:
        store.get(RIGID_FIVE_BAR, kind)
    assert gate.reached.wait(PATIENCE)
    pool = store._pool
    assert pool is not None
    store.close()
    gate.set()
    pool.shutdown(wait=True)
    assert len(gate.passed) == 1
    waiting = len(store._waiting)
    for kind in kinds[1:]:
        assert isinstance(store.get(RIGID_FIVE_BAR, kind), InterpretedLoop)
    store.get(RIGID_FIVE_BAR, replace(kinds[0], free=True))  # that is new, and refused quietly
    assert len(store._waiting) == waiting


def test_a_first_lab_finds_its_loops_compiled(store: LoopCache) -> None:
    """Free and held: whoever comes after a while meets no interpreted loop."""
    warm_up(store, NO_LESSONS, rest=0.0).join(PATIENCE)
    finish(store)
    assert all(name in sys.modules for name in (*LATER, "babel"))
    lab = Lab(store)
    for commands in ([], [c.Hold(on=True)]):
        do(lab, *commands)
        lab.advance(FRAME)
        assert all(isinstance(loop, CompiledLoop) for loop in loops(lab, store))
    assert len(store._kept) == 2 * len(SIDES)


class Quick(InterpretedLoop):
    """Stands in for a compiled loop."""


@pytest.fixture
def cheap(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is compiled, and all loops have one kernel."""
    kernel = kernel_of(RIGID_FIVE_BAR, Kind(DEFAULT_LAWS[LEFT]))
    monkeypatch.setattr(loop_store, "kernel_of", lambda *_: kernel)
    monkeypatch.setattr(loop_store, "translate_loop", Quick)
    monkeypatch.setattr(loop_store, "CompiledLoop", Quick)


def some_kinds(most: int) -> list[Kind]:
    flags = ("closed", "level_set", "encoder", "free", "delay", "stiction", "noise")
    every = (
        Kind(law, **dict(zip(flags, chosen, strict=True)))
        for law in laws_for()
        for chosen in product((False, True), repeat=len(flags))
    )
    return list(islice(every, most))


@pytest.mark.usefixtures("cheap")
def test_loops_in_use_are_shared_and_of_the_others_only_the_last_are_kept(store: LoopCache) -> None:
    robot, (mine, *others) = RIGID_FIVE_BAR, some_kinds(3 * MOST)
    store.prepare(robot, mine)
    finish(store)
    used, seen = store.get(robot, mine), WeakSet[Loop]()
    for kind in others:
        seen.add(store.get(robot, kind))
        finish(store)
        seen.add(store.get(robot, kind))
    gc.collect()
    assert store.get(robot, mine) is used
    assert len(store._kept) <= MOST and len(seen) <= MOST + 1  # the loop of the last turn


@pytest.mark.usefixtures("cheap")
def test_labs_that_wait_for_more_loops_than_are_kept_get_them(
    store: LoopCache, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Loops that labs go on with meanwhile do not displace those that have been compiled."""
    turn, made = threading.Semaphore(0), list[int]()

    def translate(kernel: Kernel) -> Loop:
        """Less than one loop is compiled in a frame."""
        assert turn.acquire(timeout=PATIENCE)
        loop = Quick(kernel)
        made.append(id(loop))
        return loop

    monkeypatch.setattr(loop_store, "translate_loop", translate)
    robot = RIGID_FIVE_BAR
    used: dict[Kind, Loop] = {kind: store.get(robot, kind) for kind in some_kinds(2 * MOST)}
    for frame in range(2 * MOST):
        turn.release()
        wait_for(lambda n=frame: made[n:] and made[n] in map(id, store._made.values()), PATIENCE)
        for kind, loop in reversed(used.items()):
            if not isinstance(loop, Quick):
                used[kind] = store.get(robot, kind, loop)
    assert all(isinstance(loop, Quick) for loop in used.values())


def test_settings_changed_without_end_do_not_hold_up_another_lab(
    store: LoopCache, gate: Gate
) -> None:
    clock = count()  # [s]; time passes whenever somebody asks
    store._waiting._clock = lambda: float(next(clock))
    for kind in some_kinds(200):
        store.prepare(RIGID_FIVE_BAR, kind)
    lab = Lab(store)
    do(lab, c.ChooseLaw(LEFT, "waiting_clock"))
    run(lab, FRAME)
    assert len(store._waiting) <= compile_queue.MOST
    gate.set()
    wait_for(lambda: (run(lab, FRAME), lab.session.laws[LEFT] == "waiting_clock")[1], PATIENCE)
    assert len(gate.passed) <= 2 * len(SIDES)


def test_what_a_speed_limit_needs_is_made_in_the_background(store: LoopCache) -> None:
    """`slow_down` builds nothing on the simulation thread."""
    speed_limit._on_path.cache_clear()
    lab = Lab(store)
    lab.advance(FRAME)
    finish(store)
    assert speed_limit._on_path.cache_info().misses == 1
    do(lab, c.SetParameter("torque_limit", 0.5), c.SetParameter("at_limit", "slow_down"))
    lab.advance(FRAME)
    found = speed_limit._on_path.cache_info()
    assert found.misses == 1 and found.hits > 0
