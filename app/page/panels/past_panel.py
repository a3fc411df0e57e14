"""The last minute: look back, resume from there, export files."""

from __future__ import annotations

import viser

from onpath.app.exports.exporter import Exporter
from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.widgets import Post, on_press, on_user_update
from onpath.lessons.words import Words

REACH = 60.0  # [s]


class PastPanel:
    """Rewind and export."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, exporter: Exporter) -> None:
        with gui.add_folder(words("past.title"), expand_by_default=False):
            self._ago = gui.add_slider(
                words("past.ago"),
                min=0.0,
                max=REACH,
                step=0.1,
                initial_value=0.0,
                hint=words("past.ago_hint"),
            )
            self._go_on = gui.add_button(
                words("past.go_on"),
                icon=viser.Icon.PLAYER_TRACK_NEXT,
                disabled=True,
                hint=words("past.go_on_hint"),
            )
            self._undo = gui.add_button(
                words("past.undo"),
                icon=viser.Icon.ARROW_BACK_UP,
                color="gray",
                disabled=True,
                hint=words("past.undo_hint"),
            )
        add_exports(gui, words, exporter)
        on_user_update(self._ago, lambda ago: post(c.LookAt(ago)))
        on_press(self._go_on, lambda: post(c.GoOn()))
        on_press(self._undo, lambda: post(c.UndoGoOn()))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Move the slider to the displayed time, even if it was changed by other means."""
        run = snapshot.run
        for button, useless in (
            (self._go_on, run.viewing is None),
            (self._undo, not run.can_undo_going_on),
        ):
            if button.disabled != useless:
                button.disabled = useless
        ago = 0.0 if run.viewing is None else round(run.now - run.viewing, 1)
        if self._ago.value != ago:
            self._ago.value = ago


def add_exports(gui: viser.GuiApi, words: Words, exporter: Exporter) -> None:
    """Add the folder with the files of the last minute."""
    with gui.add_folder(words("export.title"), expand_by_default=False):
        table = gui.add_button(words("export.table"), color="gray", icon=viser.Icon.TABLE)
        picture = gui.add_button(words("export.picture"), color="gray", icon=viser.Icon.PHOTO)
        film = gui.add_button(words("export.film"), color="gray", icon=viser.Icon.MOVIE)
    on_press(table, exporter.csv)
    on_press(picture, exporter.picture)
    on_press(film, exporter.recording)
