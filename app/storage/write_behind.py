"""Writes what happens in the labs into the database, in a thread of its own."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any, Protocol

from onpath.app.common.error_log import log_error
from onpath.app.storage.records import HeldElsewhere, NotKept

log = logging.getLogger(__name__)

INTERVAL = 2.0  # [s] between writes: what a killed process may lose
BREATH = 0.01  # [s] between labs, for the simulation: it waits while this thread computes
FLUSH = 10.0  # [s] at most for the last write


class Store(Protocol):
    """Where states go."""

    def save(self, code: str, state: dict[str, Any]) -> None:
        """See `Records.save`."""
        ...


class WriteBehind:
    """Keeps the latest state of each lab, at most every few seconds.

    Attributes:
        warning: why the latest states are not kept yet, in words; empty when they are. They are
            tried again until they are.
    """

    def __init__(self, records: Store, interval: float = INTERVAL) -> None:
        self._records = records
        self._interval = interval
        self._pending: dict[str, Callable[[], dict[str, Any]]] = {}
        self._lock, self._writing = threading.Lock(), threading.Lock()
        self._wanted, self._closing = threading.Event(), threading.Event()
        self.warning = ""
        self._thread = threading.Thread(target=self._run, name="keeper", daemon=True)
        self._thread.start()

    def submit(self, code: str, make_state: Callable[[], dict[str, Any]]) -> None:
        """Keep what `make_state` will return; from any thread, without waiting.

        Args:
            make_state: called in the keeper's thread, or never if a later one comes first; it
                must not look at what other threads change.
        """
        with self._lock:
            self._pending[code] = make_state
        self._wanted.set()

    def forget(self, delete: Callable[[], int]) -> int:
        """Delete what is kept, and what was about to be; returns what `delete` returns."""
        with self._writing:
            with self._lock:
                self._pending.clear()
            return delete()

    def flush(self, code: str) -> None:
        """Write what is waiting of one lab, in the caller's thread; when it returns, it is kept."""
        with self._writing:  # this lab's turn may be under way
            if self._write_waiting(code):
                self._wanted.set()

    def close(self) -> None:
        """Write what is waiting, and end."""
        self._closing.set()
        self._wanted.set()
        self._thread.join(FLUSH)

    def _run(self) -> None:
        while not self._closing.is_set():
            self._wanted.wait()
            self._wanted.clear()
            self._write_all()
            self._closing.wait(self._interval)
        self._write_all()

    def _write_all(self) -> None:
        with self._lock:
            codes = list(self._pending)
        failed = ""
        for code in codes:
            with self._writing:
                failed = self._write_waiting(code) or failed
            self._closing.wait(BREATH)
        if failed:
            self._wanted.set()
        if codes and failed != self.warning:
            log.warning("%s", f"not kept: {failed}" if failed else "kept again")
            self.warning = failed

    def _write_waiting(self, code: str) -> str:
        """What is waiting of one lab, if anything; see `_write`."""
        with self._lock:
            make_state = self._pending.pop(code, None)
        return "" if make_state is None else self._write(code, make_state)

    def _write(self, code: str, make_state: Callable[[], dict[str, Any]]) -> str:
        """Why it is not kept but will be tried again; empty when it is."""
        try:
            self._records.save(code, make_state())
        except NotKept as error:
            with self._lock:  # unless a later one has come
                self._pending.setdefault(code, make_state)
            return str(error)
        except HeldElsewhere:
            log.info("a lab has gone to another process")
        except Exception as error:  # this lab's alone
            log_error(error)
        return ""
