"""A page that notes what others' work costs its own lab: time, frames, and answers to commands."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass, field
from itertools import pairwise

import msgspec
import numpy as np
from typing_extensions import override
from websockets.asyncio.client import ClientConnection

from tests.bench.simulated_browser import ASK_FORM, Browser

WINDOW = 2.0  # [s]
TICKS = 1e-4  # [s], unit of times in frames
ASKS = 0.25  # [s] between two commands


@dataclass(frozen=True, slots=True)
class Testimony:
    """What a witness has seen.

    Attributes:
        rates: simulated seconds per second, in all windows of `WINDOW`: least and largest.
        gap: longest time between two frames, [s].
        answered: time until a command was answered, [s]: median, 99th percentile and largest.
        commands: number of commands.
    """

    rates: tuple[float, float]
    gap: float
    answered: tuple[float, float, float]
    commands: int


@dataclass
class Witness(Browser):
    """A tab whose robots run, and that says every quarter of a second whether both are moved."""

    _frames: list[tuple[float, float]] = field(default_factory=list)
    _answers: list[float] = field(default_factory=list)
    _asked: float | None = None
    _copied = True

    @property
    def testimony(self) -> Testimony:
        """What it has seen since `forget`."""
        arrived, simulated = np.array(self._frames).T
        grid = np.arange(arrived[0], arrived[-1] - WINDOW, 0.05)
        begin, end = (np.interp(grid + more, arrived, simulated) for more in (0.0, WINDOW))
        rates = (end - begin) / WINDOW
        waits = [*self._answers, *([time.monotonic() - self._asked] if self._asked else [])]
        middle, late = np.quantile(waits, [0.5, 0.99])
        return Testimony(
            rates=(float(rates.min()), float(rates.max())),
            gap=max(later - sooner for (sooner, _), (later, _) in pairwise(self._frames)),
            answered=(float(middle), float(late), max(waits)),
            commands=len(waits),
        )

    def forget(self) -> None:
        """Begin anew."""
        self._frames.clear()
        self._answers.clear()

    @override
    async def _use(self, socket: ClientConnection, until: float) -> None:
        await asyncio.sleep(until - time.monotonic())

    @override
    async def _talk(self, socket: ClientConnection) -> None:
        asking = asyncio.create_task(self._ask(socket))
        try:
            async for text in socket:
                self.told += 1
                message = msgspec.json.decode(text)
                if message["is"] == "lab":
                    await socket.send(ASK_FORM)
                self._note(message)
        finally:
            asking.cancel()

    async def _ask(self, socket: ClientConnection) -> None:
        while True:
            await asyncio.sleep(ASKS)
            if self._asked is None:
                self._copied = not self._copied
                self._asked = time.monotonic()
                command = {"do": "Set", "name": "copy", "value": self._copied}
                await socket.send(msgspec.json.encode(command), text=True)

    def _note(self, message: dict[str, object]) -> None:
        now = time.monotonic()
        match message:
            case {"is": "frame", "rows": [*_, [ticks, *_]]}:
                self._frames.append((now, TICKS * float(ticks)))  # type: ignore[arg-type]
            case {"is": "values", "values": {"copy": copied}} if self._asked is not None:
                if copied is self._copied:
                    self._answers.append(now - self._asked)
                    self._asked = None
            case _:
                pass
