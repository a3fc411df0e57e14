"""What is measured at the instant at which robots begin, before anything has acted on them."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.lessons.record import ROBOTS
from tests.support.lab import new_lab, run


@pytest.mark.parametrize("beside", [0.01, -0.004])
def test_robots_that_begin_beside_the_path_are_there_at_once(beside: float) -> None:
    """Also across it: overshoot is a share of the largest value, which is that at the start."""
    lab = new_lab()
    lab.simulation.set(start_beside=beside)
    lab.simulation.reset()
    run(lab, 0.1)
    record = record_of(lab.simulation, Beginning(lab.simulation.run_number, 0.0))
    assert record.times[0] == 0.0
    for robot in ROBOTS:
        values = record.values[robot]
        assert values["across"][0] == pytest.approx(1e3 * beside)
        assert values["distance"][0] == pytest.approx(1e3 * abs(beside))
        assert np.abs(values["across"]).max() == pytest.approx(values["distance"].max())
        assert values["torque"][0] == 0.0
