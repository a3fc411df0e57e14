"""Spreads the slow updates of all pages (traces, plots, panels, texts) over the frames.

They take what is left of a frame after the simulation and the moving robots, so that more labs
get fewer of these updates, and not fewer pictures.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from math import ceil
from typing import Protocol

FREQUENT, RARE = 6, 15  # frames between updates of a page, at ease and under load: 10 Hz, 4 Hz
SLOWEST = 60  # frames in which every page gets an update, whatever it costs
SHARE = 0.25  # of a frame, at most, for all slow updates


class Updated(Protocol):
    """What gets slow updates.

    Attributes:
        refreshed: number of the frame of the last one.
    """

    refreshed: int

    @property
    def is_outdated(self) -> bool:
        """Whether it needs one now."""
        ...

    def refresh(self, frame: int) -> None:
        """Make the update; `frame` is the number of the frame."""
        ...


class SlowUpdates:
    """Chooses which pages get an update in a frame: those that have waited longest.

    Args:
        clock: passed in for tests.
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock

    def run(self, pages: Sequence[Updated], frame: int, seconds: float, at_ease: bool) -> None:
        """Make the updates of a frame.

        Args:
            seconds: that they may take; exceeded by one update, or by those that are overdue.
            at_ease: whether the thread has time to spare.
        """
        interval = FREQUENT if at_ease else RARE
        due = [p for p in pages if p.is_outdated or frame - p.refreshed >= interval]
        due.sort(key=lambda page: page.refreshed)
        until, least = self._clock() + seconds, ceil(len(pages) / SLOWEST)
        for i, page in enumerate(due):
            if i >= least and self._clock() >= until:
                break
            page.refresh(frame)
