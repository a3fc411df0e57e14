"""Garbage that only a complete collection finds does not pile up while tabs come and go."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import pytest

from onpath.app.server.memory_release import MANY, MemoryRelease
from onpath.app.simulation.simulation_thread import SELDOM
from onpath.app.viser_adapter.connection_limits import CountedConnection


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
    gc.set_threshold(*before)


def old_garbage() -> weakref.ref[Circle]:
    """Something that has become old before it became garbage."""
    thing = Circle()
    gc.collect(1)
    return weakref.ref(thing)


def test_garbage_is_collected_when_many_connections_have_ended(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    garbage, memory = old_garbage(), MemoryRelease()
    monkeypatch.setattr(CountedConnection, "ended", CountedConnection.ended + MANY - 1)
    memory.look()
    assert garbage() is not None
    CountedConnection.ended += 1
    memory.look()
    assert garbage() is None
    left = old_garbage()
    memory.look()
    assert left() is not None  # nobody has left since
