"""The direction in which brakes act."""

from __future__ import annotations

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.widgets import Post, add_menu
from onpath.lessons.words import Words
from onpath.models.closed_loop.obstacles import DIRECTIONS


class HoldDirection:
    """A menu for the direction in which brakes act."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        labels = {name: words(f"run.direction_{name}") for name in DIRECTIONS}
        self._labels, self._just_changed = labels, False

        def choose(name: str) -> None:
            self._just_changed = True
            post(c.SetHoldDirection(name))

        self._menu = add_menu(
            gui,
            words("run.direction"),
            {label: name for name, label in labels.items()},
            choose,
            shown=labels[first.run.hold_direction],
            hint=words("run.direction_hint"),
        )

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's direction; see `LawPanel.follow`."""
        late, self._just_changed = self._just_changed, False
        label = self._labels[snapshot.run.hold_direction]
        if not late and self._menu.value != label:
            self._menu.value = label
