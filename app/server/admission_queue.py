"""Before a lab that is full: a page that says so costs nothing, and opens when a place is free."""

from __future__ import annotations

import threading
from collections.abc import Callable

import viser

from onpath.app.page.notice import show_notice
from onpath.lessons.words import Words


class AdmissionQueue:
    """Who is inside and who waits; the first to come is the first to get in.

    Args:
        places: so many clients are inside at once.
    """

    def __init__(self, places: int) -> None:
        self._places = places
        self._inside: set[int] = set()
        self._waiting: dict[int, Callable[[], None]] = {}
        self._lock = threading.Lock()

    def admit(self, client: viser.ClientHandle, enter: Callable[[], None], always: bool) -> None:
        """Let a client in, now or as soon as there is a place.

        Args:
            enter: builds its page; called at most once, in any thread.
            always: even when there is no place.
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
        """A client is gone; whoever has waited longest gets its place."""
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
        """Show that the lab is full; returns what takes that away again and enters."""
        words = Words()
        text = words("full.text", places=self._places)
        close = show_notice(client, words("full.title"), text)

        def open_up() -> None:
            close()
            enter()

        return open_up
