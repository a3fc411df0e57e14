"""The direction in which brakes act."""

from __future__ import annotations

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.widgets import LabValue, Post, add_menu, put
from onpath.lessons.words import Words
from onpath.models.closed_loop.obstacles import DIRECTIONS


class HoldDirection:
    """A menu for the direction in which brakes act."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        labels = {name: words(f"run.direction_{name}") for name in DIRECTIONS}
        self._labels, self._direction = labels, LabValue(post)
        self._menu = add_menu(
            gui,
            words("run.direction"),
            {label: name for name, label in labels.items()},
            lambda name: self._direction.change(c.Set("hold_direction", name)),
            shown=labels[first.settings.hold_direction],
            hint=words("run.direction_hint"),
        )

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's direction."""
        direction = snapshot.settings.hold_direction
        if self._direction.is_new(direction):
            put(self._menu, value=self._labels[direction])
