"""The queue of a full lab: waiting clients see a notice, and are admitted when a place is free.

A sixteenth of the places is kept free for other addresses, so that no address can shut out all
others; a whole class behind one router has the rest. A free place goes to the waiting client whose
address has the fewest, and among those to the one that has waited longest.
"""

from __future__ import annotations

import threading
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

import viser

from onpath.app.page.notice import show_notice
from onpath.lessons.words import Words

KEPT_FREE = 16  # one place in so many is not for an address that has all the others


@dataclass(frozen=True, slots=True)
class Waiting:
    """A client that waits.

    Attributes:
        address: see `AdmissionQueue.admit`.
        enter: removes its notice and builds its page.
    """

    address: str
    enter: Callable[[], None]


class AdmissionQueue:
    """The admitted and the waiting clients.

    Args:
        places: number of clients that may be admitted at the same time.
    """

    def __init__(self, places: int) -> None:
        self._places = places
        self._places_each = places - places // KEPT_FREE
        self._inside: dict[int, str] = {}  # address by client
        self._waiting: dict[int, Waiting] = {}
        self._lock = threading.Lock()

    def admit(
        self, client: viser.ClientHandle, enter: Callable[[], None], address: str, always: bool
    ) -> None:
        """Admit a client, now or as soon as there is a place.

        Args:
            enter: builds its page; called at most once, in any thread.
            address: the client's, as the limits on connections count it.
            always: whether to admit it even if there is no place.
        """
        number = client.client_id
        with self._lock:
            if always or self._has_room(address):
                self._inside[number] = address
            else:
                self._waiting[number] = Waiting(address, self._tell(client, enter))
                return
        enter()

    def leave(self, number: int) -> None:
        """Remove a client; another one may take its place."""
        with self._lock:
            self._waiting.pop(number, None)
            self._inside.pop(number, None)
            first = self._first()
            if first is None:
                return
            waiting = self._waiting.pop(first)
            self._inside[first] = waiting.address
        waiting.enter()

    def _has_room(self, address: str) -> bool:
        each = list(self._inside.values()).count(address)
        return len(self._inside) < self._places and each < self._places_each

    def _first(self) -> int | None:
        """Which of the waiting clients may enter now, if any."""
        have = Counter(self._inside.values())
        may = [number for number, each in self._waiting.items() if self._has_room(each.address)]
        return min(may, key=lambda number: have[self._waiting[number].address], default=None)

    def _tell(self, client: viser.ClientHandle, enter: Callable[[], None]) -> Callable[[], None]:
        """Show that the lab is full. Returns a function that removes the notice and enters."""
        words = Words()
        if len(self._inside) >= self._places:
            text = words("full.text", places=self._places)
        else:
            text = words("full.network", places=self._places_each)
        close = show_notice(client, words("full.title"), text)

        def open_up() -> None:
            close()
            enter()

        return open_up
