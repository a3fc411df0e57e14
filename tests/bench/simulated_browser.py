"""Simulated browsers, which read everything that a lab sends, drag its robots and set a gain.

`python -m tests.bench.simulated_browser PORT CLIENTS SECONDS` writes what they observe, one
line of JSON at a time; see `crowd`. They lower their own priority, because real browsers would not
take processor time from the server.
"""

from __future__ import annotations

import asyncio
import math
import os
import secrets
import sys
import time
from collections.abc import AsyncGenerator, Iterator
from contextlib import aclosing, asynccontextmanager, suppress
from dataclasses import dataclass, field
from http import HTTPStatus
from itertools import count
from pathlib import Path
from statistics import median
from typing import Any

import msgspec
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidMessage, InvalidStatus
from websockets.typing import Subprotocol

from onpath.app.channel.form_messages import AskForm, SetField
from onpath.app.channel.messages import encoded
from onpath.app.server.arrivals import PAGE_KEY
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL as DATA
from tests.bench.client_protocol import (
    CAMERA,
    SEEN,
    SUBPROTOCOL,
    answer,
    hello,
    message_headers,
    packed,
    unpacked,
)

LAST = 19  # the lowest priority
TOGETHER = Path("/proc/self/autogroup")  # priority of a whole session, on Linux
HAND_INTERVAL = 0.05  # [s] between a hand's messages; no browser sends more often
CYCLE = 4.0  # [s]: pull, rest, move the slider of a gain, rest
MOVING = "/links"
STEADY = 10  # poses after which a browser counts as settled
ANSWERED = {"LocalStorageGetItemRequestMessage", "BatchedMeshesMessage"}
LAB = '{"is":"lab"'  # begins the message after which a page asks for its form
ASK_FORM = encoded(AskForm()).decode()
SEES = 2.0  # [s] between messages that the page is drawn


class NotServed(Exception):
    """The server does not serve all simulated browsers; the message says what happened."""


@dataclass(frozen=True, slots=True)
class Observations:
    """What the simulated browsers observed in an interval.

    Attributes:
        seconds: length of the interval, [s].
        clients: number that are still connected.
        slowest_hz, median_hz: new poses per second, of the slowest and of the median browser.
        bytes_per_s: received by each.
        cpu: used by the simulated browsers themselves, in cores.
    """

    seconds: float
    clients: int
    slowest_hz: float
    median_hz: float
    bytes_per_s: float
    cpu: float


@dataclass
class Browser:
    """One simulated tab.

    Attributes:
        port: of the server.
        number: shifts its actions in time against those of the others.
        source: address from which it connects; any if None.
        shown: times at which it received new poses, [s].
        received: [B], also through the data channel.
        told: messages of the data channel.
        own: that channel, while it is open.
    """

    port: int
    number: int
    source: str | None = None
    shown: list[float] = field(default_factory=list)
    received: int = 0
    told: int = 0
    own: ClientConnection = field(init=False, repr=False)
    _page: str = field(default_factory=lambda: secrets.token_hex(16))
    _numbers: Iterator[int] = field(default_factory=lambda: count(1))
    _owner: str = ""

    async def browse(self, seconds: float) -> None:
        """Use the lab for some time, or until it closes the connection.

        Raises:
            OSError, WebSocketException: the connection failed.
        """
        async with self._greeted() as self.own, self._connected(SUBPROTOCOL) as socket:
            await socket.send(packed("ViewerCameraMessage", **CAMERA))
            until = time.monotonic() + seconds
            does = self._read(socket), self._use(socket, until), self._talk(self.own)
            tasks = [asyncio.create_task(do) for do in does]
            try:
                done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
                for task in done:
                    task.result()
            finally:
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)

    @asynccontextmanager
    async def _greeted(self) -> AsyncGenerator[ClientConnection]:
        """The page's own websocket, which tells that the page is drawn."""
        async with self._connected(DATA) as socket:
            await socket.send(hello(self._page))
            seeing = asyncio.create_task(self._see(socket))
            try:
                yield socket
            finally:
                seeing.cancel()

    async def _see(self, socket: ClientConnection) -> None:
        with suppress(ConnectionClosed):
            while True:
                await asyncio.sleep(SEES)
                await socket.send(SEEN)

    def _connected(self, subprotocol: str) -> connect:
        options: dict[str, Any] = {"max_size": None, "compression": None}
        options |= {"open_timeout": None, "ping_interval": None}  # as a browser, it just waits
        options |= {"local_addr": (self.source, 0)} if self.source else {}
        address = f"ws://127.0.0.1:{self.port}"
        return connect(address, subprotocols=[Subprotocol(subprotocol)], **options)

    async def _talk(self, socket: ClientConnection) -> None:
        """Read what the page's own script is told."""
        async for text in socket:
            assert isinstance(text, str)
            self.received += len(text)
            self.told += 1
            if text.startswith(LAB):
                await socket.send(ASK_FORM)

    async def _read(self, socket: ClientConnection) -> None:
        async for raw in socket:
            assert isinstance(raw, bytes)
            self.received += len(raw)
            messages = message_headers(raw)
            if any(self._heeds(message.type) for message in messages):
                for message in unpacked(raw):
                    await self._answer(socket, message)
            if any(m.name == MOVING and m.type == "SceneNodeUpdateMessage" for m in messages):
                self.shown.append(time.monotonic())

    def _heeds(self, kind: str) -> bool:
        """Whether `_answer` is to be called for messages of a kind."""
        return kind in ANSWERED

    async def _answer(self, socket: ClientConnection, message: dict[str, Any]) -> None:
        kind = message["type"]
        if reply := answer(message, {PAGE_KEY: self._page}):
            await socket.send(reply)
        elif kind == "BatchedMeshesMessage" and message["name"] == "/grips":
            self._owner = message["owner"]

    async def _use(self, socket: ClientConnection, until: float) -> None:
        while not self._owner and time.monotonic() < until:
            await asyncio.sleep(HAND_INTERVAL)
        held = False
        while (now := time.monotonic()) < until:
            phase, rest = (now + 0.37 * self.number) % CYCLE, HAND_INTERVAL
            pulls = phase < 1.0
            if pulls or held:
                step = ("update" if held else "start") if pulls else "end"
                await socket.send(self._pull(step, phase))
                held = pulls
            elif 2.0 < phase < 3.0:
                value = 400.0 + 10 * round(10 * (phase - 2.0))
                await self.own.send(encoded(SetField("K1", value, next(self._numbers))).decode())
            else:
                rest = max(rest, (2.0 if phase < 2.0 else CYCLE) - phase)
            await asyncio.sleep(rest)

    def _pull(self, step: str, phase: float) -> bytes:
        there = [-0.06 + 0.05 * math.cos(6 * phase), 0.0, 0.2 + 0.05 * math.sin(6 * phase)]
        return packed(
            "SceneNodeDragMessage",
            phase=step,
            name="/grips",
            instance_index=0,
            start_position=there,
            start_screen_pos=[0.5, 0.5],
            end_position=there,
            end_screen_pos=[0.5, 0.5],
            button="left",
            modifier=None,
            owner=self._owner,
        )


async def first_poses(port: int) -> None:
    """Return when a browser that connects now is shown a moving robot.

    Raises:
        WebSocketException: refused for another reason than that the server is starting.
    """
    browser = Browser(port, 0)
    while not browser.shown:
        browsing = asyncio.create_task(browser.browse(60.0))
        while not browsing.done() and not browser.shown:
            await asyncio.sleep(0.002)
        browsing.cancel()
        (error,) = await asyncio.gather(browsing, return_exceptions=True)
        if not browser.shown and isinstance(error, Exception) and not _is_early(error):
            raise error
        await asyncio.sleep(0.01)


def _is_early(error: Exception) -> bool:
    """Whether this error is expected while the server is starting."""
    if isinstance(error, InvalidStatus):
        return error.response.status_code == HTTPStatus.SERVICE_UNAVAILABLE
    return isinstance(error, OSError | EOFError | InvalidMessage | ConnectionClosed)


async def crowd(
    port: int, clients: int, seconds: float, patience: float | None = None
) -> AsyncGenerator[Observations]:
    """What several browsers observe: first when each is shown moving robots, then every `seconds`.

    Args:
        patience: time until then, [s].

    Raises:
        NotServed: some are not shown any.
    """
    browsers = [Browser(port, number) for number in range(clients)]
    tasks = [asyncio.create_task(browser.browse(math.inf)) for browser in browsers]
    begun, cpu = time.monotonic(), time.process_time()
    try:
        await _settle(browsers, tasks, patience or 30.0 + 3.0 * clients)
        while True:
            now, spent = time.monotonic(), time.process_time()
            there = sum(not task.done() for task in tasks)
            yield _seen(browsers, there, now - begun, spent - cpu)
            begun, cpu = now, spent
            await asyncio.sleep(seconds)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _settle(
    browsers: list[Browser], tasks: list[asyncio.Task[None]], patience: float
) -> None:
    until, clients = time.monotonic() + patience, len(browsers)
    while (ready := sum(len(browser.shown) >= STEADY for browser in browsers)) < clients:
        for task in tasks:
            if task.done():
                error = task.exception() or "the server has closed the connection"
                raise NotServed(f"one of {clients} clients was turned away: {error}")
        if time.monotonic() > until:
            raise NotServed(
                f"only {ready} of {clients} clients were shown moving robots in {patience:g} s"
            )
        await asyncio.sleep(0.02)


def _seen(browsers: list[Browser], there: int, seconds: float, cpu: float) -> Observations:
    """Observations since the last call."""
    rates = [len(browser.shown) / seconds for browser in browsers]
    received = sum(browser.received for browser in browsers) / len(browsers)
    for browser in browsers:
        browser.shown.clear()
        browser.received = 0
    return Observations(
        seconds, there, min(rates), median(rates), received / seconds, cpu / seconds
    )


async def _report(port: int, clients: int, seconds: float) -> None:
    async with aclosing(crowd(port, clients, seconds)) as seen:
        async for each in seen:
            sys.stdout.write(msgspec.json.encode(each).decode() + "\n")
            sys.stdout.flush()


def stand_back() -> None:
    """Lower the priority of this process, to leave the processor to the server.

    Linux may first share the processor among sessions; the priority of a process counts within its
    session only.
    """
    if hasattr(os, "nice"):
        os.nice(LAST)
    if os.name == "posix" and os.getsid(0) == os.getpid():
        with suppress(OSError):
            TOGETHER.write_text(str(LAST), "ascii")


if __name__ == "__main__":
    stand_back()
    try:
        asyncio.run(_report(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])))
    except NotServed as unserved:
        sys.exit(str(unserved))
