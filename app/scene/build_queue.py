"""Builds scenes one at a time with pauses, so that many arrivals do not stall open pages."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress

from onpath.app.common.error_log import log_error
from onpath.app.common.on_time import wait_until_on_time

REST = 2.0  # pause after a build, in durations of it; sending the scene takes time as well
LONG = 0.5  # [s]; longer builds rest no longer than one of this duration
CALM = 1.0  # [s] without a build, after which the next one need not rest between its parts
PATIENCE = 0.1  # [s] that a part of a build waits at most while frames are late


class BuildLock:
    """A lock for builds, which rest so that the simulation can go on. Use it with `with`.

    A build that soon follows another one rests after each part, for as long as the part took. The
    next build waits for the remaining rest. Each part also waits while frames are late.
    """

    def __init__(self) -> None:
        self._lock, self._free_at = threading.Lock(), 0.0
        self._owner, self._follows = 0, False
        self._since = self._worked = self._rested = 0.0

    def __enter__(self) -> None:
        self._lock.acquire()
        rest = self._free_at - time.monotonic()
        if rest > 0:
            time.sleep(rest)
        wait_until_on_time(PATIENCE)
        self._owner, self._follows = threading.get_ident(), rest > -CALM
        self._since, self._worked, self._rested = time.monotonic(), 0.0, 0.0

    def __exit__(self, *_: object) -> None:
        self._owner = 0
        self._lock.release()

    def rest(self) -> None:
        """Rest after a part of a build. No effect in a thread that does not hold the lock."""
        if self._owner != threading.get_ident():
            return
        part = time.monotonic() - self._since
        self._worked += part
        if self._follows and self._worked < LONG:
            time.sleep(part)
            self._rested += part
        wait_until_on_time(PATIENCE)
        self._since = time.monotonic()

    def finish(self) -> None:
        """Make the next thread wait for the remaining rest. Call it while holding the lock."""
        now = time.monotonic()
        worked = min(self._worked + now - self._since, LONG)
        self._free_at = now + REST * worked - self._rested


one_at_a_time = BuildLock()
"""Held while a scene is built or rebuilt, but never while waiting for a browser."""


@contextmanager
def in_turn() -> Iterator[None]:
    """Build a scene or part of one, one at a time and with rests, however many tabs ask for it."""
    with one_at_a_time:
        try:
            yield
        finally:
            one_at_a_time.finish()


class BuildQueue:
    """Builds the scenes of new clients in order of arrival.

    Uses its own thread, because viser's thread pool must stay free for the callbacks of clients
    that already have a scene.
    """

    def __init__(self) -> None:
        self._pool = ThreadPoolExecutor(1, "scenes")

    def submit(self, build: Callable[[], None]) -> None:
        """Queue the build of a scene; it is called even if its client has disconnected by then."""
        with suppress(RuntimeError):  # the server has stopped
            self._pool.submit(_build, build)

    def stop(self) -> None:
        """Finish the scene under construction and discard the queue."""
        self._pool.shutdown(cancel_futures=True)


def _build(build: Callable[[], None]) -> None:
    try:
        build()
    except Exception as error:
        log_error(error)
