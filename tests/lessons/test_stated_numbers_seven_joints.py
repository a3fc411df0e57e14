"""Lesson 4: an arm with seven joints, with and without the spring and the damper of its posture."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onpath
from onpath.app.notebook.run import Run

pytestmark = pytest.mark.thorough


def run(duration: float, **settings: Any) -> Run:
    return onpath.simulate("seven_axes", duration=duration, K3=0.0, **settings)


def turned(found: Run) -> np.ndarray:
    """By how much a joint differs at most after each lap from the second on, [degrees]."""
    along = np.unwrap(np.ravel(found.theta))
    laps = [int(np.argmin(abs(along - along[0] - 2 * np.pi * lap))) for lap in range(2, 12)]
    return np.degrees(np.abs(found.q[laps] - found.q[laps[0]]).max(axis=1))


def test_the_spring_brings_the_joints_back_after_each_lap() -> None:
    assert turned(run(12.0)).max() < 0.02


def test_without_it_the_joints_go_on_while_the_tip_draws_one_circle() -> None:
    found = run(12.0, posture_stiffness=0.0)
    off = turned(found)
    assert round(off[1]) == 17 and off[9] == pytest.approx(110, abs=5)
    assert np.ravel(found.distance).max() < 1e-5


def test_without_the_damper_a_joint_turns_too_fast_while_the_tip_is_on_its_circle() -> None:
    found = run(8.0, posture_stiffness=0.0, posture_damping=0.0)
    assert found.stopped_at == pytest.approx(6.4, abs=0.05)
    assert "100 rad/s" in found.reason
    t, distance = np.ravel(found.t), np.ravel(found.distance)
    assert distance[t < 6.3].max() < 4e-4
