"""What a run is compared with: the run before it, which ended with a reset."""

from __future__ import annotations

from collections.abc import Iterable

from onpath.lessons.checks import measured
from onpath.lessons.record import Record
from onpath.lessons.task_schema import Better, Task


class EarlierRun:
    """What the checks of some tasks measured in the latest run that was long enough for them.

    Attributes:
        values: of the run before the present one, by check; the same dictionary all the time.
    """

    def __init__(self) -> None:
        self.values: dict[Better, float] = {}
        self._now: dict[Better, float] = {}
        self._run = -1

    def follow(self, record: Record, tasks: Iterable[Task]) -> None:
        """Measure the present run; call it again and again, until it is reset."""
        if record.run != self._run:
            self.values.update(self._now)
            self._run, self._now = record.run, {}
        for check in (check for task in tasks for check in task.check):
            if isinstance(check, Better) and (value := measured(check, record)) is not None:
                self._now[check] = value
