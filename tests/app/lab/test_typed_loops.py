"""Loops of typed laws: few are kept, few are made, and nobody's loop is taken away."""

from __future__ import annotations

import gc
import threading
import weakref
from collections.abc import Callable
from concurrent.futures import Future

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops import typed_loops
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.loops.typed_loops import MOST, MOST_MADE, WITHIN, Key, TypedLoops
from onpath.models.closed_loop import simulation
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop
from onpath.models.closed_loop.simulation import kernel_of, kind_of
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT, SIDES
from onpath.models.errors import CodedError
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import FRAME, assert_sound, do, run, states
from tests.support.waiting import wait_for

PATIENCE = 60.0  # [s]

ROBOT, CURVE = FIVE_BAR.make(FIVE_BAR.parameters()), circle(0.05)


def law(number: float) -> str:
    return f"across = -K1*xi - K2*dxi - {number:g}; along = -K5*(dtheta - speed)"


def key(number: float) -> Key:
    return ROBOT, kind_of(law(number), FIVE_BAR.parameters(), CURVE)


class Side:
    """Typed loops with a clock and a background that go on when the test says so."""

    def __init__(self) -> None:
        self.time = 0.0
        self.waiting: list[tuple[Future[None], Callable[[], None]]] = []
        self.loops = TypedLoops(self._submit, lambda: self.time)

    def _submit(self, act: Callable[[], None]) -> Future[None]:
        future: Future[None] = Future()
        self.waiting.append((future, act))
        return future

    def work(self) -> int:
        """Do what waits and has not been cancelled; returns how much that was."""
        waiting, self.waiting = self.waiting, []
        acts = [act for future, act in waiting if future.set_running_or_notify_cancel()]
        for act in acts:
            act()
        return len(acts)


class Owner:
    """Stands in for a lab."""


@pytest.fixture
def cheap(monkeypatch: pytest.MonkeyPatch) -> list[Kernel]:
    """Nothing is compiled: every loop stays interpreted, and is made of one kernel."""
    made: list[Kernel] = []
    kernel = kernel_of(*key(0))

    def same(*_: object) -> Kernel:
        made.append(kernel)
        return kernel

    monkeypatch.setattr(typed_loops, "kernel_of", same)
    monkeypatch.setattr(typed_loops, "translate_loop", InterpretedLoop)
    return made


def test_only_the_loops_used_last_are_kept(cheap: list[Kernel]) -> None:
    side, lab = Side(), Owner()
    for number in range(MOST + 20):
        side.time += WITHIN
        side.loops.want(lab, [key(number)])
        assert side.work() == 1
        assert side.loops.find(key(0)) is not None  # it is used all the time
        assert len(side.loops) <= MOST
    assert side.loops.find(key(MOST + 19)) is not None
    assert all(side.loops.find(key(number)) is None for number in range(1, 21))


def test_what_is_not_kept_is_freed() -> None:
    side, lab = Side(), Owner()
    side.loops.want(lab, [key(0.5)])
    side.work()
    loop = weakref.ref(side.loops.find(key(0.5)))
    assert isinstance(loop(), CompiledLoop)
    for number in range(MOST):
        side.loops._put(key(1000 + number), CodedError("error.law_cannot_run"))
    simulation._typed_kernel.cache_clear()
    gc.collect()
    assert loop() is None


def test_a_thousand_laws_of_one_lab_leave_one_waiting(cheap: list[Kernel]) -> None:
    side, greedy, other = Side(), Owner(), Owner()
    for number in range(1000):
        side.loops.want(greedy, [key(number)])
    side.loops.want(other, [key(-1)])
    assert side.work() == 2  # the last one, and that of the other lab
    assert side.loops.find(key(999)) is not None and side.loops.find(key(-1)) is not None
    assert len(cheap) == 2


def test_a_lab_that_wants_many_has_to_wait_and_others_do_not(cheap: list[Kernel]) -> None:
    side, greedy, other = Side(), Owner(), Owner()
    done = 0
    for number in range(200):
        side.time += WITHIN / 100
        side.loops.want(greedy, [key(number)])
        done += side.work()
    assert done <= 2 * (MOST_MADE + 1)  # in two times WITHIN
    side.loops.want(other, [key(-1)])
    assert side.work() == 1
    side.time += WITHIN
    side.loops.want(greedy, [key(199)])
    side.work()
    assert side.loops.find(key(199)) is not None


def test_two_labs_that_want_the_same_get_one_loop(cheap: list[Kernel]) -> None:
    side, first, second = Side(), Owner(), Owner()
    for lab in (first, second):
        side.loops.want(lab, [key(1)])
    side.loops.want(first, [])  # which withdraws what both wait for
    side.loops.want(second, [key(1)])
    assert side.work() == 1 and side.loops.find(key(1)) is not None


def test_what_cannot_be_made_is_an_error_and_nobody_else_is_affected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    side, lab, good = Side(), Owner(), typed_loops.kernel_of

    def failing(robot: object, kind: object) -> Kernel:
        if (robot, kind) == key(1):
            raise CodedError("error.law_cannot_run")
        return good(*key(2))

    monkeypatch.setattr(typed_loops, "kernel_of", failing)
    side.loops.want(lab, [key(1), key(2)])
    side.work()
    with pytest.raises(CodedError, match="not possible"):
        side.loops.find(key(1))
    assert isinstance(side.loops.find(key(2)), CompiledLoop)


def test_kernels_of_typed_laws_displace_no_others() -> None:
    known = ROBOT, kind_of(DEFAULT_LAWS[LEFT], FIVE_BAR.parameters(), CURVE)
    kernel = kernel_of(*known)
    for number in range(simulation.MOST + 2):
        kernel_of(*key(number))
    assert kernel_of(*known) is kernel
    assert simulation._typed_kernel.cache_info().currsize == simulation.MOST


# In a lab.


def force_out(store: LoopCache) -> None:
    """Displace every loop of a typed law."""
    for number in range(MOST):
        store._typed._put(key(5000 + number), CodedError("error.law_cannot_run"))
    simulation._typed_kernel.cache_clear()


def test_a_lab_keeps_the_loop_that_it_uses() -> None:
    store = LoopCache(at_once=True)
    lab, same = Lab(store), Lab(store)
    for each in (lab, same):
        do(each, c.TypeLaw(LEFT, law(0)), c.TypeLaw(RIGHT, law(0.25)))
        run(each, 0.2)
    loops = [each.loop() for each in lab.session.runs.values()]
    force_out(store)
    built = weakref.WeakSet(loops)
    for each in (lab, same):
        do(each, c.SetParameter("K1", 500.0), c.Hold(on=True))
        run(each, 0.3)
        do(each, c.LookAt(0.2), c.GoOn())
        run(each, 0.3)
        assert_sound(each)
    assert [each.loop() for each in lab.session.runs.values()] == loops and len(built) == 2
    for side in SIDES:
        assert (states(lab.session)[side] == states(same.session)[side]).all()
    store.close()


def test_a_lab_that_types_without_end_does_not_hold_up_another_one(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    store, made = LoopCache(clock=lambda: 0.0), list[Key]()  # no time passes: no rest is over
    make = store._typed.make
    monkeypatch.setattr(store._typed, "make", lambda wanted: (made.append(wanted), make(wanted)))
    greedy, other = Lab(store), Lab(store)
    for number in range(300):
        do(
            greedy,
            *[c.TypeLaw(side, law(number + each / 4)) for each, side in enumerate(SIDES)],
        )
        run(greedy, FRAME)
        if number == 150:
            do(other, c.ChooseLaw(LEFT, "waiting_clock"), c.TypeLaw(RIGHT, law(-1)))
    wanted = {LEFT: "waiting_clock", RIGHT: law(-1)}
    wait_for(lambda: (run(other, FRAME), other.session.laws == wanted)[1], PATIENCE)
    assert len(made) <= MOST_MADE + 2 * len(SIDES) + 1
    assert greedy.session.chosen_laws == {LEFT: law(299), RIGHT: law(299.25)}
    for each in (greedy, other):
        run(each, 0.1)
        assert_sound(each)
    store.close()


def test_a_lab_that_needs_another_loop_stands_still_until_it_is_made(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    store, gate = LoopCache(), threading.Event()
    lab, text = Lab(store), law(0.125)
    do(lab, c.TypeLaw(LEFT, text))
    wait_for(lambda: (run(lab, FRAME), lab.session.laws[LEFT] == text)[1], PATIENCE)
    make, here = store._typed.make, threading.get_ident()
    monkeypatch.setattr(store._typed, "make", lambda wanted: (gate.wait(), make(wanted)))
    built: list[int] = []
    known = kernel_of
    monkeypatch.setattr(
        typed_loops, "kernel_of", lambda *k: (built.append(threading.get_ident()), known(*k))[1]
    )
    do(lab, c.SetParameter("encoder_counts", 4096.0))
    time = lab.session.time
    run(lab, 0.5)
    assert lab.session.time == time and lab.session.laws[LEFT] == text
    do(lab, c.SetRunning(False), c.StepOnce())
    assert "still being made" in lab.message and lab.session.time == time
    do(lab, c.SetRunning(True))
    gate.set()
    wait_for(lambda: (run(lab, FRAME), lab.session.time > time)[1], PATIENCE)
    assert lab.session.runs[LEFT].kind.encoder and lab.session.laws[LEFT] == text
    assert built and here not in built  # nothing was built in the thread of the simulation
    assert_sound(lab)
    store.close()
