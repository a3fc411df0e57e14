"""The menu of preset paths shows the lab's path, and is not set back while a choice comes."""

from __future__ import annotations

from typing import Any

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page.panels.path_panel import PathChoice
from onpath.lessons.labels import path_label
from onpath.lessons.words import ENGLISH
from tests.support.gui import Gui, Widget
from tests.support.lab import do, new_lab

OWN = ENGLISH("design.own")


def shown(lab: Lab) -> tuple[PathChoice, Widget]:
    """The menu of a lab, and its widget."""
    gui = Gui()
    fake: Any = gui
    panel = PathChoice(fake, ENGLISH, lab.post, take_page_snapshot(lab, 1.0))
    (menu,) = gui.named[ENGLISH("design.path")]
    return panel, menu


def test_a_snapshot_from_before_the_choice_does_not_set_the_menu_back() -> None:
    lab = new_lab()
    panel, menu = shown(lab)
    before, chosen = take_page_snapshot(lab, 1.0), path_label("ellipse", ENGLISH)
    menu.set(chosen)
    panel.follow(before)
    assert menu.value == chosen
    lab.drain()
    for _ in range(2):
        after = take_page_snapshot(lab, 1.0)
        panel.follow(after)
        assert menu.value == chosen and after.edit.name == "ellipse"


def test_a_choice_that_the_lab_does_not_take_is_set_back() -> None:
    lab = new_lab()
    panel, menu = shown(lab)
    first = menu.value
    menu.set(path_label("ellipse", ENGLISH))
    for _ in range(2):
        panel.follow(take_page_snapshot(lab, 1.0))
    assert menu.value == first


def test_a_path_of_ones_own_is_an_entry_while_it_is_followed() -> None:
    lab = new_lab()
    panel, menu = shown(lab)
    presets = list(menu.options)
    do(lab, c.AddPoint())
    panel.follow(take_page_snapshot(lab, 1.0))
    assert menu.value == OWN and list(menu.options) == [*presets, OWN]
    do(lab, c.ChoosePath("ellipse"))
    panel.follow(take_page_snapshot(lab, 1.0))
    assert menu.value == path_label("ellipse", ENGLISH) and list(menu.options) == presets
