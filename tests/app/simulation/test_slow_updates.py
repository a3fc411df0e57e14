"""Slow updates take what is left of a frame; none of the pages is forgotten."""

from __future__ import annotations

from math import ceil

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.simulation.slow_updates import FREQUENT, RARE, SLOWEST, SlowUpdates

FRAMES = 600


class Page:
    """Takes so long to update, [s]."""

    def __init__(self, clock: list[float], cost: float) -> None:
        self.clock, self.cost = clock, cost
        self.refreshed, self.is_outdated = -1000, False
        self.at = list[int]()

    def refresh(self, frame: int) -> None:
        self.refreshed, self.is_outdated = frame, False
        self.at.append(frame)
        self.clock[0] += self.cost


def updated(count: int, cost: float, seconds: float, at_ease: bool) -> tuple[list[Page], float]:
    """Pages after `FRAMES` frames, and the longest time that a frame's updates took, [s]."""
    clock, longest = [0.0], 0.0
    pages, updates = [Page(clock, cost) for _ in range(count)], SlowUpdates(lambda: clock[0])
    for frame in range(FRAMES):
        begun = clock[0]
        updates.run(pages, frame, seconds, at_ease)
        longest = max(longest, clock[0] - begun)
    return pages, longest


@settings(deadline=None)
@given(st.integers(1, 130), st.floats(1e-4, 5e-3), st.floats(-0.02, 0.02), st.sampled_from([0, 1]))
def test_they_keep_to_their_time_and_no_page_waits_for_ever(
    count: int, cost: float, seconds: float, ease: int
) -> None:
    pages, longest = updated(count, cost, seconds, bool(ease))
    overdue = ceil(count / SLOWEST)
    assert longest <= max(seconds + cost, overdue * cost) + 1e-9
    interval = FREQUENT if ease else RARE
    for page in pages:
        gaps = [b - a for a, b in zip([0, *page.at], [*page.at, FRAMES], strict=True)]
        assert max(gaps) <= max(interval, SLOWEST) + 1
        assert min(gaps[1:-1], default=interval) >= interval


@pytest.mark.parametrize(("ease", "interval"), [(True, FREQUENT), (False, RARE)])
def test_where_there_is_time_they_are_as_frequent_as_wanted(ease: bool, interval: int) -> None:
    pages, _ = updated(20, 1e-4, 0.01, ease)
    assert all(len(page.at) == ceil(FRAMES / interval) for page in pages)


def test_an_outdated_page_does_not_wait_for_its_turn() -> None:
    clock = [0.0]
    page, updates = Page(clock, 0.0), SlowUpdates(lambda: clock[0])
    updates.run([page], 0, 0.0, True)
    page.is_outdated = True
    updates.run([page], 1, 0.0, True)
    updates.run([page], 2, 0.0, True)
    assert page.at == [0, 1]
