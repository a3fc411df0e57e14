"""Garbage that only a complete collection finds does not pile up while tabs come and go."""

from __future__ import annotations

import gc
import weakref
from collections.abc import Iterator

import pytest

from onpath.app.server.memory_release import MUCH, release
from onpath.app.simulation.simulation_thread import SELDOM


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


def test_garbage_is_collected_when_many_objects_have_come() -> None:
    garbage, kept = old_garbage(), list[Circle]()
    while gc.get_count()[2] < MUCH:
        assert garbage() is not None
        release()
        kept.append(Circle())
    release()
    assert garbage() is None and gc.get_count()[2] == 0
