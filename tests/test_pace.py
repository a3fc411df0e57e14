"""The display gives way before simulated time does, and comes back."""

from __future__ import annotations

import pytest

from app.pace import STRIDES, Pace

FRAME = 1 / 60


def strides(pace: Pace, share: float, frames: int) -> list[int]:
    found: list[int] = []
    for _ in range(frames):
        pace.note(share * FRAME, FRAME)
        found.append(pace.stride)
    return found


def test_a_busy_thread_draws_less_often_step_by_step_and_recovers() -> None:
    pace = Pace()
    assert set(strides(pace, 0.2, 600)) == {STRIDES[0]}
    busy = strides(pace, 1.2, 600)
    assert busy == sorted(busy) and busy[-1] == STRIDES[-1]
    calm = strides(pace, 0.1, 600)
    assert calm == sorted(calm, reverse=True) and calm[-1] == STRIDES[0]


@pytest.mark.parametrize("work", [0.3, 0.6, 0.8, 1.0, 1.3])
def test_it_settles_although_drawing_is_most_of_the_work(work: float) -> None:
    """`work`: share of the time at the first stride; a third of it is simulation."""
    pace = Pace()
    for _ in range(1200):
        pace.note(work * (1 + 2 * STRIDES[0] / pace.stride) / 3 * FRAME, FRAME)
    assert len({strides(pace, work * (1 + 2 * STRIDES[0] / pace.stride) / 3, 1)[0]
                for _ in range(600)}) == 1  # fmt: skip


def test_one_slow_frame_changes_nothing() -> None:
    pace = Pace()
    strides(pace, 0.3, 300)
    pace.note(5 * FRAME, FRAME)
    assert set(strides(pace, 0.3, 300)) == {STRIDES[0]}
