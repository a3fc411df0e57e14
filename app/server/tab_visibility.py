"""Detects whether a browser is drawing: tabs in the background and closed laptops are not.

A hidden page of viser still receives and acknowledges messages, but reports its camera only when it
draws. So from time to time the server sends each page its own "up" direction, and a page that draws
replies with its camera. While the reply is overdue, the lab is not shown: nothing is computed or
sent, and simulated time stands still, until the reply arrives.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Protocol

import viser

from onpath.app.simulation.scheduled_lab import LabDisplay, ScheduledLab
from onpath.app.viser_adapter.camera import ask_for_camera

QUESTION_INTERVAL = 2.0  # [s] between questions, while anything is sent to the browser
PATIENCE = 4.0  # [s] to wait for the reply; a browser that draws in software may stall for two
TICK = 0.5  # [s] between checks


class CountingDisplay(LabDisplay, Protocol):
    """A display that counts its updates."""

    @property
    def updates(self) -> int:
        """Number of updates sent to the browser."""
        ...


class TabVisibility:
    """One browser. It is its lab's display as long as it draws. Thread-safe."""

    def __init__(
        self, client: viser.ClientHandle, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._client, self._clock = client, clock
        self._lock = threading.Lock()
        self._lab: ScheduledLab | None = None
        self._display: CountingDisplay | None = None
        self._heard = self._questioned = clock()
        self._updates = 0  # number of updates when the last reply came
        self._unanswered: float | None = None  # time of the unanswered question, [s]
        client.camera.on_update(self._hear)

    def watch(self, lab: ScheduledLab, display: CountingDisplay) -> None:
        """Show a lab from now on."""
        with self._lock:
            self._lab, self._display = lab, display
            self._heard, self._updates, self._unanswered = self._clock(), display.updates, None
            lab.display = display

    def leave(self) -> None:
        """Show no lab."""
        with self._lock:
            if self._lab is not None and self._lab.display is self._display:
                self._lab.display = None
            self._lab = self._display = None

    def look(self) -> None:
        """Ask the browser if it is time; detach the display if the reply is overdue."""
        now = self._clock()
        with self._lock:
            lab, display = self._lab, self._display
            if lab is None or display is None:
                return
            if self._unanswered is None:
                if display.updates == self._updates or now - self._heard < QUESTION_INTERVAL:
                    return
                self._unanswered = now
            elif now - self._questioned < QUESTION_INTERVAL:
                return
            elif now - self._unanswered >= PATIENCE and lab.display is display:
                lab.display = None
            self._questioned = now
        ask_for_camera(self._client)

    async def _hear(self, _: viser.CameraHandle) -> None:
        with self._lock:
            self._heard, self._unanswered = self._clock(), None
            if self._lab is None or self._display is None:
                return
            self._updates = self._display.updates
            if self._lab.display is None:
                self._lab.display = self._display


class TabVisibilities:
    """All browsers of a server, checked on its event loop."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._all: dict[int, TabVisibility] = {}
        self._loop = server.get_event_loop()
        self._loop.call_soon_threadsafe(self._look)

    def watch(
        self, client: viser.ClientHandle, lab: ScheduledLab, display: CountingDisplay
    ) -> None:
        """Show a lab in a browser, instead of any other."""
        number = client.client_id
        if number not in self._all:
            self._all[number] = TabVisibility(client)
        self._all[number].watch(lab, display)

    def leave(self, client: int) -> None:
        """Show no lab in a browser for now."""
        if (tab := self._all.get(client)) is not None:
            tab.leave()

    def forget(self, client: int) -> None:
        """Remove a browser that has disconnected."""
        if (tab := self._all.pop(client, None)) is not None:
            tab.leave()

    def _look(self) -> None:
        self._loop.call_later(TICK, self._look)
        for tab in list(self._all.values()):
            tab.look()
