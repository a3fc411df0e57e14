"""Spreads the slow updates of all pages (traces, plots, fields, texts) over the frames.

They take the time that is left in a frame after simulating and drawing the robots, so that more
labs means fewer of these updates, not fewer pictures.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from math import ceil
from typing import Protocol

from onpath.app.simulation.display_rate import AT_EASE

INTERVALS = {10: 6, 40: 8}  # maximum number of pages -> frames between updates of a page
MANY, RARE = 12, 15  # frames between updates with more pages, and under load
SLOWEST = 100  # frames within which every page gets an update, whatever it costs
SHARE = 0.25  # maximum share of a frame for all slow updates


class Updated(Protocol):
    """Something that gets slow updates.

    Attributes:
        refreshed: number of the frame of the last update.
    """

    refreshed: int

    @property
    def is_outdated(self) -> bool:
        """Whether it needs an update now."""
        ...

    def is_turn(self, frame: int, stride: float) -> bool:
        """Whether it is drawn in this frame anyway: then the update needs no picture of its own."""
        ...

    def refresh(self, frame: int) -> None:
        """Make the update in the frame of this number; errors are logged, not raised."""
        ...


class SlowUpdates:
    """Chooses which pages get an update in a frame: those that have waited longest.

    Args:
        clock: passed in for tests.
    """

    def __init__(self, clock: Callable[[], float] = time.perf_counter) -> None:
        self._clock = clock

    def run(self, pages: Sequence[Updated], frame: int, seconds: float, stride: float) -> None:
        """Make the updates of a frame.

        Args:
            seconds: time that they may take, exceeded by one update or by overdue ones, [s].
            stride: frames of simulation per frame of display.
        """
        latest = frame - interval(len(pages), stride)
        due = [
            page
            for page in pages
            if page.is_outdated or (page.refreshed <= latest and page.is_turn(frame, stride))
        ]
        due.sort(key=lambda page: page.refreshed)
        until, least = self._clock() + seconds, ceil(len(pages) / SLOWEST)
        for i, page in enumerate(due):
            if i >= least and self._clock() >= until:
                break
            page.refresh(frame)


def interval(pages: int, stride: float) -> int:
    """Frames between updates of a page: 10, 7.5 or 5 Hz by the number of pages, 4 Hz under load.

    Args:
        pages: number of pages.
        stride: frames of simulation per frame of display.
    """
    if stride > AT_EASE:
        return RARE
    return next((frames for most, frames in INTERVALS.items() if pages <= most), MANY)
