"""The export process may fail, die or hang: the next file is still created."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from onpath.app.exports.export_process import ExportError, ExportProcess, ExportStopped
from onpath.app.exports.files import csv_bytes, csv_file
from onpath.app.exports.worker import NICENESS
from tests.support.export_jobs import die, sleep_after_touching
from tests.support.lab import new_lab
from tests.support.waiting import wait_for

LONG = 240.0  # [s]; only ends a test that would hang


@pytest.fixture(scope="module")
def process() -> Iterator[ExportProcess]:
    process = ExportProcess()
    yield process
    process.stop()


@pytest.mark.thorough
def test_a_file_from_the_process_is_the_same_to_the_byte(process: ExportProcess) -> None:
    simulation = new_lab(0.4).simulation
    made = process.call(
        LONG, csv_file, simulation.entry.name, simulation.parameters, simulation.history.copy()
    )
    assert made == csv_bytes(simulation.robot, simulation.history.all())


@pytest.mark.thorough
def test_it_is_another_process_with_lower_priority(process: ExportProcess) -> None:
    pid = process.call(LONG, os.getpid)
    assert pid == process.pid != os.getpid()
    assert process.call(LONG, os.nice, 0) == min(os.nice(0) + NICENESS, 19)
    assert process.call(LONG, os.getpid) == pid  # it stays for the next file


def test_what_fails_is_told_and_the_process_stays(process: ExportProcess) -> None:
    pid = process.call(LONG, os.getpid)
    with pytest.raises(ExportError, match="ValueError"):
        process.call(LONG, int, "no number")
    assert process.call(LONG, os.getpid) == pid


def test_output_printed_in_the_process_is_not_taken_for_a_result(process: ExportProcess) -> None:
    assert process.call(LONG, print, "hello") is None


@pytest.mark.thorough
def test_a_crash_fails_one_call(process: ExportProcess) -> None:
    with pytest.raises(ExportError, match="died"):
        process.call(LONG, die)
    assert process.call(LONG, abs, -1) == 1


def test_a_killed_process_fails_one_call(process: ExportProcess, tmp_path: Path) -> None:
    pid, begun = process.call(LONG, os.getpid), tmp_path / "begun"

    def kill_once_begun() -> None:
        wait_for(begun.exists, LONG)
        os.kill(pid, signal.SIGKILL)

    killer = threading.Thread(target=kill_once_begun)
    killer.start()
    with pytest.raises(ExportError, match="died"):
        process.call(LONG, sleep_after_touching, begun, LONG)
    killer.join()
    assert process.call(LONG, os.getpid) != pid


@pytest.mark.thorough
def test_what_takes_too_long_is_given_up(process: ExportProcess, tmp_path: Path) -> None:
    process.call(LONG, abs, -1)  # it has been started
    with pytest.raises(ExportError, match="ended after"):
        process.call(0.1, sleep_after_touching, tmp_path / "begun", LONG)
    with pytest.raises(ExportError, match="before its turn"):
        process.call(0.0, abs, -1)
    assert process.call(LONG, abs, -1) == 1


def test_calls_of_many_threads_wait_for_each_other(process: ExportProcess) -> None:
    found: list[int] = []
    threads = [
        threading.Thread(target=lambda n=n: found.append(process.call(LONG, abs, -n)))
        for n in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(LONG)
    assert sorted(found) == list(range(8))


@pytest.mark.thorough
def test_an_idle_process_is_ended_and_started_again() -> None:
    process = ExportProcess(idle=0.0)
    assert process.pid is None  # nothing is started before it is needed
    for _ in range(2):
        assert process.call(LONG, abs, -1) == 1
        wait_for(lambda: process.pid is None, LONG)


class Noticed(float):
    """A number that tells when it is compared for the first time."""

    def __new__(cls, value: float) -> Noticed:
        made = super().__new__(cls, value)
        made.event = threading.Event()
        return made

    event: threading.Event

    def __le__(self, other: float) -> bool:
        self.event.set()
        return super().__le__(other)


@pytest.mark.thorough
def test_stopping_ends_the_calls_that_are_under_way_or_wait(tmp_path: Path) -> None:
    process, begun, noticed = ExportProcess(), tmp_path / "begun", Noticed(LONG)
    with ThreadPoolExecutor(2) as pool:
        running = pool.submit(process.call, LONG, sleep_after_touching, begun, LONG)
        wait_for(begun.exists, LONG)
        waiting = pool.submit(process.call, noticed, abs, -1)
        assert noticed.event.wait(LONG)  # the call has begun, and waits for its turn
        process.stop()
        for call in (running, waiting):
            assert isinstance(call.exception(LONG), ExportStopped)
    assert process.pid is None
    assert process.call(LONG, abs, -1) == 1  # a later one starts it again
    process.stop()
