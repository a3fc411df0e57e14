"""Loops are compiled in the background; a lab waits for its own, and no other lab waits with it."""

from __future__ import annotations

import gc
import logging
import sys
import threading
from collections.abc import Callable, Iterator
from itertools import islice, product
from weakref import WeakSet

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.scripts import player_of
from onpath.app.lab.lab import PATIENCE, Lab
from onpath.app.lab.loops import loop_cache as module
from onpath.app.lab.loops.loop_cache import MOST, MOST_SOON, Key, LoopCache
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.server.warm_up import LATER, warm_up
from onpath.lessons.action_schema import Action, Laws, Script
from onpath.lessons.course import NO_LESSONS
from onpath.models.closed_loop import simulation
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of, kind_of
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control import speed_limit
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT, SIDES
from onpath.models.errors import CodedError
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.robots import Robot
from tests.support.cases import drawn, some
from tests.support.lab import FRAME, assert_sound, do, finish, new_lab, run, states
from tests.support.suitable_laws import laws_for
from tests.support.waiting import wait_for

LONG = 60.0  # [s]


class Gate(threading.Event):
    """Translates nothing before it is open.

    Attributes:
        threads: that have asked for a translation.
        passed: kernels that have been translated.
    """

    def __init__(self, translate: Callable[[Kernel], Loop] = translate_loop) -> None:
        super().__init__()
        self._translate, self.reached = translate, threading.Event()
        self.threads, self.passed = set[int](), list[Kernel]()

    def __call__(self, kernel: Kernel) -> Loop:
        self.threads.add(threading.get_ident())
        self.reached.set()
        assert self.wait(LONG)
        self.passed.append(kernel)
        return self._translate(kernel)


@pytest.fixture
def gate() -> Gate:
    return Gate()


@pytest.fixture
def loop_cache(gate: Gate) -> Iterator[LoopCache]:
    made = LoopCache(translate=gate)
    pool = made._pool
    yield made
    gate.set()
    made.close()
    assert pool is not None
    pool.shutdown()  # it makes nothing while the next test runs


def loops(lab: Lab) -> list[Loop | None]:
    return [run.loop() for run in lab.simulation.runs.values()]


def law(number: float) -> str:
    return f"across = -K1*xi - K2*dxi - {number:g}; along = -K5*(dtheta - speed)"


def key(number: float) -> Key:
    parameters = FIVE_BAR.parameters()
    return FIVE_BAR.make(parameters), kind_of(law(number), parameters, circle(0.05))


# A lab that waits


def test_a_lab_stands_still_until_its_loops_are_made_and_says_so(
    loop_cache: LoopCache, gate: Gate
) -> None:
    lab, reference = Lab(loop_cache), new_lab()
    run(lab, 0.2)
    assert lab.simulation.time == 0.0 and loops(lab) == [None, None] and not lab.waits
    run(lab, PATIENCE * FRAME)
    assert lab.waits and take_page_snapshot(lab, 1.0).run.waits
    gate.set()
    finish(loop_cache)
    run(lab, 0.5)
    run(reference, 0.5)
    assert not lab.waits and lab.notice == reference.notice
    assert all(isinstance(loop, CompiledLoop) for loop in loops(lab))
    for name, state in states(lab.simulation).items():
        assert np.array_equal(state, reference.simulation.runs[name].state)
        assert lab.simulation.runs[name].diverged is None
    assert np.array_equal(lab.simulation.sample(), reference.simulation.sample())


def test_the_first_sample_is_the_same_whenever_its_loop_comes(
    loop_cache: LoopCache, gate: Gate
) -> None:
    late, soon = Lab(loop_cache), new_lab()
    for lab in (late, soon):
        lab.simulation.running = False
        do(lab, c.Set("start_beside", 0.01), c.Reset())
        run(lab, FRAME)
    gate.set()
    finish(loop_cache)
    run(late, FRAME)
    assert np.array_equal(late.simulation.sample(), soon.simulation.sample())


def test_commands_keep_their_order_while_a_step_waits(loop_cache: LoopCache, gate: Gate) -> None:
    lab = Lab(loop_cache)
    do(lab, c.SetRunning(False), c.StepOnce(), c.StepOnce(), c.Set("rate", 2.0))
    run(lab, 0.5)
    assert lab.simulation.time == 0.0 and lab.simulation.settings.rate == 1.0 and lab.waits
    gate.set()
    finish(loop_cache)
    run(lab, 0.1)
    assert (
        lab.simulation.time == pytest.approx(2e-3)
        and lab.simulation.settings.rate == 2.0
        and not lab.waits
    )


def test_settings_that_need_another_loop_stop_time_until_it_is_made(
    loop_cache: LoopCache, gate: Gate
) -> None:
    gate.set()
    lab = Lab(loop_cache)
    finish(loop_cache)
    do(lab, c.TypeLaw(LEFT, law(0.125)))
    wait_for(lambda: (run(lab, FRAME), lab.simulation.laws[LEFT] == law(0.125))[1], LONG)
    gate.clear()
    do(lab, c.Set("encoder_counts", 4096.0))
    time = lab.simulation.time
    run(lab, 0.5)
    assert lab.simulation.time == time and lab.waits
    gate.set()
    wait_for(lambda: (run(lab, FRAME), lab.simulation.time > time)[1], LONG)
    assert all(each.kind.encoder for each in lab.simulation.runs.values())
    assert lab.simulation.laws[LEFT] == law(0.125)
    assert_sound(lab)


class LateCache(LoopCache):
    """Each loop is there when it has been asked for some times."""

    def __init__(self, late: int) -> None:
        super().__init__(at_once=True)
        self._late, self._asked = late, dict[Key, int]()

    def find(self, robot: Robot, kind: Kind) -> Loop | None:
        key = (robot.core, kind)
        self._asked[key] = self._asked.get(key, 0) + 1
        return super().find(robot, kind) if self._asked[key] > self._late else None


EVERY_KIND = Script(
    do=(
        Action(at=0.1, path="clover"),
        Action(at=0.2, set={"encoder_counts": 2000.0}),  # while the path bends
        Action(at=0.3, laws=Laws(left="waiting_clock")),
        Action(at=0.4, hold=True),
        Action(at=0.7, path="ellipse"),
        Action(at=0.8, hold=False),
        Action(at=0.85, set={"stiction": 0.01}),
        Action(at=1.1, set={"across": "level_set", "delay": 2.0}),
        Action(at=1.2, path="segment"),
        Action(at=1.6, path="circle"),
        Action(at=1.7, set={"torque_limit": 2.0}),
    ),
    until=1.9,
)


@pytest.mark.thorough
@pytest.mark.parametrize("late", drawn(range(1, 24), 1))
def test_a_script_gives_the_same_bits_however_late_its_loops_come(late: int) -> None:
    ends = list[Lab]()
    for loop_cache in (LateCache(late), LoopCache(at_once=True)):
        lab = Lab(loop_cache)
        lab.script = player_of(EVERY_KIND)
        frames = 0
        while lab.script is not None:
            run(lab, FRAME)
            frames += 1
            assert frames < 4000
        ends.append(lab)
        loop_cache.close()
    late_lab, soon = ends
    assert late_lab.simulation.time == soon.simulation.time and late_lab.message == soon.message
    for side, state in states(soon.simulation).items():
        assert np.array_equal(state, states(late_lab.simulation)[side])
        assert late_lab.simulation.laws[side] == soon.simulation.laws[side]


OTHERS = [name for name in ROBOTS if name != FIVE_BAR.name]


@pytest.mark.parametrize("robot", some([FIVE_BAR.name, *drawn(OTHERS, 2)], (FIVE_BAR.name,)))
def test_nothing_is_built_on_the_thread_of_the_simulation(
    loop_cache: LoopCache, gate: Gate, robot: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever needs another loop: robots, laws, parameters, a hand, the kind of path."""
    built, known = set[int](), kernel_of

    def kernel(*wanted: Key) -> Kernel:
        built.add(threading.get_ident())
        return known(*wanted)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "kernel_of", kernel)
    gate.set()
    lab = Lab(loop_cache)
    asked: list[c.Command] = [c.ChooseRobot(robot)]
    asked += [c.ChooseLaw(RIGHT, each) for each in laws_for(robot)[:2]]
    asked += [c.Set("encoder_counts", 2000.0), c.Hold(on=True), c.ChoosePath("arc")]
    for command in asked:
        do(lab, command)
        run(lab, 0.4)
        finish(loop_cache)
    assert built and threading.get_ident() not in built | gate.threads
    assert_sound(lab)


# Fair to others

wanted = st.lists(
    st.tuples(st.integers(0, 4), st.lists(st.integers(0, 30), max_size=3)), min_size=1, max_size=40
)


class Owner:
    """Stands in for a lab."""


@pytest.fixture(scope="module")
def one_kernel() -> Kernel:
    return kernel_of(*key(0))


@pytest.fixture
def cheap(one_kernel: Kernel, monkeypatch: pytest.MonkeyPatch) -> None:
    """All loops have one kernel."""
    monkeypatch.setattr(module, "kernel_of", lambda *_: one_kernel)


@given(wanted)
def test_the_next_loop_is_for_the_lab_that_has_taken_least(
    asked: list[tuple[int, list[int]]],
) -> None:
    """Only what a lab wanted last is made for it, and nobody waits for who has taken more."""
    loop_cache, labs, last = LoopCache(), [Owner() for _ in range(5)], dict[int, list[int]]()
    loop_cache.close()  # the test takes the place of its thread
    for number, keys in asked:
        loop_cache.want(labs[number], [(RIGID_FIVE_BAR, Kind(str(each))) for each in keys])
        last[number] = keys
    spent, made = dict.fromkeys(range(5), 0.0), set[int]()
    while (task := loop_cache._next()) is not None:
        lab, (_, kind) = task
        number = labs.index(lab)  # type: ignore[arg-type]
        waiting = [n for n, keys in last.items() if set(keys) - made]
        assert spent[number] == min(spent[n] for n in waiting)
        assert int(kind.law) == next(k for k in last[number] if k not in made)
        made.add(int(kind.law))
        loop_cache._keep(task[1], CodedError("error.law_cannot_run"))
        spent[number] += 1.0 + number
        loop_cache._spent[labs[number]] = spent[number]
    assert made == {each for keys in last.values() for each in keys}


@pytest.mark.thorough
def test_a_lab_that_types_without_end_does_not_hold_up_another_one(
    loop_cache: LoopCache, gate: Gate
) -> None:
    greedy, other = Lab(loop_cache), Lab(loop_cache)
    for number in range(300):
        typed = [c.TypeLaw(side, law(number + i / 4)) for i, side in enumerate(SIDES)]
        do(greedy, *typed)
        run(greedy, FRAME)
        if number == 150:
            do(other, c.ChooseLaw(LEFT, "waiting_clock"), c.TypeLaw(RIGHT, law(-1)))
            gate.set()
        if number > 150:
            run(other, FRAME)
    laws = {LEFT: "waiting_clock", RIGHT: law(-1)}
    wait_for(lambda: (run(other, FRAME), other.simulation.laws == laws)[1], LONG)
    assert greedy.simulation.chosen_laws == {LEFT: law(299), RIGHT: law(299.25)}
    for each in (greedy, other):
        run(each, 0.1)
        assert_sound(each)


@pytest.mark.usefixtures("cheap")
def test_what_is_prepared_waits_for_what_labs_wait_for_and_is_bounded(
    loop_cache: LoopCache, gate: Gate
) -> None:
    for kind in some_kinds(200):
        loop_cache.prepare(RIGID_FIVE_BAR, kind)
    assert gate.reached.wait(LONG)
    lab = Owner()
    loop_cache.want(lab, [key(7)])
    gate.set()
    wait_for(lambda: loop_cache.find(*key(7)) is not None, LONG)
    assert len(gate.passed) <= 3 and len(loop_cache._soon) <= MOST_SOON


# What is kept


def some_kinds(most: int) -> list[Kind]:
    flags = ("closed", "level_set", "encoder", "free", "delay", "stiction", "noise")
    every = (
        Kind(law, **dict(zip(flags, chosen, strict=True)))
        for law in laws_for()
        for chosen in product((False, True), repeat=len(flags))
    )
    return list(islice(every, most))


@pytest.mark.thorough
@pytest.mark.usefixtures("cheap")
def test_loops_in_use_are_shared_and_of_the_others_only_the_last_are_kept() -> None:
    loop_cache = LoopCache(at_once=True, translate=InterpretedLoop)
    robot, (mine, *others) = RIGID_FIVE_BAR, some_kinds(3 * MOST)
    used, seen = loop_cache.find(robot, mine), WeakSet[Loop]()
    for kind in others:
        loop = loop_cache.find(robot, kind)
        assert loop is not None and loop_cache.find(robot, kind) is loop
        seen.add(loop)
    del loop
    gc.collect()
    assert loop_cache.find(robot, mine) is used
    assert len(loop_cache._kept) <= MOST and len(seen) <= MOST
    loop_cache.close()


def test_a_lab_keeps_the_loop_that_it_uses() -> None:
    loop_cache = LoopCache(at_once=True)
    lab, same = Lab(loop_cache), Lab(loop_cache)
    for each in (lab, same):
        do(each, c.TypeLaw(LEFT, law(0)), c.TypeLaw(RIGHT, law(0.25)))
        run(each, 0.2)
    before = loops(lab)
    for number in range(MOST):
        loop_cache._keep(key(5000 + number), CodedError("error.law_cannot_run"))
    for each in (lab, same):
        do(each, c.Set("K1", 500.0), c.Hold(on=True))
        run(each, 0.3)
        do(each, c.LookAt(0.2), c.GoOn())
        run(each, 0.3)
        assert_sound(each)
    assert loops(lab) == before == loops(same)
    loop_cache.close()


def test_kernels_of_typed_laws_displace_no_others() -> None:
    known = RIGID_FIVE_BAR, kind_of(DEFAULT_LAWS[LEFT], FIVE_BAR.parameters(), circle(0.05))
    kernel = kernel_of(*known)
    for number in range(simulation.MOST + 2):
        kernel_of(*key(number))
    assert kernel_of(*known) is kernel
    assert simulation._typed_kernel.cache_info().currsize == simulation.MOST


# What fails


def test_a_failed_compilation_is_logged_once_for_each_kind_and_the_lab_continues(
    loop_cache: LoopCache,
    gate: Gate,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    monkeypatch.setitem(sys.modules, "llvmlite.binding", None)
    gate.set()
    lab = Lab(loop_cache)
    with caplog.at_level(logging.WARNING):
        lab.advance(FRAME)
        finish(loop_cache)
        for _ in range(20):
            lab.advance(FRAME)
        do(lab, c.Hold(on=True))
        for _ in range(20):
            lab.advance(FRAME)
    warnings = [r for r in caplog.records if r.name == module.__name__]
    assert all("interpreted" in warning.getMessage() for warning in warnings)
    assert len(warnings) == 2 * len(SIDES)  # free, and held
    assert lab.simulation.time == pytest.approx(40 * FRAME, abs=2e-3)
    assert all(isinstance(loop, InterpretedLoop) for loop in loops(lab))


def test_whatever_fails_in_the_background_the_next_loop_is_made(
    loop_cache: LoopCache, gate: Gate, monkeypatch: pytest.MonkeyPatch
) -> None:
    def failing(*wanted: Key) -> Kernel:
        if wanted == key(1):
            raise MemoryError
        return kernel_of(*wanted)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "kernel_of", failing)
    gate.set()
    lab = Owner()
    loop_cache.want(lab, [key(1), key(2)])
    wait_for(lambda: loop_cache.find(*key(2)) is not None, LONG)
    with pytest.raises(CodedError, match="not possible"):
        loop_cache.find(*key(1))


def test_closing_gives_up_what_is_waiting(loop_cache: LoopCache, gate: Gate) -> None:
    lab, pool = Owner(), loop_cache._pool
    loop_cache.want(lab, [key(number) for number in range(4)])
    assert gate.reached.wait(LONG) and pool is not None
    loop_cache.close()
    gate.set()
    pool.shutdown(wait=True)
    assert len(gate.passed) == 1
    loop_cache.want(lab, [key(9)])  # that is new, and refused quietly
    assert loop_cache.find(*key(9)) is None


# In advance


def test_a_first_lab_finds_its_loops_compiled(loop_cache: LoopCache, gate: Gate) -> None:
    """Free and held: whoever comes after a while waits for no loop."""
    gate.set()
    warm_up(loop_cache, NO_LESSONS, rest=0.0).join(LONG)
    finish(loop_cache)
    assert all(name in sys.modules for name in (*LATER, "babel"))
    lab = Lab(loop_cache)
    for commands in ([], [c.Hold(on=True)]):
        do(lab, *commands)
        lab.advance(FRAME)
        assert all(isinstance(loop, CompiledLoop) for loop in loops(lab))
    assert len(loop_cache._kept) == 2 * len(SIDES)


def test_whoever_gets_a_loop_also_gets_that_with_a_hand_on_the_robot(
    loop_cache: LoopCache, gate: Gate
) -> None:
    gate.set()
    lab = Lab(loop_cache)
    run(lab, FRAME)
    finish(loop_cache)
    run(lab, FRAME)
    time = lab.simulation.time
    do(lab, c.Hold(on=True))
    run(lab, FRAME)
    assert lab.simulation.time > time


def test_what_a_speed_limit_needs_is_made_in_the_background(
    loop_cache: LoopCache, gate: Gate
) -> None:
    """`slow_down` builds nothing on the simulation thread."""
    gate.set()
    speed_limit._on_path.cache_clear()
    lab = Lab(loop_cache)
    lab.advance(FRAME)
    finish(loop_cache)
    assert speed_limit._on_path.cache_info().misses == 1
    do(lab, c.Set("torque_limit", 0.5), c.Set("at_limit", "slow_down"))
    lab.advance(FRAME)
    found = speed_limit._on_path.cache_info()
    assert found.misses == 1 and found.hits > 0
