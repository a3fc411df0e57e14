"""Tests of the mouse in the scene of the free lab: robots are pulled, the path is bent."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("playwright")

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.models.control.sides import LEFT, RIGHT
from tests.support.browser import Tab, wait_for

TRACKER, FOLLOWER = LEFT, RIGHT


def stop_between_control_points(tab: Tab) -> None:
    """Stop the end-point between control points; near one, the mouse would take that instead."""
    tab.ask(c.SetRunning(False))
    points = tab.simulation.editor.points()

    def clear() -> bool:
        tab.ask(*[c.StepOnce()] * 5)
        tips = [tab.tip(name) for name in tab.simulation.runs]
        return min(np.linalg.norm(points - tip, axis=1).min() for tip in tips) > 0.012

    wait_for(clear)


def test_pulling_an_end_point_pulls_both(tab: Tab) -> None:
    lab, name = tab.lab, TRACKER
    stop_between_control_points(tab)
    before = {each: tab.tip(each) for each in lab.simulation.runs}
    start = tab.placed(name, before[name])
    goal = start[0] - 40, start[1] + 30
    with tab.dragging(start, goal):
        wait_for(
            lambda: lab.simulation.forces.grabbed == name and len(lab.simulation.forces.hands) == 2
        )
        wait_for(lambda: math.dist(tab.placed(name, hand_targets(lab)[name]), goal) < 12)
        pulled = hand_targets(lab)
        moved = {each: pulled[each] - before[each] for each in pulled}
        np.testing.assert_allclose(moved[TRACKER], moved[FOLLOWER], atol=1e-9)
        tab.ask(c.Set("speed", 0.0), c.SetRunning(True))
        wait_for(lambda: lab.simulation.time > 0.8)
        for each, run in lab.simulation.runs.items():
            assert (tab.tip(each) - before[each]) @ moved[each] > 0, each
            assert np.linalg.norm(run.shown()["force"]) > 0.1
    wait_for(lambda: lab.simulation.forces.grabbed is None and not lab.simulation.forces.hands)


def hand_targets(lab: Lab) -> dict[str, np.ndarray]:
    """Positions of the pulling hands, in the path's plane, shape (2,) each, [m]."""
    return {
        name: lab.simulation.robot.frame.planar(hand)
        for name, hand in lab.simulation.forces.hands.items()
    }


def test_without_copy_only_the_robot_in_hand_is_pulled(tab: Tab) -> None:
    tab.switch("Copy to both").uncheck()
    wait_for(lambda: not tab.simulation.settings.copy)
    stop_between_control_points(tab)
    start = tab.placed(TRACKER, tab.tip(TRACKER))
    with tab.dragging(start, (start[0] - 30, start[1])):
        wait_for(lambda: tab.simulation.forces.hands)
        assert list(tab.simulation.forces.hands) == [TRACKER]
    tab.switch("Copy to both").check()
    wait_for(lambda: tab.simulation.settings.copy)


def test_dragging_a_control_point_bends_the_path_and_blends_in(tab: Tab) -> None:
    editor = tab.simulation.editor
    stop_between_control_points(tab)
    old = editor.points().copy()
    index = int(np.argmax(old[:, 1]))
    start = tab.placed(FOLLOWER, old[index])
    end = tab.placed(FOLLOWER, old[index] + [0.0, 0.02])
    with tab.dragging(start, end):
        tab.ask(c.SetRunning(True))
        wait_for(lambda: editor.proposed is not None)
        wait_for(lambda: np.linalg.norm(editor.points()[index] - old[index] - [0, 0.02]) < 3e-3)
        assert editor.selected == index
        times = [tab.simulation.time]
        wait_for(lambda: editor.proposed is not None and editor.curve is editor.proposed.curve)
        times.append(tab.simulation.time)
    assert times[1] - times[0] < 1.0
    wait_for(lambda: editor.proposed is None)
    assert editor.design.name == "edited"
    np.testing.assert_allclose(np.delete(editor.points(), index, 0), np.delete(old, index, 0))
    tab.page.keyboard.press("Control+z")
    wait_for(lambda: editor.design.name == "circle")
    wait_for(lambda: editor.curve is editor.design.curve)
    assert tab.simulation.running
    wait_for(lambda: tab.simulation.runs[FOLLOWER].distance < 1e-3)


def test_drawing_a_path_freehand(tab: Tab) -> None:
    tab.press("Draw")
    tab.settle()
    angle = np.linspace(0, 2 * np.pi, 18)
    stroke = 0.045 * np.column_stack([np.cos(angle), 0.8 * np.sin(angle)])
    with tab.dragging(*(tab.placed(FOLLOWER, z) for z in stroke)):
        pass
    wait_for(lambda: tab.simulation.editor.design.name == "drawn")
    drawn = tab.simulation.editor.design.curve
    distances = np.linalg.norm(drawn.at(drawn.nearest(stroke)[0]) - stroke, axis=1)
    assert distances.max() < 5e-3
    assert tab.said() == ""
