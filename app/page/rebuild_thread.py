"""Thread that rebuilds one page, separate from the simulation and export threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

from onpath.app.common.error_log import log_error


class RebuildThread:
    """Runs the changes of one page in the order in which they were submitted."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "rebuild")

    def submit(self, work: Callable[[], None]) -> None:
        """Queue a function. Exceptions are logged."""

        def guarded() -> None:
            try:
                work()
            except Exception as error:
                log_error(error)

        with suppress(RuntimeError):  # the tab has closed
            self._pool.submit(guarded)

    def close(self) -> None:
        """Start no further work."""
        self._pool.shutdown(wait=False, cancel_futures=True)
