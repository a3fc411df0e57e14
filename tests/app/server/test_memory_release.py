"""Garbage that only a complete collection finds does not pile up while tabs come and go."""

from __future__ import annotations

import gc
import socket
import sys
import weakref
from collections.abc import Iterator

import pytest

from onpath.app.server import memory_release
from onpath.app.server.memory_release import CALM, GROWTH, MANY, TABS, MemoryRelease
from onpath.app.simulation.simulation_thread import SELDOM
from onpath.app.viser_adapter.connection_limits import CountedConnection
from onpath.app.viser_adapter.secure_server import make_server
from tests.bench.raw_socket import knock
from tests.support.waiting import wait_for

WAIT = 20.0  # [s]


class Circle:
    """Refers to itself, so that counting references does not free it."""

    def __init__(self) -> None:
        self.itself = self


@pytest.fixture(autouse=True)
def as_served() -> Iterator[None]:
    """Collections are as rare as while labs are served."""
    before = gc.get_threshold()
    gc.collect()
    gc.set_threshold(*SELDOM)
    yield
    gc.unfreeze()
    gc.set_threshold(*before)


def old_garbage() -> weakref.ref[Circle]:
    """Something that has become old before it became garbage."""
    thing = Circle()
    gc.collect(1)
    return weakref.ref(thing)


def assert_collects_no_more(memory: MemoryRelease) -> None:
    left = old_garbage()
    for _ in range(3 * CALM):
        memory.look()
    assert left() is not None


def test_garbage_is_collected_when_many_connections_have_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    garbage, memory = old_garbage(), MemoryRelease(lambda: False)
    monkeypatch.setattr(CountedConnection, "ended", CountedConnection.ended + MANY - 1)
    memory.look()
    assert garbage() is not None
    CountedConnection.ended += 1
    memory.look()
    assert garbage() is None
    left = old_garbage()
    memory.look()
    assert left() is not None  # nobody has left since


def test_what_a_dropped_lab_leaves_is_collected_once_no_tab_is_closed() -> None:
    garbage, dropped = old_garbage(), [True]
    memory = MemoryRelease(lambda: bool(dropped and dropped.pop()))
    for _ in range(CALM - 1):
        memory.look()
        assert garbage() is not None
    memory.look()
    assert garbage() is None
    assert_collects_no_more(memory)  # none has been dropped since


def test_what_a_tab_leaves_is_collected_once_no_other_is_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    memory = MemoryRelease(lambda: False)
    monkeypatch.setattr(CountedConnection, "tabs_ended", CountedConnection.tabs_ended)
    for closed in (0, 1, 1):
        garbage = old_garbage()
        CountedConnection.tabs_ended += closed
        for _ in range(CALM):
            memory.look()
            assert garbage() is not None
    memory.look()
    assert garbage() is None
    assert_collects_no_more(memory)  # nobody has left since


def test_many_tabs_that_are_closed_together_are_collected_once_no_other_one_is(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Also if a collection that was not complete has come before."""
    for name in ("ended", "tabs_ended"):
        monkeypatch.setattr(CountedConnection, name, getattr(CountedConnection, name))
    memory = MemoryRelease(lambda: False)
    page = Circle()
    CountedConnection.ended += MANY
    memory.look()  # the page is in use
    left = weakref.ref(page)
    del page
    CountedConnection.ended += MANY
    CountedConnection.tabs_ended += MANY
    for _ in range(CALM):
        memory.look()
        assert left() is not None
    memory.look()
    assert left() is None


def test_what_many_tabs_leave_is_collected_while_others_are_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name in ("ended", "tabs_ended"):
        monkeypatch.setattr(CountedConnection, name, getattr(CountedConnection, name))
    memory, page, looks = MemoryRelease(lambda: False), Circle(), 0
    CountedConnection.ended += MANY
    memory.look()  # the page is in use
    left = weakref.ref(page)
    del page
    while left() is not None:
        CountedConnection.tabs_ended += TABS // 10
        memory.look()
        looks += 1
    assert looks == 10


def test_pages_that_are_built_anew_are_collected_although_nobody_leaves(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(memory_release, "MUCH", 1_000)
    memory = MemoryRelease(lambda: False)
    garbage = old_garbage()
    memory.look()
    assert garbage() is not None
    kept = [Circle() for _ in range(1_000)]
    memory.look()
    assert garbage() is None and kept


def test_what_was_in_use_at_a_collection_is_examined_by_complete_ones_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(CountedConnection, "ended", CountedConnection.ended)
    memory = MemoryRelease(lambda: False)

    def collect() -> None:
        CountedConnection.ended += MANY
        memory.look()

    thing, old = Circle(), gc.get_freeze_count()
    collect()
    assert gc.get_freeze_count() > old
    left = weakref.ref(thing)
    del thing
    collect()
    assert left() is not None
    monkeypatch.setattr(memory_release, "MUCH", 10**9)
    kept = [Circle() for _ in range(int(GROWTH * sys.getallocatedblocks()))]
    memory.look()
    assert left() is None and kept


def test_websockets_that_end_are_counted() -> None:
    server = make_server(port=0)
    try:
        port, before = server.get_port(), CountedConnection.tabs_ended
        all_before = CountedConnection.ended
        socket.create_connection(("127.0.0.1", port)).close()
        wait_for(lambda: CountedConnection.ended == all_before + 1, WAIT)
        assert CountedConnection.tabs_ended == before
        tab = knock(port)
        assert tab.recv(1)  # the answer
        tab.close()
        wait_for(lambda: CountedConnection.tabs_ended == before + 1, WAIT)
    finally:
        server.stop()
