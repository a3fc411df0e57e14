"""Plays a lesson's script by posting its commands at their times."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from typing import Generic, TypeVar

from onpath.app.lab.simulation import Simulation

Request = TypeVar("Request")


class ScriptPlayer(Generic[Request]):
    """A script that is being played; its times count from the simulation's time zero.

    Args:
        script: commands and their times, [s].
        until: end of the script, [s].
        stop: whether to pause the simulation at the end of the script.

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

    def play(self, simulation: Simulation, ask: Callable[[Request], None]) -> bool:
        """Post the commands that are due; call before every frame.

        Returns:
            Whether the script has ended, or was cancelled by a reset from elsewhere.

        Raises:
            ValueError: the lab refuses a command; the script is then over.
        """
        if self._run is None:
            self._run = simulation.run_number
        if simulation.run_number != self._run:
            return True
        while self._waiting and self._waiting[0][0] <= self._now(simulation) + 1e-9:
            before = simulation.time
            ask(self._waiting.popleft()[1])
            if simulation.run_number != self._run:
                self._run, self._before = simulation.run_number, self._before + before
        if self._now(simulation) < self._until - 1e-9:
            return False
        if self._stop:
            simulation.running = False
        self.finished = True
        return True

    def _now(self, simulation: Simulation) -> float:
        return self._before + simulation.time
