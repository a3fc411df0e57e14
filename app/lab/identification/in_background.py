"""Identification in a thread of its own, since it takes longer than a frame.

All labs share the thread. Each waits for one identification at most, and the thread rests after
each as long as it took, so that no lab can delay others by asking all the time.
"""

from __future__ import annotations

import time
from concurrent.futures import Future, ThreadPoolExecutor

from onpath.app.lab.identification.identify import Learned, learn
from onpath.app.lab.segments import HistoryCopy
from onpath.models.systems.robots import Robot

_thread = ThreadPoolExecutor(1, "identification")


class Identification:
    """What one lab has asked to be identified.

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
        asked = self._under_way
        if asked is None or not (self._at_once or asked.done()):
            return None
        self._under_way = None
        return asked.result()

    @property
    def is_under_way(self) -> bool:
        """Whether there will be a result."""
        return self._under_way is not None and not self._under_way.done()


def _learn(asked: Future[Learned], robot: Robot, history: HistoryCopy) -> None:
    begun = time.monotonic()
    try:
        asked.set_result(learn(robot, history))
    except Exception as error:
        asked.set_exception(error)
    time.sleep(time.monotonic() - begun)
