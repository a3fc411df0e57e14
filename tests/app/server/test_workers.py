"""Several processes behind one address: a lab survives its process, and all end together."""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
import viser

from onpath.app.cli.main import run_command
from onpath.app.exports.export_process import ExportProcess
from onpath.app.server.workers import Worker, shares
from onpath.app.storage.database_url import DATABASE, database_url
from onpath.app.viser_adapter import secure_server as hardening
from onpath.app.viser_adapter.request_filter import RequestFilter
from onpath.app.viser_adapter.sockets import PortInUse, listen, reserve
from tests.support.student import Student
from tests.support.supervisor import Supervisor
from tests.support.waiting import wait_for

linux_only = pytest.mark.skipif(sys.platform != "linux", reason="tried on Linux only")


@pytest.fixture
def supervisor(tmp_path: Path) -> Iterator[Supervisor]:
    made = Supervisor(tmp_path, "--workers", "2", "--port", "0")
    yield made
    made.end()


@pytest.mark.thorough
@linux_only
def test_a_lab_survives_its_worker_on_a_shared_port(supervisor: Supervisor) -> None:
    supervisor.wait_for(r"^\[worker [12]\] INFO .*OnPath is ready", times=2)
    (port,) = supervisor.wait_for(r"2 workers at http://localhost:(\d+)")
    before = supervisor.workers()
    with Student(f"ws://127.0.0.1:{port}") as student:
        student.open()
        student.set("K2", 44.0)
        student.set("Path", "clover")
        student.read(lambda: supervisor.has_kept(student.code, "'K2': 44.0", "'clover'"))
        (serving,) = [worker for worker in before if supervisor.sockets(worker)]
        os.kill(serving, signal.SIGKILL)
        code = student.code
        student.wait_until_closed()
        student.reopen()
        assert student.find("K2")["value"] == 44.0 and student.code == code
        assert student.find("Path")["value"] == "clover"
    supervisor.wait_for(r"worker . has ended")
    wait_for(lambda: len(set(supervisor.workers()) - {serving}) == 2, 60.0)
    after = supervisor.workers()
    supervisor.process.send_signal(signal.SIGINT)
    assert supervisor.process.wait(15) == 0
    assert not any(Path(f"/proc/{worker}").exists() for worker in after)


@linux_only
def test_the_database_is_on_no_worker_s_command_line(supervisor: Supervisor) -> None:
    """Its URL may hold a password, and all users of the machine see command lines."""
    supervisor.wait_for(r"^\[worker [12]\] INFO .*OnPath is ready", times=2)
    workers = supervisor.workers()
    assert len(workers) == 2
    for worker in workers:
        command = Path(f"/proc/{worker}/cmdline").read_bytes().split(b"\0")
        assert b"onpath" in command and b"--database" not in command
        assert not any(b"labs.db" in word for word in command)
        opened = [os.readlink(file) for file in Path(f"/proc/{worker}/fd").iterdir()]
        assert any(name.endswith("/labs.db") for name in opened)


def test_child_processes_do_not_inherit_the_database(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(DATABASE, "sqlite:///secret.db")
    assert database_url("sqlite://") == "sqlite://"
    monkeypatch.setenv(DATABASE, "sqlite:///secret.db")
    assert database_url(None) == "sqlite:///secret.db" and database_url(None) is None
    exports = ExportProcess()
    try:
        assert exports.call(60.0, os.getenv, DATABASE) is None
    finally:
        exports.stop()


@pytest.mark.parametrize("cores", [[], [3], [0, 1], [0, 2, 4, 6], list(range(7))])
@pytest.mark.parametrize("workers", [1, 2, 3, 5])
def test_each_worker_has_its_own_cores_and_none_is_left_idle(
    cores: list[int], workers: int
) -> None:
    given = shares(cores, workers)
    assert len(given) == workers and all(given) == bool(cores)
    assert frozenset[int]().union(*given) == set(cores)
    if len(cores) >= workers:
        assert sum(map(len, given)) == len(cores)


def test_what_cannot_be_is_said_once() -> None:
    with listen("127.0.0.1", 0, share_port=True) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(PortInUse, match="in use"):
            reserve("127.0.0.1", port)
        with listen("127.0.0.1", port, share_port=True):
            pass
    for options in (
        ["0"],
        ["65"],
        ["2", "--classroom", "--database", "sqlite://"],
        ["2", "--socket", "x"],
        ["2", "--keep-days", "0"],
        ["2", "--most-labs", "0"],
    ):
        assert run_command(["--workers", *options]) == 2
    useless = Worker(1, [sys.executable, "-c", "raise SystemExit(2)"])
    useless.start()
    with pytest.raises(ValueError, match="worker 1 cannot start"):
        while True:
            useless.look()


def test_who_comes_while_a_server_starts_waits_and_is_let_in(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    genuine = hardening.harden
    page: list[int] = []

    def ask() -> None:
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/health", timeout=9) as reply:
            page.append(reply.status)

    async def let_wait(requests: RequestFilter) -> None:
        assert not requests.open
        waits.set()
        await opened(requests)

    def slow(server: viser.ViserServer, *, limits: hardening.Limits) -> None:
        asking.start()
        assert waits.wait(9) and not page
        genuine(server, limits=limits)

    asking, waits, opened = threading.Thread(target=ask), threading.Event(), hardening._opened
    monkeypatch.setattr(hardening, "_opened", let_wait)
    monkeypatch.setattr(hardening, "harden", slow)
    server = hardening.make_server(port=port)
    asking.join(9)
    server.stop()
    assert page == [200]
