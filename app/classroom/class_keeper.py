"""Keeps a class in the database (write-behind), and notices when another process takes it over.

A class is in the memory of one process, the one that claimed its row last. A process claims it
when somebody comes to its address and the row is not its own: then its own memory, if it has any,
is outdated, and replaced by what is stored.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from onpath.app.classroom.admission import class_id_of
from onpath.app.classroom.class_state import from_stored, to_stored
from onpath.app.classroom.classroom import NOTHING_DONE, Classroom, ClassState
from onpath.app.common.error_log import log_warning
from onpath.app.common.periodic import Periodic
from onpath.app.storage.records import HeldElsewhere, NotKept, Records
from onpath.app.storage.schema import classes
from onpath.lessons.progress import Progress, read_progress

KEEP_INTERVAL = 1.0  # [s] between writes: the most that is lost if the process is killed


class ClassKeeper:
    """Keeps one class with an address.

    Args:
        lost: called when another process has taken the class over; it is empty here by then.

    Attributes:
        rounds: the periodic writes.
    """

    def __init__(self, classroom: Classroom, records: Records, lost: Callable[[], object]) -> None:
        self._class, self._records, self._lost = classroom, records, lost
        self._id = class_id_of(classroom.key)
        self._is_open = False
        self._kept: tuple[object, ...] = ()
        self._lock = threading.Lock()
        self.rounds = Periodic("class keeper", KEEP_INTERVAL, self.look)

    def open(self) -> None:
        """Take the class over, unless it is here and up to date. Waits for the database."""
        with self._lock:
            try:
                if self._is_open and self._records.is_current(self._id, classes):
                    return
                stored = self._records.claim(self._id, classes)
            except NotKept as error:
                log_warning("the class is not read from the database: %s", error)
                self._is_open = True
                return
            now = self._class.clock()
            self._class.restore(from_stored(stored, self._progress, now))
            self._kept, self._is_open = (), True

    def look(self) -> None:
        """Store the class if it has changed; give it up if another process has it."""
        with self._lock:
            if not self._is_open:
                return
            try:
                self._store()
                return
            except NotKept as error:
                log_warning("the class is not stored: %s", error)
                return
            except HeldElsewhere:
                log_warning("class %s has moved to another process", self._class.code)
                self._is_open = False
                self._class.restore(ClassState())
        self._lost()

    def stop(self) -> None:
        """Store the class for the last time."""
        self.rounds.stop()
        self.look()

    def _store(self) -> None:
        """Raises: HeldElsewhere, NotKept."""
        now, state = self._class.clock(), self._class.state
        stored = to_stored(state, now)
        mark = stored, self._records.generation
        if mark != self._kept:
            self._records.save(self._id, stored, classes)
            self._kept = mark
        elif not self._records.is_current(self._id, classes):
            raise HeldElsewhere

    def _progress(self, session: str) -> Progress:
        """The progress stored with a student's lab."""
        try:
            return read_progress((self._records.load(session) or {}).get("lessons"))
        except (OSError, ValueError) as error:
            log_warning("a student's progress cannot be read: %s", error)
            return NOTHING_DONE
