"""Unresponsive tabs occupy no thread and no place, and late answers are accepted."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial

import pytest
import viser
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.arrivals import MOST_EACH, PAGE_KEY, Arrivals
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.secure_server import Limits, make_server
from tests.bench.client_protocol import CAMERA, SUBPROTOCOL, answer, packed, unpacked
from tests.bench.raw_socket import is_closed, knock, say
from tests.support import waiting
from tests.support.own_socket import feeds
from tests.support.student import Student

WAIT = 30.0  # [s]; only ends a test that would hang
SILENT = 200
wait_for = partial(waiting.wait_for, seconds=WAIT)


def silent(server: viser.ViserServer, source: str = "127.0.0.1") -> socket.socket:
    """A tab that connects and then sends nothing."""
    raw = knock(server.get_port(), source=source)
    say(raw, packed("ViewerCameraMessage", **CAMERA))
    return raw


def all_threads_are_free(server: viser.ViserServer) -> bool:
    """Whether all of viser's threads are free."""
    pool = server._thread_executor
    meet = threading.Barrier(pool._max_workers)
    jobs = [pool.submit(meet.wait, WAIT / 2) for _ in range(pool._max_workers)]
    return not any(job.exception() for job in jobs)


@pytest.fixture
def lab() -> Iterator[LabServer]:
    lab = LabServer("127.0.0.1", 0, LoopCache())
    yield lab
    lab.stop()


@pytest.mark.thorough
def test_silent_tabs_hold_no_thread_no_lab_and_no_place(lab: LabServer) -> None:
    address = f"ws://127.0.0.1:{lab.server.get_port()}"
    with ExitStack() as stay:
        insider = stay.enter_context(Student(address))
        insider.open()
        insider.read(lambda: insider.moving)
        tabs = [stay.enter_context(silent(lab.server)) for _ in range(SILENT)]
        oldest = [True] * (SILENT - MOST_EACH) + [False] * MOST_EACH
        wait_for(lambda: [is_closed(tab) for tab in tabs] == oldest)
        assert all_threads_are_free(lab.server)
        newcomer = stay.enter_context(Student(address))
        newcomer.open()
        newcomer.read(lambda: newcomer.moving)
        assert insider.ask("lessons")["lessons"]
        wait_for(lambda: len(feeds(lab)) == 2)
        assert len(lab.registry) == 2


def test_a_late_answer_returns_to_the_same_lab(lab: LabServer) -> None:
    with Student(f"ws://127.0.0.1:{lab.server.get_port()}") as student:
        student.open()
        student.read(lambda: student.code and student.moving)
        code = student.code
        student.close()
        wait_for(lambda: not lab.server.get_clients())
        student.open()  # and reads no question yet
        wait_for(lab.server.get_clients)
        assert all_threads_are_free(lab.server)
        student.read(lambda: student.moving)
        assert student.code == code and len(lab.registry) == 1


def test_a_browser_that_opens_a_lab_by_its_code_remembers_its_own_too(lab: LabServer) -> None:
    address = f"ws://127.0.0.1:{lab.server.get_port()}"
    with Student(address) as one, Student(address) as other:
        for student in (one, other):
            student.open()
            student.read(lambda student=student: student.code and student.moving)
        codes = [other.code, one.code]
        other.close()
        wait_for(lambda: len(lab.visits) == 1 and len(lab.registry.held()) == 1)  # it is free
        (visit,) = lab.visits
        lab._enter(visit, codes[0])
        one.read(lambda: one.code == codes[0])
        assert ",".join(codes) in one.kept.values()


# The question alone, without a lab.


class Inn:
    """A server that asks for the page."""

    def __init__(self) -> None:
        self.server = make_server(port=0, limits=Limits(farewell=0.1))
        self.let_in: list[str] = []
        self.arrivals = Arrivals(self.server, lambda _, page: self.let_in.append(page), 5, 3)

    def visit(self) -> ClientConnection:
        """A browser that has answered nothing yet."""
        address = f"ws://127.0.0.1:{self.server.get_port()}"
        versions = [Subprotocol(SUBPROTOCOL)]
        client = connect(address, subprotocols=versions, compression=None, close_timeout=1)
        client.send(packed("ViewerCameraMessage", **CAMERA))
        return client

    def settled(self, client: ClientConnection) -> None:
        """Return when everything that a client has sent so far has been handled."""
        assert client.ping().wait(WAIT)
        assert all_threads_are_free(self.server)


def answer_of(client: ClientConnection) -> bytes:
    """The message with which a browser would answer; it is not sent."""
    while True:
        raw = client.recv(WAIT)
        assert isinstance(raw, bytes)
        for message in unpacked(raw):
            if reply := answer(message, {PAGE_KEY: "a page"}):
                return reply


@pytest.fixture
def inn() -> Iterator[Inn]:
    inn = Inn()
    yield inn
    inn.server.stop()


def test_a_client_that_has_answered_enters_once(inn: Inn) -> None:
    client = inn.visit()
    with client:
        reply = answer_of(client)
        response = "LocalStorageGetItemResponseMessage"
        client.send(packed(response, request_uuid="made up", value="x", error=None))
        inn.settled(client)
        assert not inn.let_in
        client.send(reply)
        wait_for(lambda: inn.let_in)
        client.send(reply)
        inn.settled(client)
        assert inn.let_in == ["a page"]
        assert not len(inn.arrivals._silent)


def test_the_oldest_of_an_address_is_turned_away_and_then_the_oldest_of_all(inn: Inn) -> None:
    def come(source: str) -> socket.socket:
        known = len(inn.server.get_clients())
        tab = stay.enter_context(silent(inn.server, source))
        wait_for(lambda: len(inn.server.get_clients()) > known or any(map(is_closed, tabs)))
        return tab

    tabs = list[socket.socket]()
    with ExitStack() as stay:
        for source, turned_away in [
            *[("127.0.0.1", [])] * 3,
            ("127.0.0.1", [0]),
            *[("127.0.0.2", [0])] * 2,
            ("127.0.0.3", [0, 1]),
            ("127.0.0.1", [0, 1, 2]),
        ]:
            tabs.append(come(source))
            gone = [tabs[number] for number in turned_away]
            wait_for(lambda gone=gone: all(map(is_closed, gone)))
            assert [n for n, tab in enumerate(tabs) if is_closed(tab)] == turned_away
    wait_for(lambda: not len(inn.arrivals._silent))  # who leaves is not waited for
    assert not inn.let_in
