"""Values measured earlier: in the run before, and once in a step."""

from __future__ import annotations

from collections.abc import Iterable

from onpath.lessons.checks import event_named, happens, keeps, measured
from onpath.lessons.record import Record
from onpath.lessons.task_schema import Better, Once, Task


class EarlierRun:
    """The values that the checks of some tasks measured.

    Attributes:
        values: by check, always in the same dictionary. For `Better`, from the latest earlier run
            that was long enough; for `Once`, from when the bound was last kept.
    """

    def __init__(self) -> None:
        self.values: dict[Better | Once, float] = {}
        self._now: dict[Better | Once, float] = {}
        self._run = -1
        self._undone: dict[Once, int] = {}  # events that have undone it

    def follow(self, record: Record, tasks: Iterable[Task]) -> None:
        """Measure the present run; to be called repeatedly until the run is reset."""
        if record.run != self._run:
            self.values.update(self._now)
            self._run, self._now = record.run, {}
        for check in (check for task in tasks for check in task.check):
            if isinstance(check, Better) and (value := measured(check, record)) is not None:
                self._now[check] = value
            elif isinstance(check, Once):
                self._follow_once(check, record)

    def _follow_once(self, check: Once, record: Record) -> None:
        undoing = [event_named(text) for text in check.since]
        undone = sum(happens(event, each) for event in record.happenings for each in undoing)
        if undone != self._undone.get(check, 0):
            self._undone[check] = undone
            self.values.pop(check, None)
        if (value := keeps(check, record)) is not None:
            self.values[check] = value
