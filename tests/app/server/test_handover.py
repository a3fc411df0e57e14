"""Connections handed from process to process: evenly, and never to a dead one."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest

from onpath.app.server.handover import CHANNEL, HandoverSocket, Reception, handover_socket
from onpath.app.viser_adapter.sockets import listen

ADDRESS = ("127.0.0.1", 4711)


class Desk:
    """A reception, and workers in the same process."""

    def __init__(self) -> None:
        listener = listen("127.0.0.1", 0)
        self.address = listener.getsockname()
        self.reception = Reception(listener)
        self.callers: list[socket.socket] = []

    def worker(self, ready: bool = True) -> HandoverSocket:
        made = HandoverSocket(self.reception.join().detach(), ADDRESS)
        made.setblocking(False)
        if ready:
            made.listen()
        return made

    def call(self, times: int = 1) -> None:
        for _ in range(times):
            self.callers.append(socket.create_connection(self.address, timeout=5.0))
        self.settle()

    def settle(self) -> None:
        for _ in range(100):
            self.reception.attend(0.0)


def accepted(worker: HandoverSocket) -> list[socket.socket]:
    """All that wait."""
    got: list[socket.socket] = []
    while True:
        try:
            got.append(worker.accept()[0])
        except BlockingIOError:
            return got


@pytest.fixture
def desk() -> Iterator[Desk]:
    made = Desk()
    yield made
    made.reception.close()
    for caller in made.callers:
        caller.close()


def test_each_gets_as_many_as_the_others(desk: Desk) -> None:
    workers = [desk.worker() for _ in range(3)]
    desk.call(31)
    served = [accepted(worker) for worker in workers]
    assert sorted(map(len, served)) == [10, 10, 11]
    for connection in served[1][:5]:
        connection.close()
        connection.close()  # said once
    desk.settle()
    desk.call(5)
    assert [len(accepted(worker)) for worker in workers] == [0, 5, 0]


def test_what_is_handed_over_is_the_connection(desk: Desk) -> None:
    worker = desk.worker()
    desk.call()
    connection, address = worker.accept()
    with connection:
        assert address == desk.callers[0].getsockname()
        desk.callers[0].sendall(b"hello")
        connection.settimeout(5.0)
        assert connection.recv(5) == b"hello"
    assert worker.getsockname() == ADDRESS


def test_who_comes_too_early_waits(desk: Desk) -> None:
    slow = desk.worker(ready=False)
    desk.call(2)
    assert not accepted(slow)
    slow.listen()
    desk.settle()
    assert len(accepted(slow)) == 2
    later = desk.worker(ready=False)
    desk.call(2)
    assert (len(accepted(slow)), len(accepted(later))) == (2, 0)


def test_who_has_ended_gets_nothing(desk: Desk) -> None:
    first, second = desk.worker(), desk.worker()
    desk.call(4)
    assert len(accepted(first)) == len(accepted(second)) == 2
    second.close()
    desk.call(2)  # the first of these finds out
    assert len(accepted(first)) == 2
    first.close()
    desk.settle()
    desk.call(1)
    third = desk.worker()
    desk.settle()
    assert len(accepted(third)) == 1


def test_who_comes_as_the_last_worker_ends_waits(desk: Desk) -> None:
    desk.worker().close()
    desk.call(1)
    last = desk.worker()
    desk.settle()
    assert not accepted(last)[1:]
    last.close()
    desk.call(1)  # both are noticed at once
    again = desk.worker()
    desk.settle()
    assert len(accepted(again)) == 1


def test_who_is_stuck_is_passed_over(desk: Desk) -> None:
    stuck, other = desk.worker(), desk.worker()
    accepts = 0
    while True:
        waiting = len(desk.callers)
        desk.call(50)
        accepts += (got := len(accepted(other)))
        if got > 30:  # the channel of the other is full
            break
        assert waiting < 2000
    assert accepts + len(accepted(stuck)) == len(desk.callers)


def test_only_a_worker_is_handed_anything(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(CHANNEL, raising=False)
    assert handover_socket(*ADDRESS) is None
    ours, theirs = socket.socketpair()
    with ours:
        monkeypatch.setenv(CHANNEL, str(theirs.detach()))
        made = handover_socket(*ADDRESS)
        assert made is not None
        with made:
            made.listen()
            assert ours.recv(8)
