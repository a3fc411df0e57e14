"""Widgets that follow a lab."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab.commands import ChooseRobot, Command, Set
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page.panels.gains_panel import ADVANCED, BASIC, own_of
from onpath.app.page.panels.widgets import OwnGainWidgets, ParameterWidgets
from onpath.lessons.words import ENGLISH
from onpath.models.control.laws.registry import OWN_GAINS
from onpath.models.control.settable import changed
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import declared
from onpath.models.systems.robots import RobotEntry
from tests.support.gui import Gui
from tests.support.lab import loop_cache


def test_a_snapshot_from_before_a_change_does_not_set_the_slider_back() -> None:
    lab, posted = Lab(loop_cache()), list[Command]()
    before, gui = take_page_snapshot(lab, 1.0), Gui()
    fake: Any = gui
    widgets = ParameterWidgets(fake, ENGLISH, posted.append, ["K1"], before)
    ((slider,),) = gui.named.values()
    slider.set(123.0)
    widgets.follow(before)
    assert slider.value == 123.0 and posted == [Set("K1", 123.0)]
    for command in posted:
        command.apply(lab)
    widgets.follow(take_page_snapshot(lab, 1.0))
    assert slider.value == 123.0
    slider.set(1e9)  # refused: the lab keeps its value, and so does the slider
    widgets.follow(before)
    widgets.follow(take_page_snapshot(lab, 1.0))
    assert slider.value == 123.0


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_a_slider_stops_at_multiples_of_its_step(entry: RobotEntry) -> None:
    lab, gui = Lab(loop_cache()), Gui()
    fake: Any = gui
    ChooseRobot(entry.name).apply(lab)
    names = [name for name, spec in declared(entry.parameters).items() if not spec.options]
    for end in ("low", "high"):
        for name in names:
            limit = getattr(declared(entry.parameters)[name], end)
            lab.simulation.parameters = changed(lab.simulation.parameters, name, limit)
        ParameterWidgets(fake, ENGLISH, lambda _: None, names, take_page_snapshot(lab, 0.0))
    made = [(heading, slider) for heading, sliders in gui.named.items() for slider in sliders]
    assert len(made) == 2 * len(names)
    for heading, slider in made:
        low, high, step = slider.min, slider.max, slider.step
        assert low <= slider.value <= high, heading
        for end in (low, high):
            assert end == pytest.approx(round(end / step) * step, abs=1e-12), heading


def test_the_sliders_of_own_gains_are_those_of_the_laws_in_use() -> None:
    lab, gui = Lab(loop_cache()), Gui()
    fake: Any = gui
    widgets = OwnGainWidgets(fake, ENGLISH, lambda _: None, take_page_snapshot(lab, 0.0))
    shown = {heading.partition(" [")[0]: slider for heading, (slider,) in gui.named.items()}

    def visible() -> set[str]:
        widgets.follow(take_page_snapshot(lab, 0.0))
        return {label for label, slider in shown.items() if slider.visible}

    assert len(shown) == len(OWN_GAINS) and visible() == set()
    lab.simulation.change_law(LEFT, "waiting_clock")
    assert visible() == {"Clock waits"}
    lab.simulation.change_law(RIGHT, "contouring")
    assert visible() == {"Clock waits", "Along / across"}
    lab.simulation.change_law(LEFT, "path_following")
    assert visible() == {"Along / across"}


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
def test_every_parameter_of_a_robot_has_one_place_in_the_lab(entry: RobotEntry) -> None:
    specs = declared(entry.parameters)
    own, apart = own_of(entry), [n for n, s in specs.items() if s.group in ("realism", "path")]
    shown = [*BASIC, *ADVANCED, *own, *apart]
    assert len(shown) == len(set(shown))
    if entry.flexible_link is None:  # its panel has the others
        assert set(shown) == specs.keys()


def test_what_only_one_robot_has_stands_beside_the_gains() -> None:
    assert own_of(ROBOTS["rod_gantry"]) == ["alpha", "rod", "pivot"]
    assert own_of(ROBOTS["cart_pendulum"]) == ["pendulum", "mass", "pivot"]
