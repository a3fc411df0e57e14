"""Windows that close by a button at their end, by Escape, by a click beside them, or by an x."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

import viser

from onpath.app.common.templates import render
from onpath.app.page.panels.widgets import close_once, on_press
from onpath.lessons.words import Words


@contextmanager
def dialog(gui: viser.GuiApi, words: Words, title: str) -> Iterator[Callable[[], None]]:
    """A window whose widgets are added in the context; yields a function that closes it."""
    with gui.add_modal(title) as modal:
        close = partial(close_once, modal)
        gui.add_html(render("panel/focus.html"))
        yield close
        mark_closing(gui, words)
        on_press(gui.add_button(words("help.close"), color="gray"), close)


def mark_closing(gui: viser.GuiApi, words: Words) -> None:
    """Mark the next button as the one that closes the window; see assets/page/dialogs.js."""
    gui.add_html(render("panel/close.html", words=words))
