"""Attacks on a running server, one kind after the other, from a separate address.

`python -m tests.bench.attacks PORT` reads names of `ATTACKS`, and makes each until the next.
"""

from __future__ import annotations

import asyncio
import random
import sys
import time
from collections.abc import AsyncIterator, Callable, Coroutine, Sequence
from contextlib import suppress
from functools import partial
from itertools import count, cycle, product
from math import inf
from typing import Any

from typing_extensions import override
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import ConnectionClosed, WebSocketException
from websockets.frames import Opcode

from onpath.app.viser_adapter.data_channel import SUBPROTOCOL as DATA
from onpath.app.viser_adapter.message_filter import Limits
from onpath.lessons.labels import robot_label
from onpath.lessons.words import Words
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
RATE = 0.9 * Limits().changes_per_second  # of changed widgets or drags; no tab is closed for that
BYTES = 0.9 * 4000 * Limits().messages_per_second  # per second; see `Limits.message_burst`
MIXED = 0.75 * Limits().messages_per_second  # of messages, a quarter of which are drags
TURNED_AWAY = 0.1  # [s] until it comes back
GREETING = frames(packed("ViewerCameraMessage", **CAMERA))
UNFINISHED = frames(bytes(980_000))[:-1]
TOO_LARGE = frames(bytes(1_000_001))
PATHS = ("ellipse", "clover", "rounded square", "figure of eight", "segment", "circle")

Attack = Callable[[int], Coroutine[Any, Any, None]]
Misuse = Callable[["Intruder"], AsyncIterator[bytes]]


class Intruder(Browser):
    """A tab that receives its lab like any other, and sends what `misuse` yields.

    Args:
        rate: messages per second.

    Attributes:
        widgets: the ids of its widgets by label.
        socket: its connection, once it has begun.
    """

    def __init__(self, port: int, misuse: Misuse, rate: float = RATE) -> None:
        super().__init__(port, 0, SOURCE)
        self._misuse, self._rate = misuse, rate
        self.widgets: dict[str, str] = {}

    async def find(self, label: str) -> str:
        """The id of the widget whose label begins so, as soon as there is one."""
        while True:
            for text, uuid in self.widgets.items():
                if text.startswith(label):
                    return uuid
            await asyncio.sleep(TURNED_AWAY)

    @property
    def owner(self) -> str:
        """The client whose nodes it may drag: its own."""
        return self._owner

    def _heeds(self, kind: str) -> bool:
        return kind.startswith("Gui") or super()._heeds(kind)

    async def _answer(self, socket: ClientConnection, message: dict[str, Any]) -> None:
        await super()._answer(socket, message)
        if label := message.get("props", {}).get("label"):
            self.widgets[label] = message["uuid"]

    async def _use(self, socket: ClientConnection, until: float) -> None:
        self.socket = socket
        async for message in self._misuse(self):
            await socket.send(message)
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


def update(uuid: str, value: Any) -> bytes:
    """The message of a widget whose value the user has changed, or of a pressed button."""
    return packed("GuiUpdateMessage", uuid=uuid, updates={"value": value})


# Attacks by a single tab.


async def press(tab: Intruder, *presses: tuple[str, Any]) -> AsyncIterator[bytes]:
    """Change widgets, given by the beginnings of their labels, in turn and without end."""
    for label, value in cycle(presses):
        yield update(await tab.find(label), value)


async def guess(tab: Intruder, typed: str, length: int, button: str) -> AsyncIterator[bytes]:
    """Type random codes of a given length, and press a button."""
    field, pressed = await tab.find(typed), await tab.find(button)
    while True:
        yield update(field, "".join(random.choices("abcdefghjkmnpqrstuvwxyz", k=length)))
        yield update(pressed, True)


async def scribble(tab: Intruder) -> AsyncIterator[bytes]:
    """A stroke that does not end."""
    yield update(await tab.find("Draw freehand"), True)
    for step in count():
        end = [0.2 + 0.1 * random.random(), 0.0, 0.1 + 0.1 * random.random()]
        phase = "update" if step % 100_000 else "start"
        at = {"name": "/freehand/sheet", "owner": tab.owner, "instance_index": None}
        yield packed("SceneNodeDragMessage", **DRAG | at | {"phase": phase, "end_position": end})


async def send_nonsense(tab: Intruder) -> AsyncIterator[bytes]:
    """Any field of any message with any value, any index of a drag, any value of any widget."""
    await tab.find("K1")
    while True:
        for kind in random.choices(list(HONEST), k=3):
            field = random.choice(list(HONEST[kind]))
            yield packed(kind, **HONEST[kind] | {field: random.choice(HOSTILE)})
        at = {"name": "/grips", "owner": tab.owner, "instance_index": random.choice(INDEXES)}
        yield packed("SceneNodeDragMessage", **DRAG | at)
        yield update(random.choice(list(tab.widgets.values())), random.choice(HOSTILE))


async def leave(tab: Intruder) -> AsyncIterator[bytes]:
    """Close the tab as soon as it is shown its lab."""
    await tab.find("K1")
    yield GREETING


async def read_nothing(tab: Intruder) -> AsyncIterator[bytes]:
    """Never read what the server sends."""
    await tab.find("K1")
    tab.socket.transport.pause_reading()
    yield GREETING
    await asyncio.sleep(inf)


async def look_on(tab: Intruder) -> AsyncIterator[bytes]:
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


def pressing(*presses: tuple[str, Any]) -> Misuse:
    """See `press`."""
    return lambda tab: press(tab, *presses)


ROBOT_LABELS = [robot_label(name, Words()) for name in ROBOTS]
FILES = ("CSV", "Picture", "Record of my", "Recording")
ATTACKS: dict[str, Attack] = {
    "recordings": tabs(12, pressing(("Recording", True))),  # D1
    "silent tabs": connections(200, [GREETING]),  # D2
    "other labs' codes": tabs(4, lambda tab: guess(tab, "Another code", 12, "Go to that")),  # D3
    "half-open": connections(1000, [b""], []),  # D4
    "strokes": tabs(4, scribble),  # D5
    "class codes": tabs(20, lambda tab: guess(tab, "Class code", 6, "Join")),  # D6, D14
    "unfinished": connections(300, [UNFINISHED]),  # D7
    "files": tabs(8, pressing(*((name, True) for name in FILES))),  # D7
    "identification": tabs(8, pressing(("Identify", True))),
    "paths": tabs(8, pressing(*(("Path", name) for name in PATHS))),
    "menus": tabs(8, pressing(("Robot…", True))),
    "robots": tabs(8, pressing(("Robot…", True), *((label, True) for label in ROBOT_LABELS))),
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
