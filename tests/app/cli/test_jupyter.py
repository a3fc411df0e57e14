"""A lab inside a real Jupyter server, under its sub-path and behind its login."""

from __future__ import annotations

import http.client
import socket
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tests.support import stranger
from tests.support.checkout import ROOT
from tests.support.student import Student
from tests.support.waiting import wait_for

pytestmark = pytest.mark.thorough

TOKEN = "a-token"
CONFIGURATION = """
from onpath.app.cli.jupyter import server
from tests.support.waiting import wait_for
c.ServerProxy.servers = {"onpath": server()}
c.IdentityProvider.token = "a-token"
c.ServerApp.jpserver_extensions = {"jupyter_server_proxy": True}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A student's, with an app.py, models/ and lessons/ that no lab must run."""
    folder = tmp_path_factory.mktemp("jupyter")
    stranger.fill(folder)
    (folder / "viser.py").write_text(stranger.CODE)  # nor what is named like a library
    return folder


@pytest.fixture(scope="module")
def port(folder: Path) -> Iterator[int]:
    (folder / "jupyter_server_config.py").write_text(CONFIGURATION)
    with socket.create_server(("127.0.0.1", 0)) as probe:
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "jupyter_server", "--no-browser", "--allow-root"]
    command += [f"--port={port}", "--ServerApp.port_retries=0", f"--ServerApp.root_dir={folder}"]
    names = ("HOME", "JUPYTER_CONFIG_DIR", "JUPYTER_RUNTIME_DIR", "XDG_DATA_HOME", "XDG_CACHE_HOME")
    places = dict.fromkeys(names, str(folder))
    environment = stranger.environment(**places)
    said = (folder / "log").open("w")
    server = subprocess.Popen(command, cwd=folder, env=environment, stderr=said)
    wait_for(lambda: _answers(port) or server.poll() is not None, 60.0)
    assert server.poll() is None, (folder / "log").read_text()
    yield port
    server.terminate()
    server.wait(10)
    said.close()


def _answers(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def get(port: int, path: str, token: str = TOKEN) -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("GET", path, headers={"Authorization": f"token {token}"})
    return connection.getresponse()


def test_a_lab_runs_under_jupyters_sub_path(port: int, folder: Path) -> None:
    page = get(port, "/onpath/")
    assert page.status == 200 and b"<html" in page.read(200).lower()
    headers: dict[str, Any] = {
        "Origin": f"http://127.0.0.1:{port}",
        "Authorization": f"token {TOKEN}",
    }
    with Student(f"ws://127.0.0.1:{port}/onpath/", None, **headers) as student:
        student.open()
        student.settle("K2", 44.0)
        student.read(lambda: student.moving > 10)
    assert not stranger.marks(folder)


def test_strangers_stay_outside(port: int) -> None:
    address, own = f"ws://127.0.0.1:{port}/onpath/", f"http://127.0.0.1:{port}"
    for origin, token in (("https://evil.example", TOKEN), (own, "wrong")):
        stranger = Student(address, Origin=origin, Authorization=f"token {token}")
        with stranger, pytest.raises((InvalidStatus, ConnectionClosed)):
            stranger.open()
            stranger.read(lambda: stranger.told)
    assert get(port, "/onpath/", "wrong").status in (302, 403)


def test_the_entry_is_declared_and_listens_to_its_user_alone() -> None:
    declared = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
    module, _, name = declared["jupyter_serverproxy_servers"]["onpath"].partition(":")
    entry = getattr(import_module(module), name)()
    assert entry["unix_socket"] is True and "--socket" in entry["command"]
    assert not any(word in entry["command"] for word in ("--port", "--host"))


@pytest.mark.skipif(sys.platform == "win32", reason="no Unix sockets")
def test_nobody_else_can_open_the_socket(tmp_path: Path) -> None:
    from onpath.app.viser_adapter.secure_server import make_server

    server = make_server(unix_socket=tmp_path / "lab.sock")
    assert (tmp_path / "lab.sock").stat().st_mode & 0o077 == 0
    server.stop()
