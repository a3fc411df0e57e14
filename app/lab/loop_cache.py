"""Closed loops for sessions: interpreted at first, compiled in the background."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Collection
from concurrent.futures import Future, ThreadPoolExecutor

from onpath.app.lab.typed_loops import Key, TypedLoops
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.own import is_text
from onpath.models.control.speed_limit import prepare_speed_limit
from onpath.models.systems.robots import Robot

log = logging.getLogger(__name__)


class LoopCache:
    """Loops by robot and kind. `get` never waits for compilation.

    Those of the registry's laws are kept for ever; for those of typed laws see `TypedLoops`.

    Args:
        at_once: whether loops of typed laws are made while they are asked for, not in the
            background.
        clock: monotonic time, [s].
    """

    def __init__(self, at_once: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._compiled: dict[Key, CompiledLoop] = {}
        self._interpreted: dict[Key, InterpretedLoop] = {}
        self._wanted: dict[Key, Future[None]] = {}
        self._typed, self._at_once = TypedLoops(self._submit, clock), at_once
        self._pool: ThreadPoolExecutor | None = ThreadPoolExecutor(1, "compile")
        self._lock = threading.Lock()

    def get(self, robot: Robot, kind: Kind, known: Loop | None = None) -> Loop:
        """The fastest loop available now. Call from the simulation thread only.

        Args:
            known: one that the caller has, which may not be kept here any more.
        """
        key = (robot.core, kind)
        if is_text(kind.controller):
            return self._typed.find(key) or known or InterpretedLoop(kernel_of(robot, kind))
        ready = self._compiled.get(key)
        if ready is not None:
            return ready
        if key not in self._interpreted:
            self._interpreted.setdefault(key, InterpretedLoop(kernel_of(robot, kind)))
        self.prepare(robot, kind)
        return self._interpreted[key]

    def kernel(self, robot: Robot, kind: Kind) -> Kernel:
        """The kernel of a loop; built now if that of a typed law is not ready."""
        made = self._typed.find((robot.core, kind)) if is_text(kind.controller) else None
        return kernel_of(robot, kind) if made is None else made.kernel

    def is_ready(self, robot: Robot, kind: Kind) -> bool:
        """Whether `get` returns a loop at once.

        If not, that of a registry's law is made in the background; for others see `want`.

        Raises:
            ValueError: a typed law cannot be used with this robot and these settings.
        """
        key = (robot.core, kind)
        if is_text(kind.controller):
            if self._typed.find(key) is None and (self._at_once or self._pool is None):
                self._typed.make(key)
            return self._typed.find(key) is not None
        if key in self._compiled or key in self._interpreted:
            return True
        self.prepare(robot, kind)
        wanted = self._wanted.get(key)
        return wanted is None or wanted.done()

    def want(self, lab: object, keys: Collection[Key]) -> None:
        """Make these loops of typed laws in the background, and no others for this lab."""
        if not self._at_once and self._pool is not None:
            self._typed.want(lab, [(robot.core, kind) for robot, kind in keys])

    def prepare(self, robot: Robot, kind: Kind) -> None:
        """Compile a loop of a registry's law in the background, unless requested before."""
        key = (robot.core, kind)
        with self._lock:
            if self._pool is not None and key not in self._wanted and not is_text(kind.controller):
                self._wanted[key] = self._pool.submit(self._compile, key)

    def close(self) -> None:
        """Cancel pending compilations."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown(wait=False, cancel_futures=True)

    def _submit(self, act: Callable[[], None]) -> Future[None]:
        with self._lock:
            if self._pool is not None:
                return self._pool.submit(act)
        ended = Future[None]()
        ended.cancel()
        return ended

    def _compile(self, key: Key) -> None:
        try:
            kernel = kernel_of(*key)
            if key not in self._interpreted:
                self._interpreted.setdefault(key, InterpretedLoop(kernel))
            self._compiled[key] = translate_loop(kernel)
            prepare_speed_limit(key[0])
        except Exception as error:  # the lab continues with interpreted loops
            log.warning("cannot compile a loop, the interpreted one goes on: %s", error)
            self.close()  # further compilations would fail, too
