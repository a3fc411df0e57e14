"""Assigns sessions to browsers, so that a reload returns to the same lab.

The browser keeps a short list of session codes. A returning tab takes the session that was left
most recently. A session without a client is paused, and dropped after a while.
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
from onpath.models.errors import CodedError, Message

log = logging.getLogger(__name__)

CODE = re.compile(r"[a-z0-9]{12}")
MOST_CODES = 8
KEPT = 15 * 60.0  # [s] that an abandoned session is kept
MOST_ABANDONED = 60


@dataclass(slots=True)
class RegisteredLab:
    """A lab and its client.

    Attributes:
        client: id of the client, or None.
        left: when the last client left, [s].
        stands_in: whether its client came for another lab, which could not be opened then.
    """

    code: str
    scheduled: ScheduledLab
    client: int | None = None
    left: float = 0.0
    stands_in: bool = False


@dataclass(slots=True)
class LabRegistry:
    """All sessions by code.

    Attributes:
        make: makes a new lab.
        load: returns the state stored under a code, or None.
        keeper: stores changes, or None.
        leases: tells which labs other processes own, or None.
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
        """The session of a new client.

        Args:
            known: the list of codes that its browser keeps, as returned by `remembered`.
        """
        codes = CODE.findall(known[:200]) if known else []
        if self.leases is not None and codes:
            codes = self.leases.available(codes)
        refusal: NotKept | None = None
        try:
            for code in self._in_turn(codes):
                if (entry := self._open(client, code)) is not None:
                    return entry
        except NotKept as error:
            refusal = error
        entry = self._made(new_code())
        if refusal is not None:
            entry.stands_in = True
            lab, said = entry.scheduled.lab, Message("say.lab_kept", {"reason": refusal.message})
            lab.show_message(lab.words.sentence(said), "warning")
        return self._give(client, entry)

    def enter(self, client: int, code: str) -> RegisteredLab:
        """Join the session of a code that was typed; the client leaves its own.

        Raises:
            ValueError: no such session, it is open elsewhere, or there were too many attempts.
            NotKept: the database is unavailable, or the stored state cannot be read.
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
        """Codes whose labs wait here, the most recently left first, then those not here.

        Labs that stand in for others come last: the others may be opened by now.
        """
        with self._lock:
            self._drop_old()
            here = {code: self._entries[code] for code in codes if code in self._entries}
        waiting = [entry for entry in here.values() if entry.client is None]
        waiting.sort(key=lambda entry: entry.left, reverse=True)
        own = [entry.code for entry in waiting if not entry.stands_in]
        stand_ins = [entry.code for entry in waiting if entry.stands_in]
        return [*own, *(code for code in codes if code not in here), *stand_ins]

    def _open(self, client: int, code: str) -> RegisteredLab | None:
        """Give a lab to a client; None if there is no lab that it may have.

        Raises:
            NotKept: the database is unavailable, or the stored state cannot be read.
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
        """Lock one code, so that nobody else opens or releases its lab.

        This may block on the database or on other processes; the lock of all sessions is never
        held meanwhile.
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
        """A new lab, or a restored one. Made one at a time, to spare the simulation.

        Raises:
            NotKept: the stored state cannot be read.
        """
        with self._making:
            lab = self.make()
            try:
                if state is not None:
                    put_back(lab, state)
            except ValueError as error:
                log.warning("what was kept cannot be read: %s", error)
                raise NotKept("error.lab_unreadable") from None
        if (keeper := self.keeper) is not None:
            lab.watch = StateObserver(code, keeper, lab)
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
        """Release a lab that another process has taken while this one was suspended."""
        return self._entries.get(code)

    def leave(self, client: int) -> RegisteredLab | None:
        """Pause a client's session when it disconnects; it may return, here or elsewhere."""
        with self._lock:
            entry = self._abandon(client)
            if entry is not None:
                self._drop_old()
        if entry is not None:
            self._let_go(entry)
        return entry

    def held(self) -> list[str]:
        """The codes of the labs that have a client."""
        with self._lock:
            return [entry.code for entry in self._entries.values() if entry.client is not None]

    def lose(self, code: str) -> int | None:
        """Remove a lab that another process owns now. Returns the client that it had here."""
        with self._lock:
            entry = self._entries.get(code)
            if entry is not None:
                self._remove(entry)
            return entry.client if entry is not None else None

    def _kept(self, code: str) -> LabState | None:
        """Load the stored state of a code and own it, unless another process owns it.

        Raises:
            NotKept: the database is unavailable.
        """
        state = self.load(code)
        if state is None or self.leases is None:
            return state
        return None if self.leases.claim(code) is None else self.load(code)

    def _is_up_to_date(self, entry: RegisteredLab) -> bool:
        """Whether no other process has owned a waiting lab meanwhile; if so, own it again."""
        try:
            return self.leases is None or self.leases.claim(entry.code) is True
        except NotKept:
            return True

    def _let_go(self, entry: RegisteredLab) -> None:
        """Store a lab and release it to other processes."""
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
        """The list of codes for the browser to keep, newest first."""
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
