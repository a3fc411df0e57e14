"""The threads that need the interpreter share a processor, unless others need that, too."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace

import pytest

from onpath.app.common.processors import ALL, KNOWN, Times, processor, run_anywhere
from onpath.app.exports.exporter import process
from onpath.app.server import shared_processor
from onpath.app.server.shared_processor import REST, TERM, SharedProcessor

pytestmark = pytest.mark.skipif(not KNOWN, reason="the system does not say where threads run")


@pytest.fixture(autouse=True)
def _everywhere_again() -> Iterator[None]:
    yield
    run_anywhere()


@contextmanager
def waiting(name: str) -> Iterator[threading.Thread]:
    """A thread that does nothing."""
    ends = threading.Event()
    thread = threading.Thread(target=ends.wait, name=name)
    thread.start()
    yield thread
    ends.set()
    thread.join()


def allowed(thread: threading.Thread) -> set[int]:
    """The processors on which a thread may run."""
    assert thread.native_id is not None
    return os.sched_getaffinity(thread.native_id)


def test_threads_share_the_processor_of_the_first_and_others_run_anywhere() -> None:
    os.sched_setaffinity(0, {max(ALL)})  # moves this thread there, and it runs
    with waiting("network") as network:
        own = threading.current_thread()
        assert own.native_id and processor(own.native_id) == max(ALL)
        SharedProcessor([own, network]).look()
        assert allowed(own) == allowed(network) == {max(ALL)}
        with waiting("started") as started:
            assert allowed(started) == {max(ALL)}
    run_anywhere()
    with waiting("first") as first, waiting("other") as other:
        SharedProcessor([first]).look()
        assert len(allowed(first)) == 1 and allowed(other) == ALL


def test_threads_run_anywhere_for_a_while_when_others_crowd_the_processor(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    waited = 0.0
    monkeypatch.setattr(shared_processor, "times", lambda _: Times(0.0, waited))
    with waiting("first") as first, waiting("second") as second:
        shared = SharedProcessor([first, second])
        shared.look()
        assert len(allowed(first)) == 1 and allowed(first) == allowed(second)
        waited = 1e6  # [s]
        shared.look()
        assert allowed(first) == allowed(second) == ALL
        for _ in range(REST - 1):
            shared.look()
            assert allowed(first) == ALL
        shared.look()
        assert len(allowed(first)) == 1


@pytest.mark.parametrize(("others", "shares"), [(0.7, True), (0.4, False)])
def test_waiting_for_this_process_s_own_threads_is_no_crowding(
    others: float, shares: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a second, the first runs 0.2 s and waits 0.7 s, while this process's others run."""
    now = iter(range(1, 100))
    seconds = 0.0

    def own_times(_: int) -> Times:
        nonlocal seconds
        seconds = next(now)
        return Times(0.2 * seconds, 0.7 * seconds)

    clock = SimpleNamespace(
        monotonic=lambda: 100.0 + seconds, process_time=lambda: (0.2 + others) * seconds
    )
    monkeypatch.setattr(shared_processor, "time", clock)
    monkeypatch.setattr(shared_processor, "times", own_times)
    with waiting("first") as first:
        shared = SharedProcessor([first])
        for _ in range(3):
            shared.look()
        assert (len(allowed(first)) == 1) == (shares or len(ALL) == 1)


def test_the_system_chooses_anew_after_a_term(monkeypatch: pytest.MonkeyPatch) -> None:
    """For one look the threads run anywhere."""
    monkeypatch.setattr(shared_processor, "times", lambda _: Times(1.0, 0.0))
    with waiting("first") as first:
        shared = SharedProcessor([first])
        shares = list[bool]()
        for _ in range(2 * TERM):
            shared.look()
            shares.append(len(allowed(first)) == 1)
        assert shares == [i % (TERM + 1) != TERM for i in range(2 * TERM)] or len(ALL) == 1
        shared.release()


def test_what_has_been_started_is_released_too() -> None:
    with waiting("first") as first:
        shared = SharedProcessor([first, threading.current_thread()])
        shared.look()
        with waiting("started") as started:
            shared.release()
            assert allowed(first) == allowed(started) == os.sched_getaffinity(0) == ALL


def test_nothing_happens_where_the_system_does_not_say(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown(_: int) -> Times:
        raise FileNotFoundError

    monkeypatch.setattr(shared_processor, "times", unknown)
    SharedProcessor([threading.current_thread()]).look()
    assert os.sched_getaffinity(0) == ALL


def test_a_process_that_writes_files_runs_on_all_processors() -> None:
    os.sched_setaffinity(0, {min(ALL)})
    found = list[set[int]]()
    thread = threading.Thread(target=lambda: (run_anywhere(), found.append(_of_child())))
    thread.start()
    thread.join()
    process.stop()
    assert found == [ALL]


def _of_child() -> set[int]:
    return process.call(60.0, os.sched_getaffinity, 0)
