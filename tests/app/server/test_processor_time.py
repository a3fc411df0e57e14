"""Silence counts by the processor: a machine that is taken away makes nothing hang."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from itertools import count
from typing import Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.server import processor_time
from onpath.app.server.processor_time import ProcessorTime, Times

SILENT, OTHER = 7, 8  # native ids
SLICE = 0.01  # [s] that a processor is given or taken away
EVERY = 50  # slices between looks
HANG = 3.0  # [s]
Does = Literal["spins", "is locked", "works", "waits for work"]


@dataclass
class Machine:
    """A process of two threads on a machine that gives it a processor for some slices only.

    Attributes:
        does: what the silent thread does; it works, or waits for the other's work, for `work` [s].
    """

    does: Does
    work: float
    now: float = 0.0

    def __post_init__(self) -> None:
        self.times = {SILENT: (0, 0), OTHER: (0, 0)}

    def run(self, gets: bool) -> None:
        """One slice."""
        silent_wants = self.does in ("spins", "works")
        other_wants = self.does == "waits for work"
        for thread, wants in ((SILENT, silent_wants), (OTHER, other_wants)):
            computed, waited = self.times[thread]
            step = round(1e9 * SLICE) if wants else 0
            self.times[thread] = (computed + step, waited) if gets else (computed, waited + step)
        if gets and self.does in ("works", "waits for work"):
            self.work -= SLICE
        self.now += SLICE

    @property
    def has_signed(self) -> bool:
        """Whether the thread has shown a sign of life at last."""
        return self.does in ("works", "waits for work") and self.work <= 0

    def threads(self) -> dict[int, Times]:
        return dict(self.times)


def silence(machine: Machine, share: float, seconds: float) -> float:
    """What counts until the thread gives a sign, at most for `seconds`."""
    clock = ProcessorTime(machine.threads, lambda: machine.now)
    counted = owed = 0.0
    for number in count(1):
        owed += share
        machine.run(owed >= 1)
        owed -= owed >= 1
        if number % EVERY == 0:
            clock.check()
            counted += clock.counted(SILENT, EVERY * SLICE)
        if machine.has_signed or number * SLICE > seconds:
            return counted
    raise AssertionError


@given(st.sampled_from(["works", "waits for work"]), st.floats(0.05, 1.0), st.floats(0.0, 0.8))
def test_a_thread_that_is_starved_does_not_hang(does: Does, share: float, part: float) -> None:
    """However little of the machine its process gets, for its own work or another thread's."""
    assert silence(Machine(does, part * HANG), share, 1000.0) < HANG


@given(st.floats(0.05, 1.0))
def test_a_thread_that_spins_hangs_once_it_has_used_enough(share: float) -> None:
    assert silence(Machine("spins", 0.0), share, (HANG + 1) / share) >= HANG


@given(st.floats(0.05, 1.0))
def test_a_thread_that_is_locked_hangs_if_nobody_takes_the_processor(share: float) -> None:
    assert silence(Machine("is locked", 0.0), share, HANG + 1) >= HANG


@pytest.mark.skipif(not processor_time.THREADS.is_dir(), reason="Linux tells it")
def test_the_system_tells_what_threads_of_this_process_do() -> None:
    over, ids = threading.Event(), dict[str, int]()

    def spin() -> None:
        ids["spins"] = threading.get_native_id()
        while not over.is_set():
            pass

    def wait() -> None:
        ids["waits"] = threading.get_native_id()
        over.wait()

    clock = ProcessorTime()
    threads = [threading.Thread(target=act) for act in (spin, wait)]
    for thread in threads:
        thread.start()
    spent = 0.0
    while spent < 0.1:
        threading.Event().wait(0.05)
        clock.check()
        spent += clock.counted(ids["spins"], 0.0)  # as a thread that waits, it would count nothing
        assert 0 <= clock.counted(ids["waits"], 0.05) <= 0.05
    over.set()
    for thread in threads:
        thread.join()


def test_where_the_system_does_not_tell_the_processor_time_counts() -> None:
    clock = ProcessorTime(dict)
    sum(range(300_000))
    clock.check()
    assert 0 < clock.counted(1, 0.0) < 60
