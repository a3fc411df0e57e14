"""Slow updates take what is left of a frame; none of the pages is forgotten."""

from __future__ import annotations

from math import ceil

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.simulation.display_rate import STRIDES, is_turn
from onpath.app.simulation.slow_updates import RARE, SLOWEST, SlowUpdates, interval

FRAMES = 600


class Page:
    """Takes so long to update, [s]."""

    def __init__(self, clock: list[float], cost: float, offset: int = 0) -> None:
        self.clock, self.cost, self.offset = clock, cost, offset
        self.refreshed, self.is_outdated = -1000, False
        self.at = list[int]()

    def is_turn(self, frame: int, stride: float) -> bool:
        return is_turn(frame + self.offset, stride)

    def refresh(self, frame: int) -> None:
        self.refreshed, self.is_outdated = frame, False
        self.at.append(frame)
        self.clock[0] += self.cost


def updated(count: int, cost: float, seconds: float, stride: float) -> tuple[list[Page], float]:
    """Pages after `FRAMES` frames, and the longest time that a frame's updates took, [s]."""
    clock, longest = [0.0], 0.0
    pages, updates = [Page(clock, cost, i) for i in range(count)], SlowUpdates(lambda: clock[0])
    for frame in range(FRAMES):
        begun = clock[0]
        updates.run(pages, frame, seconds, stride)
        longest = max(longest, clock[0] - begun)
    return pages, longest


@pytest.mark.thorough
@settings(deadline=None)
@given(st.integers(1, 130), st.floats(1e-4, 5e-3), st.floats(-0.02, 0.02), st.sampled_from(STRIDES))
def test_they_keep_to_their_time_and_no_page_waits_for_ever(
    count: int, cost: float, seconds: float, stride: float
) -> None:
    pages, longest = updated(count, cost, seconds, stride)
    overdue = ceil(count / SLOWEST)
    assert longest <= max(seconds + cost, overdue * cost) + 1e-9
    wanted = interval(count, stride)
    for page in pages:
        gaps = [b - a for a, b in zip([0, *page.at], [*page.at, FRAMES], strict=True)]
        assert max(gaps) <= max(wanted, SLOWEST) + stride
        assert min(gaps[1:-1], default=wanted) >= wanted
        assert all(page.is_turn(frame, stride) for frame in page.at)


@pytest.mark.parametrize(
    ("count", "stride", "frames"),
    [(10, 2, 6), (11, 2, 8), (40, 2, 8), (41, 2, 12), (20, 2.5, RARE), (20, 3, RARE), (20, 4, 16)],
)
def test_where_there_is_time_they_are_as_frequent_as_wanted(
    count: int, stride: float, frames: int
) -> None:
    """At a stride of 4, a page's turn is never 15 frames after another one."""
    pages, _ = updated(count, 1e-4, 0.01, stride)
    assert all(abs(len(page.at) - FRAMES / frames) < 1 for page in pages)


def test_an_outdated_page_does_not_wait_for_its_turn() -> None:
    clock = [0.0]
    page, updates = Page(clock, 0.0), SlowUpdates(lambda: clock[0])
    updates.run([page], 0, 0.0, 2.0)
    page.is_outdated = True
    updates.run([page], 1, 0.0, 2.0)
    updates.run([page], 2, 0.0, 2.0)
    assert page.at == [0, 1]
