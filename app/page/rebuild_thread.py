"""Thread that rebuilds one page, separate from the simulation and export threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

import viser

from onpath.app.common.error_log import log_error


class RebuildThread:
    """Runs the changes of one page in the order in which they were submitted."""

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client
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

    def change(self, work: Callable[[], None]) -> None:
        """Queue a change of widgets, which the browser receives as a whole.

        Otherwise a user could press a widget before its callbacks are set, in vain.
        """

        def atomically() -> None:
            with self._client.atomic():
                work()

        self.submit(atomically)

    def close(self) -> None:
        """Start no further work."""
        self._pool.shutdown(wait=False, cancel_futures=True)
