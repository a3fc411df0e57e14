"""What the supplied nginx configuration allows one address, and that others are still served.

Behind nginx is no process, or a socket instead of one, so that only nginx can refuse anything.
"""

from __future__ import annotations

import re
import socket
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from http.client import HTTPConnection
from pathlib import Path
from select import select

import pytest

from tests.support.lab_process import free_ports
from tests.support.site import CONFIGURATION, HOST, needs_nginx, proxy

pytestmark = [pytest.mark.thorough, needs_nginx]

FLOOD, NEIGHBOUR = "127.0.0.2", "127.0.0.3"
REFUSED = 503  # as nginx does where the file names no other status
NOBODY = 502  # let through by nginx, but no process is behind it
ANSWER = b"HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n"

Ask = Callable[[str], HTTPConnection]
"""Sends a request from an address, and does not wait for the answer."""


def allowed(pattern: str) -> int:
    """A number in the configuration."""
    (found,) = re.findall(pattern, CONFIGURATION.read_text())
    return int(found)


@contextmanager
def asking(folder: Path, behind: int) -> Iterator[Ask]:
    """How to ask nginx in front of a port."""
    (port,) = free_ports(1)
    with proxy(folder, port, (behind, behind)), ExitStack() as stack:

        def ask(address: str) -> HTTPConnection:
            made = HTTPConnection("127.0.0.1", port, timeout=60.0, source_address=(address, 0))
            stack.callback(made.close)
            made.request("GET", "/", headers={"Host": HOST})
            return made

        yield ask


def status(asked: HTTPConnection) -> int:
    """Wait for the answer."""
    return asked.getresponse().status


def test_an_address_has_so_many_connections_and_others_are_served(tmp_path: Path) -> None:
    most = allowed(r"limit_conn onpath_open (\d+);")
    with socket.create_server(("127.0.0.1", 0)) as silent, ExitStack() as stack:
        silent.settimeout(60.0)

        def take() -> socket.socket:
            return stack.enter_context(silent.accept()[0])

        with asking(tmp_path, silent.getsockname()[1]) as ask:
            held = [(ask(FLOOD), take()) for _ in range(most)]
            assert status(ask(FLOOD)) == REFUSED
            for address in (NEIGHBOUR, FLOOD):  # the latter when one of its connections has ended
                asked = ask(address)
                take().sendall(ANSWER)
                assert status(asked) == 200
                mine, behind = held.pop()
                mine.close()
                assert behind.recv(1 << 16) and behind.recv(1) == b""  # nginx has closed it


def test_an_address_asks_so_often_and_others_are_served(tmp_path: Path) -> None:
    burst = allowed(r"limit_req +zone=onpath_rate burst=(\d+);")
    (nobody,) = free_ports(1)
    with asking(tmp_path, nobody) as ask:
        waiting: dict[socket.socket, HTTPConnection] = {}
        told: list[int] = []
        while REFUSED not in told:
            assert len(told) < 5 * burst
            asked = ask(FLOOD)
            waiting[asked.sock] = asked
            told += [status(waiting.pop(each)) for each in select([*waiting], [], [], 0)[0]]
        assert len(told) + len(waiting) > burst
        assert status(ask(NEIGHBOUR)) == NOBODY
        others = {status(each) for each in waiting.values()}  # slowed down, or refused as well
        assert NOBODY in others and others.union(told) == {NOBODY, REFUSED}
        assert status(ask(FLOOD)) == NOBODY
