"""The box in which a user types a law for one side, with the button that applies it."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.page.panels.widgets import on_press, put, refused
from onpath.lessons.words import Words
from onpath.models.control.laws.own import PATH_FOLLOWING, is_text, tidy


class OwnLawBox:
    """A text box, a button, and the reason of a refusal; hidden while another law is chosen.

    Enter presses the button; see assets/page/keys.js.

    Args:
        use: called with the text when the button is pressed.
    """

    def __init__(
        self, gui: viser.GuiApi, words: Words, side: str, law: str, use: Callable[[str], None]
    ) -> None:
        shown = is_text(law)
        self._text = gui.add_text(
            words(f"laws.own_{side}"),
            lines_of(law if shown else PATH_FOLLOWING),
            multiline=True,
            visible=shown,
            hint=words("laws.own_hint"),
        )
        self._use = gui.add_button(
            words("laws.use"), color="gray", visible=shown, icon=viser.Icon.CHECK
        )
        self._reason = gui.add_html("", visible=shown)
        self._refusal = ""
        on_press(self._use, lambda: use(self._text.value))

    def show(self, visible: bool) -> None:
        """Show or hide everything."""
        for handle in (self._text, self._use, self._reason):
            put(handle, visible=visible)

    def take(self, law: str) -> None:
        """Show a law that was typed elsewhere."""
        if tidy(self._text.value) != law:
            self._text.value = lines_of(law)

    def follow(self, refusal: str) -> None:
        """Show why the last text was refused; an empty reason hides it."""
        if refusal != self._refusal:
            self._refusal = refusal
            self._reason.content = refused(refusal) if refusal else ""


def lines_of(law: str) -> str:
    """A typed law with each formula on a line of its own."""
    return law.replace("; ", "\n")
