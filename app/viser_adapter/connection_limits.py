"""Limits on open connections, in total and per address, so that no address can take all of them.

A connection that has not sent a complete request yet is pending. When too many are pending, the
oldest one is closed, so that a client that sends its request at once is always served.
"""

from __future__ import annotations

import asyncio
import logging
from collections import Counter
from http import HTTPStatus
from ipaddress import IPv4Address, IPv6Address, ip_address, ip_network
from typing import Any, Generic, TypeVar

from typing_extensions import override
from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request

from onpath.app.common.allowance import Allowance
from onpath.app.viser_adapter.addresses import screen_of
from onpath.app.viser_adapter.limits import Limits
from onpath.assets.messages import preferred

_log = logging.getLogger("websockets.server")

T = TypeVar("T")
MOST_ADDRESSES = 4096  # number of addresses whose new tabs are counted


class PerAddress(Generic[T]):
    """Items counted by address, oldest first.

    Args:
        most, most_each: limits in total, and per address.
    """

    def __init__(self, most: int, most_each: int) -> None:
        self._most, self._most_each = most, most_each
        self._held: dict[T, str] = {}
        self._each: Counter[str] = Counter()

    def __contains__(self, thing: T) -> bool:
        return thing in self._held

    def __len__(self) -> int:
        return len(self._held)

    def count(self, address: str) -> int:
        """Number of items of an address."""
        return self._each[address]

    def has_room(self, address: str) -> bool:
        """Whether one more item of this address stays within both limits."""
        return len(self._held) < self._most and self._each[address] < self._most_each

    def add(self, thing: T, address: str) -> T | None:
        """Add an item. Returns the item that exceeds a limit, if any.

        That is the oldest one of this address, or else the oldest of all.
        """
        self._held[thing] = address
        self._each[address] += 1
        if self._each[address] > self._most_each:
            return next(other for other, where in self._held.items() if where == address)
        return next(iter(self._held)) if len(self._held) > self._most else None

    def discard(self, thing: T) -> bool:
        """Remove an item. Returns whether it was there."""
        address = self._held.pop(thing, None)
        if address is None:
            return False
        self._each[address] -= 1
        if not self._each[address]:
            del self._each[address]
        return True


class Proxies:
    """The proxies whose X-Forwarded-For header is trusted: those on this machine, and those given.

    Args:
        networks: of the proxies on other machines, "10.0.0.0/8" or a single address.

    Raises:
        ValueError: a network is malformed.
    """

    def __init__(self, networks: tuple[str, ...] = ()) -> None:
        self._networks = [ip_network(network) for network in networks]

    def client_address(self, peer: str, forwarded: list[str]) -> str:
        """The client's address, as the limits count it.

        Args:
            peer: address at the other end of the connection; empty for a Unix socket.
            forwarded: values of X-Forwarded-For, the nearest hop last.
        """
        client = peer
        for hop in reversed([hop.strip() for hop in ",".join(forwarded).split(",")]):
            if not self._trusts(client) or not _is_address(hop):
                break
            client = hop
        return _limited_part(client)

    def _trusts(self, address: str) -> bool:
        if not address:
            return True
        peer = _parsed(address)
        return peer.is_loopback or any(peer in network for network in self._networks)


def _is_address(text: str) -> bool:
    try:
        ip_address(text)
    except ValueError:
        return False
    return True


def _limited_part(address: str) -> str:
    """The part of an address to which limits apply: for IPv6 the /64 network of one user."""
    if not address:
        return address
    parsed = _parsed(address)
    return str(ip_network((int(parsed), 64), strict=False) if parsed.version == 6 else parsed)


def _parsed(address: str) -> IPv4Address | IPv6Address:
    """The parsed address; an IPv4-mapped one (::ffff:192.0.2.1) becomes IPv4."""
    parsed = ip_address(address)
    mapped = parsed.ipv4_mapped if isinstance(parsed, IPv6Address) else None
    return mapped or parsed


class ConnectionLimits:
    """Limits on open connections, in total and per address. Use it on one event loop."""

    def __init__(self, limits: Limits, proxies: Proxies) -> None:
        self._proxies, self._limits = proxies, limits
        self._tabs: dict[str, Allowance] = {}
        self._waiting = PerAddress[CountedConnection](limits.max_waiting, limits.max_waiting_each)
        self._inside = PerAddress[CountedConnection](
            limits.max_connections, limits.max_connections_each
        )
        self._screens = PerAddress[CountedConnection](limits.max_screens, limits.max_screens_each)

    def opened(self, connection: CountedConnection) -> None:
        """Count a new connection; if there are too many, close the oldest without a request."""
        surplus = self._waiting.add(connection, self._proxies.client_address(connection.peer, []))
        if surplus is not None:
            self._waiting.discard(surplus)
            surplus.transport.abort()

    def admits(self, connection: CountedConnection, request: Request) -> bool:
        """Admit a connection with its request, if there is room. Returns whether it is admitted."""
        forwarded = request.headers.get_all("X-Forwarded-For")
        connection.address = self._proxies.client_address(connection.peer, forwarded)
        places = self._screens if screen_of(request.path) else self._inside
        if connection in self._waiting and places.has_room(connection.address):
            self._waiting.discard(connection)
            places.add(connection, connection.address)
        return connection in places

    def refusal(
        self, connection: CountedConnection, request: Request
    ) -> tuple[HTTPStatus, str] | None:
        """Why a request is refused, or None: too many connections, or too many new tabs."""
        if not self.admits(connection, request):
            return HTTPStatus.SERVICE_UNAVAILABLE, "Too many connections.\n"
        if "Upgrade" in request.headers and not self._allowance_of(connection.address).take():
            return HTTPStatus.TOO_MANY_REQUESTS, "Too many tabs at once.\n"
        return None

    def _allowance_of(self, address: str) -> Allowance:
        """The allowance of new tabs of an address. The addresses seen longest ago are forgotten."""
        allowance = self._tabs.pop(address, None)
        if allowance is None:
            allowance = Allowance(self._limits.tab_burst_each, self._limits.tabs_per_second_each)
        self._tabs[address] = allowance  # now the last in order
        if len(self._tabs) > MOST_ADDRESSES:
            del self._tabs[next(iter(self._tabs))]
        return allowance

    def closed(self, connection: CountedConnection) -> None:
        """Stop counting a connection."""
        for places in (self._waiting, self._inside, self._screens):
            places.discard(connection)


class CountedConnection(ServerConnection):
    """A connection that counts towards the limits.

    When it ends, its reference cycles are broken, so that its memory is freed at once. Otherwise
    its memory would wait for the next full garbage collection, and an attacker can open and close
    tens of thousands of connections before that.

    Attributes:
        peer: the address at its other end, which may be a proxy's.
        address: the client's, as the limits count it.
        prefix, screen: see addresses.py.
    """

    def __init__(self, *args: Any, connections: ConnectionLimits, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.logger = self.protocol.logger = logging.LoggerAdapter(_log, {})  # holds no connection
        self._connections = connections
        self.peer = self.address = self.prefix = self.screen = ""

    @property
    def language(self) -> str:
        """The supported language that the browser prefers."""
        accepted = self.request.headers.get_all("Accept-Language") if self.request else []
        return preferred(",".join(accepted))

    @override
    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        super().connection_made(transport)
        name = transport.get_extra_info("peername")
        self.peer = self.address = name[0] if isinstance(name, tuple) else ""
        self._connections.opened(self)

    @override
    def connection_lost(self, exc: Exception | None) -> None:
        self._connections.closed(self)
        super().connection_lost(exc)
        self._break_cycles()

    def _break_cycles(self) -> None:
        self.keepalive_task = None
        self.protocol.parser.close()  # a generator, which holds the protocol
        for error in (self.recv_exc, self.protocol.parser_exc):
            if error is not None:
                error.__traceback__ = None  # which holds this connection and its protocol
        vars(self.protocol).pop("select_subprotocol", None)  # a function that holds the connection
        getattr(self.transport, "__dict__", {}).pop("_read_ready_cb", None)  # its own bound method

    @override
    async def handshake(self, *args: Any, **kwargs: Any) -> None:
        try:
            await super().handshake(*args, **kwargs)
        except BaseException:
            self.protocol.handshake_exc = None  # its traceback holds the connection
            raise
