"""The lab that a newcomer finds begins gently, whichever robot is chosen."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.server.new_lab import new_lab
from onpath.lessons.course import NO_LESSONS
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import do, loop_cache, run


@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_both_robots_are_on_the_path_from_the_beginning(name: str) -> None:
    lab = new_lab(loop_cache(), NO_LESSONS)
    do(lab, c.ChooseRobot(name))
    run(lab, 2.0)
    for each in lab.simulation.runs.values():
        system = each.robot.system
        assert np.abs(each.shown()["xi"]).max() < 1e-4  # of the controlled output
        swings = system.controlled_output is not system.output  # the end-point beside it
        assert each.max_distance < (3e-3 if swings else 1e-4)


def test_a_hand_can_catch_an_end_point() -> None:
    lab = new_lab(loop_cache(), NO_LESSONS)
    places = []
    for _ in range(120):
        run(lab, 1 / 60)
        places.append(lab.simulation.runs["right"].shown()["y"].copy())
    speeds = 60 * np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert speeds[:6].max() < 0.03 and 0.09 < speeds.max() < 0.11


def test_the_usual_parameters_are_one_command_away() -> None:
    lab = new_lab(loop_cache(), NO_LESSONS)
    do(lab, c.ResetParameters())
    assert lab.simulation.parameters == ROBOTS["five_bar"].parameters()
