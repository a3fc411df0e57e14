"""Panel for joining the class and for opening the teacher's page."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.common.templates import render
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.page_context import PageContext
from onpath.app.page.panels.slow_presses import on_slow_press
from onpath.app.page.panels.widgets import refused
from onpath.lessons.words import Words


class ClassPanel:
    """A folder with fields for class code and nickname, or with the student's name once joined."""

    def __init__(
        self, gui: viser.GuiApi, words: Words, context: PageContext, first: PageSnapshot
    ) -> None:
        self._words, seat = words, context.seat
        assert seat is not None
        with gui.add_folder(words("class.title"), expand_by_default=not first.nickname):
            self._member = gui.add_html("")
            code, hint = seat.code.upper(), words("class.code_hint")
            self._code = _required_text(gui, words("class.code"), hint, code)
            self._stored = gui.add_html(
                render(
                    "panel/stored.html",
                    days=context.keep_days,
                    url=context.privacy_url,
                    words=words,
                )
            )
            hint = words("class.nickname_hint")
            self._name = _required_text(gui, words("class.nickname"), hint, kind="name")
            self._join = gui.add_button(words("class.join"), icon=viser.Icon.LOGIN)
            self._leave = gui.add_button(words("class.leave"), color="gray", icon=viser.Icon.LOGOUT)
            message = gui.add_html("")
            with gui.add_folder(words("class.teacher"), expand_by_default=False):
                hint = words("class.key_hint")
                key = _required_text(gui, words("class.key"), hint, kind="secret")
                teach = gui.add_button(words("class.teach"), color="gray", icon=viser.Icon.KEY)
                teach_message = gui.add_html("")
        self._try(self._join, lambda: seat.join(self._code.value, self._name.value), message)
        self._try(self._leave, lambda: seat.leave() or "", message)
        self._try(teach, lambda: seat.teach(key.value), teach_message)
        self._shown: str | None = None
        self.follow(first)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show whether the student is in the class."""
        name = snapshot.nickname
        if name == self._shown:
            return
        self._shown = name
        member = render("panel/member.html", name=name, words=self._words, small=True)
        self._member.content = member if name else ""
        for handle in (self._code, self._stored, self._name, self._join):
            handle.visible = not name
        self._leave.visible = bool(name)

    def _try(
        self, button: viser.GuiButtonHandle, act: Callable[[], str], message: viser.GuiHtmlHandle
    ) -> None:
        """Act when a button is pressed, and show the outcome below it."""

        def tried() -> None:
            message.content = ""
            try:
                address = act()  # may rebuild the page without this panel
                if address:
                    message.content = render(
                        "panel/class_link.html", address=address, words=self._words
                    )
            except (ValueError, OSError) as error:
                message.content = refused(self._words.sentence(error))

        on_slow_press(button, tried)


def _required_text(
    gui: viser.GuiApi, label: str, hint: str, value: str = "", kind: str = "code"
) -> viser.GuiTextHandle:
    """Add a text field that is marked as required.

    Args:
        kind: "name"; "code", which no phone corrects; or "secret", one that is not shown.
    """
    gui.add_html(render("panel/field.html", kind=kind, required=True))
    return gui.add_text(label, value, hint=hint)
