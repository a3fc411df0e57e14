"""The switch with which pulling and holding act on both robots."""

from __future__ import annotations

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.widgets import LabValue, Post, on_user_update, put
from onpath.lessons.words import Words


class CopyBox:
    """A checkbox: whether pulling and holding act on both robots."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        self._box = gui.add_checkbox(
            words("controls.copy"), first.settings.copy, hint=words("controls.copy_hint")
        )
        self._copies = LabValue(post)
        on_user_update(self._box, lambda on: self._copies.change(c.Set("copy", on)))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's choice, which every set-up brings with it."""
        if self._copies.is_new(snapshot.settings.copy):
            put(self._box, value=snapshot.settings.copy)
