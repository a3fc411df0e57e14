"""How many connections there may be of one address, so that nobody can hold them all.

Whoever has sent no whole request yet waits; of those that wait too many are cut off, the oldest
first, so that one who comes and asks at once is always heard.
"""

from __future__ import annotations

import asyncio
from collections import Counter
from ipaddress import IPv4Address, IPv6Address, ip_address, ip_network
from typing import Any, Generic, TypeVar

from websockets.asyncio.server import ServerConnection
from websockets.http11 import Request

from app.gate import Limits

T = TypeVar("T")


class PerAddress(Generic[T]):
    """What addresses hold, the oldest first.

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
    """Who asks, where a proxy asks for somebody: this machine's are believed, and those given.

    Args:
        networks: of the others, "10.0.0.0/8" or an address.

    Raises:
        ValueError: one of them is neither.
    """

    def __init__(self, networks: tuple[str, ...] = ()) -> None:
        self._networks = [ip_network(network) for network in networks]

    def asker(self, peer: str, forwarded: list[str]) -> str:
        """The address that counts.

        Args:
            peer: at the other end of the connection; empty for a Unix socket.
            forwarded: what X-Forwarded-For says, the nearest last.
        """
        asker = peer
        for hop in reversed([each.strip() for each in ",".join(forwarded).split(",")]):
            if not self._believes(asker) or not _is_address(hop):
                break
            asker = hop
        return _household(asker)

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


def _household(address: str) -> str:
    """One who has an address of IPv6 has 2^64 of them."""
    if not address:
        return address
    there = _parsed(address)
    return str(ip_network((int(there), 64), strict=False) if there.version == 6 else there)


def _parsed(address: str) -> IPv4Address | IPv6Address:
    """An address; ::ffff:192.0.2.1 is 192.0.2.1."""
    there = ip_address(address)
    mapped = there.ipv4_mapped if isinstance(there, IPv6Address) else None
    return mapped or there


class Crowd:
    """Everybody who is connected. On one event loop."""

    def __init__(self, limits: Limits, proxies: Proxies) -> None:
        self._proxies = proxies
        self._waiting = PerAddress[Visitor](limits.max_waiting, limits.max_waiting_each)
        self._inside = PerAddress[Visitor](limits.max_connections, limits.max_connections_each)

    def came(self, visitor: Visitor) -> None:
        """Somebody has connected."""
        surplus = self._waiting.add(visitor, self._proxies.asker(visitor.peer, []))
        if surplus is not None:
            self._waiting.discard(surplus)
            surplus.transport.abort()

    def takes(self, visitor: Visitor, request: Request) -> bool:
        """Whether there is room for one whose request is here, if it is still there itself."""
        forwarded = request.headers.get_all("X-Forwarded-For")
        visitor.address = self._proxies.asker(visitor.peer, forwarded)
        if visitor in self._waiting and self._inside.has_room(visitor.address):
            self._waiting.discard(visitor)
            self._inside.add(visitor, visitor.address)
        return visitor in self._inside

    def gone(self, visitor: Visitor) -> None:
        """Somebody has left."""
        self._waiting.discard(visitor)
        self._inside.discard(visitor)


class Visitor(ServerConnection):
    """A connection of a crowd.

    Attributes:
        peer: the address at its other end, which may be a proxy's.
        address: whose it is.
    """

    def __init__(self, *args: Any, crowd: Crowd, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._crowd = crowd
        self.peer = self.address = ""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """See `asyncio.Protocol`."""
        super().connection_made(transport)
        name = transport.get_extra_info("peername")
        self.peer = self.address = name[0] if isinstance(name, tuple) else ""
        self._crowd.came(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """See `asyncio.Protocol`."""
        self._crowd.gone(self)
        super().connection_lost(exc)
