"""The two small buttons of every page: language and display, and help."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.dialog import dialog
from onpath.app.page.panels.glossary import glossary_html
from onpath.app.page.panels.keys import help_text
from onpath.app.page.panels.slow_presses import on_menu_press
from onpath.app.page.panels.widgets import Post, add_menu, on_user_update
from onpath.app.view.preferences import Preferences, Switch
from onpath.lessons.words import Words, language_name, languages

HALF = "dark"
"""Colour of buttons that share a row; assets/page/style.css makes them quiet and half as wide."""


class PageMenus:
    """Both buttons and their windows.

    Args:
        preferences: the browser's preferences.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        post: Post,
        first: PageSnapshot,
        preferences: Preferences,
    ) -> None:
        self._gui, self._words, self._post = gui, words, post
        self._preferences = preferences
        self._presenting = first.key.presenting
        display = gui.add_button(words("display.title"), color=HALF, icon=viser.Icon.LANGUAGE)
        on_menu_press(display, self._open_display)
        helping = gui.add_button(words("controls.help"), color=HALF, icon=viser.Icon.HELP)
        on_menu_press(helping, self._open_help)

    def _open_display(self) -> Callable[[], None]:
        gui, words = self._gui, self._words
        names = {language_name(code): code for code in languages()}
        with dialog(gui, words, words("display.title")) as close:
            add_menu(
                gui,
                words("lesson.language"),
                names,
                lambda code: chosen(c.SetLanguage(code)),
                shown=language_name(words.language),
            )
            large = gui.add_checkbox(words("lesson.presenting"), self._presenting)
            labels: dict[Switch, str] = {
                "speaks": words("display.speaks"),
                "sounds": words("display.sounds"),
            }
            boxes = {
                name: gui.add_checkbox(label, self._preferences[name])
                for name, label in labels.items()
            }

        def chosen(command: c.Command) -> None:
            close()
            self._post(command)

        on_user_update(large, lambda on: chosen(c.Set("presenting", on)))
        for name in labels:
            on_user_update(boxes[name], partial(self._preferences.set, name))
        return close

    def _open_help(self) -> Callable[[], None]:
        words = self._words
        with dialog(self._gui, words, words("help.title")) as close:
            self._gui.add_markdown(help_text(words))
            self._gui.add_html(glossary_html(words))
        return close
