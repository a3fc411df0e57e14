"""A lab of a busy thread is simulated when it is drawn; nothing of its time is lost by that."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.lab import Lab
from onpath.app.lab.script_player import ScriptPlayer
from onpath.app.simulation.display_rate import LATE, STRIDES, is_turn
from onpath.app.simulation.frame_length import FRAME, frame_length
from onpath.app.simulation.scheduled_lab import LONGEST, ScheduledLab
from tests.support.lab import new_lab

EASY, *BUSY = (*STRIDES, *LATE.values())


class Screen:
    """A viewer that is drawn at its turns."""

    def __init__(self, offset: int) -> None:
        self.offset = offset

    is_outdated = False

    def is_turn(self, lab: Lab, frame: int, stride: float) -> bool:
        return is_turn(frame + self.offset, stride)

    def show(self, lab: Lab, frame: int, stride: float) -> None: ...

    def refresh(self, lab: Lab, achieved: float) -> None: ...

    def send(self) -> None: ...


def seen_lab(offset: int = 0) -> ScheduledLab:
    scheduled = ScheduledLab(new_lab())
    scheduled.display = Screen(offset)
    return scheduled


def times(scheduled: ScheduledLab, strides: Iterable[float]) -> list[float]:
    """Simulated time after each frame, with a stride for each."""
    found = list[float]()
    for count, stride in enumerate(strides):
        advance_together([scheduled.frame(FRAME, frame_length(count), count, stride)])
        found.append(scheduled.simulation.time)
    return found


@settings(max_examples=30)
@given(
    offset=st.integers(0, 20),
    spells=st.lists(st.tuples(st.sampled_from((EASY, *BUSY)), st.integers(1, 12)), max_size=8),
)
def test_what_is_drawn_is_the_present_and_no_lab_waits_long(
    offset: int, spells: list[tuple[float, int]]
) -> None:
    strides = [stride for stride, frames in spells for _ in range(frames)]
    waited = 0
    for count, time in enumerate(times(seen_lab(offset), strides)):
        missing = frame_length(0, count + 1) - time
        waited = waited + 1 if missing > 1e-9 else 0
        assert waited < LONGEST
        if strides[count] == EASY or is_turn(count + offset, strides[count]):
            assert missing == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("stride", STRIDES[1:])
def test_a_busy_thread_simulates_a_lab_as_often_as_it_draws_it(stride: float) -> None:
    found = [0.0, *times(seen_lab(), [stride] * 440)]
    steps = sum(after > before for before, after in pairwise(found))
    assert steps == pytest.approx(440 / stride, abs=1)


def test_frames_together_give_the_same_numbers_as_one_by_one() -> None:
    one, together = seen_lab(), seen_lab()
    times(one, [EASY] * 31)
    times(together, [BUSY[0]] * 31)  # ends with its turn
    assert one.simulation.time == pytest.approx(together.simulation.time, abs=1e-9)
    for mine, other in zip(
        one.simulation.runs.values(), together.simulation.runs.values(), strict=True
    ):
        assert np.array_equal(mine.state, other.state) and mine.max_distance == other.max_distance


def test_the_measured_speed_does_not_depend_on_how_often_it_is_simulated() -> None:
    for stride in (EASY, *STRIDES[1:]):
        scheduled = seen_lab()
        for count in range(300):  # at half of its pace
            advance_together([scheduled.frame(2 * FRAME, frame_length(count), count, stride)])
        assert scheduled.achieved == pytest.approx(0.5, rel=0.01)


def test_a_script_has_every_frame() -> None:
    scheduled = seen_lab()
    scheduled.lab.script = ScriptPlayer([], until=10.0)
    found = times(scheduled, [BUSY[-1]] * 20)
    assert found == pytest.approx([frame_length(0, count + 1) for count in range(20)], abs=1e-9)


def test_frames_that_nobody_saw_are_not_made_up_for() -> None:
    scheduled = seen_lab()
    scheduled.display = None
    times(scheduled, [BUSY[0]] * 10)
    scheduled.display = Screen(0)
    assert times(scheduled, [EASY]) == pytest.approx([frame_length(0)], abs=1e-9)
