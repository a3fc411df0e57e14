"""The thread in which one page is built anew: not the simulation's, nor that of exports."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

from onpath.app.common.error_log import log_error


class RebuildThread:
    """Changes a page in the order in which changes are asked for."""

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "rebuild")

    def submit(self, work: Callable[[], None]) -> None:
        """Do something soon; what fails is logged."""

        def guarded() -> None:
            try:
                work()
            except Exception as error:
                log_error(error)

        with suppress(RuntimeError):  # the tab is gone
            self._pool.submit(guarded)

    def close(self) -> None:
        """Begin nothing more."""
        self._pool.shutdown(wait=False, cancel_futures=True)
