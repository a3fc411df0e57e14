"""What a tab that has left was made of is collected, and nothing is done while nobody leaves."""

from __future__ import annotations

import gc
import weakref

from onpath.app.lab.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.memory_release import MemoryRelease
from tests.support.student import Student
from tests.support.waiting import wait_for

WAIT = 60.0  # [s]; only ends a test that would hang


class Circle:
    """Refers to itself, so that counting references does not free it."""

    def __init__(self) -> None:
        self.itself = self


def test_garbage_is_collected_once_after_somebody_has_left() -> None:
    gc.collect()
    gc.disable()
    try:
        memory, garbage = MemoryRelease(), weakref.ref(Circle())
        memory.release()
        assert garbage() is not None
        memory.note()
        memory.release()
        assert garbage() is None
        later = weakref.ref(Circle())
        memory.release()
        assert later() is not None
    finally:
        gc.enable()


def test_a_tab_that_closes_has_left() -> None:
    server = LabServer("127.0.0.1", 0, LoopCache())
    server._memory.rounds.stop()
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.moving)
        assert not server._memory._anybody_left
    wait_for(lambda: server._memory._anybody_left, WAIT)
    server.stop()
