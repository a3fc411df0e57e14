"""Closed loops for sessions: interpreted at first, compiled in the background."""

from __future__ import annotations

import logging
import threading
from concurrent.futures import Future, ThreadPoolExecutor

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.systems.robots import Robot

log = logging.getLogger(__name__)
Key = tuple[Robot, Kind]


class LoopCache:
    """Loops by robot and kind. `get` never waits for compilation."""

    def __init__(self) -> None:
        self._compiled: dict[Key, CompiledLoop] = {}
        self._interpreted: dict[Key, InterpretedLoop] = {}
        self._wanted: dict[Key, Future[None]] = {}
        self._pool: ThreadPoolExecutor | None = ThreadPoolExecutor(1, "compile")
        self._lock = threading.Lock()

    def get(self, robot: Robot, kind: Kind) -> Loop:
        """The fastest loop available now. Call from the simulation thread only."""
        key = (robot, kind)
        ready = self._compiled.get(key)
        if ready is not None:
            return ready
        if key not in self._interpreted:
            self._interpreted.setdefault(key, InterpretedLoop(kernel_of(robot, kind)))
        self.prepare(robot, kind)
        return self._interpreted[key]

    def is_ready(self, robot: Robot, kind: Kind) -> bool:
        """Whether `get` returns a loop at once; if not, one is made in the background."""
        key = (robot, kind)
        if key in self._compiled or key in self._interpreted:
            return True
        self.prepare(robot, kind)
        wanted = self._wanted.get(key)
        return wanted is None or wanted.done()

    def prepare(self, robot: Robot, kind: Kind) -> None:
        """Compile a loop in the background, unless that was requested before."""
        key = (robot, kind)
        with self._lock:
            if self._pool is not None and key not in self._wanted:
                self._wanted[key] = self._pool.submit(self._compile, key)

    def close(self) -> None:
        """Cancel pending compilations."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown(wait=False, cancel_futures=True)

    def _compile(self, key: Key) -> None:
        try:
            kernel = kernel_of(*key)
            if key not in self._interpreted:
                self._interpreted.setdefault(key, InterpretedLoop(kernel))
            self._compiled[key] = translate_loop(kernel)
        except Exception as error:  # the lab continues with interpreted loops
            log.warning("cannot compile a loop, the interpreted one goes on: %s", error)
            self.close()  # further compilations would fail, too
