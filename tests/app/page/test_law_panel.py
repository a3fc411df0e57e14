"""The panel of the laws follows the lab, and never takes away what its user is typing."""

from __future__ import annotations

from typing import Any

import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page.panels.law_help import law_help
from onpath.app.page.panels.law_panel import LawPanel
from onpath.lessons.sides import law_label
from onpath.lessons.words import ENGLISH, Words
from onpath.models.control.laws.expressions import FUNCTIONS
from onpath.models.control.laws.own import PATH_FOLLOWING, SPACE, VIEW
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT
from tests.support.gui import Gui
from tests.support.lab import FRAME, do, new_lab, run

SLOW = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed/2)"
OWN = ENGLISH("laws.own")


class Shown:
    """A panel of a lab; commands are applied when the test says so."""

    def __init__(self, lab: Lab | None = None) -> None:
        self.lab, self.gui = lab or new_lab(0.1), Gui()
        gui: Any = self.gui
        self.panel = LawPanel(gui, ENGLISH, self.lab.post, take_page_snapshot(self.lab, 1.0))
        self.menu, self.box = self.gui.named["Law, left"][0], self.gui.named["Own law, left"][0]
        self.use, self.why = self.gui.named["Use this law"][0], self.gui.html[0]

    def follow(self, frames: int = 2) -> None:
        """Advance the lab, and show it."""
        for _ in range(frames):
            run(self.lab, FRAME)
            self.panel.follow(take_page_snapshot(self.lab, 1.0))


def test_the_box_is_there_for_an_own_law_alone() -> None:
    shown = Shown()
    assert shown.menu.options[-1] == OWN and not shown.box.visible
    shown.menu.set(OWN)
    for _ in range(2):
        assert shown.box.visible and shown.use.visible
        assert shown.box.value == PATH_FOLLOWING.replace("; ", "\n")
        shown.follow()
        assert shown.menu.value == OWN and shown.lab.simulation.laws == DEFAULT_LAWS
    shown.menu.set("Path following")
    shown.follow(4)
    assert not shown.box.visible and shown.menu.value == "Path following"


def test_the_law_in_the_box_is_used_and_a_refusal_stands_beside_it() -> None:
    shown = Shown()
    shown.menu.set(OWN)
    shown.box.value = "across = -K1*xii; along = 0"
    shown.use.set(True)
    shown.follow()
    assert "did you mean xi?" in shown.why.content and shown.why.visible
    assert shown.lab.simulation.chosen_laws == DEFAULT_LAWS and shown.menu.value == OWN
    shown.box.value = SLOW.replace("; ", "\n")
    shown.use.set(True)
    shown.follow()
    assert shown.lab.simulation.laws == {**DEFAULT_LAWS, LEFT: SLOW}
    assert shown.why.content == "" and shown.menu.value == OWN
    assert any(SLOW in html.content for html in shown.gui.html)


@pytest.mark.parametrize("late", [0, 1, 3])
def test_what_is_typed_while_a_law_comes_stays(late: int) -> None:
    shown = Shown()
    shown.menu.set(OWN)
    for number in range(4):
        shown.box.value = law = f"across = -{number + 1}*xi\nalong = 1"
        shown.use.set(True)
        shown.follow(late)
        shown.box.value = law + " - dtheta"  # the user types on
        shown.follow()
        assert shown.box.value == law + " - dtheta" and shown.box.visible


def test_an_own_law_right_after_another_one_keeps_its_box() -> None:
    shown = Shown()
    shown.menu.set("Waiting clock")
    shown.menu.set(OWN)
    while shown.lab.simulation.laws[LEFT] != "waiting_clock":
        shown.follow()
    shown.follow()
    assert shown.box.visible and shown.menu.value == OWN


def test_a_law_from_elsewhere_is_shown() -> None:
    shown = Shown()
    do(shown.lab, c.TypeLaw(LEFT, SLOW))
    shown.follow()
    assert shown.box.visible and shown.box.value == SLOW.replace("; ", "\n")
    assert shown.menu.value == OWN
    do(shown.lab, c.ChooseLaw(LEFT, DEFAULT_LAWS[LEFT]))
    shown.follow()
    assert not shown.box.visible and shown.menu.value == "Trajectory tracking"
    again = new_lab()
    do(again, c.TypeLaw(LEFT, SLOW))
    other = Shown(again)
    assert other.box.visible and other.box.value == SLOW.replace("; ", "\n")
    assert other.gui.named["Law, right"][0].value == law_label(DEFAULT_LAWS[RIGHT], ENGLISH)


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_page_of_help_tells_every_law_and_every_name(language: str) -> None:
    words = Words(language)
    for spatial in (False, True):
        for own_first in (False, True):
            page = law_help(LAWS, spatial, own_first, words)
            places = [page.index(f"<b>{law_label(name, words)}.</b>") for name in LAWS]
            assert sorted(places) == places
            assert (page.index("<table") < places[0]) == own_first
            for name in (*VIEW, *(SPACE if spatial else ()), *FUNCTIONS):
                assert name in page
            assert ("across2" in page) == spatial
            assert all(law.source.split(",")[0] in page for law in LAWS.values())
