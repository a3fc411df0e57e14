"""Closed loops for labs: compiled in the background, shared by all labs."""

from __future__ import annotations

import logging
import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from time import thread_time
from weakref import WeakKeyDictionary, WeakValueDictionary

from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.own import is_text
from onpath.models.control.speed_limit import prepare_speed_limit
from onpath.models.control.standing_torque import prepare_standing_torque
from onpath.models.errors import CodedError, Message, message_of
from onpath.models.systems.robots import Robot

log = logging.getLogger(__name__)
Key = tuple[Robot, Kind]
MOST = 64  # loops that are kept, in use or not; 0.1 to 0.4 MB each
MOST_SOON = 32  # loops that nobody waits for yet


class LoopCache:
    """Loops by robot and kind. Nothing here waits, unless `at_once`.

    A lab says in every frame which loops it lacks. The lab whose loops have taken the least time
    comes first, so that one that keeps asking for new loops holds up no other.

    Args:
        at_once: whether loops are made when they are first asked for, not in the background.
        translate: makes a loop; if it fails, the loop is interpreted.

    Attributes:
        at_once: see above; users of the cache then do their other long work at once, too.
    """

    def __init__(
        self, at_once: bool = False, translate: Callable[[Kernel], Loop] | None = None
    ) -> None:
        self.at_once, self._translate = at_once, translate or translate_loop
        self._shared: WeakValueDictionary[Key, Loop] = WeakValueDictionary()
        self._kept: OrderedDict[Key, Loop | ValueError] = OrderedDict()  # the last used is last
        self._interpreted = dict[Key, Message | str]()  # why these are not compiled
        self._wanted: WeakKeyDictionary[object, list[Key]] = WeakKeyDictionary()
        self._spent: WeakKeyDictionary[object, float] = WeakKeyDictionary()  # [s], for each lab
        self._soon: OrderedDict[Key, None] = OrderedDict()
        self._pool: ThreadPoolExecutor | None = ThreadPoolExecutor(1, "compile")
        self._works, self._lock = False, threading.RLock()

    def find(self, robot: Robot, kind: Kind) -> Loop | None:
        """A loop; None if it is not made yet, see `want`.

        Raises:
            ValueError: the law cannot be used with this robot and these settings.
        """
        key = (robot.core, kind)
        found = self._found(key)
        if found is None and self.at_once:
            found = self._make(key)
        if isinstance(found, ValueError):
            raise found.with_traceback(None)
        return found

    def want(self, lab: object, keys: Sequence[Key]) -> None:
        """Make these loops in the background, and no others that this lab has asked for."""
        if self.at_once:
            return
        with self._lock:
            self._wanted[lab] = [(robot.core, kind) for robot, kind in keys]
            if not keys:
                del self._wanted[lab]
        self._work_on()

    def prepare(self, robot: Robot, kind: Kind) -> None:
        """Make a loop that will be needed, when no lab waits for another one."""
        key = (robot.core, kind)
        with self._lock:
            if self.at_once or self._is_made(key):
                return
            self._soon[key] = None
            if len(self._soon) > MOST_SOON:
                self._soon.popitem(last=False)
        self._work_on()

    def make(self, robot: Robot, kind: Kind) -> None:
        """Make a loop now."""
        self._make((robot.core, kind))

    def why_interpreted(self, robot: Robot, kind: Kind) -> Message | str | None:
        """Why a loop could not be compiled; None if it is compiled, or may still be."""
        return self._interpreted.get((robot.core, kind))

    def close(self) -> None:
        """Make no more loops."""
        with self._lock:
            pool, self._pool = self._pool, None
        if pool is not None:
            pool.shutdown(wait=False, cancel_futures=True)

    def _found(self, key: Key) -> Loop | ValueError | None:
        """What was made for a key, if anything; it then counts as the one used last."""
        with self._lock:
            found = self._kept.get(key) or self._shared.get(key)
            if found is not None:
                self._keep(key, found)
            return found

    def _is_made(self, key: Key) -> bool:
        return key in self._kept or key in self._shared

    def _keep(self, key: Key, made: Loop | ValueError) -> None:
        self._kept[key] = made
        self._kept.move_to_end(key)
        if len(self._kept) > MOST:
            self._interpreted.pop(self._kept.popitem(last=False)[0], None)

    def _work_on(self) -> None:
        with self._lock:
            if self._pool is not None and not self._works and self._next() is not None:
                self._works = True
                self._pool.submit(self._work)

    def _work(self) -> None:
        """Make what is wanted, one loop after the other."""
        while True:
            with self._lock:
                task = self._next() if self._pool is not None else None
                if task is None:
                    self._works = False
                    return
            lab, key = task
            begun = thread_time()
            self._make(key)
            if lab is not None:
                self._spent[lab] = self._spent.get(lab, 0.0) + thread_time() - begun
            del task, lab  # the lab may end meanwhile

    def _next(self) -> tuple[object | None, Key] | None:
        """The loop to be made next, and the lab that waits for it, if any does."""
        labs = sorted(self._wanted.items(), key=lambda each: self._spent.get(each[0], 0.0))
        for lab, keys in labs:
            for key in keys:
                if not self._is_made(key):
                    return lab, key
        while self._soon:
            key, _ = self._soon.popitem(last=False)
            if not self._is_made(key):
                self._soon[key] = None
                self._soon.move_to_end(key, last=False)
                return None, key
        return None

    def _make(self, key: Key) -> Loop | ValueError:
        made, reason = self._made(key)
        with self._lock:
            if not isinstance(made, ValueError):
                self._shared[key] = made
            self._keep(key, made)
            if reason is not None:
                self._interpreted[key] = reason
        return made

    def _made(self, key: Key) -> tuple[Loop | ValueError, Message | str | None]:
        """A loop, or why there is none; and why it is not compiled, if it is not."""
        robot, kind = key
        try:
            kernel = kernel_of(robot, kind)
        except Exception as error:
            typed = is_text(kind.law)  # by a user; another one is a programmer's
            log.warning("a law cannot be used: %s", error.__cause__ or error, exc_info=not typed)
            refused = error if isinstance(error, ValueError) else None
            return without_frames(refused or CodedError("error.law_cannot_run")), None
        try:
            prepare_speed_limit(robot)
            prepare_standing_torque(robot)
            return self._translate(kernel), None
        except Exception as error:  # labs use the interpreted loop
            log.warning("%s is not compiled, it is interpreted: %s", kind.law, error)
            return InterpretedLoop(kernel), message_of(error)


def without_frames(error: ValueError) -> ValueError:
    """The error alone, to be kept: the frames of its traceback and causes hold many objects."""
    error.__cause__ = error.__context__ = None
    return error.with_traceback(None)
