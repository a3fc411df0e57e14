"""Runs a function periodically in its own thread."""

from __future__ import annotations

import threading
from collections.abc import Callable

from onpath.app.common.error_log import log_error


class Periodic:
    """Calls a function periodically, from `start` to `stop`; exceptions are logged.

    Args:
        name: of the thread.
        every: pause before each call, [s].
        act: the function.

    Attributes:
        awake: while it is not set, no call is made.
        due: set it to end the pause before the next call.
    """

    def __init__(self, name: str, every: float, act: Callable[[], object]) -> None:
        self._every, self._act = every, act
        self._stop, self.awake = threading.Event(), threading.Event()
        self.due = threading.Event()
        self.awake.set()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self, patience: float = 2.0) -> None:
        """Stop the thread, and wait up to `patience` [s] for a call in progress."""
        self._stop.set()
        self.awake.set()
        self.due.set()
        if self._thread.is_alive():
            self._thread.join(patience)

    def _run(self) -> None:
        while self.awake.wait():
            self.due.wait(self._every)
            self.due.clear()
            if self._stop.is_set():
                return
            try:
                self._act()
            except Exception as error:
                log_error(error)
