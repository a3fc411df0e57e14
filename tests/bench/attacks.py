"""Attacks on a running server, one kind after the other, from a separate address.

`python -m tests.bench.attacks PORT` reads names of `ATTACKS`, and makes each until the next.
"""

from __future__ import annotations

import asyncio
import json
import random
import sys
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Sequence
from contextlib import suppress
from functools import partial
from itertools import count, cycle, product
from math import inf
from typing import Any, get_args

from typing_extensions import override
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.frames import Opcode

from onpath.app.channel.sheet_messages import SheetName
from onpath.app.viser_adapter.data_channel import SUBPROTOCOL as DATA
from onpath.app.viser_adapter.limits import Limits
from onpath.models.systems.catalogue import ROBOTS
from tests.bench.client_protocol import CAMERA, SUBPROTOCOL, packed
from tests.bench.dear_commands import dear_message
from tests.bench.hostile_messages import (
    BROKEN,
    DRAG,
    GARBAGE,
    HONEST,
    HOSTILE,
    INDEXES,
    VERSIONS,
    wild_message,
)
from tests.bench.raw_socket import frames, handshake
from tests.bench.simulated_browser import Browser, stand_back

SOURCE = "127.0.0.2" if sys.platform == "linux" else "127.0.0.1"
RATE = 0.9 * Limits().changes_per_second  # of messages or drags; no tab is closed for that
BYTES = 0.9 * 4000 * Limits().messages_per_second  # per second; see `Limits.message_burst`
MIXED = 0.75 * Limits().messages_per_second  # of messages, a quarter of which are drags
TURNED_AWAY = 0.1  # [s] until it comes back
GREETING = frames(packed("ViewerCameraMessage", **CAMERA))
UNFINISHED = frames(bytes(980_000))[:-1]
TOO_LARGE = frames(bytes(1_000_001))
PATHS = ("ellipse", "clover", "rounded square", "figure of eight", "segment", "circle")

Attack = Callable[[int], Coroutine[Any, Any, None]]
Misuse = Callable[["Intruder"], AsyncIterator[str | bytes]]
"""Yields texts for the page's own websocket, and bytes for viser's."""


class Intruder(Browser):
    """A tab that receives its lab like any other, and sends what `misuse` yields.

    Args:
        rate: messages per second.

    Attributes:
        socket: its connection to viser, once it has begun.
    """

    def __init__(self, port: int, misuse: Misuse, rate: float = RATE) -> None:
        super().__init__(port, 0, SOURCE)
        self._misuse, self._rate = misuse, rate

    async def arrive(self) -> None:
        """Return when it is shown its lab."""
        while not self.shown:
            await asyncio.sleep(TURNED_AWAY)

    @property
    def owner(self) -> str:
        """The client whose nodes it may drag: its own."""
        return self._owner

    @override
    async def _use(self, socket: ClientConnection, until: float) -> None:
        self.socket = socket
        async for message in self._misuse(self):
            await (self.own if isinstance(message, str) else socket).send(message)
            await asyncio.sleep(1 / self._rate)


class Script(Browser):
    """A tab whose script sends what `say` draws, as fast as is allowed."""

    def __init__(self, port: int, say: Callable[[random.Random], str | bytes]) -> None:
        super().__init__(port, 0, SOURCE)
        self._say = say

    @override
    async def _use(self, socket: ClientConnection, until: float) -> None:
        await asyncio.sleep(until - time.monotonic())

    @override
    async def _talk(self, socket: ClientConnection) -> None:
        draw = random.Random(self._page)
        await self._speak(socket, draw)
        await again(lambda: self._come_back(draw))

    async def _come_back(self, draw: random.Random) -> None:
        async with self._greeted() as socket:
            await self._speak(socket, draw)

    async def _speak(self, data: ClientConnection, draw: random.Random) -> None:
        reading = asyncio.create_task(_read_all(data))
        try:
            while not reading.done():
                message = self._say(draw)
                await data.send(message)
                await asyncio.sleep(max(1 / RATE, len(message) / BYTES))
        except ConnectionClosed:
            pass  # for what it has said
        finally:
            reading.cancel()


async def _read_all(data: ClientConnection) -> None:
    async for _ in data:
        pass


def scripts(number: int, say: Callable[[random.Random], str | bytes]) -> Attack:
    """A number of tabs whose scripts all say such things; see `Script`."""

    async def attack(port: int) -> None:
        await asyncio.gather(*(again(lambda: Script(port, say).browse(inf)) for _ in range(number)))

    return attack


# Attacks by a single tab.


async def repeat(tab: Intruder, *messages: dict[str, Any]) -> AsyncIterator[str | bytes]:
    """Send messages in turn and without end."""
    await tab.arrive()
    for message in cycle(messages):
        yield json.dumps(message)


async def guess(
    tab: Intruder, length: int, ask: Callable[[str], dict[str, Any]]
) -> AsyncIterator[str | bytes]:
    """Ask with random codes of a given length."""
    await tab.arrive()
    while True:
        yield json.dumps(ask("".join(random.choices("abcdefghjkmnpqrstuvwxyz", k=length))))


async def scribble(tab: Intruder) -> AsyncIterator[str | bytes]:
    """A stroke that does not end."""
    await tab.arrive()
    yield json.dumps({"is": "freehand"})
    for step in count():
        end = [0.2 + 0.1 * random.random(), 0.0, 0.1 + 0.1 * random.random()]
        phase = "update" if step % 100_000 else "start"
        at = {"name": "/freehand/sheet", "owner": tab.owner, "instance_index": None}
        yield packed("SceneNodeDragMessage", **DRAG | at | {"phase": phase, "end_position": end})


async def send_nonsense(tab: Intruder) -> AsyncIterator[str | bytes]:
    """Any field of any message with any value, and any index of a drag."""
    await tab.arrive()
    while True:
        for kind in random.choices(list(HONEST), k=3):
            field = random.choice(list(HONEST[kind]))
            yield packed(kind, **HONEST[kind] | {field: random.choice(HOSTILE)})
        at = {"name": "/grips", "owner": tab.owner, "instance_index": random.choice(INDEXES)}
        yield packed("SceneNodeDragMessage", **DRAG | at)


async def leave(tab: Intruder) -> AsyncIterator[str | bytes]:
    """Close the tab as soon as it is shown its lab."""
    await tab.arrive()
    yield GREETING


async def read_nothing(tab: Intruder) -> AsyncIterator[str | bytes]:
    """Never read what the server sends."""
    await tab.arrive()
    tab.socket.transport.pause_reading()
    tab.own.transport.pause_reading()
    yield GREETING
    await asyncio.sleep(inf)


async def look_on(tab: Intruder) -> AsyncIterator[str | bytes]:
    """Take a place, and nothing more."""
    await asyncio.sleep(inf)
    yield GREETING


# How many tabs or connections attack.


async def again(visit: Callable[[], Coroutine[Any, Any, None]]) -> None:
    """Come back whenever turned away."""
    while True:
        with suppress(OSError, EOFError, WebSocketException):
            await visit()
        await asyncio.sleep(TURNED_AWAY)


def tabs(number: int, misuse: Misuse, rate: float = RATE) -> Attack:
    """A number of tabs that all make the same attack; see `Intruder`."""

    async def attack(port: int) -> None:
        await asyncio.gather(
            *(again(lambda: Intruder(port, misuse, rate).browse(inf)) for _ in range(number))
        )

    return attack


def connections(
    number: int, said: Sequence[bytes], versions: Sequence[str | None] = (SUBPROTOCOL,)
) -> Attack:
    """A number of connections, each of which sends one of these messages and then waits.

    Args:
        versions: of the page that a websocket is asked for; without any, none is asked for.
    """
    ways = list(product(versions, said)) or [(None, each) for each in said]

    async def visit(port: int, version: str | None, last: bytes) -> None:
        reader, writer = await asyncio.open_connection("127.0.0.1", port, local_addr=(SOURCE, 0))
        try:
            if versions:
                writer.write(handshake(port, version))
                await reader.read(1)
            writer.write(last)
            while await reader.read(1 << 16):
                pass
        finally:
            writer.close()

    async def attack(port: int) -> None:
        await asyncio.gather(
            *(again(partial(visit, port, *ways[k % len(ways)])) for k in range(number))
        )

    return attack


def repeating(*messages: dict[str, Any]) -> Misuse:
    """See `repeat`."""
    return lambda tab: repeat(tab, *messages)


def guessing(length: int, ask: Callable[[str], dict[str, Any]]) -> Misuse:
    """See `guess`."""
    return lambda tab: guess(tab, length, ask)


FILES = [{"is": "make", "file": file} for file in ("table", "picture", "lines", "report", "film")]
ROBOT_CHOICES = [{"do": "ChooseRobot", "name": name} for name in ROBOTS]
ATTACKS: dict[str, Attack] = {
    "recordings": tabs(12, repeating({"is": "make", "file": "film"})),  # D1
    "silent tabs": connections(200, [GREETING]),  # D2
    "other labs' codes": tabs(4, guessing(12, lambda code: {"is": "enter", "code": code})),  # D3
    "half-open": connections(1000, [b""], []),  # D4
    "strokes": tabs(4, scribble),  # D5
    "class codes": tabs(
        20, guessing(6, lambda code: {"is": "join", "code": code, "name": "Ada"})
    ),  # D6, D14
    "unfinished": connections(300, [UNFINISHED]),  # D7
    "files": tabs(8, repeating(*FILES)),  # D7
    "identification": tabs(8, repeating({"do": "Identify"})),
    "paths": tabs(8, repeating(*({"do": "ChoosePath", "name": name} for name in PATHS))),
    "sheets": tabs(8, repeating(*({"is": "ask", "what": what} for what in get_args(SheetName)))),
    "robots": tabs(8, repeating(*ROBOT_CHOICES)),
    "all places": tabs(66, look_on),  # D10
    "nonsense": tabs(8, send_nonsense, MIXED),  # D16
    "wild scripts": scripts(8, wild_message),
    "one dear tab": scripts(1, dear_message),
    "dear tabs": scripts(8, dear_message),
    "greetings": connections(20, [frames(b"x" * 32, opcode=Opcode.TEXT), UNFINISHED], [DATA]),
    "come and go": tabs(20, leave),  # D18
    "floods": connections(20, [100 * GREETING, TOO_LARGE]),
    "broken frames": connections(20, [GREETING + broken for broken in BROKEN.values()]),
    "no requests": connections(20, list(GARBAGE.values()), []),
    "wrong versions": connections(20, [GREETING], VERSIONS),
    "deaf tabs": tabs(8, read_nothing),
}
"""By name; D1-D18 are defects that were found by trying them."""


async def serve(port: int) -> None:
    """Make the attack whose name was read last from standard input; none for an empty line."""
    under_way: asyncio.Task[None] | None = None
    while name := await asyncio.to_thread(sys.stdin.readline):
        if under_way is not None:
            under_way.cancel()
            await asyncio.gather(under_way, return_exceptions=True)
        chosen = ATTACKS.get(name.strip())
        under_way = asyncio.create_task(chosen(port)) if chosen else None


if __name__ == "__main__":
    stand_back()
    asyncio.run(serve(int(sys.argv[1])))
