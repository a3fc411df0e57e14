"""How a server starts: with its database, or not at all, and at an address that a browser opens."""

from __future__ import annotations

import logging
import socket
import sqlite3
import subprocess
import sys
import urllib.request
from collections.abc import Callable
from contextlib import ExitStack, closing
from pathlib import Path
from typing import Any

import pytest

from onpath.app.cli.main import INTERRUPTED, run_command
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server import lab_server
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.storage import records
from onpath.app.storage.database_url import DATABASE
from onpath.app.storage.records import Records, file_url
from tests.support.checkout import ROOT
from tests.support.lab_process import LabProcess, free_ports


def newer(file: Path) -> None:
    """A database of a newer OnPath."""
    Records(file_url(file)).close()
    with closing(sqlite3.connect(file)) as raw, raw:
        raw.execute("UPDATE meta SET number = number + 1")


def of_others(file: Path) -> None:
    """A database of another program."""
    with closing(sqlite3.connect(file)) as raw, raw:
        raw.execute("CREATE TABLE labs (a INTEGER)")


UNUSABLE = [newer, of_others, Path.mkdir]
PUBLIC = {
    "option": ["--database", "{url}"],
    "environment": [],
    "proxy": ["--origin", "https://lab.example.org"],
    "proxy elsewhere": ["--trusted-proxy", "10.0.0.7"],
}


@pytest.fixture
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's own database; a server that would start is interrupted."""

    def started(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    file = tmp_path / "onpath.db"
    monkeypatch.setattr(records, "default_file", lambda: file)
    monkeypatch.setattr(lab_server, "LabServer", started)
    return file


@pytest.mark.parametrize("make", UNUSABLE)
@pytest.mark.parametrize("way", PUBLIC)
def test_nobody_is_served_without_the_database_that_was_named_or_is_shared(
    make: Callable[[Path], None],
    way: str,
    file: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    make(file)
    url = f"sqlite:///{file}"
    if way == "environment":
        monkeypatch.setenv(DATABASE, url)
    assert run_command(["serve", *(each.format(url=url) for each in PUBLIC[way])]) == 1
    (said,) = capsys.readouterr().err.splitlines()
    assert said.startswith(f"onpath: cannot use {file}: ")


@pytest.mark.parametrize("make", UNUSABLE)
def test_a_lab_of_one_s_own_goes_on_in_memory(
    make: Callable[[Path], None], file: Path, caplog: pytest.LogCaptureFixture
) -> None:
    make(file)
    with caplog.at_level(logging.WARNING):
        assert run_command(["serve"]) == INTERRUPTED
    assert "Nothing outlives the server" in caplog.text


@pytest.mark.parametrize("way", PUBLIC)
def test_a_database_that_can_be_used_is(
    way: str, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    url = f"sqlite:///{file}"
    if way == "environment":
        monkeypatch.setenv(DATABASE, url)
    options = [each.format(url=url) for each in PUBLIC[way]]
    assert run_command(["serve", *options]) == INTERRUPTED and file.is_file()


LIMITED = """
import resource
resource.setrlimit(resource.RLIMIT_NOFILE, ({0}, {0}))
from onpath.app.cli.main import main
main()
"""


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_with_few_open_files_idle_connections_keep_nobody_away(tmp_path: Path) -> None:
    (port,) = free_ports(1)
    program = ("-c", LIMITED.format(80))
    served = LabProcess(port, ["--database", "sqlite://"], {}, program, tmp_path / "log")
    try:
        served.wait_until_well()
        with ExitStack() as idle:
            for _ in range(100):
                idle.enter_context(socket.create_connection(("127.0.0.1", port)))
            assert served.health()[0] == 200
    finally:
        served.kill()
    assert "Traceback" not in served.said and "Too many open files" not in served.said


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_too_few_open_files_are_refused(tmp_path: Path) -> None:
    told = ["--port", "0", "--database", "sqlite://"]
    command = [sys.executable, "-c", LIMITED.format(40), *told]
    run = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert run.returncode == 2 and "ulimit -n 40: expected 64 open files" in run.stderr


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0", "localhost", "::1", "::"])
def test_the_address_that_is_printed_can_be_opened(host: str) -> None:
    if ":" in host and not _has_ipv6():
        pytest.skip("no IPv6 here")
    server = LabServer(host, 0, LoopCache())
    try:
        with urllib.request.urlopen(f"{server.address}/health", timeout=60) as reply:
            assert reply.status == 200
    finally:
        server.stop()


@pytest.mark.skipif(sys.platform == "win32", reason="no Unix sockets")
def test_the_socket_is_printed_by_its_name(tmp_path: Path) -> None:
    server = LabServer(
        "127.0.0.1", 0, LoopCache(), ServerOptions(unix_socket=tmp_path / "lab.sock")
    )
    try:
        assert server.address == str(tmp_path / "lab.sock")
    finally:
        server.stop()


def _has_ipv6() -> bool:
    try:
        socket.create_server(("::1", 0), family=socket.AF_INET6).close()
    except OSError:
        return False
    return True
