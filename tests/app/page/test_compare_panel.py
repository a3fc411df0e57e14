"""The comparison of laws offers those that are typed on the sides."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

from onpath.app.exports.comparison import Results, compared
from onpath.app.exports.figures_comparison import comparison_figure
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page.panels.compare_panel import ComparePanel, comparison_html
from onpath.lessons.sides import law_label
from onpath.lessons.words import ENGLISH, Words
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, new_lab, run

TYPED = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed/2)"
OTHER = "across = -K1*xi - 30*dxi; along = -K5*(dtheta - speed)"
ROBOT = FIVE_BAR.make(FIVE_BAR.parameters())
BOXES = {side: ENGLISH(f"laws.own_{side}") for side in (LEFT, RIGHT)}


class Gui:
    """Notes checkboxes by label, and the button."""

    def __init__(self) -> None:
        self.boxes: dict[str, SimpleNamespace] = {}
        self.shown = SimpleNamespace(content="")

    @contextlib.contextmanager
    def add_folder(self, *_: Any, **__: Any) -> Iterator[None]:
        yield

    def add_markdown(self, _: str) -> None: ...

    def add_checkbox(self, label: str, value: bool, visible: bool = True, **_: Any) -> Any:
        self.boxes[label] = SimpleNamespace(value=value, visible=visible)
        return self.boxes[label]

    def add_dropdown(self, *_: Any, initial_value: str, **__: Any) -> Any:
        return SimpleNamespace(value=initial_value)

    def add_button(self, *_: Any, **__: Any) -> Any:
        return SimpleNamespace(on_click=self._note)

    def add_html(self, _: str) -> Any:
        return self.shown

    def _note(self, pressed: Any) -> None:
        self._pressed = pressed

    def press(self) -> None:
        with contextlib.suppress(StopIteration):
            self._pressed(None).send(None)


def panel(lab: Lab) -> tuple[ComparePanel, Gui, list[list[str]]]:
    gui, asked = Gui(), list[list[str]]()
    first = take_page_snapshot(lab, 1.0)
    made = ComparePanel(gui, ENGLISH, first, lambda laws, *_: asked.append(laws))  # pyright: ignore
    return made, gui, asked


def test_a_typed_law_can_be_chosen_while_it_is_there() -> None:
    lab = new_lab(0.1)
    made, gui, asked = panel(lab)
    assert not any(gui.boxes[label].visible for label in BOXES.values())
    do(lab, c.TypeLaw(RIGHT, TYPED))
    run(lab, 0.2)
    made.follow(take_page_snapshot(lab, 1.0))
    box = gui.boxes[BOXES[RIGHT]]
    assert box.visible and not gui.boxes[BOXES[LEFT]].visible
    gui.press()
    assert TYPED not in asked[-1]
    box.value = True
    gui.press()
    assert asked[-1][-1] == TYPED
    do(lab, c.ChooseLaw(RIGHT, "path_following"))
    run(lab, 0.2)
    made.follow(take_page_snapshot(lab, 1.0))
    gui.press()
    assert not box.visible and TYPED not in asked[-1]


def test_the_same_law_on_both_sides_is_compared_once_and_six_are_the_most() -> None:
    lab = new_lab(0.1)
    do(lab, c.TypeLaw(RIGHT, TYPED), c.TypeLaw(LEFT, TYPED))
    run(lab, 0.2)
    _, gui, asked = panel(lab)
    for label in BOXES.values():
        gui.boxes[label].value = True
    gui.press()
    assert asked[-1].count(TYPED) == 1
    for box in gui.boxes.values():
        box.value = True
    before = len(asked)
    gui.press()
    assert len(asked) == before and "6" in gui.shown.content


def test_two_typed_laws_are_told_apart_in_the_table() -> None:
    results: Results = {}
    for law in (TYPED, OTHER):
        what = FIVE_BAR.name, FIVE_BAR.parameters(), circle(0.05), results, law, "none", "en"
        results, picture = compared(*what)
    for language in ("en", "de"):
        words = Words(language)
        page = comparison_html(results, picture, words, ROBOT)
        label = law_label(TYPED, words)
        assert f"{label} 1" in page and f"{label} 2" in page
        assert TYPED in page and OTHER in page


def test_a_law_that_stops_has_no_numbers_and_stands_at_the_edge_of_the_picture() -> None:
    results: Results = {}
    for law in ("u1 = 9; u2 = 0", "path_following"):
        what = FIVE_BAR.name, FIVE_BAR.parameters(), circle(0.05), results, law, "none", "en"
        results, picture = compared(*what)
    for language, stopped in (("en", "stopped"), ("de", "angehalten")):
        page = comparison_html(results, picture, Words(language), ROBOT)
        assert page.count(f"<td>{stopped}</td>") == 3 and "inf" not in page
    figure = comparison_figure(results)
    (axes,) = figure.axes
    hollow = [line for line in axes.lines if line.get_markerfacecolor() == "none"]
    assert len(hollow) == 1 and [text.get_text() for text in axes.texts] == ["stopped"]
