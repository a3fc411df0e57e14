"""Pages are built one at a time, with rests: sixty at once would stop those who are inside."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

import viser

from onpath.app.common.error_log import log_error
from onpath.app.page.notice import show_notice
from onpath.lessons.words import Words

one_at_a_time = threading.Lock()
"""Held while a page is built, or built anew; never while a browser is waited for."""
MOST_REST = 0.5  # [s] after a newcomer's page; else as long as that took
FEW = 2  # so many pages are built while a newcomer looks at nothing


class BuildQueue:
    """Builds the pages of those who come, in the order in which they have come.

    In a thread of its own: viser's, which many waiting for their page would take up, are for
    those inside who press a button.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._pool = ThreadPoolExecutor(1, "pages")
        self._lock = threading.Lock()
        self._ahead = 0

    def submit(self, client: viser.ClientHandle, build: Callable[[], None]) -> None:
        """Build a page soon; a client that has to wait is told so meanwhile.

        Args:
            build: called even if the client has left by then.
        """
        with self._lock:
            told = _tell(client) if self._ahead >= FEW else None
            self._ahead += 1
        with suppress(RuntimeError):  # the server has stopped
            self._pool.submit(self._build, client.client_id, told, build)

    def stop(self) -> None:
        """Finish the page that is being built, and no other."""
        self._pool.shutdown(cancel_futures=True)

    def _build(
        self, client: int, told: Callable[[], None] | None, build: Callable[[], None]
    ) -> None:
        begun = time.monotonic()
        try:
            if told is not None and client in self._server.get_clients():
                told()
            build()
        except Exception as error:
            log_error(error)
        time.sleep(min(time.monotonic() - begun, MOST_REST))
        with self._lock:
            self._ahead -= 1


def _tell(client: viser.ClientHandle) -> Callable[[], None]:
    """Returns what takes it away again."""
    words = Words()
    return show_notice(client, words("coming.title"), words("coming.text"))
