"""A thread that does one piece of work after another."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

from onpath.app.common.error_log import log_error


class WorkThread:
    """Runs functions in the order in which they were submitted."""

    def __init__(self, name: str) -> None:
        self._pool = ThreadPoolExecutor(1, name)

    def submit(self, work: Callable[[], None]) -> None:
        """Queue a function. Exceptions are logged."""

        def guarded() -> None:
            try:
                work()
            except Exception as error:
                log_error(error)

        with suppress(RuntimeError):  # the thread has been closed
            self._pool.submit(guarded)

    def close(self) -> None:
        """Start no further work."""
        self._pool.shutdown(wait=False, cancel_futures=True)
