"""The latest frames of the simulation, and nothing else, are kept."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.simulation.frame_times import SPARE, FrameTimes
from tests.support.kept_blocks import blocks_kept

FRAMES = st.tuples(st.floats(0, 9), st.floats(0, 1))


@pytest.mark.thorough
@given(st.integers(1, 9), st.lists(FRAMES, max_size=30) | st.lists(FRAMES, min_size=SPARE + 9))
def test_the_latest_frames_are_kept_in_their_order(
    most: int, frames: list[tuple[float, float]]
) -> None:
    kept = FrameTimes(most)
    for began, late in frames:
        kept.append(began, late)
    assert kept.count == len(frames)
    assert np.array_equal(kept.latest(), np.reshape(frames[-most:], (-1, 2)))


def test_frames_add_no_objects() -> None:
    kept = FrameTimes(1000)

    def note_frames() -> None:
        for count in range(3000):
            kept.append(count / 60, 0.001 * count)

    assert blocks_kept(note_frames, "*/simulation/frame_times.py", __file__) < 20
