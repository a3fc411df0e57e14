"""Assigns labs to browsers, so that a reload returns to the same one.

The browser stores a short list of lab codes. A returning tab gets the lab that was left
most recently. A lab without a client is paused, and dropped after a while.
"""

from __future__ import annotations

import logging
import re
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field

from onpath.app.common.access_codes import new_code
from onpath.app.common.throttle import Throttle
from onpath.app.lab.lab import Lab
from onpath.app.lab.looking_back import forget_history
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage.lab_state import LabState, StateObserver, put_back
from onpath.app.storage.leases import LEASE
from onpath.app.storage.records import HeldElsewhere, NotKept
from onpath.app.storage.write_behind import WriteBehind
from onpath.lessons.concept_test.concept_test import dealt
from onpath.models.errors import CodedError, Message

log = logging.getLogger(__name__)

CODE = re.compile(r"[a-z0-9]{12}")
KEPT = 15 * 60.0  # [s] for which an abandoned lab is kept, if it was used
HISTORY_KEPT = 30.0  # [s] for which its history is kept, which takes most of its memory
MOST_ABANDONED = 60
LEASE_WAIT = LEASE + 1.0  # [s] to wait for another process to give up a lab
ASK_AGAIN = 0.1  # [s] between attempts while waiting


@dataclass(slots=True)
class RegisteredLab:
    """A lab and its client.

    Attributes:
        client: id of the client, or None.
        left: when the last client left, [s].
        stands_in: whether its client came for another lab, which could not be opened.
    """

    code: str
    scheduled: ScheduledLab
    client: int | None = None
    left: float = 0.0
    stands_in: bool = False


@dataclass(slots=True)
class LabRegistry:
    """All labs by code.

    Attributes:
        make: makes a new lab.
        load: takes over the state stored under a code and returns it, or None; raises
            `HeldElsewhere` if another process has it open.
        give_up: lets other processes open the lab of a code.
        is_current: whether no other process has had the lab of a code meanwhile.
        keeper: stores changes, or None.
    """

    thread: SimulationThread
    make: Callable[[], Lab]
    clock: Callable[[], float] = time.monotonic
    load: Callable[[str], LabState | None] = lambda _: None
    give_up: Callable[[str], None] = lambda _: None
    is_current: Callable[[str], bool] = lambda _: True
    keeper: WriteBehind | None = None
    _entries: dict[str, RegisteredLab] = field(default_factory=dict)
    _opening: set[str] = field(default_factory=set)
    _lock: threading.Condition = field(default_factory=threading.Condition)
    _making: threading.Lock = field(default_factory=threading.Lock)
    _throttle: Throttle = field(default_factory=Throttle)

    def join(self, client: int, known: str | None, language: str = "") -> RegisteredLab:
        """The lab of a new client.

        Args:
            known: the list of codes that the browser keeps, newest first, separated by commas.
            language: of a lab that has to be made; empty for the default.
        """
        codes = CODE.findall(known[:200]) if known else []
        refusal: NotKept | None = None
        until = time.monotonic() + LEASE_WAIT
        try:
            for code in self._in_turn(codes):
                with suppress(HeldElsewhere):  # in use, like a lab in another tab of this process
                    if (entry := self._open(client, code, until)) is not None:
                        return entry
        except NotKept as error:
            refusal = error
        entry = self._made(new_code(), language=language)
        if refusal is not None:
            entry.stands_in = True
            lab = entry.scheduled.lab
            message = Message("say.lab_kept", {"reason": refusal.message})
            lab.show_message(lab.words.sentence(message), "warning")
        return self._give(client, entry)

    def enter(self, client: int, code: str) -> RegisteredLab:
        """Join the lab of a typed code; the client leaves its own.

        Raises:
            ValueError: no such lab, it is open elsewhere, or there were too many attempts.
            NotKept: the database is unavailable, or the stored state cannot be read.
        """
        with self._throttle.attempt(str(client)):
            entry = self._entries.get(code)
            if entry is not None and entry.client is not None:
                raise CodedError("error.lab_is_open")
            try:
                found = self._open(client, code, time.monotonic() + LEASE_WAIT)
            except HeldElsewhere:
                raise CodedError("error.lab_is_open") from None
            if found is None:
                raise CodedError("error.no_such_lab")
            return found

    def _in_turn(self, codes: list[str]) -> list[str]:
        """Codes of the labs that wait here, the most recently left first, then codes of other labs.

        Labs that stand in for others come last, because the others may be open to this client now.
        """
        with self._lock:
            self._drop_old()
            here = {code: self._entries[code] for code in codes if code in self._entries}
        waiting = [entry for entry in here.values() if entry.client is None]
        waiting.sort(key=lambda entry: entry.left, reverse=True)
        genuine = [entry.code for entry in waiting if not entry.stands_in]
        stand_ins = [entry.code for entry in waiting if entry.stands_in]
        return [*genuine, *(code for code in codes if code not in here), *stand_ins]

    def _open(self, client: int, code: str, until: float) -> RegisteredLab | None:
        """Give a lab to a client; None if there is no lab that the client may have.

        Args:
            until: when to stop waiting for the lease of another process to end, by
                `time.monotonic`, [s].

        Raises:
            NotKept: the database is unavailable, or the stored state cannot be read.
            HeldElsewhere: another process has it open.
        """
        with self._alone(code):
            entry = self._entries.get(code)
            if entry is not None and entry.client is not None:
                return None
            if entry is not None and not self._is_current(code):
                self._drop(entry)
                entry = None
            if entry is None:
                state = self._load(code, until)
                if state is None:
                    return None
                entry = self._made(code, state)
            return self._give(client, entry)

    def _load(self, code: str, until: float) -> LabState | None:
        """The stored state of a lab, including changes of it that are still pending here.

        A process that has the lab open may just have been killed, or be about to notice that its
        client has left; then its lease ends within `LEASE_WAIT`.
        """
        if self.keeper is not None and not self.keeper.flush(code):
            raise NotKept("error.database_busy")
        while True:
            try:
                return self.load(code)
            except HeldElsewhere:
                if time.monotonic() >= until:
                    raise
                time.sleep(ASK_AGAIN)

    @contextmanager
    def _alone(self, code: str) -> Iterator[None]:
        """Lock one code, so that no other thread opens or releases its lab.

        The body may block on the database; the lock of all labs is not held meanwhile.
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

    def unowned_lab(self) -> ScheduledLab:
        """A new lab that belongs to no browser, is not stored and cannot be entered."""
        with self._making:
            return ScheduledLab(self.make())

    def _made(self, code: str, state: LabState | None = None, language: str = "") -> RegisteredLab:
        """A new lab, or a restored one. Made one at a time, to spare the simulation.

        Raises:
            NotKept: the stored state cannot be read.
        """
        with self._making:
            lab = self.make()
            lab.lessons.first_form = dealt(code)
            if language:
                lab.lessons.set_language(language)
            try:
                if state is not None:
                    put_back(lab, state)
            except ValueError as error:
                log.warning("the stored lab cannot be read: %s", error)
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
                self.thread.add(entry.scheduled)
            return entry

    def find(self, code: str) -> RegisteredLab | None:
        """The lab with this code, if it is in this process."""
        return self._entries.get(code)

    def leave(self, client: int) -> RegisteredLab | None:
        """Pause a client's lab when it disconnects; it may return here at once."""
        with self._lock:
            entry = self._abandon(client)
            if entry is not None:
                self._drop_old()
        return entry

    def give_back(self, code: str) -> None:
        """Let a lab that was left return to another process, unless it has returned here."""
        if self.keeper is None:
            return
        with self._alone(code):
            entry = self._entries.get(code)
            if entry is not None and entry.client is None and self.keeper.flush(code):
                with suppress(NotKept):  # else its lease ends by itself
                    self.give_up(code)

    def held(self) -> list[str]:
        """The codes of the labs that have a client."""
        with self._lock:
            return [entry.code for entry in self._entries.values() if entry.client is not None]

    def check(self) -> None:
        """Submit the latest changes. Call it when the simulation thread has stopped."""
        for entry in list(self._entries.values()):
            lab = entry.scheduled.lab
            if isinstance(lab.watch, StateObserver):
                lab.watch.check(lab)

    def lose(self, code: str) -> int | None:
        """Remove a lab that another process has now. Returns the client that it had here."""
        with self._lock:
            entry = self._entries.get(code)
            if entry is not None:
                self._remove(entry)
            return entry.client if entry is not None else None

    def delete(self, code: str, delete: Callable[[str], object]) -> None:
        """Delete a lab for good: here, its pending changes, and its stored state by `delete`.

        Raises:
            NotKept: the lab is still being stored, and nothing was changed; or `delete` raised it.
            HeldElsewhere: another process has it open.
        """
        with self._alone(code):
            self._discard(code)
            self.lose(code)
            self.thread.call(lambda: None)  # the frame that may still have stored it has ended
            self._discard(code)
            delete(code)

    def _discard(self, code: str) -> None:
        if self.keeper is not None:
            self.keeper.discard(code)

    def _is_current(self, code: str) -> bool:
        try:
            return self.is_current(code)
        except NotKept:
            return True

    def _drop(self, entry: RegisteredLab) -> None:
        """Remove an outdated lab and its pending changes.

        Raises:
            NotKept: the lab is still being stored; it is not removed.
        """
        self._discard(entry.code)
        with self._lock:
            self._remove(entry)

    def _remove(self, entry: RegisteredLab) -> None:
        self.thread.remove(entry.scheduled)
        self._entries.pop(entry.code, None)
        entry.scheduled.simulation.history.clear()  # the rest waits until garbage is collected

    def _abandon(self, client: int) -> RegisteredLab | None:
        for entry in self._entries.values():
            if entry.client == client:
                entry.client, entry.left = None, self.clock()
                entry.scheduled.display = None
                return entry
        return None

    def __len__(self) -> int:
        return len(self._entries)

    def free_memory(self) -> None:
        """Drop labs that have been unused for long; delete the histories of the rest.

        A lab that was reopened and not used since is in the database. A history stays while a past
        instant is shown. Do not call this on the simulation thread, for which it waits.
        """
        with self._lock:
            left = [e for e in self._waiting() if self.clock() - e.left > HISTORY_KEPT]
            for entry in left:
                if not entry.scheduled.lab.asked:
                    self._remove(entry)
        simulations = [e.scheduled.simulation for e in left]
        outdated = [s for s in simulations if s.viewing is None and len(s.history)]

        def forget() -> None:
            for simulation in outdated:
                forget_history(simulation)

        if outdated:
            self.thread.call(forget)

    def _drop_old(self) -> None:
        waiting = sorted(self._waiting(), key=lambda e: e.left, reverse=True)
        for rank, entry in enumerate(waiting):
            if rank >= MOST_ABANDONED or self.clock() - entry.left > KEPT:
                self._remove(entry)

    def _waiting(self) -> list[RegisteredLab]:
        """The labs without a client that nobody is opening."""
        idle = [e for e in self._entries.values() if e.client is None]
        return [e for e in idle if e.code not in self._opening]
