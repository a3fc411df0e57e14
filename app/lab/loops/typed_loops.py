"""Loops of typed laws, of which there may be any number: few are kept, and few are made at a time.

The loops used last are kept. Each lab says in every frame which ones it lacks; a loop that it no
longer wants is not made, and a lab that wants many in a short time has to wait.
"""

from __future__ import annotations

import logging
import threading
from collections import OrderedDict, deque
from collections.abc import Callable, Collection
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial
from weakref import WeakKeyDictionary

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.errors import Message, message_of
from onpath.models.systems.robots import Robot

log = logging.getLogger(__name__)
Key = tuple[Robot, Kind]
Submit = Callable[[Callable[[], None]], "Future[None]"]
MOST = 64  # loops that are kept; 0.1 to 0.4 MB each
MOST_MADE, WITHIN = 8, 10.0  # maximum number of loops begun for one lab, within this time, [s]


@dataclass(slots=True)
class Requests:
    """The loops that one lab wants.

    Attributes:
        waiting: the loops that it lacked in the last frame.
        begun: when the latest loops for it were begun, [s].
    """

    waiting: set[Key] = field(default_factory=set[Key])
    begun: deque[float] = field(default_factory=lambda: deque[float](maxlen=MOST_MADE))


class TypedLoops:
    """The loops of typed laws, by robot and kind. Thread-safe.

    Args:
        submit: runs something in the background.
        clock: monotonic time, [s].
    """

    def __init__(self, submit: Submit, clock: Callable[[], float]) -> None:
        self._submit, self._clock = submit, clock
        self._made = OrderedDict[Key, Loop | ValueError]()  # the one used last comes last
        self._interpreted: dict[Key, Message | str] = {}  # reasons
        self._making: dict[Key, Future[None]] = {}
        self._labs: WeakKeyDictionary[object, Requests] = WeakKeyDictionary()
        self._lock = threading.RLock()

    def __len__(self) -> int:
        return len(self._made)

    def find(self, key: Key) -> Loop | None:
        """The fastest loop available now; None if it is not made.

        Raises:
            ValueError: the law cannot be used with this robot and these settings.
        """
        with self._lock:
            found = self._made.get(key)
            if found is not None:
                self._made.move_to_end(key)
        if isinstance(found, ValueError):
            raise found.with_traceback(None)
        return found

    def why_interpreted(self, key: Key) -> Message | str | None:
        """Why a loop cannot be compiled; None if it is, or may still be."""
        return self._interpreted.get(key)

    def want(self, lab: object, keys: Collection[Key]) -> None:
        """Make these loops in the background, and cancel the lab's other requests.

        Another lab that wants the same says so in its next frame.
        """
        with self._lock:
            requests = self._labs.setdefault(lab, Requests())
            for key in requests.waiting.difference(keys):
                if key in self._making and self._making[key].cancel():
                    del self._making[key]
            requests.waiting = {key for key in keys if key not in self._made}
            for key in requests.waiting:
                if key not in self._making and self._may_begin(requests.begun):
                    self._making[key] = self._submit(partial(self._make, key, requests.begun))

    def _may_begin(self, begun: deque[float]) -> bool:
        return len(begun) < MOST_MADE or self._clock() - begun[0] >= WITHIN

    def _make(self, key: Key, begun: deque[float]) -> None:
        begun.append(self._clock())
        try:
            self.make(key)
        finally:
            with self._lock:
                self._making.pop(key, None)

    def make(self, key: Key) -> None:
        """Make a loop: an interpreted one first, and then the compiled one in its place."""
        robot, kind = key
        try:
            kernel = kernel_of(robot, kind)
            self._put(key, InterpretedLoop(kernel))
        except ValueError as refused:
            log.warning("a typed law cannot be run: %s", refused.__cause__ or refused)
            self._put(key, without_frames(refused))
            return
        try:
            self._put(key, translate_loop(kernel))
        except Exception as error:
            log.warning("a typed law cannot be compiled, it is interpreted: %s", error)
            self._interpreted[key] = message_of(error)

    def _put(self, key: Key, made: Loop | ValueError) -> None:
        with self._lock:
            self._made[key] = made
            self._made.move_to_end(key)
            while len(self._made) > MOST:
                self._interpreted.pop(self._made.popitem(last=False)[0], None)


def without_frames(error: ValueError) -> ValueError:
    """The error alone, to be kept: the frames of its traceback and causes hold many objects."""
    error.__cause__ = error.__context__ = None
    return error.with_traceback(None)
