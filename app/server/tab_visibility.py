"""Whether a browser draws what it is told: a tab in the background does not, nor a closed laptop.

viser's page takes its messages in even while it is hidden, and answers them; but where its camera
is, it says only when it draws. So now and then it is told which way is up, just as it has said
itself, and says in turn where its camera is. While that is overdue, nobody looks at its lab:
nothing is computed and nothing sent, simulated time waits, and goes on with the answer.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Protocol

import viser
from viser import _messages

from onpath.app.simulation.simulation_thread import Display, ScheduledLab

QUESTION_INTERVAL = 2.0  # [s] between questions, while the browser is told anything
PATIENCE = 4.0  # [s] with the answer; a browser that draws in software may stall for two
TICK = 0.5  # [s]


class CountingDisplay(Display, Protocol):
    """A view that counts."""

    @property
    def told(self) -> int:
        """How often the browser has been told something."""
        ...


class TabVisibility:
    """One browser; the view is its lab's as long as it draws. From any thread."""

    def __init__(
        self, client: viser.ClientHandle, clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._client, self._clock = client, clock
        self._lock = threading.Lock()
        self._lab: ScheduledLab | None = None
        self._view: CountingDisplay | None = None
        self._heard = self._questioned = clock()
        self._told = 0  # when it was heard
        self._unanswered: float | None = None  # since when, [s]
        client.camera.on_update(self._hear)

    def watch(self, lab: ScheduledLab, view: CountingDisplay) -> None:
        """Look at a lab from now on."""
        with self._lock:
            self._lab, self._view = lab, view
            self._heard, self._told, self._unanswered = self._clock(), view.told, None
            lab.view = view

    def leave(self) -> None:
        """Look at nothing."""
        with self._lock:
            if self._lab is not None and self._lab.view is self._view:
                self._lab.view = None
            self._lab = self._view = None

    def look(self) -> None:
        """Ask the browser if it is time, and take the view away if it has not answered."""
        now = self._clock()
        with self._lock:
            lab, view = self._lab, self._view
            if lab is None or view is None:
                return
            if self._unanswered is None:
                if view.told == self._told or now - self._heard < QUESTION_INTERVAL:
                    return
                self._unanswered = now
            elif now - self._questioned < QUESTION_INTERVAL:
                return
            elif now - self._unanswered >= PATIENCE and lab.view is view:
                lab.view = None
            self._questioned = now
        up = tuple(self._client.camera.up_direction.tolist())
        message = _messages.SetCameraUpDirectionMessage(up)
        self._client._websock_connection.queue_message(message)

    async def _hear(self, _: viser.CameraHandle) -> None:
        with self._lock:
            self._heard, self._unanswered = self._clock(), None
            if self._lab is None or self._view is None:
                return
            self._told = self._view.told
            if self._lab.view is None:
                self._lab.view = self._view


class TabVisibilities:
    """All browsers of a server, looked at by its event loop."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._all: dict[int, TabVisibility] = {}
        self._loop = server.get_event_loop()
        self._loop.call_soon_threadsafe(self._look)

    def watch(self, client: viser.ClientHandle, lab: ScheduledLab, view: CountingDisplay) -> None:
        """A browser looks at a lab, and at no other."""
        number = client.client_id
        if number not in self._all:
            self._all[number] = TabVisibility(client)
        self._all[number].watch(lab, view)

    def leave(self, client: int) -> None:
        """A browser looks at nothing, for now."""
        if (onlooker := self._all.get(client)) is not None:
            onlooker.leave()

    def forget(self, client: int) -> None:
        """A browser is gone."""
        if (onlooker := self._all.pop(client, None)) is not None:
            onlooker.leave()

    def _look(self) -> None:
        self._loop.call_later(TICK, self._look)
        for onlooker in list(self._all.values()):
            onlooker.look()
