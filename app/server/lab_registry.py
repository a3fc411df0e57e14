"""Which session belongs to which browser: a reload comes back to the same lab.

The browser keeps a short list of session codes. A tab that comes back takes the one of them that
was left last; a session that nobody looks at is paused, and dropped after a while.
"""

from __future__ import annotations

import logging
import re
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from onpath.app.common.access_codes import new_code
from onpath.app.common.throttle import Throttle
from onpath.app.lab.lab import Lab
from onpath.app.simulation.simulation_thread import ScheduledLab, SimulationThread
from onpath.app.storage.lab_state import LabState, StateObserver, put_back
from onpath.app.storage.leases import Leases
from onpath.app.storage.records import NotKept
from onpath.app.storage.write_behind import WriteBehind
from onpath.models.errors import CodedError

log = logging.getLogger(__name__)

CODE = re.compile(r"[a-z0-9]{12}")
MOST_CODES = 8
KEPT = 15 * 60.0  # [s] that an abandoned session is kept
MOST_ABANDONED = 60


@dataclass(slots=True)
class RegisteredLab:
    """A lab and who looks at it.

    Attributes:
        client: id of the client, or None.
        left: when the last client left, [s].
    """

    code: str
    scheduled: ScheduledLab
    client: int | None = None
    left: float = 0.0


@dataclass(slots=True)
class LabRegistry:
    """All sessions by code.

    Attributes:
        make: a new lab.
        load: what was kept under a code, or None.
        keeper: keeps what changes, or None.
        leases: says which labs other processes have, or None.
    """

    simulation: SimulationThread
    make: Callable[[], Lab]
    clock: Callable[[], float] = time.monotonic
    load: Callable[[str], LabState | None] = lambda _: None
    keeper: WriteBehind | None = None
    leases: Leases | None = None
    _entries: dict[str, RegisteredLab] = field(default_factory=dict)
    _opening: set[str] = field(default_factory=set)
    _lock: threading.Condition = field(default_factory=threading.Condition)
    _making: threading.Lock = field(default_factory=threading.Lock)
    _throttle: Throttle = field(default_factory=Throttle)

    def join(self, client: int, known: str | None) -> RegisteredLab:
        """The session for a new client.

        Args:
            known: the list of codes that its browser keeps, as `remembered` made it.
        """
        codes = CODE.findall(known[:200]) if known else []
        if self.leases is not None and codes:
            codes = self.leases.available(codes)
        remark = ""
        try:
            for code in self._in_turn(codes):
                if (entry := self._open(client, code)) is not None:
                    return entry
        except NotKept as error:
            remark = f"Your lab is kept, but cannot be opened now: {error}"
        entry = self._made(new_code())
        if remark:
            entry.scheduled.lab.show_message(remark, "warning")
        return self._give(client, entry)

    def enter(self, client: int, code: str) -> RegisteredLab:
        """The session of a code that somebody typed, for a client that leaves its own.

        Raises:
            ValueError: there is none, it is open elsewhere, or the client has tried too often.
            NotKept: the database cannot say, or what it has cannot be read.
        """
        with self._throttle.attempt(str(client)):
            entry = self._entries.get(code)
            taken = entry is not None and entry.client is not None
            if taken or (self.leases is not None and not self.leases.available([code])):
                raise CodedError("error.lab_is_open")
            found = self._open(client, code)
            if found is None:
                raise CodedError("error.no_such_lab")
            return found

    def _in_turn(self, codes: list[str]) -> list[str]:
        """Those of some codes whose lab waits, the one left last first; then those not here."""
        with self._lock:
            self._drop_old()
            here = {code: self._entries[code] for code in codes if code in self._entries}
        waiting = [entry for entry in here.values() if entry.client is None]
        waiting.sort(key=lambda entry: entry.left, reverse=True)
        return [*(entry.code for entry in waiting), *(code for code in codes if code not in here)]

    def _open(self, client: int, code: str) -> RegisteredLab | None:
        """The lab of a code, a client's from now on; None if there is none that it can have.

        Raises:
            NotKept: the database cannot say, or what it has cannot be read.
        """
        with self._alone(code):
            entry = self._entries.get(code)
            if entry is not None and entry.client is not None:
                return None
            if entry is not None and not self._is_up_to_date(entry):
                with self._lock:
                    self._remove(entry)
                entry = None
            if entry is None:
                state = self._kept(code)
                if state is None:
                    return None
                entry = self._made(code, state)
            return self._give(client, entry)

    @contextmanager
    def _alone(self, code: str) -> Iterator[None]:
        """Nobody else opens the lab of a code, or lets it go.

        This may take as long as the database, or other processes, do; the lock of all sessions is
        never held meanwhile.
        """
        with self._lock:
            self._lock.wait_for(lambda: code not in self._opening)
            self._opening.add(code)
        try:
            yield
        finally:
            with self._lock:
                self._opening.discard(code)
                self._lock.notify_all()

    def _made(self, code: str, state: LabState | None = None) -> RegisteredLab:
        """A new lab, or one as it was kept; one is made at a time, for the simulation's sake.

        Raises:
            NotKept: the state cannot be read.
        """
        with self._making:
            lab = self.make()
            try:
                if state is not None:
                    put_back(lab, state)
            except ValueError as error:
                log.warning("what was kept cannot be read: %s", error)
                raise NotKept("what was kept of this lab cannot be read") from None
        if (keeper := self.keeper) is not None:
            lab.watch = StateObserver(lambda make: keeper.submit(code, make), lab)
        return RegisteredLab(code, ScheduledLab(lab))

    def _give(self, client: int, entry: RegisteredLab) -> RegisteredLab:
        with self._lock:
            self._abandon(client)
            entry.client = client
            if entry.code not in self._entries:
                self._entries[entry.code] = entry
                self.simulation.add(entry.scheduled)
            return entry

    def find(self, code: str) -> RegisteredLab | None:
        """The session of a code, if it is here now."""
        return self._entries.get(code)

    def leave(self, client: int) -> RegisteredLab | None:
        """A client is gone; its session waits, paused, for it to come back, here or elsewhere."""
        with self._lock:
            entry = self._abandon(client)
            if entry is not None:
                self._drop_old()
        if entry is not None:
            self._let_go(entry)
        return entry

    def held(self) -> list[str]:
        """The labs that somebody looks at."""
        with self._lock:
            return [entry.code for entry in self._entries.values() if entry.client is not None]

    def lose(self, code: str) -> int | None:
        """Another process has a lab now. Returns the client that looked at it here."""
        with self._lock:
            entry = self._entries.get(code)
            if entry is not None:
                self._remove(entry)
            return entry.client if entry is not None else None

    def _kept(self, code: str) -> LabState | None:
        """What is kept under a code that no other process has; now this one has it.

        Raises:
            NotKept: the database cannot say.
        """
        state = self.load(code)
        if state is None or self.leases is None:
            return state
        return None if self.leases.claim(code) is None else self.load(code)

    def _is_up_to_date(self, entry: RegisteredLab) -> bool:
        """Whether nobody else had a lab that has waited here; then it is not theirs now."""
        try:
            return self.leases is None or self.leases.claim(entry.code) is True
        except NotKept:
            return True

    def _let_go(self, entry: RegisteredLab) -> None:
        """Other processes may have a lab, as it was left."""
        if self.keeper is not None:
            self.keeper.flush(entry.code)
        with self._alone(entry.code):
            if self.leases is not None and entry.client is None:
                self.leases.release(entry.code)

    def _remove(self, entry: RegisteredLab) -> None:
        self.simulation.remove(entry.scheduled)
        self._entries.pop(entry.code, None)

    def _abandon(self, client: int) -> RegisteredLab | None:
        for entry in self._entries.values():
            if entry.client == client:
                entry.client, entry.left = None, self.clock()
                entry.scheduled.view = None
                return entry
        return None

    def remembered(self, code: str, known: str | None) -> str:
        """The list of codes for the browser to keep, the newest first."""
        codes = [code, *(CODE.findall(known[:200]) if known else [])]
        return ",".join(list(dict.fromkeys(codes))[:MOST_CODES])

    def __len__(self) -> int:
        return len(self._entries)

    def _drop_old(self) -> None:
        idle = [e for e in self._entries.values() if e.client is None]
        waiting = [e for e in idle if e.code not in self._opening]
        waiting.sort(key=lambda e: e.left, reverse=True)
        for rank, entry in enumerate(waiting):
            if rank >= MOST_ABANDONED or self.clock() - entry.left > KEPT:
                self._remove(entry)
