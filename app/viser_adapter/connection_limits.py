"""Limits on open connections, in all and of one address, so that no address can hold them all.

A connection that has not sent a complete request yet is pending. When too many are pending, the
oldest is cut off, so that a client that sends its request at once is always served.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from ipaddress import IPv4Address, IPv6Address, ip_address, ip_network
from typing import Any, Generic, TypeVar

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request

from onpath.app.viser_adapter.message_filter import Limits

T = TypeVar("T")


class PerAddress(Generic[T]):
    """Things counted by the address that holds them, the oldest first.

    Args:
        most, most_each: in all, and of one address.
    """

    def __init__(self, most: int, most_each: int) -> None:
        self._most, self._most_each = most, most_each
        self._held: dict[T, str] = {}
        self._each: Counter[str] = Counter()

    def __contains__(self, thing: T) -> bool:
        return thing in self._held

    def __len__(self) -> int:
        return len(self._held)

    def has_room(self, address: str) -> bool:
        """For one more."""
        return len(self._held) < self._most and self._each[address] < self._most_each

    def add(self, thing: T, address: str) -> T | None:
        """Returns which is too many now, if any: the oldest of this address, or of all."""
        self._held[thing] = address
        self._each[address] += 1
        if self._each[address] > self._most_each:
            return next(other for other, where in self._held.items() if where == address)
        return next(iter(self._held)) if len(self._held) > self._most else None

    def discard(self, thing: T) -> bool:
        """Whether it was there."""
        address = self._held.pop(thing, None)
        if address is None:
            return False
        self._each[address] -= 1
        if not self._each[address]:
            del self._each[address]
        return True


class Proxies:
    """Proxies whose X-Forwarded-For is believed: those on this machine, and those given.

    Args:
        networks: of the proxies on other machines, "10.0.0.0/8" or a single address.

    Raises:
        ValueError: one of them is neither.
    """

    def __init__(self, networks: tuple[str, ...] = ()) -> None:
        self._networks = [ip_network(network) for network in networks]

    def client_address(self, peer: str, forwarded: list[str]) -> str:
        """The client's address, as the limits count it.

        Args:
            peer: at the other end of the connection; empty for a Unix socket.
            forwarded: what X-Forwarded-For says, the nearest last.
        """
        client = peer
        for hop in reversed([each.strip() for each in ",".join(forwarded).split(",")]):
            if not self._believes(client) or not _is_address(hop):
                break
            client = hop
        return _limited_part(client)

    def _believes(self, address: str) -> bool:
        if not address:
            return True
        there = _parsed(address)
        return there.is_loopback or any(there in network for network in self._networks)


def _is_address(text: str) -> bool:
    try:
        ip_address(text)
    except ValueError:
        return False
    return True


def _limited_part(address: str) -> str:
    """What the limits of an address apply to: for IPv6 the /64 network, which one user owns."""
    if not address:
        return address
    there = _parsed(address)
    return str(ip_network((int(there), 64), strict=False) if there.version == 6 else there)


def _parsed(address: str) -> IPv4Address | IPv6Address:
    """An address; ::ffff:192.0.2.1 is 192.0.2.1."""
    there = ip_address(address)
    mapped = there.ipv4_mapped if isinstance(there, IPv6Address) else None
    return mapped or there


class ConnectionLimits:
    """Limits on open connections, in all and of one address. Used on one event loop."""

    def __init__(self, limits: Limits, proxies: Proxies) -> None:
        self._proxies = proxies
        self._waiting = PerAddress[CountedConnection](limits.max_waiting, limits.max_waiting_each)
        self._inside = PerAddress[CountedConnection](
            limits.max_connections, limits.max_connections_each
        )

    def opened(self, connection: CountedConnection) -> None:
        """Count a new connection; the oldest one without a request is cut off if it is too many."""
        surplus = self._waiting.add(connection, self._proxies.client_address(connection.peer, []))
        if surplus is not None:
            self._waiting.discard(surplus)
            surplus.transport.abort()

    def admits(self, connection: CountedConnection, request: Request) -> bool:
        """Whether there is room for a connection that has sent its request and is still open."""
        forwarded = request.headers.get_all("X-Forwarded-For")
        connection.address = self._proxies.client_address(connection.peer, forwarded)
        if connection in self._waiting and self._inside.has_room(connection.address):
            self._waiting.discard(connection)
            self._inside.add(connection, connection.address)
        return connection in self._inside

    def closed(self, connection: CountedConnection) -> None:
        """Count it no longer."""
        self._waiting.discard(connection)
        self._inside.discard(connection)


class CountedConnection(ServerConnection):
    """A connection that counts towards the limits.

    Attributes:
        peer: the address at its other end, which may be a proxy's.
        address: the client's, as the limits count it.
    """

    def __init__(self, *args: Any, connections: ConnectionLimits, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._connections = connections
        self.peer = self.address = ""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """See `asyncio.Protocol`."""
        super().connection_made(transport)
        name = transport.get_extra_info("peername")
        self.peer = self.address = name[0] if isinstance(name, tuple) else ""
        self._connections.opened(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """See `asyncio.Protocol`."""
        self._connections.closed(self)
        super().connection_lost(exc)
