"""Identification in a thread of its own, since it takes longer than a frame.

All labs share the thread. A lab has at most one identification under way, and the thread rests
after each for as long as it took, so that no lab can delay the others by asking continually.
"""

from __future__ import annotations

import time
from concurrent.futures import Future, ThreadPoolExecutor

from onpath.app.lab.identification.identify import Learned, learn
from onpath.app.lab.segments import HistoryCopy
from onpath.models.systems.robots import Robot

_thread = ThreadPoolExecutor(1, "identification")


class Identification:
    """The identification that one lab has requested.

    Args:
        at_once: whether to wait for the result.
    """

    def __init__(self, at_once: bool = False) -> None:
        self._at_once = at_once
        self._under_way: Future[Learned] | None = None

    def begin(self, robot: Robot, history: HistoryCopy) -> None:
        """Identify the model of a robot, unless an identification is under way."""
        if self._under_way is None:
            self._under_way = Future()
            _thread.submit(_learn, self._under_way, robot, history)

    def take(self) -> Learned | None:
        """The result, once, as soon as there is one.

        Raises:
            ValueError: see `learn`.
        """
        future = self._under_way
        if future is None or not (self._at_once or future.done()):
            return None
        self._under_way = None
        return future.result()


def _learn(future: Future[Learned], robot: Robot, history: HistoryCopy) -> None:
    begun = time.monotonic()
    try:
        future.set_result(learn(robot, history))
    except Exception as error:
        future.set_exception(error)
    time.sleep(time.monotonic() - begun)
