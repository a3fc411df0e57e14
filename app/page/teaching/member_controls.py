"""What a teacher can do with the student who is followed: rename, remove, delete."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.common.templates import render
from onpath.app.page.panels.widgets import note, on_press, put
from onpath.lessons.words import Words


class MemberControls:
    """A field with the nickname, and buttons; hidden while nobody is followed.

    Args:
        ask: runs an action after confirmation, given a title and a question.
        let_go: stops following, which may rebuild the page.
        look_again: updates the page.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        teaching: TeacherContext,
        ask: Callable[[str, str, Callable[[], None]], None],
        let_go: Callable[[], None],
        look_again: Callable[[], None],
    ) -> None:
        self._words, self._teaching = words, teaching
        self._class, self._chosen = teaching.classroom, teaching.chosen
        self._ask, self._let_go, self._look_again = ask, let_go, look_again
        icons = viser.Icon
        mark = gui.add_html(render("panel/field.html", kind="name", required=True))
        self._name = gui.add_text(words("class.nickname"), "", hint=words("class.rename_hint"))
        rename = gui.add_button(words("class.rename"), color="gray", icon=icons.PENCIL)
        remove = gui.add_button(words("class.remove"), color="gray", icon=icons.USER_X)
        delete = gui.add_button(words("class.delete"), color="red", icon=icons.USER_MINUS)
        self._message = gui.add_html("")
        self._handles = [mark, self._name, rename, remove, delete]
        self._filled = ""  # lab code of the student whose nickname has been put into the field
        on_press(rename, self._rename)
        on_press(remove, self._remove)
        on_press(delete, self._ask_to_delete)
        self.look()

    def look(self) -> None:
        """Show the controls of the student who is followed now."""
        code = self._chosen.followed
        member = self._class.member(code)
        if member is not None and code != self._filled:
            self._name.value = member.name
        self._filled = code if member is not None else ""
        for handle in self._handles:
            put(handle, visible=member is not None)
        put(self._message, content=note(self._chosen.message) if self._chosen.message else "")

    def _rename(self) -> None:
        try:
            self._class.rename(self._chosen.followed, self._name.value)
            self._filled = ""  # show the nickname as it is stored
            self._tell(self._words("class.renamed"))
        except ValueError as error:
            self._tell(self._words.sentence(error))

    def _remove(self) -> None:
        """Take the student out of the class; the lab goes on without it."""
        self._class.leave(self._chosen.followed)
        self._let_go()
        self._tell(self._words("class.removed"))

    def _ask_to_delete(self) -> None:
        code = self._chosen.followed
        member = self._class.member(code)
        if member is not None:
            question = self._words("class.delete_sure", name=member.name)
            self._ask(self._words("class.delete"), question, lambda: self._delete(code))

    def _delete(self, code: str) -> None:
        try:
            self._teaching.delete(code)
            message = self._words("class.deleted")
        except (OSError, ValueError) as error:
            message = self._words.sentence(error)
        else:
            self._chosen.numbered.clear()
            self._let_go()
        self._tell(message)

    def _tell(self, message: str) -> None:
        self._chosen.message = message
        self._look_again()
