"""Plays a lesson's script by posting its commands at their times."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from typing import Generic, TypeVar

from onpath.app.lab.session import Session

Request = TypeVar("Request")


class ScriptPlayer(Generic[Request]):
    """A script that is being played; its times count from the session's time zero.

    Args:
        script: commands and their times, [s].
        until: end of the script, [s].
        stop: whether to pause the session at the end of the script.

    Attributes:
        finished: whether the script was played to its end, not cancelled.
    """

    def __init__(
        self, script: Iterable[tuple[float, Request]], until: float, stop: bool = True
    ) -> None:
        self._until = until
        self._waiting = deque(sorted(script, key=lambda timed: timed[0]))
        self._stop = stop
        self._before = 0.0  # simulated time before the last reset, [s]
        self._run: int | None = None
        self.finished = False

    def play(self, session: Session, ask: Callable[[Request], None]) -> bool:
        """Post the commands that are due; call before every frame.

        Returns:
            Whether the script has ended, or was cancelled by a reset from elsewhere.

        Raises:
            ValueError: the lab refuses a command; the script is then over.
        """
        if self._run is None:
            self._run = session.run_number
        if session.run_number != self._run:
            return True
        while self._waiting and self._waiting[0][0] <= self._now(session) + 1e-9:
            before = session.time
            ask(self._waiting.popleft()[1])
            if session.run_number != self._run:
                self._run, self._before = session.run_number, self._before + before
        if self._now(session) < self._until - 1e-9:
            return False
        if self._stop:
            session.running = False
        self.finished = True
        return True

    def _now(self, session: Session) -> float:
        return self._before + session.time
