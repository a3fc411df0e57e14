"""Which robot: a button that opens a menu of pictures."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable
from functools import lru_cache

import viser

from onpath.app.lab.commands import ChooseRobot
from onpath.app.lab.lab import Lab
from onpath.app.page.panels.widgets import Post, on_press
from onpath.assets import asset_path
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import ROBOTS, RobotEntry


class RobotPanel:
    """The button near the top, and its menu."""

    def __init__(self, gui: viser.GuiApi, lab: Lab, post: Post) -> None:
        self._gui, self._words = gui, lab.words
        self._post = post
        self._chosen = lab.session.entry
        button = gui.add_button(
            self._words("robots.button"),
            icon=viser.Icon.ROBOT,
            color="gray",
            hint=self._words("robots.hint", robot=label_of(lab.session.entry, self._words)),
        )
        on_press(button, self._open)

    def _open(self) -> None:
        words = self._words
        with self._gui.add_modal(words("robots.choose")) as modal:
            for entry in ROBOTS.values():
                label = label_of(entry, words)
                text = words.get(f"machine.{entry.name}.text", entry.text)
                self._gui.add_html(_card(entry.picture, label, text))
                now = entry is self._chosen
                choose = self._gui.add_button(
                    words("robots.this", robot=label) if now else label,
                    icon=viser.Icon.CHECK if now else viser.Icon.ROBOT,
                    color="gray" if now else None,
                )
                on_press(choose, lambda name=entry.name: self._choose(name, modal.close))

    def _choose(self, name: str, close: Callable[[], None]) -> None:
        close()
        self._post(ChooseRobot(name))


def label_of(entry: RobotEntry, words: Words) -> str:
    """A robot's name as shown."""
    return words.get(f"machine.{entry.name}.label", entry.label)


@lru_cache
def _card(asset: str, label: str, text: str) -> str:
    """Picture and a sentence."""
    picture = base64.b64encode(asset_path(asset).read_bytes()).decode()
    return (
        f'<div style="padding:0.6em 0 0.2em 0"><img alt="{html.escape(label)}" style="width:100%;'
        f'border:1px solid #dde" src="data:image/png;base64,{picture}"/>'
        f'<div style="font-size:0.9em;color:#445">{html.escape(text)}</div></div>'
    )
