"""Which robot: a button that opens a menu of pictures."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable
from functools import lru_cache

import viser

from app.commands import ChooseRobot
from app.panels.widgets import Post, on_press
from app.session import Session
from assets import asset_path
from models.catalogue import ROBOTS, Entry


class RobotPanel:
    """The button near the top, and its menu."""

    def __init__(self, gui: viser.GuiApi, session: Session, post: Post) -> None:
        self._gui = gui
        self._post = post
        self._chosen = session.entry
        button = gui.add_button(
            "Robot…",
            icon=viser.Icon.ROBOT,
            color="gray",
            hint=f"Now: {session.entry.label}. Choose another; each keeps its path and settings.",
        )
        on_press(button, self._open)

    def _open(self) -> None:
        with self._gui.add_modal("Choose a robot") as modal:
            for entry in ROBOTS.values():
                self._gui.add_html(_card(entry))
                now = entry is self._chosen
                choose = self._gui.add_button(
                    f"{entry.label} (this one)" if now else entry.label,
                    icon=viser.Icon.CHECK if now else viser.Icon.ROBOT,
                    color="gray" if now else None,
                )
                on_press(choose, lambda name=entry.name: self._choose(name, modal.close))

    def _choose(self, name: str, close: Callable[[], None]) -> None:
        close()
        self._post(ChooseRobot(name))


@lru_cache
def _card(entry: Entry) -> str:
    """Picture and a sentence."""
    picture = base64.b64encode(asset_path(entry.picture).read_bytes()).decode()
    label, text = html.escape(entry.label), html.escape(entry.text)
    return (
        f'<div style="padding:0.6em 0 0.2em 0"><img alt="{label}" style="width:100%;'
        f'border:1px solid #dde" src="data:image/png;base64,{picture}"/>'
        f'<div style="font-size:0.9em;color:#445">{text}</div></div>'
    )
