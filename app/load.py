"""Simulated browsers: they read everything that a lab sends, pull at it and move its sliders.

`python -m app.load PORT CLIENTS SECONDS` prints, as JSON, what they have seen.
"""

from __future__ import annotations

import asyncio
import json
import math
import sys
import time
from dataclasses import dataclass, field
from http import HTTPStatus
from typing import Any

import numpy as np
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidMessage, InvalidStatus
from websockets.typing import Subprotocol

from app.protocol import CAMERA, SUBPROTOCOL, answer, packed, unpacked

EVERY = 0.05  # [s] between a hand's messages; no browser sends more often
CYCLE = 4.0  # [s]: pull, rest, move a slider, rest
MOVING = "/links"


@dataclass
class Browser:
    """One simulated tab.

    Attributes:
        number: sets it apart in time from the others.
        shown: when it was told new poses, [s].
        received: [B].
    """

    port: int
    number: int
    shown: list[float] = field(default_factory=list)
    received: int = 0
    _slider: str = ""
    _owner: str = ""

    async def browse(self, seconds: float) -> None:
        """Use the lab for a while, or until it closes the connection.

        Raises:
            OSError, WebSocketException: no connection, or one that broke.
        """
        address = f"ws://127.0.0.1:{self.port}"
        options: dict[str, Any] = {"max_size": None, "compression": None}
        async with connect(address, subprotocols=[Subprotocol(SUBPROTOCOL)], **options) as socket:
            await socket.send(packed("ViewerCameraMessage", **CAMERA))
            until = time.monotonic() + seconds
            tasks = [
                asyncio.create_task(do) for do in (self._read(socket), self._use(socket, until))
            ]
            try:
                done, _ = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
                for task in done:
                    task.result()
            finally:
                for task in tasks:
                    task.cancel()
                await asyncio.gather(*tasks, return_exceptions=True)

    async def _read(self, socket: ClientConnection) -> None:
        async for raw in socket:
            assert isinstance(raw, bytes)
            self.received += len(raw)
            names: set[str] = set()
            for message in unpacked(raw):
                names.add(message.get("name", ""))
                await self._answer(socket, message)
            if MOVING in names:
                self.shown.append(time.monotonic())

    async def _answer(self, socket: ClientConnection, message: dict[str, Any]) -> None:
        kind = message["type"]
        if reply := answer(message):
            await socket.send(reply)
        elif kind == "GuiSliderMessage" and message["props"]["label"].startswith("K1"):
            self._slider = message["uuid"]
        elif kind == "BatchedMeshesMessage" and message["name"] == "/grips":
            self._owner = message["owner"]

    async def _use(self, socket: ClientConnection, until: float) -> None:
        while not self._slider and time.monotonic() < until:
            await asyncio.sleep(EVERY)
        held = False
        while (now := time.monotonic()) < until:
            phase = (now + 0.37 * self.number) % CYCLE
            pulls = phase < 1.0
            if pulls or held:
                step = ("update" if held else "start") if pulls else "end"
                await socket.send(self._pull(step, phase))
                held = pulls
            elif 2.0 < phase < 3.0:
                value = {"value": 400.0 + 10 * round(10 * (phase - 2.0))}
                await socket.send(packed("GuiUpdateMessage", uuid=self._slider, updates=value))
            await asyncio.sleep(EVERY)

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
    """Return when a browser that comes now is shown a moving robot.

    Raises:
        WebSocketException: refused for another reason than that the server is not ready yet.
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
    """Whether a server that is starting answers in this way."""
    if isinstance(error, InvalidStatus):
        return error.response.status_code == HTTPStatus.SERVICE_UNAVAILABLE
    return isinstance(error, OSError | EOFError | InvalidMessage | ConnectionClosed)


async def crowd(port: int, clients: int, seconds: float, settled: float = 4.0) -> dict[str, float]:
    """What some browsers see, at once, after they have settled [s]."""
    browsers = [Browser(port, number) for number in range(clients)]
    begun = time.monotonic()
    await asyncio.gather(*(browser.browse(seconds) for browser in browsers))
    rates: list[float] = []
    gaps: list[float] = []
    for browser in browsers:
        shown = np.array([t for t in browser.shown if t > begun + settled])
        if len(shown) > 2:
            rates.append((len(shown) - 1) / float(shown[-1] - shown[0]))
            gaps.extend(np.diff(shown).tolist())
    return {
        "clients": float(len(rates)),
        "slowest_hz": min(rates, default=0.0),
        "gap_p99_s": float(np.quantile(gaps, 0.99)) if gaps else float("inf"),
        "bytes_per_s": sum(browser.received for browser in browsers) / seconds / clients,
    }


if __name__ == "__main__":
    seen = asyncio.run(crowd(int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])))
    sys.stdout.write(json.dumps(seen) + "\n")
