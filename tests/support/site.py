"""nginx with the supplied configuration, in front of two processes, and a PostgreSQL for them."""

from __future__ import annotations

import http.client
import os
import re
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from onpath.app.storage.database_url import DATABASE
from tests.support.checkout import ROOT
from tests.support.lab_process import LabProcess, free_ports
from tests.support.student import Student
from tests.support.waiting import wait_for

HOST, ORIGIN = "lab.example.org", "https://lab.example.org"
CONFIGURATION = ROOT / "assets" / "deploy" / "nginx.conf"
NGINX = shutil.which("nginx", path=os.environ.get("PATH", "") + ":/usr/sbin")
needs_nginx = pytest.mark.skipif(NGINX is None, reason="nginx is not installed (apt install nginx)")


@dataclass
class Site:
    """The proxy and what is behind it."""

    port: int
    processes: list[LabProcess]

    def get(self, path: str = "/", host: str = HOST, **headers: str) -> http.client.HTTPResponse:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=10)
        connection.request("GET", path, headers={"Host": host, **headers})
        return connection.getresponse()

    def student(self, prefix: str, origin: str = ORIGIN) -> Student:
        """A browser under a prefix, "c/CODE" or "l/NAME"."""
        return Student(f"ws://{HOST}/{prefix}", self.port, Origin=origin)

    def serving(self) -> LabProcess:
        """The process that has connections; there must be one only."""
        (found,) = [process for process in self.processes if process.connections()]
        return found


def supplied(port: int, behind: Sequence[int]) -> str:
    """The supplied file with other ports."""
    text = CONFIGURATION.read_text()
    for given, process in zip(("8081", "8082"), behind, strict=True):
        text = text.replace(f"127.0.0.1:{given}", f"127.0.0.1:{process}")
    return re.sub(r"^(\s+listen) 80\b", rf"\1 127.0.0.1:{port}", text, flags=re.MULTILINE)


def _command(folder: Path, sites: str) -> list[str]:
    """The command that starts nginx with these sites."""
    (folder / "onpath.conf").write_text(sites)
    kinds = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    paths = "".join(f"{kind}_temp_path {folder / kind};" for kind in kinds)
    main = f"daemon off; worker_processes 2; pid {folder / 'pid'}; error_log stderr; events {{}}"
    (folder / "nginx.conf").write_text(
        f"{main} http {{ access_log off; {paths} include {folder / 'onpath.conf'}; }}"
    )
    return [NGINX or "", "-e", "stderr", "-p", str(folder), "-c", str(folder / "nginx.conf")]


def _answers(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


@contextmanager
def nginx(folder: Path, port: int, sites: str) -> Iterator[None]:
    """nginx with sites that listen at a port."""
    running = subprocess.Popen(_command(folder, sites), stderr=subprocess.DEVNULL)
    try:
        wait_for(lambda: _answers(port) or running.poll() is not None, 60.0)
        assert running.poll() is None
        yield
    finally:
        running.terminate()
        running.wait()


def proxy(folder: Path, port: int, behind: Sequence[int]) -> AbstractContextManager[None]:
    """nginx as supplied, at a port.

    Args:
        behind: ports of two processes.
    """
    return nginx(folder, port, supplied(port, behind))


@contextmanager
def site(
    folder: Path, database: str, options: Sequence[str] = (), **environment: str
) -> Iterator[Site]:
    """A site whose processes share a database.

    Args:
        options: of the processes, besides port and origin.
        environment: additional variables.
    """
    *ports, port = free_ports(3)
    told = ["--origin", ORIGIN, "--log-level", "warning", *options]
    processes = [LabProcess(each, told, {DATABASE: database, **environment}) for each in ports]
    try:
        with proxy(folder, port, ports):
            for process in processes:
                process.wait_until_well()
            yield Site(port, processes)
    finally:
        for process in processes:
            process.kill()


def postgres_programs() -> Path | None:
    """The folder with PostgreSQL's programs, as Debian installs them."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    return found[-1].parent if found else None


needs_postgres = pytest.mark.skipif(
    postgres_programs() is None, reason="PostgreSQL is not installed (apt install postgresql)"
)


@contextmanager
def postgres() -> Iterator[str]:
    """The URL of a new, empty database of a server of its own, which refuses to run as root."""
    programs, (port,) = postgres_programs(), free_ports(1)
    assert programs is not None
    own: dict[str, Any] = {"user": "postgres", "group": "postgres"} if os.getuid() == 0 else {}
    with tempfile.TemporaryDirectory() as name:  # outside of pytest's, which is its owner's alone
        folder = Path(name)
        if own:
            shutil.chown(folder, **own)
        data = folder / "data"
        make = [programs / "initdb", "-D", data, "-A", "trust", "-U", "onpath", "--no-sync"]
        subprocess.run(make, check=True, stdout=subprocess.DEVNULL, cwd=folder, **own)
        command = [programs / "postgres", "-D", data, "-p", str(port), "-k", folder, "-F"]
        server = subprocess.Popen(command, stderr=subprocess.DEVNULL, cwd=folder, **own)
        try:
            wait_for(lambda: _is_ready(programs, port) or server.poll() is not None, 60.0)
            assert server.poll() is None
            yield f"postgresql+psycopg://onpath@127.0.0.1:{port}/postgres"
        finally:
            server.send_signal(signal.SIGINT)  # SIGTERM would wait for a client that hangs
            server.wait()


def _is_ready(programs: Path, port: int) -> bool:
    ask = [programs / "pg_isready", "-q", "-h", "127.0.0.1", "-p", str(port)]
    return subprocess.run(ask, check=False).returncode == 0
