"""Tests of the buttons, sliders, numbers and keys of the free lab."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("playwright")

from onpath.app.lab import commands as c
from onpath.models.control.sides import LEFT, RIGHT
from tests.support.browser import Tab, wait_for

TRACKER, FOLLOWER = LEFT, RIGHT


def test_holding_both_back_shows_the_difference(tab: Tab) -> None:
    """The main result, which a student must be able to find within a minute."""
    lab = tab.lab
    tab.press("Pause")
    wait_for(lambda: not lab.simulation.running)
    tab.press("Reset")
    wait_for(lambda: lab.simulation.time == 0.0)
    for _ in range(5):  # two laps: as in the paper's experiment, held back at the rightmost point
        tab.ask(*[c.StepOnce()] * 400)
    tab.press("Hold both back")
    wait_for(lambda: len(lab.simulation.forces.held) == 2)
    tab.press("Run")
    wait_for(lambda: lab.simulation.time > 4.0)
    assert lab.simulation.runs[FOLLOWER].max_distance < 0.003
    assert lab.simulation.runs[TRACKER].max_distance > 0.040
    shown = tab.page.get_by_role("group", name="Follower").inner_text()
    assert float(shown.split()[0]) < 3.0
    tab.press("Let both go")
    wait_for(lambda: not lab.simulation.forces.held)
    tab.button("Hold both back").wait_for()
    wait_for(lambda: max(run.distance for run in lab.simulation.runs.values()) < 2e-3)


def test_gains_by_number_and_by_slider(tab: Tab) -> None:
    lab = tab.lab
    tab.enter("K2", "10")
    wait_for(lambda: lab.simulation.parameters.K2 == 10.0)
    tab.enter("K3", "8000")  # more than K1 K2
    wait_for(lambda: lab.simulation.parameters.K3 == 8000.0)
    tab.page.locator("#op-panel").get_by_text("unstable").first.wait_for()
    track = tab.slider("K1").bounding_box()
    assert track is not None
    middle = track["y"] + track["height"] / 2
    with tab.dragging(
        (track["x"] + 0.6 * track["width"], middle),
        (track["x"] + 0.9 * track["width"], middle),
        in_scene=False,
    ):
        wait_for(lambda: lab.simulation.parameters.K1 > 600.0)
    shown = tab.number("K1")
    wait_for(lambda: float(shown.input_value()) == lab.simulation.parameters.K1)
    tab.press("Reset to defaults")
    wait_for(lambda: lab.simulation.parameters == type(lab.simulation.parameters)())
    wait_for(lambda: float(shown.input_value()) == 400.0)


def test_a_robot_that_leaves_its_workspace_stops_and_says_why(tab: Tab) -> None:
    tab.ask(c.Set("K1", 0.0), c.Set("K2", 0.0))
    tab.ask(*[c.MoveHand(-0.1, -0.1)] * 4)
    tab.page.get_by_role("status").filter(has_text="Reset starts the run again").wait_for()
    assert any(run.diverged for run in tab.simulation.runs.values())
    tab.ask(c.ResetParameters())
    tab.press("Reset")
    wait_for(lambda: all(run.diverged is None for run in tab.simulation.runs.values()))
    tab.wait_for_no_message()
    wait_for(lambda: tab.simulation.runs[FOLLOWER].distance < 1e-3 < tab.simulation.time)


def test_rewind_and_go_on_from_there(tab: Tab) -> None:
    lab = tab.lab
    wait_for(lambda: lab.simulation.time > 2.5)
    tab.press("Pause")
    wait_for(lambda: not lab.simulation.running)
    handle = tab.page.get_by_role("slider", name="Look back")
    tab.focus(handle)
    handle.press("PageDown")
    for _ in range(5):
        handle.press("ArrowLeft")
    then = lab.simulation.time

    def shown() -> float:  # in tenths of a second
        return float(handle.get_attribute("aria-valuenow") or 0)

    def viewed() -> float:
        return then if lab.simulation.viewing is None else lab.simulation.viewing

    wait_for(lambda: then - viewed() > 1.45 and abs(shown() - viewed()) < 0.051)
    viewing = viewed()
    times, _ = lab.simulation.history.samples(-1.0, then, 10_000)
    assert then - viewing < 1.5 + 6 * np.diff(times).max()  # each step ends at a sample
    tab.press("Go on from here")
    wait_for(lambda: lab.simulation.viewing is None and lab.simulation.running)
    assert lab.simulation.time < then
    wait_for(lambda: lab.simulation.time > viewing + 0.2)
    assert lab.simulation.runs[FOLLOWER].distance < 1e-3
    tab.button("Go on from here").wait_for(state="hidden")
    tab.press("Restore what was discarded")
    wait_for(lambda: lab.simulation.time == then)


# Keys.


def test_keys_do_what_the_buttons_do(tab: Tab) -> None:
    lab, keys = tab.lab, tab.page.keyboard
    keys.press("Space")
    wait_for(lambda: not lab.simulation.running)
    paused = lab.simulation.time
    keys.press("ArrowRight")
    wait_for(lambda: lab.simulation.time > paused)
    assert lab.simulation.time == pytest.approx(paused + 1e-3, abs=1e-9)
    keys.press("h")
    wait_for(lambda: len(lab.simulation.forces.held) == 2)
    keys.press("h")
    wait_for(lambda: not lab.simulation.forces.held)
    keys.press("r")
    wait_for(lambda: lab.simulation.time == 0.0)
    keys.press("Space")
    wait_for(lambda: lab.simulation.running and lab.simulation.time > 0.1)
    tab.press("Pause")
    wait_for(lambda: not lab.simulation.running)
    tab.button("Run").wait_for()
    keys.press("Space")  # once, though the button has been pressed
    wait_for(lambda: lab.simulation.running)
    begun = lab.simulation.time
    wait_for(lambda: lab.simulation.time > begun + 0.5)


def test_a_control_point_moves_by_keys_and_by_numbers(tab: Tab) -> None:
    editor, keys = tab.simulation.editor, tab.page.keyboard
    first = editor.points()[0].copy()
    keys.press("n")
    wait_for(lambda: editor.selected == 0)
    keys.press("ArrowUp")
    wait_for(lambda: np.allclose(editor.points()[0], first + np.array([0, 1e-3])))
    box = tab.number("y1")
    wait_for(lambda: tab.value("y1") == pytest.approx(first[0] * 1e3, abs=0.1))
    tab.enter("y1", "-56")
    wait_for(lambda: editor.points()[0][0] == pytest.approx(-0.056))
    tab.press("Undo")
    tab.press("Undo")
    wait_for(lambda: editor.design.name == "circle")
    for selected in (None, 0):  # without a point there are no coordinates
        tab.ask(c.SelectPoint(selected))
        wait_for(lambda selected=selected: box.is_visible() == (selected is not None))
