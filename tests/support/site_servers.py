"""A folder of pages behind web servers that know nothing of OnPath."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from http.client import HTTPConnection
from pathlib import Path

from tests.support.lab_process import free_ports
from tests.support.site import NGINX
from tests.support.waiting import wait_for

CONFIGURATION = """user {user}; daemon off; worker_processes 1; pid {own}/pid; error_log stderr;
events {{}}
http {{
    access_log off; {paths}
    types {{ text/html html; text/css css; text/javascript js; image/svg+xml svg; }}
    server {{
        listen 127.0.0.1:{port};
        root {folder};
        add_header Content-Security-Policy "{policy}" always;
        add_header X-Content-Type-Options nosniff always;
    }}
}}"""
KINDS = ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")


@contextmanager
def python_server(folder: Path) -> Iterator[str]:
    """The address of a folder under `python -m http.server`."""
    (port,) = free_ports(1)
    command = [sys.executable, "-m", "http.server", str(port), "--bind", "127.0.0.1"]
    with running([*command, "--directory", str(folder)], port) as address:
        yield address


@contextmanager
def nginx(folder: Path, own: Path, policy: str) -> Iterator[str]:
    """The address of a folder in nginx, which sends a Content-Security-Policy with every file.

    Args:
        own: an empty folder for its files.
    """
    (port,) = free_ports(1)
    user = f"{own.owner()} {own.group()}"  # root's nginx would read as another user
    paths = "".join(f"{kind}_temp_path {own / kind};" for kind in KINDS)
    text = CONFIGURATION.format(
        user=user, own=own, paths=paths, port=port, folder=folder, policy=policy
    )
    (own / "nginx.conf").write_text(text)
    command = [NGINX or "", "-e", "stderr", "-p", str(own), "-c", str(own / "nginx.conf")]
    with running(command, port) as address:
        yield address


@contextmanager
def running(command: list[str], port: int, folder: Path | None = None) -> Iterator[str]:
    """The address of a web server, which a command starts in a folder."""
    silent = subprocess.DEVNULL
    process = subprocess.Popen(command, cwd=folder, stdout=silent, stderr=silent)
    try:
        wait_for(lambda: _answers(port) or process.poll() is not None, 60.0)
        assert process.poll() is None
        yield f"http://127.0.0.1:{port}"
    finally:
        process.terminate()
        process.wait()


def _answers(port: int) -> bool:
    try:
        connection = HTTPConnection("127.0.0.1", port, timeout=5)
        connection.request("GET", "/")
        return connection.getresponse().status < 500
    except OSError:
        return False
