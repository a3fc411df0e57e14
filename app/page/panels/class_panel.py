"""A student's way into the class, and a teacher's to the teacher's page."""

from __future__ import annotations

import html
from collections.abc import Callable

import viser

from onpath.app.lab.lab import Lab
from onpath.app.page.page_context import ClassSeat
from onpath.app.page.panels.widgets import on_slow_press


class ClassPanel:
    """A folder: class code and nickname, or who one is in the class."""

    def __init__(self, gui: viser.GuiApi, lab: Lab, seat: ClassSeat) -> None:
        self._seat, self._words = seat, lab.words
        words = self._words
        with gui.add_folder(words("class.title"), expand_by_default=not seat.name()):
            self._member = gui.add_html("")
            self._code = gui.add_text(words("class.code"), "", hint=words("class.code_hint"))
            self._name = gui.add_text(
                words("class.nickname"), "", hint=words("class.nickname_hint")
            )
            self._join = gui.add_button(words("class.join"), icon=viser.Icon.LOGIN)
            self._leave = gui.add_button(words("class.leave"), color="gray", icon=viser.Icon.LOGOUT)
            self._said = gui.add_html("")
            with gui.add_folder(words("class.teacher"), expand_by_default=False):
                key = gui.add_text(words("class.key"), "", hint=words("class.key_hint"))
                teach = gui.add_button(words("class.teach"), color="gray", icon=viser.Icon.KEY)
        self._try(self._join, lambda: seat.join(self._code.value, self._name.value))
        self._try(self._leave, seat.leave)
        self._try(teach, lambda: seat.teach(key.value))
        self._shown: str | None = None
        self.follow(lab)

    def follow(self, lab: Lab) -> None:
        """Show whether the student is in the class."""
        name = self._seat.name()
        if name == self._shown:
            return
        self._shown = name
        said = self._words("class.member", name=f"<b><bdi>{html.escape(name)}</bdi></b>")
        self._member.content = _text(said) if name else ""
        for handle in (self._code, self._name, self._join):
            handle.visible = not name
        self._leave.visible = bool(name)

    def _try(self, button: viser.GuiButtonHandle, act: Callable[[], object]) -> None:
        def tried() -> None:
            self._said.content = ""
            try:
                act()  # may build the page anew, without this panel
            except (ValueError, OSError) as error:
                self._said.content = _text(html.escape(self._words.sentence(str(error))))

        on_slow_press(button, tried)


def _text(content: str) -> str:
    return f'<div role="note" style="padding:0.3em 0.9em;font-size:0.9em">{content}</div>'
