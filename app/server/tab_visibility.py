"""Detects whether a browser is drawing: tabs in the background and closed laptops are not.

A page tells every other second that it draws. While it is silent, its lab is not shown: nothing is
computed or sent, and simulated time stands still, until the page tells again.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from onpath.app.simulation.scheduled_lab import LabDisplay, ScheduledLab

PATIENCE = 6.0  # [s] of silence; a page tells every 2 s, but may stall when it draws in software
TICK = 0.5  # [s] between checks


class TabVisibility:
    """One page. Its feed is its lab's display as long as it draws. Thread-safe."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._lab: ScheduledLab | None = None
        self._display: LabDisplay | None = None
        self._heard = clock()

    def watch(self, lab: ScheduledLab, display: LabDisplay) -> None:
        """Show a lab from now on."""
        with self._lock:
            self._lab, self._display, self._heard = lab, display, self._clock()
            lab.display = display

    def leave(self) -> None:
        """Show no lab."""
        with self._lock:
            if self._lab is not None and self._lab.display is self._display:
                self._lab.display = None
            self._lab = self._display = None

    def hear(self) -> None:
        """Note that the page draws."""
        with self._lock:
            self._heard = self._clock()
            if self._lab is not None and self._lab.display is None:
                self._lab.display = self._display

    def check(self) -> None:
        """Detach the display if the page has been silent for too long."""
        with self._lock:
            silent = self._clock() - self._heard > PATIENCE
            if silent and self._lab is not None and self._lab.display is self._display:
                self._lab.display = None
