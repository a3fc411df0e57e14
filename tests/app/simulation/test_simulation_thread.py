"""One thread, all labs, 60 frames a second; late frames cost simulated time and nothing else."""

from __future__ import annotations

import itertools
import logging
import threading
from collections.abc import Callable
from math import ceil

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.session import Session
from onpath.app.simulation.display_rate import HURRIED, STRIDES, is_turn
from onpath.app.simulation.simulation_thread import LATEST, Lab, SimulationThread
from tests.support.lab import FRAME, new_session


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
    """A thread that runs for so long, by a clock of its own."""
    clock = Clock(seconds)
    clock.thread = SimulationThread(clock, clock.sleep)
    return clock, clock.thread


class View:
    """Looks for a while at every frame."""

    def __init__(self, work: Callable[[int], object]) -> None:
        self.work = work
        self.shown: list[tuple[float, float, int]] = []

    def show(self, session: Session, achieved: float, frame: int, stride: float) -> None:
        self.shown.append((session.time, achieved, frame))
        self.work(frame)

    def send(self) -> None:
        pass


class Screen:
    """Draws when it is its turn, which takes so long, [s]."""

    def __init__(self, clock: Clock, offset: int, cost: float) -> None:
        self.clock, self.offset, self.cost = clock, offset, cost
        self.drawn = list[int]()

    def show(self, session: Session, achieved: float, frame: int, stride: float) -> None:
        if is_turn(frame + self.offset, stride):
            self.drawn.append(frame)
            self.clock.work(self.cost)

    def send(self) -> None:
        pass


def drawn(
    seconds: float, cost: Callable[[int], float], drawing: float, count: int = 8
) -> tuple[SimulationThread, list[Lab], list[Screen]]:
    """The same with labs that are drawn.

    Args:
        cost: of each frame's simulation, [s].
        drawing: drawing each of them once, [s].
    """
    clock, thread = clocked(seconds)
    labs = [Lab(new_session()) for _ in range(count)]
    frames = itertools.count()

    class Costly(Session):
        def advance(self, seconds: float) -> None:
            super().advance(seconds)
            clock.work(cost(next(frames)))

    labs[0] = Lab(Costly(new_session()._store))
    screens = [Screen(clock, at, drawing / count) for at in range(count)]
    for lab, screen in zip(labs, screens, strict=True):
        lab.view = screen
        thread.add(lab)
    thread.run()
    return thread, labs, screens


def simulated(
    seconds: float, cost: Callable[[int], float], *others: Lab
) -> tuple[SimulationThread, Lab, View, Clock]:
    """Some seconds of a thread whose frames cost as much as `cost` says."""
    clock, thread = clocked(seconds)
    lab = Lab(new_session())
    lab.view = view = View(lambda frame: clock.work(cost(frame)))
    for other in others:
        thread.add(other)
    thread.add(lab)
    thread.run()
    return thread, lab, view, clock


def test_sixty_frames_a_second_each_on_time() -> None:
    thread, lab, view, _ = simulated(3.0, lambda _: 0.004)
    assert len(view.shown) == pytest.approx(180, abs=2)
    assert lab.session.time == pytest.approx(3.0, abs=0.04)
    assert max(thread.lateness) < 1e-9
    assert lab.achieved == pytest.approx(1.0, abs=0.02)
    assert [frame for _, _, frame in view.shown] == list(range(len(view.shown)))


def test_slow_frames_slow_simulated_time_visibly() -> None:
    thread, lab, _, _ = simulated(4.0, lambda _: 2.5 * FRAME)
    assert lab.session.time == pytest.approx(4.0 / 2.5, rel=0.05)
    assert lab.achieved == pytest.approx(1 / 2.5, rel=0.05)
    assert max(thread.lateness) <= LATEST + 2.5 * FRAME  # it never piles up


def test_after_a_stall_it_goes_on_at_its_pace() -> None:
    cost = 5.0

    def stall(frame: int) -> float:
        return cost if frame == 30 else 0.001

    _, lab, view, _ = simulated(10.0, stall)
    assert lab.session.time == pytest.approx(10.0 - cost, abs=0.1)  # the stall is not made up for
    steps = [b[0] - a[0] for a, b in zip(view.shown, view.shown[1:], strict=False)]
    assert max(steps) < FRAME + 2e-3
    assert lab.achieved == pytest.approx(1.0, abs=0.15)  # and is forgotten again


def test_short_hiccups_are_made_up_for() -> None:
    _, lab, _, _ = simulated(4.0, lambda frame: 0.05 if frame % 40 == 7 else 0.001)
    assert lab.session.time == pytest.approx(4.0, abs=0.06)


def test_frames_that_are_late_are_drawn_less_often_until_they_no_longer_are() -> None:
    """Two thirds of the time are taken: 16 late frames at the usual pace, half as many so."""
    thread, _, screens = drawn(8.0, lambda at: 0.095 if at == 300 else 0.005, drawing=0.015)
    late = [at for at, late in enumerate(thread.lateness) if late > FRAME]
    assert 3 <= len(late) <= 8 and late[0] == 301
    for screen in screens:
        gaps = [b - a for a, b in itertools.pairwise(screen.drawn)]
        assert max(gaps) < HURRIED + STRIDES[1]  # a turn may be left out when that ends
        assert max(gaps[-60:]) <= ceil(STRIDES[1])


def test_drawing_gives_way_before_simulated_time_does() -> None:
    """At the slowest pace there is too much to do; when hurried, there is not."""
    thread, labs, screens = drawn(20.0, lambda _: 0.008, drawing=0.040)
    for lab, screen in zip(labs, screens, strict=True):
        assert lab.session.time == pytest.approx(20.0, abs=2 * LATEST)  # until the cost is known
        assert lab.achieved == pytest.approx(1.0, abs=0.01)
        assert len(screen.drawn) > 20.0 * 60 / HURRIED
    assert max(thread.lateness[60:]) < 0.05


def test_late_frames_of_what_costs_nothing_to_draw_are_drawn_as_ever() -> None:
    _, _, (screen,) = drawn(8.0, lambda at: 0.05 if at % 20 == 0 else 0.010, 0.001, count=1)
    assert max(b - a for a, b in itertools.pairwise(screen.drawn)) <= ceil(STRIDES[1])


def test_simulated_time_follows_the_wanted_speed() -> None:
    clock, thread = clocked(2.0)
    labs = [Lab(new_session()) for _ in range(3)]
    for lab, rate in zip(labs, (0.25, 1.0, 4.0), strict=True):
        lab.session.post(c.SetRate(rate))
        lab.view = View(lambda _: clock.work(0.001))
        thread.add(lab)
    thread.run()
    for lab, rate in zip(labs, (0.25, 1.0, 4.0), strict=True):
        assert lab.session.time == pytest.approx(2.0 * rate, rel=0.02)
        assert lab.achieved == pytest.approx(rate, rel=0.03)


def test_a_lab_that_raises_does_not_stop_the_others(caplog: pytest.LogCaptureFixture) -> None:
    class Broken(Session):
        def advance(self, seconds: float) -> None:
            raise RuntimeError("this lab is broken")

    blind = Lab(new_session())
    blind.view = View(lambda _: 1 / 0)
    broken = Lab(Broken(new_session()._store))
    broken.view = View(lambda _: None)
    with caplog.at_level(logging.ERROR):
        _, lab, _, _ = simulated(1.0, lambda _: 0.001, broken, blind)
    assert lab.session.time == pytest.approx(1.0, abs=0.04)
    assert blind.session.time == pytest.approx(1.0, abs=0.04)  # it simulates; only its view fails
    text = [record.getMessage() for record in caplog.records]
    assert sum("this lab is broken" in line for line in text) <= 3  # not at every frame
    assert any("this lab is broken" in line for line in text)


def test_time_waits_while_nobody_looks_and_commands_do_not() -> None:
    unseen = Lab(new_session())
    unseen.session.post(c.SetParameter("K1", 123))
    simulated(1.0, lambda _: 0.001, unseen)
    assert unseen.session.time == 0.0
    assert unseen.session.parameters.K1 == 123


def test_paused_lab_does_not_spoil_its_measured_speed() -> None:
    clock, thread = clocked(3.0)
    lab = Lab(new_session())

    def show(frame: int) -> None:
        if frame in (60, 120):
            lab.session.post(c.SetRunning(frame == 120))
        clock.work(0.001)

    lab.view = View(show)
    thread.add(lab)
    thread.run()
    assert lab.session.time == pytest.approx(2.0, abs=0.05)
    assert lab.achieved == pytest.approx(1.0, abs=0.03)


def test_labs_come_and_go_from_other_threads_while_it_runs() -> None:
    thread = SimulationThread()
    thread.start()
    try:
        seen = threading.Event()
        labs = [Lab(new_session()) for _ in range(4)]
        for lab in labs:
            lab.view = View(lambda _: seen.set())
        workers = [threading.Thread(target=thread.add, args=(lab,)) for lab in labs]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        assert seen.wait(5.0) and set(thread.labs) == set(labs)
        for lab in labs[1:]:
            thread.remove(lab)
        assert thread.labs == labs[:1]
        thread.remove(labs[1])  # twice does no harm
    finally:
        thread.stop()
    assert not thread._thread.is_alive()
