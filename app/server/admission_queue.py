"""The queue of a full lab: waiting clients see a notice, and are admitted when a place is free.

No address gets more than fifteen sixteenths of the places, so that no address can shut out all
others; a whole class behind one router fits in. A free place goes to the waiting client whose
address has the fewest, and among those to the one that has waited longest.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

import viser

from onpath.app.page.notice import show_notice
from onpath.app.viser_adapter.connection_limits import PerAddress
from onpath.lessons.words import Words

RESERVED = 16  # one place in 16 is reserved for other addresses


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
        capacity: number of clients that may be admitted at the same time.
    """

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._capacity_each = capacity - capacity // RESERVED
        self._inside = PerAddress[int](capacity, self._capacity_each)
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
            if always or self._inside.has_room(address):
                self._inside.add(number, address)
            else:
                self._waiting[number] = Waiting(address, self._show_notice(client, enter))
                return
        enter()

    def leave(self, number: int) -> None:
        """Remove a client; another one may take its place."""
        with self._lock:
            self._waiting.pop(number, None)
            self._inside.discard(number)
            first = self._first()
            if first is None:
                return
            waiting = self._waiting.pop(first)
            self._inside.add(first, waiting.address)
        waiting.enter()

    def _first(self) -> int | None:
        """Which of the waiting clients may enter now, if any."""
        inside = self._inside
        waiting = self._waiting
        may_enter = [number for number in waiting if inside.has_room(waiting[number].address)]
        return min(
            may_enter, key=lambda number: inside.count(waiting[number].address), default=None
        )

    def _show_notice(
        self, client: viser.ClientHandle, enter: Callable[[], None]
    ) -> Callable[[], None]:
        """Show that the lab is full. Returns a function that removes the notice and enters."""
        words = Words()
        if len(self._inside) >= self._capacity:
            text = words("full.text", places=self._capacity)
        else:
            text = words("full.network", places=self._capacity_each)
        close = show_notice(client, words("full.title"), text)

        def close_and_enter() -> None:
            close()
            enter()

        return close_and_enter
