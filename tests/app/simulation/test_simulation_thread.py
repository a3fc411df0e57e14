"""One thread, all labs, 60 frames a second; two at once, or slower, while frames are late."""

from __future__ import annotations

import gc
import itertools
import logging
import sys
import threading
import time
import weakref
from collections.abc import Callable
from math import ceil
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.common.on_time import wait_until_on_time
from onpath.app.lab import commands as c
from onpath.app.lab.advance_together import Frame
from onpath.app.lab.commands import Command
from onpath.app.lab.lab import Lab
from onpath.app.simulation import simulation_thread
from onpath.app.simulation.display_rate import LATE, STRIDES, is_turn
from onpath.app.simulation.frame_length import frame_length
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.simulation.simulation_thread import (
    ALL_COMMANDS,
    BEHIND,
    LATEST,
    PAUSE,
    TOLERATED,
    CommandTurns,
    SimulationThread,
)
from onpath.models.systems.parameters import TICK
from tests.support.lab import FRAME, new_lab


class Clock:
    """Time that passes only when somebody sleeps or works."""

    def __init__(self, thread_stop: float) -> None:
        self.now, self.end = 100.0, 100.0 + thread_stop
        self.thread: SimulationThread | None = None

    def __call__(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        assert seconds > 0
        self.now += seconds

    def work(self, seconds: float) -> None:
        self.now += seconds
        if self.now >= self.end and self.thread is not None:
            self.thread.stop()


def clocked(seconds: float) -> tuple[Clock, SimulationThread]:
    """A thread that runs for some time by a clock of its own, [s]."""
    clock = Clock(seconds)
    clock.thread = SimulationThread(clock, clock.sleep)
    return clock, clock.thread


class View:
    """A viewer that is shown every frame for some time."""

    def __init__(self, work: Callable[[int], object]) -> None:
        self.work = work
        self.shown: list[tuple[float, float, int]] = []

    is_outdated = False

    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        return True

    def show(self, lab: Lab, frame: int, stride: float) -> None:
        self.shown.append((lab.simulation.time, 0.0, frame))
        self.work(frame)

    def refresh(self, lab: Lab, achieved: float) -> None:
        pass

    def send(self) -> None:
        pass


class Screen:
    """A viewer that takes some time to draw, [s], when it is its turn."""

    def __init__(self, clock: Clock, offset: int, cost: float) -> None:
        self.clock, self.offset, self.cost = clock, offset, cost
        self.drawn = list[int]()

    is_outdated = False

    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        return is_turn(frame + self.offset, stride)

    def show(self, lab: Lab, frame: int, stride: float) -> None:
        if self.is_turn(lab, frame, stride):
            self.drawn.append(frame)
            self.clock.work(self.cost)

    def refresh(self, lab: Lab, achieved: float) -> None:
        pass

    def send(self) -> None:
        pass


def drawn(
    seconds: float, cost: Callable[[int], float], drawing: float, count: int = 8
) -> tuple[SimulationThread, list[ScheduledLab], list[Screen]]:
    """The same with labs that are drawn.

    Args:
        cost: of each frame's simulation, [s].
        drawing: drawing each of them once, [s].
    """
    clock, thread = clocked(seconds)
    labs = [ScheduledLab(new_lab()) for _ in range(count)]
    frames = itertools.count()

    class Costly(ScheduledLab):
        def frame(self, *args: Any, **named: Any) -> Frame:
            yield from super().frame(*args, **named)
            clock.work(cost(next(frames)))

    labs[0] = Costly(new_lab())
    screens = [Screen(clock, at, drawing / count) for at in range(count)]
    for scheduled, screen in zip(labs, screens, strict=True):
        scheduled.display = screen
        thread.add(scheduled)
    thread.run()
    return thread, labs, screens


def simulated(
    seconds: float, cost: Callable[[int], float], *others: ScheduledLab
) -> tuple[SimulationThread, ScheduledLab, View, Clock]:
    """Some seconds of a thread whose frames cost as much as `cost` says."""
    clock, thread = clocked(seconds)
    scheduled = ScheduledLab(new_lab())
    scheduled.display = view = View(lambda frame: clock.work(cost(frame)))
    for other in others:
        thread.add(other)
    thread.add(scheduled)
    thread.run()
    return thread, scheduled, view, clock


def test_sixty_frames_a_second_each_on_time() -> None:
    thread, scheduled, view, _ = simulated(3.0, lambda _: 0.004)
    assert len(view.shown) == pytest.approx(180, abs=2)
    assert scheduled.simulation.time == pytest.approx(3.0, abs=0.04)
    assert max(thread.lateness) < 1e-9
    assert scheduled.achieved == pytest.approx(1.0, abs=0.02)
    assert [frame for _, _, frame in view.shown] == list(range(len(view.shown)))


@pytest.mark.parametrize("cost", [1.1, 1.5, 1.9])
def test_frames_that_take_too_long_are_simulated_two_at_once(cost: float) -> None:
    """Simulated time does not slow down, as long as two at once are done in time."""
    thread, scheduled, view, _ = simulated(20.0, lambda _: cost * FRAME)
    assert scheduled.simulation.time == pytest.approx(20.0, abs=2 * BEHIND)
    assert scheduled.achieved == pytest.approx(1.0, rel=0.02)
    assert max(thread.lateness) < BEHIND + FRAME  # less than one more, since that takes two
    assert len(view.shown) == pytest.approx(20.0 / (cost * FRAME + PAUSE), rel=0.01)


@pytest.mark.parametrize(("cost", "at_once"), [(4.0, 5 / 3), (8.0, 1.0)])
def test_slower_frames_slow_simulated_time_visibly(cost: float, at_once: float) -> None:
    """The schedule restarts with each that is over six frames late: every third, or every one."""
    thread, scheduled, _, _ = simulated(24.0, lambda _: cost * FRAME)
    assert scheduled.simulation.time == pytest.approx(24.0 * at_once / cost, rel=0.05)
    assert scheduled.achieved == pytest.approx(at_once / cost, rel=0.05)
    assert max(thread.lateness) <= LATEST + cost * FRAME  # it never piles up


def test_after_a_stall_it_continues_at_its_pace() -> None:
    cost = 5.0

    def stall(frame: int) -> float:
        return cost if frame == 30 else 0.001

    _, scheduled, view, _ = simulated(10.0, stall)
    assert scheduled.simulation.time == pytest.approx(
        10.0 - cost, abs=0.1
    )  # the stall is not made up for
    steps = [b[0] - a[0] for a, b in zip(view.shown, view.shown[1:], strict=False)]
    assert max(steps) < FRAME + 2e-3
    assert scheduled.achieved == pytest.approx(1.0, abs=0.15)  # and is forgotten again


def test_short_hiccups_are_made_up_for() -> None:
    _, scheduled, _, _ = simulated(4.0, lambda frame: 0.05 if frame % 40 == 7 else 0.001)
    assert scheduled.simulation.time == pytest.approx(4.0, abs=0.06)


@pytest.mark.thorough
def test_frames_that_are_late_are_drawn_less_often_until_they_no_longer_are() -> None:
    """60 % of the time are taken: 11 late frames at the usual pace, fewer so."""
    thread, _, screens = drawn(14.0, lambda at: 0.095 if at == 300 else 0.004, drawing=0.015)
    late = [at for at, late in enumerate(thread.lateness) if late > FRAME]
    assert 3 <= len(late) < 11 and late[0] == 301
    for screen in screens:
        gaps = [b - a for a, b in itertools.pairwise(screen.drawn)]
        assert max(gaps) < max(LATE.values()) + STRIDES[1]  # a turn may be left out when that ends
        assert max(gaps[-60:]) <= ceil(STRIDES[1])


@pytest.mark.thorough
def test_drawing_gives_way_before_simulated_time_does() -> None:
    """At the slowest pace there is too much to do; when hurried, there is not."""
    thread, labs, screens = drawn(20.0, lambda _: 0.008, drawing=0.040)
    for scheduled, screen in zip(labs, screens, strict=True):
        assert scheduled.simulation.time == pytest.approx(
            20.0, abs=2 * LATEST
        )  # until the cost is known
        assert scheduled.achieved == pytest.approx(1.0, abs=0.01)
        assert len(screen.drawn) > 20.0 * 60 / max(LATE.values())
    assert max(thread.lateness[60:]) < max(LATE) + FRAME


def test_long_work_in_other_threads_gives_way_while_frames_are_late() -> None:
    on_time = list[bool]()

    def cost(frame: int) -> float:
        on_time.append(wait_until_on_time(0.0))
        return 0.05 if frame == 100 else 0.004

    thread, *_ = simulated(4.0, cost)
    assert on_time == [late <= TOLERATED for late in thread.lateness]
    assert 1 <= on_time.count(False) <= 5
    simulated(1.0, lambda _: 2.5 * FRAME)
    assert wait_until_on_time(0.0)  # nobody waits for a thread that has stopped


def test_late_frames_are_drawn_as_usual_where_drawing_costs_nothing() -> None:
    _, _, (screen,) = drawn(8.0, lambda at: 0.05 if at % 20 == 0 else 0.007, 0.001, count=1)
    assert max(b - a for a, b in itertools.pairwise(screen.drawn)) <= ceil(STRIDES[1])


def test_simulated_time_follows_the_wanted_speed() -> None:
    clock, thread = clocked(2.0)
    labs = [ScheduledLab(new_lab()) for _ in range(3)]
    for scheduled, rate in zip(labs, (0.25, 1.0, 4.0), strict=True):
        scheduled.lab.post(c.Set("rate", rate))
        scheduled.display = View(lambda _: clock.work(0.001))
        thread.add(scheduled)
    thread.run()
    for scheduled, rate in zip(labs, (0.25, 1.0, 4.0), strict=True):
        assert scheduled.simulation.time == pytest.approx(2.0 * rate, rel=0.02)
        assert scheduled.achieved == pytest.approx(rate, rel=0.03)


def test_a_lab_that_raises_does_not_stop_the_others(caplog: pytest.LogCaptureFixture) -> None:
    class Broken(Lab):
        def frame(self, seconds: float) -> Frame:
            raise RuntimeError("this lab is broken")
            yield  # a generator, as any frame

    blind = ScheduledLab(new_lab())
    blind.display = View(lambda _: 1 / 0)
    broken = ScheduledLab(Broken(new_lab().simulation._loop_cache))
    broken.display = View(lambda _: None)
    with caplog.at_level(logging.ERROR):
        _, scheduled, _, _ = simulated(1.0, lambda _: 0.001, broken, blind)
    assert scheduled.simulation.time == pytest.approx(1.0, abs=0.04)
    assert blind.simulation.time == pytest.approx(
        1.0, abs=0.04
    )  # it simulates; only its view fails
    text = [record.getMessage() for record in caplog.records]
    assert sum("this lab is broken" in line for line in text) <= 3  # not at every frame
    assert any("this lab is broken" in line for line in text)


def test_time_waits_while_nobody_looks_and_commands_do_not() -> None:
    unseen = ScheduledLab(new_lab())
    unseen.lab.post(c.Set("K1", 123))
    simulated(1.0, lambda _: 0.001, unseen)
    assert unseen.simulation.time == 0.0
    assert unseen.simulation.parameters.K1 == 123


def test_paused_lab_does_not_spoil_its_measured_speed() -> None:
    clock, thread = clocked(3.0)
    scheduled = ScheduledLab(new_lab())

    def show(frame: int) -> None:
        if frame in (60, 120):
            scheduled.lab.post(c.SetRunning(frame == 120))
        clock.work(0.001)

    scheduled.display = View(show)
    thread.add(scheduled)
    thread.run()
    assert scheduled.simulation.time == pytest.approx(2.0, abs=0.05)
    assert scheduled.achieved == pytest.approx(1.0, abs=0.03)


def test_labs_come_and_go_from_other_threads_while_it_runs() -> None:
    thread = SimulationThread()
    thread.start()
    try:
        seen = threading.Event()
        labs = [ScheduledLab(new_lab()) for _ in range(4)]
        for scheduled in labs:
            scheduled.display = View(lambda _: seen.set())
        workers = [threading.Thread(target=thread.add, args=(scheduled,)) for scheduled in labs]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        assert seen.wait(5.0) and set(thread.labs) == set(labs)
        for scheduled in labs[1:]:
            thread.remove(scheduled)
        assert thread.labs == labs[:1]
        thread.remove(labs[1])  # twice does no harm
    finally:
        thread.stop()
    assert not thread.thread.is_alive()


class Asking(Lab):
    """A lab that always has a command waiting that takes some time, [s]."""

    def __init__(self, cost: float) -> None:
        self.cost, self.begun = cost, list[int]()
        self.frame_number = 0

    @property
    def has_commands(self) -> bool:
        return True

    def drain(self, most: float = 0.0) -> float:
        self.frame_number += 1
        if most <= 0:
            return 0.0
        self.begun.append(self.frame_number)
        return self.cost


class Asked(ScheduledLab):
    """Such a lab, with nothing to simulate."""

    lab: Asking

    def __init__(self, cost: float) -> None:
        self.lab, self.used, self._longest = Asking(cost), 0.0, 0.0


def spent(labs: list[Asked]) -> float:
    return sum(len(lab.lab.begun) * lab.lab.cost for lab in labs)


@pytest.mark.parametrize("cost", [1e-3, 12e-3, 60e-3])
@pytest.mark.parametrize("count", [1, 8, 40])
def test_long_work_for_many_labs_takes_a_part_of_each_frame_and_no_other_lab_waits(
    cost: float, count: int
) -> None:
    labs = [*(Asked(cost) for _ in range(count)), Asked(1e-5)]
    honest, frames, most, turns = labs[-1].lab, 4000, 0.0, CommandTurns()
    for _ in range(frames):
        before = spent(labs)
        turns.apply([*labs], ALL_COMMANDS)
        most = max(most, spent(labs) - before)
    assert most <= ALL_COMMANDS + 2 * cost  # at most one of each group is too long
    assert spent(labs) <= frames * ALL_COMMANDS + 2 * cost + 1e-9
    assert max(np.diff(honest.begun)) <= 2 + cost / ALL_COMMANDS
    assert honest.begun[-1000:] == list(range(frames - 999, frames + 1))  # it has been short lately
    counts = [len(lab.lab.begun) for lab in labs[:-1]]
    assert min(counts) > 0 and max(counts) <= 2 * min(counts) + 2  # all get their turn


@given(st.floats(0.01, 1.0))
def test_the_frames_after_a_long_command_make_up_for_it(cost: float) -> None:
    lab, turns, frames = Asked(cost), CommandTurns(), 2000
    for _ in range(frames):
        turns.apply([lab], ALL_COMMANDS)
    waits = np.diff(lab.lab.begun)
    assert len(waits) > 1 and waits.max() <= 2 + cost / ALL_COMMANDS
    assert spent([lab]) <= frames * ALL_COMMANDS + 2 * cost + 1e-9


def test_a_command_that_waits_for_others_is_not_counted_as_long() -> None:
    lab = new_lab()
    lab.post(Sleeping())
    assert lab.drain() < 0.01


class Sleeping(Command):
    """Waits without computing."""

    def apply(self, lab: Lab) -> None:
        time.sleep(0.03)


def test_commands_take_what_is_left_of_a_frame() -> None:
    """Frames stay on time when labs are many and some ask for long work without end."""
    clock, thread = clocked(10.0)

    class Greedy(Asking):
        def drain(self, most: float = 0.0) -> float:
            taken = super().drain(most)
            clock.work(taken)
            return taken

    honest = ScheduledLab(new_lab())
    honest.display = View(lambda _: clock.work(0.011))
    for _ in range(20):
        asked = Asked(1e-3)
        asked.lab, asked.display, asked.simulation = Greedy(1e-3), None, honest.simulation
        thread.add(asked)
    thread.add(honest)
    thread.run()
    assert sorted(thread.lateness)[-60] < FRAME  # all but those of the first second
    assert honest.simulation.time == pytest.approx(10.0, abs=0.2)


def test_labs_that_began_at_different_frames_need_equally_many_ticks() -> None:
    """So that they are advanced together; and 60 frames, one or two at once, are a second."""
    labs = dict[ScheduledLab, list[int]]()
    for count in range(120):
        if count in (0, 1, 2, 13, 59):
            lab = ScheduledLab(new_lab())
            lab.display = Screen(Clock(1.0), 0, 0.0)
            labs[lab] = []
        for lab, needed in labs.items():
            frame = lab.frame(FRAME, frame_length(count))
            ticks = next(frame)
            needed.append(ticks.count)
            frame.close()
    longest = max(labs.values(), key=len)
    assert all(needed == longest[-len(needed) :] for needed in labs.values())
    assert sum(longest[:60]) == sum(longest[7:67]) == 1000
    for number, ticks in enumerate(itertools.pairwise(longest)):
        assert frame_length(number, 2) == pytest.approx(sum(ticks) * TICK, abs=1e-12)


def test_other_threads_soon_hand_the_interpreter_over() -> None:
    before = sys.getswitchinterval()
    sys.setswitchinterval(FRAME)
    thread = SimulationThread()
    thread.start()
    try:
        assert sys.getswitchinterval() <= FRAME / 50
    finally:
        thread.stop()
        sys.setswitchinterval(before)


class Circle:
    """Refers to itself, so that counting references does not free it."""

    def __init__(self) -> None:
        self.itself = self


@pytest.mark.thorough
def test_old_garbage_is_collected_while_labs_run() -> None:
    """By itself, as new objects are made; what was imported before is not examined each time."""
    gc.unfreeze()  # what another test has left
    gc.collect()
    before = len(gc.get_objects())
    gc.disable()  # as while modules are imported
    thread = SimulationThread()
    thread.start()
    try:
        assert len(gc.get_objects()) < before / 2
        thing, kept = Circle(), list[Circle]()
        gc.collect(1)
        left = weakref.ref(thing)
        del thing
        while left() is not None:
            kept.append(Circle())
            assert len(kept) < 3 * before
    finally:
        thread.stop()
        gc.unfreeze()
        gc.enable()


def test_another_thread_reads_a_lab_between_two_frames_only() -> None:
    """Else a page could get the parameters of one robot with the name of another."""
    thread, inside = SimulationThread(), threading.Event()

    class Busy(Lab):
        def frame(self, seconds: float) -> Frame:
            inside.set()
            yield from super().frame(seconds)
            inside.clear()

    scheduled = ScheduledLab(Busy(new_lab().simulation._loop_cache))
    scheduled.display = View(lambda _: None)
    thread.add(scheduled)
    thread.start()
    try:
        for _ in range(20):
            assert inside.wait(10)
            assert thread.call(inside.is_set) is False
            assert thread.call(lambda: thread.call(threading.current_thread)).name == "simulation"
        with pytest.raises(KeyError, match="of the caller"):
            thread.call(lambda: {}["of the caller"])
        assert thread.call(lambda: "goes on") == "goes on"
    finally:
        thread.stop()


def test_a_caller_waits_as_long_as_a_frame_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else a page would stay without its first picture on a busy machine."""
    monkeypatch.setattr(simulation_thread, "ANSWER", 0.01)
    thread, begun, may_end = SimulationThread(), threading.Event(), threading.Event()
    looks = list[float]()

    class Slow(Lab):
        def frame(self, seconds: float) -> Frame:
            begun.set()
            assert may_end.wait(10)
            yield from super().frame(seconds)

    def waited(_: object, seconds: float) -> None:
        looks.append(seconds)
        if len(looks) > 20:
            may_end.set()
        time.sleep(seconds)

    scheduled = ScheduledLab(Slow(new_lab().simulation._loop_cache))
    scheduled.display = View(lambda _: None)
    thread.add(scheduled)
    thread.start()
    try:
        assert begun.wait(10)
        monkeypatch.setattr(simulation_thread, "wait", waited)
        assert thread.call(lambda: "at last") == "at last"
    finally:
        may_end.set()
        thread.stop()
    assert len(looks) > 20


def test_a_caller_does_not_wait_for_a_thread_that_has_ended() -> None:
    thread = SimulationThread()
    thread.start()
    thread.stop()
    with pytest.raises(RuntimeError, match="stopped"):
        thread.call(lambda: None)
