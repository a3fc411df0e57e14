"""The queue of a full lab: waiting clients see a notice, and are admitted when a place is free."""

from __future__ import annotations

import threading
from collections.abc import Callable

import viser

from onpath.app.page.notice import show_notice
from onpath.lessons.words import Words


class AdmissionQueue:
    """The admitted and the waiting clients; first come, first served.

    Args:
        places: number of clients that may be admitted at the same time.
    """

    def __init__(self, places: int) -> None:
        self._places = places
        self._inside: set[int] = set()
        self._waiting: dict[int, Callable[[], None]] = {}
        self._lock = threading.Lock()

    def admit(self, client: viser.ClientHandle, enter: Callable[[], None], always: bool) -> None:
        """Admit a client, now or as soon as there is a place.

        Args:
            enter: builds its page; called at most once, in any thread.
            always: whether to admit it even if there is no place.
        """
        number = client.client_id
        with self._lock:
            if always or len(self._inside) < self._places:
                self._inside.add(number)
            else:
                self._waiting[number] = self._tell(client, enter)
                return
        enter()

    def leave(self, number: int) -> None:
        """Remove a client; the one that has waited longest takes its place."""
        with self._lock:
            self._waiting.pop(number, None)
            self._inside.discard(number)
            if not self._waiting or len(self._inside) >= self._places:
                return
            first = next(iter(self._waiting))
            enter = self._waiting.pop(first)
            self._inside.add(first)
        enter()

    def _tell(self, client: viser.ClientHandle, enter: Callable[[], None]) -> Callable[[], None]:
        """Show that the lab is full. Returns a function that removes the notice and enters."""
        words = Words()
        text = words("full.text", places=self._places)
        close = show_notice(client, words("full.title"), text)

        def open_up() -> None:
            close()
            enter()

        return open_up
