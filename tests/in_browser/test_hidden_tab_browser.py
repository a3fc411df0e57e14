"""A lab behind another tab of a real browser: the cost meanwhile, and the picture afterwards.

Playwright keeps all its tabs visible, so the browser is controlled by the DevTools protocol.
"""

from __future__ import annotations

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.request import Request, urlopen

import numpy as np
import pytest
import websockets.sync.client

pytest.importorskip("playwright")

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_feed import LabFeed
from onpath.app.server.lab_server import LabServer
from onpath.app.server.tab_visibility import PATIENCE, TICK
from tests.support.browser import CHROMIUM, COARSER, PLAIN, wait_for
from tests.support.frame_clock import FrameClock

pytestmark = pytest.mark.thorough

SHOWN = "onpathLab.settings.value('path')"
SMALL = ("--window-size=600,400",)  # so that drawing in software keeps up
HIDDEN, PAUSED = 200.0, 1000.0  # [B/s]


class Window:
    """A browser with the lab in its first tab."""

    def __init__(self, folder: Path, address: str) -> None:
        options = ["--headless=new", f"--user-data-dir={folder}", "--remote-debugging-port=0"]
        self._process = subprocess.Popen(
            [CHROMIUM, *options, "--remote-allow-origins=*", *SMALL, *PLAIN, address],
            stderr=subprocess.DEVNULL,
        )
        told = folder / "DevToolsActivePort"
        self._port = wait_for(lambda: told.exists() and told.read_text().partition("\n")[0])
        self._lab = wait_for(lambda: [t for t in self._ask("list") if t["type"] == "page"])[0]

    def close(self) -> None:
        self._process.terminate()
        self._process.wait()

    def cover(self) -> None:
        """Bring another tab to the front."""
        self._ask("new?about:blank", "PUT")
        wait_for(lambda: self.evaluate("document.visibilityState") == "hidden")

    def uncover(self) -> None:
        """Bring the lab's tab back to the front."""
        self._ask(f"activate/{self._lab['id']}")
        wait_for(lambda: self.evaluate("document.visibilityState") == "visible")

    def evaluate(self, expression: str) -> Any:
        """Evaluate a JavaScript expression in the lab's page."""
        ask = {"id": 1, "method": "Runtime.evaluate", "params": {"expression": expression}}
        with websockets.sync.client.connect(self._lab["webSocketDebuggerUrl"]) as socket:
            socket.send(json.dumps(ask))
            return json.loads(socket.recv(timeout=10))["result"]["result"]["value"]

    def _ask(self, what: str, method: str = "GET") -> Any:
        with urlopen(Request(f"http://127.0.0.1:{self._port}/json/{what}", method=method)) as reply:
            said = reply.read()
        return json.loads(said) if said.startswith((b"{", b"[")) else said


@pytest.fixture
def server() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, LoopCache())
    yield server
    server.stop()


@pytest.fixture
def window(server: LabServer, tmp_path: Path) -> Iterator[Window]:
    window = Window(tmp_path / "browser", f"{server.address}/?{COARSER}")
    yield window
    window.close()


class Meter:
    """Counts the bytes that are written to the only browser, through both of its websockets."""

    def __init__(self, server: LabServer, view: LabFeed) -> None:
        visers = server.server._websock_server._live_connections
        wait_for(lambda: visers)
        self._clock, self._sent = FrameClock(server.thread), 0
        own = view._data._stream._connection
        assert own is not None
        for connection in (*visers.values(), own):
            self._count(connection.transport)

    def _count(self, transport: Any) -> None:
        write = transport.write

        def counted(data: bytes | bytearray | memoryview) -> None:
            self._sent += len(data)
            write(data)

        transport.write = counted

    def rate(self, seconds: float) -> float:
        """Measure the data rate, [B/s], in as many frames as should pass in these seconds."""
        before = self._sent
        wait_for(self._clock.alarm(seconds))
        return (self._sent - before) / seconds


def test_a_covered_tab_costs_nothing_and_then_shows_the_current_state(
    server: LabServer, window: Window
) -> None:
    (lab,) = wait_for(lambda: server.thread.labs)
    view = wait_for(lambda: lab.display)
    meter = Meter(server, view)
    wait_for(lambda: lab.simulation.time > 1.0)

    def seen_throughout() -> float:
        rate = meter.rate(PATIENCE + TICK)
        return rate if lab.display is view else 0.0

    visible = wait_for(seen_throughout)  # drawn in software, but seen, once the page has settled
    (client,) = server.server.get_clients().values()
    camera = client.camera.position
    window.cover()
    wait_for(lambda: lab.display is None)
    wait_for(lambda: meter.rate(TICK) < HIDDEN)  # what was on its way to a busy browser
    simulated = lab.simulation.time
    hidden = meter.rate(3.0)
    assert hidden < min(HIDDEN, 0.02 * visible)
    assert lab.display is None and lab.simulation.time == simulated
    lab.lab.post(c.ChoosePath("clover"))
    window.uncover()
    wait_for(lambda: lab.display is view)
    wait_for(lambda: window.evaluate(SHOWN) == "clover")
    assert meter.rate(1.0) > 0.3 * visible and lab.simulation.time > simulated
    assert np.allclose(client.camera.position, camera, atol=1e-9)  # for all that it was asked
    lab.lab.post(c.SetRunning(False))
    wait_for(lambda: meter.rate(2.0) < PAUSED)  # once the last frames have been written
    assert meter.rate(PATIENCE + TICK) < PAUSED and lab.display is view
