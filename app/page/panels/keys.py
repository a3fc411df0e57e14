"""The keyboard shortcuts as viser has them, and the window that lists them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import viser

from onpath.app.page.panels.widgets import Post
from onpath.app.view.keys import KEYS, Key
from onpath.lessons.words import Words


class Keys:
    """The shortcuts of a page, which also appear in viser's command palette.

    They stay while the page is built anew, so that none that is pressed meanwhile is lost.
    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._gui, self._handles = gui, dict[str, viser.CommandHandle]()
        self._acts = dict[str, Callable[[], None]]()

    def renew(
        self, words: Words, post: Post, page_actions: Mapping[str, Callable[[], None]]
    ) -> None:
        """Register the shortcuts, or change what they do and how they are called.

        Args:
            page_actions: the actions of the keys without a command, by name.
        """
        posts = {k.name: partial(post, k.command) for k in KEYS if k.command is not None}
        self._acts = {**page_actions, **posts}
        for key in KEYS:
            if key.name in self._handles:
                self._handles[key.name].label = key.does(words)
            else:
                self._handles[key.name] = self._added(key, words)

    def close(self) -> None:
        """Forget what the shortcuts do."""
        self._acts.clear()

    def _added(self, key: Key, words: Words) -> viser.CommandHandle:
        hotkey: Any = key.hotkey
        modifier = "cmd/ctrl" if key.control else None
        handle = self._gui.add_command(key.does(words), hotkey=hotkey, modifier=modifier)

        async def triggered(_: object) -> None:
            if key.name in self._acts:
                self._acts[key.name]()

        handle.on_trigger(triggered)
        return handle


def help_text(words: Words) -> str:
    """Text of the help window."""
    rows = [f"| **{key.shown(words)}** | {key.does(words)} |" for key in KEYS]
    return "\n".join([words("help.text"), *rows])
