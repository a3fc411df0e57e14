"""Something done again and again, in a thread of its own."""

from __future__ import annotations

import threading
from collections.abc import Callable

from onpath.app.common.error_log import log_error


class Periodic:
    """A round every so many seconds, from `start` to `stop`; one that fails does not end them.

    Args:
        name: of the thread.
        every: [s] of rest before each round.
        act: one round.
    """

    def __init__(self, name: str, every: float, act: Callable[[], object]) -> None:
        self._every, self._act = every, act
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self, patience: float = 2.0) -> None:
        """End, after waiting so long for a round that is under way, [s]."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(patience)

    def _run(self) -> None:
        while not self._stop.wait(self._every):
            try:
                self._act()
            except Exception as error:
                log_error(error)
