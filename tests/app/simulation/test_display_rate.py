"""Under load the display rate drops before simulated time slows down, and recovers."""

from __future__ import annotations

import itertools
import math

import pytest

from onpath.app.simulation.display_rate import BUSY, STRIDES, DisplayRate, is_turn

FRAME = 1 / 60


def strides(pace: DisplayRate, share: float, frames: int, drawing: float = 0.0) -> list[float]:
    found: list[float] = []
    for _ in range(frames):
        pace.note(share * FRAME, drawing * FRAME, FRAME)
        found.append(pace.stride)
    return found


def test_a_busy_thread_draws_less_often_step_by_step_and_recovers() -> None:
    pace = DisplayRate()
    assert set(strides(pace, 0.2, 600)) == {STRIDES[0]}
    busy = strides(pace, 1.2, 600)
    assert busy == sorted(busy) and busy[-1] == STRIDES[-1]
    calm = strides(pace, 0.1, 1200)
    assert calm == sorted(calm, reverse=True) and calm[-1] == STRIDES[0]


@pytest.mark.parametrize("drawing", [0.0, 0.3, 0.67, 1.0])
@pytest.mark.parametrize("work", [0.3, 0.55, 0.6, 0.8, 1.0, 1.3, 1.9])
@pytest.mark.parametrize("together", [1.0, 0.75])
def test_it_settles_where_there_is_time(work: float, drawing: float, together: float) -> None:
    """Also where simulating several frames together takes less time.

    Args:
        work: share of the time at the first stride.
        drawing: share of the work.
        together: time of the simulation at the other strides, as a share of that at the first.
    """
    pace, found = DisplayRate(), list[float]()

    def shares() -> tuple[float, float]:
        drawn = drawing * work * STRIDES[0] / pace.stride
        rest = (1 - drawing) * work * (1.0 if pace.stride == STRIDES[0] else together)
        return rest + drawn, drawn

    for _ in range(1800):
        share, drawn = shares()
        found += strides(pace, share, 1, drawn)
    assert len(set(found[1200:])) == 1
    assert shares()[0] <= dict(zip(STRIDES, BUSY, strict=False)).get(pace.stride, math.inf)


def test_one_slow_frame_changes_nothing() -> None:
    pace = DisplayRate()
    strides(pace, 0.3, 300)
    pace.note(5 * FRAME, 5 * FRAME, FRAME)
    assert set(strides(pace, 0.3, 300)) == {STRIDES[0]}


@pytest.mark.parametrize("stride", [1.0, *STRIDES])
def test_display_is_as_often_as_the_stride_says_and_even(stride: float) -> None:
    """Also of a lab that is drawn in every n-th of its frames only."""
    for step in (stride, 5 * stride):
        turns = [frame for frame in range(1, 1201) if is_turn(frame, step)]
        gaps = {later - earlier for earlier, later in itertools.pairwise(turns)}
        assert len(turns) == 1200 // step and gaps <= {math.floor(step), math.ceil(step)}
        assert all(is_turn(frame, stride) for frame in turns)
