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
    """A folder to join the class.

    At the address of a class it asks for a nickname, and shows it once the student has joined.
    Elsewhere it asks for the class code, and leads to the address.
    """

    def __init__(
        self, gui: viser.GuiApi, words: Words, context: PageContext, first: PageSnapshot
    ) -> None:
        self._words, seat = words, context.seat
        assert seat is not None
        with gui.add_folder(words("class.title"), expand_by_default=not first.nickname):
            self._member = gui.add_html("")
            if seat.code:
                told = render(
                    "panel/stored.html",
                    days=context.keep_days,
                    url=context.privacy_url,
                    words=words,
                )
                before = [gui.add_html(told)]
                hint = words("class.nickname_hint")
                typed = _required_text(gui, words("class.nickname"), hint, kind="name")
                join = lambda: seat.join(seat.code, typed.value)  # noqa: E731
            else:
                before = []
                typed = _required_text(gui, words("class.code"), words("class.code_hint"))
                join = lambda: seat.join(typed.value, "")  # noqa: E731
            button = gui.add_button(words("class.join"), icon=viser.Icon.LOGIN)
            self._leave = gui.add_button(words("class.leave"), color="gray", icon=viser.Icon.LOGOUT)
            message = gui.add_html("")
            with gui.add_folder(words("class.teacher"), expand_by_default=False):
                hint = words("class.key_hint")
                key = _required_text(gui, words("class.key"), hint, kind="secret")
                teach = gui.add_button(words("class.teach"), color="gray", icon=viser.Icon.KEY)
                teach_message = gui.add_html("")
        self._joining = [*before, typed, button]
        self._try(button, join, message)
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
        for handle in self._joining:
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
    gui: viser.GuiApi, label: str, hint: str, kind: str = "code"
) -> viser.GuiTextHandle:
    """Add a text field that is marked as required.

    Args:
        kind: "name"; "code", which no phone corrects; or "secret", one that is not shown.
    """
    gui.add_html(render("panel/field.html", kind=kind, required=True))
    return gui.add_text(label, "", hint=hint)
