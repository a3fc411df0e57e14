"""Keeps a class in the database (write-behind), and notices when another process takes it over.

A class lives in the memory of one process, the one that claimed its row last. When somebody opens
the address of a class whose row belongs to another process, this process claims the row, and
replaces any outdated copy in its memory by the stored class. It cannot claim a class that another
process has open, because that process holds a lease of it; see `app.storage.leases`.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from onpath.app.classroom.admission import class_id_of
from onpath.app.classroom.class_state import from_stored, to_stored
from onpath.app.classroom.classroom import NOTHING_DONE, Classroom, ClassState
from onpath.app.common.error_log import log_warning
from onpath.app.common.periodic import Periodic
from onpath.app.storage.deletions import seat_name
from onpath.app.storage.engine import held
from onpath.app.storage.records import HeldElsewhere, NotKept, Records
from onpath.app.storage.schema import classes
from onpath.lessons.progress import Progress, read_progress

KEEP_INTERVAL = 1.0  # [s] between writes: at most this much is lost if the process is killed
FRESH = 2.5  # [s] for which the last answer of the database is good enough for newcomers
OPENING_WAIT = 10.0  # [s] to wait for another thread that is asking the database


class ClassKeeper:
    """Keeps one class.

    Args:
        lost: called when another process has taken the class over and its copy here is empty.

    Attributes:
        id: identifies the class in the database.
        rounds: the periodic writes.
    """

    def __init__(self, classroom: Classroom, records: Records, lost: Callable[[], object]) -> None:
        self._class, self._records, self._lost = classroom, records, lost
        self.id = class_id_of(classroom.key)
        self._kept: tuple[object, ...] = ()
        self._seats = frozenset[str]()  # the students' labs as stored
        self._asked: float | None = None  # when the database was last asked; None: not here
        self._claims = 0
        self._opening, self._storing = threading.Lock(), threading.Lock()
        self.rounds = Periodic("class keeper", KEEP_INTERVAL, self.check)

    def open(self) -> bool:
        """Claim the class unless it is here and up to date. May wait for the database.

        Returns:
            Whether the class is here; if not, another process has it open.
        """
        was_here = self._asked is not None
        try:
            with held(self._opening, OPENING_WAIT):
                if self._asked is None or self._class.clock() - self._asked >= FRESH:
                    self._ask()
                return True
        except NotKept as error:  # another thread has been asking for too long
            log_warning("the class is not read from the database: %s", error)
            return True
        except HeldElsewhere:
            if was_here:
                self._lost()
            return False

    def _ask(self) -> None:
        """Ask the database whether the class is still here, and claim it if not.

        Raises:
            HeldElsewhere: another process has it open; the copy here is now empty.
        """
        try:
            if self._asked is None or not self._records.is_current(self.id, classes):
                self._claim()
        except NotKept as error:
            log_warning("the class is not read from the database: %s", error)
        except HeldElsewhere:
            self._asked = None
            self._class.restore(ClassState())
            raise
        self._asked = self._class.clock()

    def check(self) -> None:
        """Store the class if it has changed; drop it if another process has it."""
        if self._asked is None:
            return
        claims = self._claims
        try:
            with self._storing:
                self._store()
            self._asked = self._class.clock()
        except NotKept as error:
            log_warning("the class is not stored: %s", error)
        except HeldElsewhere:
            with self._opening:
                if claims != self._claims:
                    return  # it has been claimed again in the meantime
                log_warning("class %s has moved to another process", self._class.code)
                self._asked = None
                self._class.restore(ClassState())
            self._lost()

    def stop(self) -> None:
        """Store the class for the last time."""
        self.rounds.stop()
        self.check()

    def _claim(self) -> None:
        stored = self._records.claim(self.id, classes)
        if stored is None:  # a class without a row could be open in two processes
            self._records.save(self.id, to_stored(ClassState(), self._class.clock()), classes)
            stored = self._records.claim(self.id, classes)
        self._class.restore(from_stored(stored, self._progress, self._class.clock()))
        self._kept, self._seats = (), frozenset(self._class.members())
        self._claims += 1

    def _store(self) -> None:
        """Store the class if it has changed.

        Raises:
            HeldElsewhere: another process owns the row.
            NotKept: the database cannot be used.
        """
        state = self._class.state
        stored, seats = to_stored(state, self._class.clock()), frozenset(state.members)
        mark = stored, self._records.generation
        if mark != self._kept:
            gone = [seat_name(self.id, lab) for lab in self._seats - seats]
            self._records.save(self.id, stored, classes, gone=gone)
            self._kept, self._seats = mark, seats
        elif not self._records.is_current(self.id, classes):
            raise HeldElsewhere

    def _progress(self, lab: str) -> Progress:
        """The progress stored with a student's lab."""
        try:
            state = self._records.load(lab)
            return NOTHING_DONE if state is None else read_progress(state.get("lessons"))
        except (OSError, ValueError) as error:
            log_warning("a student's progress cannot be read: %s", error)
            return NOTHING_DONE
