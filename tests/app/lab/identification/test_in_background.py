"""Identification takes longer than a frame, and delays neither its own lab nor others."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Iterator

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.identification import in_background
from onpath.app.lab.identification.identify import Learned, learn
from onpath.app.lab.identification.in_background import Identification
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.segments import HistoryCopy
from onpath.models.systems.robots import Robot
from tests.support.lab import do, run
from tests.support.waiting import wait_for

SECONDS = 3.0  # of motion
LONGEST = 10.0  # [s] to wait


class SlowThread:
    """Identification that goes on only when it may.

    Attributes:
        begun: number of identifications.
        may_end: set to let them end.
    """

    def __init__(self) -> None:
        self.begun, self.may_end = 0, threading.Event()

    def learn(self, robot: Robot, history: HistoryCopy) -> Learned:
        self.begun += 1
        self.may_end.wait(LONGEST)
        return learn(robot, history)


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> Iterator[SlowThread]:
    slow = SlowThread()
    monkeypatch.setattr(in_background, "learn", slow.learn)
    yield slow
    slow.may_end.set()


@pytest.fixture(scope="module")
def loop_cache() -> Iterator[LoopCache]:
    loop_cache = LoopCache(at_once=True)
    yield loop_cache
    loop_cache.close()


@pytest.fixture
def lab(loop_cache: LoopCache) -> Lab:
    lab = Lab(loop_cache)
    lab.identification = Identification()
    do(lab, c.Set("error_M11", 30), c.Set("speed", 6.0))
    run(lab, SECONDS)
    return lab


def error_of(lab: Lab) -> float:
    """By how much the controllers' M11 is wrong, [%]."""
    return dataclasses.asdict(lab.simulation.parameters)["error_M11"]


def has_learned(lab: Lab) -> bool:
    lab.drain()
    return bool(lab.message)


def test_a_lab_goes_on_until_its_robot_is_identified(lab: Lab, slow: SlowThread) -> None:
    time = lab.simulation.time
    do(lab, c.Identify(), c.Identify())
    run(lab, 0.5)
    assert lab.simulation.time == pytest.approx(time + 0.5, abs=0.02)
    assert error_of(lab) == 30 and not lab.message
    slow.may_end.set()
    wait_for(lambda: has_learned(lab), LONGEST)
    assert "M11 = 0.0226" in lab.message
    assert abs(error_of(lab)) < 1
    assert slow.begun == 1


def test_what_was_learned_of_another_robot_is_not_used(
    lab: Lab, loop_cache: LoopCache, slow: SlowThread
) -> None:
    do(lab, c.Identify(), c.ChooseRobot("two_link_arm"), c.ChooseRobot("flexible"))
    before = lab.simulation.parameters
    slow.may_end.set()
    next_one = Lab(loop_cache)
    next_one.identification = Identification()
    do(next_one, c.Identify())
    wait_for(lambda: has_learned(next_one), LONGEST)  # and so it is the other's turn no more
    lab.drain()
    assert lab.simulation.parameters == before and not lab.message


def test_many_labs_are_identified_one_after_the_other(
    loop_cache: LoopCache, slow: SlowThread
) -> None:
    labs = [Lab(loop_cache) for _ in range(3)]
    for each in labs:
        each.identification = Identification()
    do(labs[0], c.Identify())
    wait_for(lambda: slow.begun, LONGEST)
    for lab in labs:
        do(lab, c.Identify())
    assert slow.begun == 1
    slow.may_end.set()
    wait_for(lambda: all([has_learned(lab) for lab in labs]), LONGEST)
    assert slow.begun == len(labs)
