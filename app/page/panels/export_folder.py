"""The folder with the files of the last minute."""

from __future__ import annotations

import viser

from onpath.app.exports.exporter import Exporter
from onpath.app.page.panels.widgets import on_press
from onpath.lessons.words import Words


def add_exports(gui: viser.GuiApi, words: Words, exporter: Exporter) -> None:
    """Add the folder with the files of the last minute."""
    with gui.add_folder(words("export.title"), expand_by_default=False):
        table = gui.add_button(words("export.table"), color="gray", icon=viser.Icon.TABLE)
        picture = gui.add_button(words("export.picture"), color="gray", icon=viser.Icon.PHOTO)
        film = gui.add_button(words("export.film"), color="gray", icon=viser.Icon.MOVIE)
    on_press(table, exporter.csv)
    on_press(picture, exporter.picture)
    on_press(film, exporter.recording)
