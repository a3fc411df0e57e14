"""The task "lower the jumps" of lesson 6b: a stiffer spring helps, whenever it is set."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.lessons.task_schema import Bound
from tests.support.built_in import built_in_course
from tests.support.lab import FRAME, RIGHT, do, loop_cache

pytestmark = pytest.mark.thorough

LESSON, TASK = "06b-friction-and-the-integral", "lower-the-jumps"
WAIT, WINDOW = 8.0, 6.0  # [s], as the task says


def opened() -> tuple[Lab, float]:
    """The step with the task, and the bound that the task asks for, [m]."""
    lab = Lab(loop_cache(), course=built_in_course()[0])
    do(lab, c.OpenLesson(LESSON))
    assert lab.lessons.lesson is not None
    for place, step in enumerate(lab.lessons.lesson.steps):
        for task in step.tasks():
            if task.id == TASK:
                do(lab, c.GoToStep(place))
                (bound,) = [check for check in task.check if isinstance(check, Bound)]
                assert (bound.last, bound.below) == (WINDOW, 0.62)
                return lab, 0.62e-3
    raise AssertionError(TASK)


def distances(lab: Lab, seconds: float) -> np.ndarray:
    """Distance of the follower from the circle in each frame, [m]."""
    run = lab.simulation.runs[RIGHT]
    found = list[float]()
    for _ in range(round(seconds / FRAME)):
        lab.drain()
        lab.advance(FRAME)
        found.append(abs(float(np.hypot(*run.row[run.log.slices["y"]])) - 0.05))
    return np.array(found)


@pytest.mark.parametrize("begun", [0.0, 1.0, 2.0, 5.0, 9.0, 17.0, 20.0, 25.0])
def test_eight_seconds_after_the_spring_is_stiff_it_is_near_and_stays_so(begun: float) -> None:
    lab, bound = opened()
    distances(lab, begun)
    do(lab, c.Set("K1", 1100.0), c.Set("K2", 66.0))
    distances(lab, WAIT - WINDOW)
    assert distances(lab, 52.0).max() < bound


def test_as_it_is_it_is_never_near_for_six_seconds() -> None:
    lab, bound = opened()
    away = distances(lab, 60.0) > bound
    away[0] = away[-1] = True  # the ends of the record
    assert np.diff(np.flatnonzero(away)).max() < WINDOW / FRAME
