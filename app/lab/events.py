"""The events of a lab: what its user did, and incidents."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

MOST, FIRST = 500, 16  # maximum and initial capacity, in events
_ROW = np.dtype([("run", "i4"), ("time", "f8"), ("name", "O"), ("detail", "O"), ("sides", "O")])


class LabEvent(Struct, frozen=True):
    """A user action or an incident.

    Attributes:
        run: number of resets before it.
        time: simulated time, [s].
        name: "set", "path", "robot", "law", "reset", "hold", "let_go", "pull", "release",
            "identify" or "diverged".
        detail: the parameter, the path, the robot, or the `short_name` of the law; or empty.
        sides: the sides concerned.
    """

    run: int
    time: float
    name: str
    detail: str
    sides: tuple[str, ...]

    def repeats(self, earlier: LabEvent) -> bool:
        """Whether it sets the same parameter again, less than a second after an earlier event."""
        return (
            self.name == earlier.name == "set"
            and (self.run, self.detail) == (earlier.run, earlier.detail)
            and 0.0 <= self.time - earlier.time < 1.0
        )


class EventLog:
    """The latest events, oldest first.

    They are rows of one array. Small objects that are replaced one by one over minutes would
    fragment the memory, so that little of it could be returned to the system.

    Args:
        events: the initial ones.
    """

    def __init__(self, events: Iterable[LabEvent] = ()) -> None:
        self._rows: NDArray[Any] = np.zeros(FIRST, _ROW)
        self._count = 0
        for event in events:
            self._add(event)

    def __len__(self) -> int:
        return min(self._count, MOST)

    def __iter__(self) -> Iterator[LabEvent]:
        for number in range(self._count - len(self), self._count):
            yield self._event(number)

    @property
    def last(self) -> LabEvent | None:
        """The latest event."""
        return self._event(self._count - 1) if self._count else None

    def append(self, event: LabEvent) -> None:
        """Add an event, unless it repeats the last one; see `LabEvent.repeats`."""
        if (last := self.last) is None or not event.repeats(last):
            self._add(event)

    def clear(self) -> None:
        """Forget all events."""
        self._rows, self._count = np.zeros(FIRST, _ROW), 0

    def _add(self, event: LabEvent) -> None:
        if self._count == len(self._rows) < MOST:
            longer = np.zeros(min(2 * self._count, MOST), _ROW)
            longer[: self._count] = self._rows
            self._rows = longer
        row = event.run, event.time, event.name, event.detail, event.sides
        self._rows[self._count % MOST] = row
        self._count += 1

    def _event(self, number: int) -> LabEvent:
        run, time, name, detail, sides = self._rows.item(number % MOST)
        return LabEvent(run=run, time=time, name=name, detail=detail, sides=sides)
