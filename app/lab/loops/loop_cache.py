"""Closed loops for sessions: interpreted at first, compiled in the background."""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Collection
from concurrent.futures import Future, ThreadPoolExecutor
from weakref import WeakValueDictionary

from onpath.app.lab.loops.compile_queue import CompileQueue
from onpath.app.lab.loops.typed_loops import Key, TypedLoops, without_frames
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.own import is_text
from onpath.models.control.speed_limit import prepare_speed_limit
from onpath.models.errors import Message, message_of
from onpath.models.systems.robots import Robot

log = logging.getLogger(__name__)
MOST = 8  # compiled loops that are kept, in use or not; 0.1 to 0.4 MB each
MOST_REFUSED = 256  # loops remembered as impossible; forgotten ones are tried again


class LoopCache:
    """Loops by robot and kind. `get` never waits for compilation.

    Labs share the loops of the registry's laws. A loop exists as long as a lab uses it; the
    compiled loops used last are kept longer. For the loops of typed laws see `TypedLoops`.

    Args:
        at_once: whether loops of typed laws are made on request, not in the background.
        clock: monotonic time, [s].

    Attributes:
        at_once: see above; users of the cache then do their other long work at once, too.
    """

    def __init__(self, at_once: bool = False, clock: Callable[[], float] = time.monotonic) -> None:
        self._made: WeakValueDictionary[Key, Loop] = WeakValueDictionary()
        self._kept: OrderedDict[Key, Loop] = OrderedDict()  # compiled; the most recent last
        self._waiting, self._making = CompileQueue[Key](clock), set[Key]()
        self._refused = dict[Key, Message | str]()  # why not compilable; in order of discovery
        self._broken = dict[Key, ValueError]()  # laws with an error: not even interpretable
        self._typed, self.at_once = TypedLoops(self._submit, clock), at_once
        self._pool: ThreadPoolExecutor | None = ThreadPoolExecutor(1, "compile")
        self._lock = threading.RLock()

    def get(self, robot: Robot, kind: Kind, known: Loop | None = None) -> Loop:
        """The fastest loop available now. Call from the simulation thread only.

        Args:
            known: a loop that the caller has, which may no longer be kept here.
        """
        key = (robot.core, kind)
        if is_text(kind.controller):
            return self._typed.find(key) or known or InterpretedLoop(kernel_of(robot, kind))
        loop = self._find(key) or self._share(key, InterpretedLoop(kernel_of(robot, kind)))
        self.prepare(robot, kind)
        return loop

    def is_ready(self, robot: Robot, kind: Kind) -> bool:
        """Whether `get` returns a loop at once.

        If not, the loop of a registry's law is made in the background; for others see `want`.

        Raises:
            ValueError: the law cannot be used with this robot and these settings.
        """
        key = (robot.core, kind)
        if is_text(kind.controller):
            if self._typed.find(key) is None and (self.at_once or self._pool is None):
                self._typed.make(key)
            return self._typed.find(key) is not None
        if self._find(key) is not None:
            return True
        if key in self._broken:
            raise self._broken[key].with_traceback(None)
        self.prepare(robot, kind)
        return self._pool is None or key in self._refused

    def check(self, robot: Robot, kind: Kind) -> None:
        """Refuse a law with which `get` would have no loop, as far as that is known of a typed law.

        Raises:
            ValueError: the law cannot be used with this robot and these settings.
        """
        key = (robot.core, kind)
        if is_text(kind.controller):
            self._typed.find(key)
        elif self._find(key) is None:
            kernel_of(robot, kind)

    def why_interpreted(self, robot: Robot, kind: Kind) -> Message | str | None:
        """Why a loop cannot be compiled; None if it is, or may still be."""
        key = (robot.core, kind)
        if is_text(kind.controller):
            return self._typed.why_interpreted(key)
        return self._refused.get(key)

    def want(self, lab: object, keys: Collection[Key]) -> None:
        """Make these loops of typed laws in the background, and no others for this lab."""
        if not self.at_once and self._pool is not None:
            self._typed.want(lab, [(robot.core, kind) for robot, kind in keys])

    def prepare(self, robot: Robot, kind: Kind) -> None:
        """Compile a loop of a registry's law in the background, unless it is compiled.

        Call again in every frame in which it is lacking: see `CompileQueue`.
        """
        key = (robot.core, kind)
        if is_text(kind.controller) or isinstance(self._made.get(key), CompiledLoop):
            return
        with self._lock:
            known = key in self._making or key in self._refused or key in self._broken
            if self._pool is not None and not known and self._waiting.ask(key):
                self._pool.submit(self._compile_next)

    def make(self, robot: Robot, kind: Kind) -> None:
        """Compile a loop of a registry's law now."""
        self._share((robot.core, kind), translate_loop(kernel_of(robot, kind)))
        prepare_speed_limit(robot)

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
        cancelled = Future[None]()
        cancelled.cancel()
        return cancelled

    def _find(self, key: Key) -> Loop | None:
        """The loop made for a key, if any; it then counts as the one used last."""
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
            return self._made.get(key)

    def _share(self, key: Key, loop: Loop) -> Loop:
        """Let all labs use a loop, and keep it if it is compiled.

        An interpreted loop is not kept: labs that wait for a compiled loop ask in every frame, and
        their interpreted ones would displace a compiled loop before its lab asks again.
        """
        with self._lock:
            self._made[key] = loop
            if isinstance(loop, CompiledLoop):
                self._kept[key] = loop
                if len(self._kept) > MOST:
                    self._kept.popitem(last=False)
        return loop

    def _compile_next(self) -> None:
        with self._lock:
            key = self._waiting.next()
            if key is None:  # dropped
                return
            self._making.add(key)
        robot, kind = key
        try:
            kernel = self._kernel(key)
            if kernel is None:
                return
            meanwhile = self._find(key) or self._share(key, InterpretedLoop(kernel))
            self._share(key, translate_loop(kernel))
            del meanwhile  # nothing else refers to it, unless a lab uses it
            prepare_speed_limit(robot)
        except Exception as error:  # labs continue with the interpreted loop
            log.warning("%s is not compiled, it is interpreted: %s", kind.controller, error)
            self._refused[key] = message_of(error)
            if len(self._refused) > MOST_REFUSED:
                del self._refused[next(iter(self._refused))]
        finally:
            self._making.discard(key)

    def _kernel(self, key: Key) -> Kernel | None:
        """The tick of a registry's law; None if the law has an error, which `is_ready` raises."""
        try:
            return kernel_of(*key)
        except ValueError as error:
            log.warning("a law cannot be used: %s", error, exc_info=True)
            self._broken[key] = without_frames(error)
            if len(self._broken) > MOST_REFUSED:
                del self._broken[next(iter(self._broken))]
            return None
