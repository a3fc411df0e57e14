"""The scenes of sixty simultaneous clients are built one at a time."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import ExitStack
from types import SimpleNamespace

import pytest

from onpath.app.exports import exporter
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.scene import build_queue
from onpath.app.scene.build_queue import LONG, REST, BuildLock
from onpath.app.scene.client_scene import ClientScene
from onpath.app.server.lab_server import LabServer
from tests.support.own_socket import feeds
from tests.support.student import Student
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

CROWD = 6


class Builds:
    """What is built, how many at a time, and what happens in between.

    Attributes:
        may_begin: until it is set, the first scene is under construction.
        rests: pauses before a build, in seconds of a clock that each build advances by one.
    """

    def __init__(self) -> None:
        self.done, self.most, self._now, self._time = 0, 0, 0, 0.0
        self.may_begin = threading.Event()
        self.rests: list[float] = []

    def watch(self, monkeypatch: pytest.MonkeyPatch) -> None:
        genuine = ClientScene._build

        def build(scene: ClientScene, first: PageSnapshot) -> None:
            self._now += 1
            self.most = max(self.most, self._now)
            assert self.may_begin.wait(60)
            genuine(scene, first)
            self._now -= 1
            self._time += 1.0
            self.done += 1

        monkeypatch.setattr(ClientScene, "_build", build)
        self.time_by_hand(monkeypatch)
        monkeypatch.setattr(build_queue.one_at_a_time, "_free_at", 0.0)

    def time_by_hand(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Have the queue's time pass with builds, rests and `pass_` alone."""
        clock = SimpleNamespace(monotonic=lambda: self._time, sleep=self._rest)
        monkeypatch.setattr(build_queue, "time", clock)

    def pass_(self, seconds: float) -> None:
        self._time += seconds

    def _rest(self, seconds: float) -> None:
        if seconds > 0:
            self.rests.append(seconds)
        self._time += seconds


@pytest.fixture
def server() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache())
    yield server
    server.stop()


@pytest.fixture
def builds(monkeypatch: pytest.MonkeyPatch) -> Builds:
    builds = Builds()
    builds.watch(monkeypatch)
    return builds


def wait_for_clients(server: LabServer, count: int) -> None:
    wait_for(lambda: len(server.server.get_clients()) == count, 60)


def wait_for_queue(server: LabServer, count: int) -> None:
    """Wait until so many wait in the queue; both a page's client and its lab ask for its scene."""
    wait_for(lambda: server._newcomers._pool._work_queue.qsize() >= count, 60)


def wait_for_views(server: LabServer, count: int) -> None:
    wait_for(lambda: len(feeds(server)) == count, 60)


class Comer(threading.Thread):
    """A student who looks until a robot moves, or until it is time to leave."""

    def __init__(self, address: str) -> None:
        super().__init__(daemon=True)
        self.student, self.leaves = Student(address), threading.Event()

    def run(self) -> None:
        self.student.open()
        self.student.read(lambda: self.student.moving > 0 or self.leaves.is_set())
        if self.leaves.is_set():
            self.student.__exit__()


def test_scenes_are_built_one_at_a_time(server: LabServer, builds: Builds) -> None:
    address = f"ws://127.0.0.1:{server.server.get_port()}"
    with ExitStack() as stay:
        crowd = [Comer(address) for _ in range(CROWD)]
        for comer in crowd:
            stay.enter_context(comer.student)
            comer.start()
        wait_for_queue(server, CROWD - 1)
        builds.may_begin.set()
        for comer in crowd:
            comer.join(60)
        wait_for_views(server, CROWD)
        assert builds.done == CROWD and builds.most == 1
        assert builds.rests == (CROWD - 1) * [REST * LONG]  # between two pages
        for visit in server.visits:  # the sun sets for all
            visit.look.dark = True
        wait_for(lambda: builds.done >= 2 * CROWD, 60)
        assert builds.most == 1


def test_a_build_that_follows_another_rests_for_as_long_as_it_works(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """So the simulation gets the processor in between; a first build, and a short one, do not."""
    lock, clock = BuildLock(), Builds()
    clock.time_by_hand(monkeypatch)

    def build() -> list[float]:
        clock.rests.clear()
        with lock:
            for _ in range(3):
                clock.pass_(0.01)
                lock.rest()
            clock.pass_(0.01)
            lock.finish()
        return list(clock.rests)

    clock.pass_(60.0)
    assert build() == []
    assert build() == pytest.approx([REST * 0.04, 0.01, 0.01, 0.01])
    assert build() == pytest.approx([REST * 0.04 - 0.03, 0.01, 0.01, 0.01])
    clock.pass_(60.0)
    assert build() == []
    other = threading.Thread(target=lock.rest)  # of a thread that builds nothing
    with lock:
        clock.rests.clear()
        clock.pass_(0.01)
        other.start()
        other.join()
    assert not clock.rests


def test_a_file_that_is_being_made_does_not_delay_the_scene(
    server: LabServer, builds: Builds, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, over = threading.Event(), threading.Event()
    monkeypatch.setattr(exporter.process, "call", lambda *_: (begun.set(), over.wait(), b"")[2])
    builds.may_begin.set()
    comer = Comer(f"ws://127.0.0.1:{server.server.get_port()}")
    with comer.student:
        comer.run()
        wait_for_views(server, 1)
        (lab,) = server.thread.labs
        wait_for(lambda: lab.simulation.time > 0, 60)  # its loops are compiled first
        comer.student.tell({"is": "make", "file": "table"})
        comer.student.read(begun.is_set)
        (visit,) = server.visits
        visit.look.dark = True
        wait_for(lambda: builds.done == 2, 60)
        over.set()


def test_no_scene_is_built_for_a_client_that_leaves_while_waiting(
    server: LabServer, builds: Builds
) -> None:
    address = f"ws://127.0.0.1:{server.server.get_port()}"
    crowd = [Comer(address) for _ in range(CROWD)]
    for number, comer in enumerate(crowd):
        comer.start()
        wait_for_queue(server, number)
    for comer in crowd[3:]:
        comer.leaves.set()
    wait_for_clients(server, 3)
    builds.may_begin.set()
    for comer in crowd:
        comer.join(60)
    inside = [comer for comer in crowd if comer.student.moving]
    wait_for_views(server, len(inside))
    assert builds.done == len(inside) < CROWD
    for comer in inside:
        comer.student.__exit__()
    wait_for_views(server, 0)
    wait_for(lambda: all(lab.display is None for lab in server.thread.labs), 60)
    assert not server.registry.held()
