"""A test pulse: a short pull across, after which the end-point comes back as its gains say."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.commands.pulse import ASIDE, FRAME, FRAMES
from onpath.models.control.sides import RIGHT
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import do, new_lab, replayed, run


@pytest.mark.thorough
@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_both_are_pulled_across_and_let_go(robot: str) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot(robot))
    run(lab, 1.0)
    begin = lab.simulation.time
    do(lab, c.Pulse())
    run(lab, (FRAMES + 4) * FRAME)
    for motion in replayed(lab.simulation).values():
        before = float(motion.distance[(motion.t > begin - 0.1) & (motion.t < begin)].max())
        assert before + 5e-5 < motion.distance[motion.t >= begin].max() < 2 * ASIDE
    assert lab.script is None and not lab.simulation.forces.hands
    names = [event.name for event in lab.simulation.events]
    assert names.count("pull") == names.count("release") == 1


def test_without_damping_it_goes_on_swinging_and_with_damping_it_does_not() -> None:
    left = {}
    for k2 in (2.0, 40.0):
        lab = new_lab()
        do(lab, c.Set("K2", k2), c.Set("K3", 0.0))
        run(lab, 1.0)
        do(lab, c.Pulse())
        run(lab, 1.0)
        begin = lab.simulation.time
        run(lab, 0.3)
        motion = replayed(lab.simulation)[RIGHT]
        left[k2] = float(motion.distance[motion.t >= begin].max())
    assert left[2.0] > 10 * left[40.0]


def test_a_hand_that_pulls_already_is_not_taken_away() -> None:
    lab = new_lab()
    run(lab, 0.2)
    target = lab.simulation.runs[RIGHT].shown()["y"] + np.array([0.01, 0.0])
    do(lab, c.Grab(RIGHT, target), c.Pulse())
    run(lab, 1.0)
    assert lab.simulation.forces.grabbed == RIGHT and lab.script is None


def test_it_pulls_each_robot_where_it_is() -> None:
    """Two robots under the same law are moved alike, though one is at another place."""
    lab = new_lab()
    do(lab, c.ChooseLaw("left", "path_following"), c.Set("K3", 0.0))
    run(lab, 0.5)
    do(lab, c.Hold(True, "left"), c.Set("copy", False))
    run(lab, 0.4)
    do(lab, c.Hold(False, "left"))
    run(lab, 2.0)
    begin = lab.simulation.time
    do(lab, c.Pulse())
    run(lab, 0.5)
    largest = [float(m.distance[m.t >= begin].max()) for m in replayed(lab.simulation).values()]
    assert largest[0] == pytest.approx(largest[1], rel=0.15)
