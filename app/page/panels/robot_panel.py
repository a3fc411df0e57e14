"""Selection of the robot: a button that opens a menu of pictures."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.common.templates import render
from onpath.app.lab.commands import ChooseRobot
from onpath.app.page.panels.dialog import dialog
from onpath.app.page.panels.slow_presses import on_menu_press
from onpath.app.page.panels.widgets import Post, on_press
from onpath.app.view.robots import picture_of
from onpath.lessons.labels import robot_label, robot_text
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import ROBOTS


class RobotPanel:
    """The button near the top and its menu."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, robot: str) -> None:
        self._gui, self._words = gui, words
        self._post = post
        self._chosen = ROBOTS[robot]
        button = gui.add_button(
            self._words("robots.button"),
            icon=viser.Icon.ROBOT,
            color="gray",
            hint=self._words("robots.hint", robot=robot_label(self._chosen.name, self._words)),
        )
        on_menu_press(button, self._open)

    def _open(self) -> Callable[[], None]:
        words = self._words
        with dialog(self._gui, words, words("robots.choose")) as close:
            for entry in ROBOTS.values():
                label = robot_label(entry.name, words)
                text = robot_text(entry, words)
                now = entry is self._chosen
                choose = self._gui.add_button(
                    words("robots.this", robot=label) if now else label,
                    icon=viser.Icon.CHECK if now else viser.Icon.ROBOT,
                    color="gray" if now else None,
                )
                on_press(choose, lambda name=entry.name: self._choose(name, close))
                self._gui.add_html(_card(picture_of(entry), label, text))
        return close

    def _choose(self, name: str, close: Callable[[], None]) -> None:
        close()
        self._post(ChooseRobot(name))


def _card(picture: str, label: str, text: str) -> str:
    """Picture and one-sentence description of a robot."""
    return render("panel/robot.html", label=label, text=text, picture=picture)
