"""Writes the states of labs to the database in a background thread (write-behind)."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import Any, Protocol

from onpath.app.common.error_log import log_error
from onpath.app.storage.engine import held
from onpath.app.storage.records import HeldElsewhere, NotKept, NotStorable

log = logging.getLogger(__name__)

INTERVAL = 2.0  # [s] between writes: the most that is lost if the process is killed
BREATH = 0.01  # [s] after a lab for which nobody waits, in which the simulation thread can run
FLUSH = 10.0  # [s] to wait for the last write
TURN_WAIT = 2.0  # [s] to wait for a write in progress; a user may be waiting, too
HANGING = 5.0  # [s] after which a write in progress counts as failed
FAILED, TOO_LARGE = "keep.failed", "keep.too_large"
"""Keys of what a user is told."""


class StateStore(Protocol):
    """Where states are saved; see `Records`."""

    @property
    def warning(self) -> str: ...
    @property
    def generation(self) -> int: ...

    def save(self, code: str, state: dict[str, Any]) -> None:
        """Save a state, with the errors of `Records.save`."""
        ...


class WriteBehind:
    """Saves the latest state of each lab, at most once per interval.

    Args:
        lost: called with the code of a lab that another process has claimed.

    Attributes:
        warning: why the latest states are not saved yet; empty if they are. Failed writes are
            repeated.
    """

    def __init__(
        self,
        records: StateStore,
        interval: float = INTERVAL,
        lost: Callable[[str], object] = lambda _: None,
    ) -> None:
        self._records, self._lost = records, lost
        self._interval = interval
        self._pending: dict[str, Callable[[], dict[str, Any]]] = {}
        self._failed = dict[str, str]()  # code of a lab -> why its latest state is not saved
        self._current: tuple[str, float] | None = None  # the lab being written, and since when
        self._lock, self._writing = threading.Lock(), threading.Lock()
        self._wanted, self._closing = threading.Event(), threading.Event()
        self._hurry = threading.Event()  # ends the interval
        self._hurried: set[str] = set()  # codes of labs that are written first
        self._tickets, self._written = dict[str, int](), dict[str, int]()
        self.warning = ""
        self._thread = threading.Thread(target=self._run, name="keeper", daemon=True)
        self._thread.start()

    def submit(
        self, code: str, make_state: Callable[[], dict[str, Any]], at_once: bool = False
    ) -> int:
        """Save the state that `make_state` returns. Thread-safe, and does not block.

        Args:
            make_state: called in the background thread, or never if a later one replaces it; must
                not read anything that other threads modify.
            at_once: whether somebody waits until it is saved.

        Returns:
            Its number; see `written`.
        """
        with self._lock:
            self._pending[code] = make_state
            number = self._tickets[code] = self._tickets.get(code, 0) + 1
            if at_once:
                self._hurried.add(code)
        self._wanted.set()
        if at_once:
            self._hurry.set()
        return number

    def written(self, code: str) -> int:
        """Number of the latest state of a lab that is saved; 0 if none is."""
        return self._written.get(code, 0)

    def unsaved(self, code: str) -> str:
        """Why the latest state of a lab is not saved, or will not outlive the process.

        Returns:
            A key of the catalogues; empty if it is saved.
        """
        if (why := self._failed.get(code, "")) or not (self._records.warning or self._hangs(code)):
            return why
        return FAILED

    def _hangs(self, code: str) -> bool:
        """Whether the write of this lab, or the one that it waits for, takes too long."""
        with self._lock:
            if self._current is None:
                return False
            written, since = self._current
            waits = code == written or code in self._pending
            return waits and time.monotonic() - since > HANGING

    @property
    def generation(self) -> int:
        """Changes when saved states may be gone; see `Records.generation`."""
        return self._records.generation

    def discard(self, code: str) -> None:
        """Discard the outdated pending state of a lab; on return no write of it is in progress.

        Raises:
            NotKept: another write takes too long; the state stays pending.
        """
        with held(self._writing, TURN_WAIT), self._lock:
            for known in (self._pending, self._failed, self._tickets, self._written):
                known.pop(code, None)

    def flush(self, code: str) -> bool:
        """Write the pending state of one lab, if any, in the caller's thread.

        Waits briefly for a write in progress, which may be this lab's.

        Returns:
            Whether it is no longer pending. If it is, another write takes too long or the database
            cannot be used, and the background thread will write it.
        """
        try:
            with held(self._writing, TURN_WAIT):
                failed = self._write_waiting(code)
        except NotKept:
            return False
        if failed:
            self._wanted.set()
        return not failed

    def close(self) -> None:
        """Write all pending states, and end the thread."""
        self._closing.set()
        self._wanted.set()
        self._hurry.set()
        self._thread.join(FLUSH)

    def _run(self) -> None:
        while not self._closing.is_set():
            self._wanted.wait()
            self._wanted.clear()
            self._hurry.clear()
            wrote = self._write_all()
            if wrote and not self._closing.is_set():
                self._hurry.wait(self._interval)
        self._write_all()

    def _write_all(self) -> bool:
        """Write the pending states; return whether there were any."""
        with self._lock:
            hurried, self._hurried = self._hurried, set[str]()
            codes = sorted(self._pending, key=lambda code: code not in hurried)
        failed = ""
        for code in codes:
            with self._writing:
                failed = self._write_waiting(code) or failed
            if code not in hurried:
                self._closing.wait(BREATH)
        if failed:
            self._wanted.set()
        if codes and failed != self.warning:
            log.warning("%s", f"not kept: {failed}" if failed else "kept again")
            self.warning = failed
        return bool(codes)

    def _write_waiting(self, code: str) -> str:
        """Write the pending state of one lab, if any; see `_write`."""
        with self._lock:
            make_state = self._pending.pop(code, None)
            if make_state is None:
                return ""
            self._current = code, time.monotonic()
            number = self._tickets.get(code, 0)
        return self._write(code, make_state, number)

    def _write(self, code: str, make_state: Callable[[], dict[str, Any]], number: int) -> str:
        """Write a state. Returns why it failed and will be repeated, or ""."""
        failed = dict[str, str]()
        try:
            self._records.save(code, make_state())
            self._written[code] = number
            return ""
        except NotKept as error:
            with self._lock:  # keeps a later state if there is one
                self._pending.setdefault(code, make_state)
                failed = dict.fromkeys(self._pending, FAILED)  # the others wait behind this one
            return str(error)
        except NotStorable as error:
            failed = {code: TOO_LARGE}
            if self._failed.get(code) != TOO_LARGE:
                log.warning("a lab cannot be stored and stays as it was stored last: %s", error)
        except HeldElsewhere:
            log.info("a lab has moved to another process")
            self._tell_lost(code)
        except Exception as error:  # must not affect other labs
            failed = {code: FAILED}
            log_error(error)
        finally:
            with self._lock:
                self._current = None
                self._failed.pop(code, None)
                self._failed |= failed
        return ""

    def _tell_lost(self, code: str) -> None:
        try:
            self._lost(code)
        except Exception as error:  # must not affect other labs
            log_error(error)
