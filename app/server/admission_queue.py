"""The queue of a full lab: waiting pages say so, and are admitted when a place is free.

No address gets more than fifteen sixteenths of the places, so that no address can shut out all
others; a whole class behind one router fits in. A free place goes to the waiting page whose
address has the fewest, and among those to the one that has waited longest.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass

from onpath.app.viser_adapter.connection_limits import PerAddress

RESERVED = 16  # one place in 16 is reserved for other addresses


@dataclass(slots=True)
class Waiting:
    """A page that waits.

    Attributes:
        address, enter, wait: see `AdmissionQueue.admit`.
        before: how many have waited longer, as it knows.
    """

    address: str
    enter: Callable[[], None]
    wait: Callable[[str, int, int], None]
    before: int = -1


class AdmissionQueue:
    """The admitted and the waiting pages, by number.

    Args:
        capacity: number of pages that may be admitted at the same time.
    """

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._capacity_each = capacity - capacity // RESERVED
        self._inside = PerAddress[int](capacity, self._capacity_each)
        self._waiting: dict[int, Waiting] = {}
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._inside) + len(self._waiting)

    def admit(
        self,
        number: int,
        *,
        enter: Callable[[], None],
        wait: Callable[[str, int, int], None],
        address: str,
        always: bool,
    ) -> None:
        """Admit a page, now or as soon as there is a place.

        Args:
            enter: gives it its lab; called at most once, in any thread.
            wait: called if it must wait, and whenever fewer have waited longer: with the key of the
                message that says why, the number of places, and of those who have waited longer.
            address: the page's, as the limits on connections count it.
            always: whether to admit it even if there is no place.
        """
        with self._lock:
            if not always and not self._inside.has_room(address):
                self._waiting[number] = Waiting(address, enter, wait)
                self._tell()
                return
            self._inside.add(number, address)
        enter()

    def leave(self, number: int) -> None:
        """Remove a page; another one may take its place."""
        with self._lock:
            self._waiting.pop(number, None)
            self._inside.discard(number)
            first = self._first()
            waiting = None if first is None else self._waiting.pop(first)
            if first is not None and waiting is not None:
                self._inside.add(first, waiting.address)
            self._tell()
        if waiting is not None:
            waiting.enter()

    def _tell(self) -> None:
        """Tell those who wait how many have waited longer, if they do not know."""
        for before, waiting in enumerate(self._waiting.values()):
            if waiting.before != before:
                waiting.before = before
                waiting.wait(*self._reason(), before)

    def _first(self) -> int | None:
        """Which of the waiting pages may enter now, if any."""
        inside = self._inside
        waiting = self._waiting
        may_enter = [number for number in waiting if inside.has_room(waiting[number].address)]
        return min(
            may_enter, key=lambda number: inside.count(waiting[number].address), default=None
        )

    def _reason(self) -> tuple[str, int]:
        """Why there is no place."""
        if len(self._inside) >= self._capacity:
            return "full.text", self._capacity
        return "full.network", self._capacity_each
