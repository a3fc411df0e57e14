"""An address that has reached its connection limit does not block other addresses."""

from __future__ import annotations

import logging
import re
import socket
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any

import pytest
import viser
from hypothesis import given
from hypothesis import strategies as st
from websockets.datastructures import Headers
from websockets.http11 import Request

from onpath.app.viser_adapter.connection_limits import ConnectionLimits, PerAddress, Proxies
from onpath.app.viser_adapter.limits import FEWEST, OWN_FILES
from onpath.app.viser_adapter.secure_server import Limits, make_server
from tests.bench.client_protocol import SUBPROTOCOL
from tests.support import waiting
from tests.support.site import CONFIGURATION

WAIT = 20.0  # [s]; only ends a test that would hang
ONE, OTHER = "127.0.0.1", "127.0.0.2"
UPGRADE = {
    "Upgrade": "websocket",
    "Connection": "Upgrade",
    "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
    "Sec-WebSocket-Version": "13",
    "Sec-WebSocket-Protocol": SUBPROTOCOL,
}
STUDENTS, SOCKETS = 60, 5
wait_for = partial(waiting.wait_for, seconds=WAIT)


@contextmanager
def serving(limits: Limits) -> Iterator[Site]:
    server = make_server(port=0, limits=limits)
    with ExitStack() as visits:
        yield Site(server, visits)
    server.stop()


class Site:
    """A server, and who is connected to it until the test ends."""

    def __init__(self, server: viser.ViserServer, visits: ExitStack) -> None:
        self.server, self._visits = server, visits

    def connect(self, source: str = ONE) -> socket.socket:
        """Open a connection and send nothing."""
        target = ("127.0.0.1", self.server.get_port())
        made = socket.create_connection(target, timeout=WAIT, source_address=(source, 0))
        return self._visits.enter_context(made)

    def ask(self, path: str = "/", source: str = ONE, **headers: str) -> int:
        """The status of the answer. A websocket stays open."""
        return status(say(self.connect(source), path, **headers))

    def websocket(self, source: str = ONE, **headers: str) -> int:
        return self.ask(source=source, **UPGRADE, **headers)


def say(connection: socket.socket, path: str = "/", **headers: str) -> socket.socket:
    """A whole request."""
    lines = [f"GET {path} HTTP/1.1", f"Host: 127.0.0.1:{connection.getpeername()[1]}"]
    lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
    connection.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
    return connection


def status(connection: socket.socket) -> int:
    """Of the answer; 0 if the connection was cut off."""
    try:
        first = connection.makefile("rb").readline()
    except ConnectionResetError:
        first = b""
    return int(first.split()[1]) if first else 0


def test_silent_connections_of_one_address_keep_nobody_out(
    caplog: pytest.LogCaptureFixture,
) -> None:
    caplog.set_level(logging.WARNING)
    with serving(Limits(max_connections=20)) as site:
        silent = [site.connect() for _ in range(60)]
        for source in (OTHER, ONE):
            assert site.ask("/health", source) == 200
            assert site.ask("/", source) == 200
            assert site.websocket(source) == 101
        assert silent
    assert not caplog.records


def test_beyond_the_limit_the_oldest_silent_connections_are_closed() -> None:
    with serving(Limits(max_waiting=9, max_waiting_each=6)) as site:
        first = [site.connect(OTHER) for _ in range(3)]
        mine = [site.connect() for _ in range(20)]
        assert [status(each) for each in mine[:14]] == [0] * 14
        assert [status(say(each)) for each in mine[14:]] == [200] * 6
        assert [status(say(each, "/health")) for each in first] == [200] * 3


def test_one_address_has_no_more_websockets_than_its_share() -> None:
    with serving(Limits(max_connections=9, max_connections_each=6)) as site:
        assert [site.websocket() for _ in range(8)] == [101] * 6 + [503] * 2
        assert [site.websocket(OTHER) for _ in range(3)] == [101] * 3
        assert site.ask("/", "127.0.0.3") == 503
        assert site.ask("/health") == 200


def test_closing_a_connection_makes_room() -> None:
    with serving(Limits(max_connections_each=1)) as site:
        inside = say(site.connect(), **UPGRADE)
        assert status(inside) == 101 and site.websocket() == 503
        inside.close()
        assert wait_for(lambda: site.websocket() == 101)


@pytest.mark.thorough
def test_a_class_behind_one_address_and_a_proxy_fits() -> None:
    with serving(Limits()) as site:
        school, home = {"X_Forwarded_For": "203.0.113.7"}, {"X_Forwarded_For": "198.51.100.9"}
        for _ in range(STUDENTS * SOCKETS):
            assert site.websocket(**school) == 101
        assert site.websocket(**school) == 503
        assert site.websocket(**home) == site.websocket() == 101


class CountedConnection:
    """One end of a connection."""

    peer = address = ONE


def test_a_client_that_is_gone_before_its_request_is_read_takes_no_room() -> None:
    connections, request = (
        ConnectionLimits(Limits(max_connections_each=1), Proxies()),
        Request("/", Headers()),
    )
    hasty, patient = CountedConnection(), CountedConnection()
    connections.opened(hasty)  # type: ignore[arg-type]
    connections.closed(hasty)  # type: ignore[arg-type]
    assert not connections.admits(hasty, request)  # type: ignore[arg-type]
    connections.opened(patient)  # type: ignore[arg-type]
    assert connections.admits(patient, request)  # type: ignore[arg-type]


def test_students_take_no_place_of_a_wall_and_walls_none_of_students() -> None:
    limits = Limits(max_connections=2, max_connections_each=2, max_screens=2, max_screens_each=2)
    connections, paths = ConnectionLimits(limits, Proxies()), ("/c/abc/", "/c/abc/wall")
    for path in (*paths, *paths):
        assert admits(connections, path)
    assert not any(admits(connections, path) for path in paths)


def admits(connections: ConnectionLimits, path: str) -> bool:
    connection: Any = CountedConnection()
    connections.opened(connection)
    return connections.admits(connection, Request(path, Headers()))


@pytest.mark.parametrize(
    ("peer", "forwarded", "asker"),
    [
        ("127.0.0.1", ["::ffff:203.0.113.7"], "203.0.113.7"),  # an IPv4 address in IPv6
        ("::ffff:127.0.0.1", ["203.0.113.7"], "203.0.113.7"),
        ("203.0.113.7", [], "203.0.113.7"),
        ("203.0.113.7", ["198.51.100.9"], "203.0.113.7"),  # anybody can write that
        ("127.0.0.1", ["198.51.100.9"], "198.51.100.9"),
        ("127.0.0.1", ["192.0.2.1, 198.51.100.9"], "198.51.100.9"),
        ("127.0.0.1", ["192.0.2.1", "198.51.100.9, 10.1.2.3"], "198.51.100.9"),
        ("10.0.0.1", ["198.51.100.9, 127.0.0.1"], "198.51.100.9"),
        ("11.0.0.1", ["198.51.100.9"], "11.0.0.1"),
        ("", ["198.51.100.9"], "198.51.100.9"),
        ("", [], ""),
        ("127.0.0.1", ["unknown"], "127.0.0.1"),
        ("127.0.0.1", ["198.51.100.9, nonsense"], "127.0.0.1"),
        ("2001:db8:1:2:3::4", [], "2001:db8:1:2::/64"),
        ("::1", ["2001:db8:1:2:ffff::"], "2001:db8:1:2::/64"),
    ],
)
def test_only_a_trusted_proxy_determines_the_client_address(
    peer: str, forwarded: list[str], asker: str
) -> None:
    assert Proxies(("10.0.0.0/8",)).client_address(peer, forwarded) == asker


def test_an_invalid_proxy_is_refused() -> None:
    with pytest.raises(ValueError, match="does not appear"):
        make_server(port=0, trusted_proxies=("10.0.0.0/99",))


@given(st.lists(st.tuples(st.sampled_from("abc"), st.booleans()), max_size=60))
def test_nobody_holds_more_than_a_share_and_the_oldest_goes_first(
    steps: list[tuple[str, bool]],
) -> None:
    holders, held = PerAddress[int](5, 3), list[tuple[int, str]]()
    for number, (address, comes) in enumerate(steps):
        if comes:
            held.append((number, address))
            surplus = holders.add(number, address)
            same = [each for each, where in held if where == address]
            wanted = same[0] if len(same) > 3 else held[0][0] if len(held) > 5 else None
            assert surplus == wanted
        else:
            surplus = held[0][0] if held else None
        if surplus is not None:
            assert holders.discard(surplus) and not holders.discard(surplus)
            held = [each for each in held if each[0] != surplus]
        assert len(holders) == len(held) <= 5
        for where in "abc":
            mine = [each for each, whose in held if whose == where]
            assert len(mine) <= 3
            assert holders.has_room(where) == (len(mine) < 3 and len(held) < 5)


def test_an_address_that_opens_too_many_tabs_is_refused_those_and_nothing_else() -> None:
    with serving(Limits(tab_burst_each=3, tabs_per_second_each=1e-6)) as site:
        assert [site.websocket(ONE) for _ in range(4)] == [101, 101, 101, 429]
        assert site.ask("/index.html", ONE) == 200
        assert site.websocket(OTHER) == 101


def test_two_websockets_a_page_fit_for_a_class_of_sixty_behind_one_address() -> None:
    """Also when all its pages are reloaded at once, before their former connections have ended."""
    limits, sockets = Limits(), 2 * 60
    assert limits.max_connections_each >= 2 * sockets
    assert limits.tab_burst_each >= 2 * sockets
    assert limits.max_waiting_each >= sockets
    assert limits.max_connections >= 2 * limits.max_connections_each
    found = re.search(r"limit_conn onpath_open (\d+);", CONFIGURATION.read_text("utf-8"))
    assert found is not None and int(found[1]) >= 2 * sockets


def test_connections_leave_room_for_the_other_open_files() -> None:
    usual = Limits()
    numbers = ("max_connections", "max_connections_each", "max_waiting", "max_waiting_each")
    before = [0] * 4
    for files in range(OWN_FILES + FEWEST, 2000):
        limits = usual.within(files)
        now = [getattr(limits, name) for name in numbers]
        assert limits.max_connections + limits.max_waiting + OWN_FILES <= files
        assert all(each >= max(1, least) for each, least in zip(now, before, strict=True))
        before = now
    assert usual.within(1024) == usual  # a common limit
    with pytest.raises(ValueError, match="ulimit -n 40: expected 64"):
        usual.within(40)
