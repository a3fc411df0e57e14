"""The choice of the class's sketches to show, by numbers that do not reveal who drew them."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.classroom.teaching.class_answers import picked
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.page.panels.widgets import on_user_update
from onpath.lessons.words import Words


class SketchChoice:
    """A field for the numbers of some sketches; empty for all."""

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        chosen: TeacherChoices,
        look_again: Callable[[], None],
    ) -> None:
        self._chosen, self._look_again = chosen, look_again
        typed = ", ".join(map(str, chosen.picked))
        self._box = gui.add_text(words("class.picked"), typed, hint=words("class.picked_hint"))
        on_user_update(self._box, self._choose)

    def clear(self) -> None:
        """Show all sketches again, since another step has other ones."""
        self._chosen.picked = ()
        if self._box.value:
            self._box.value = ""

    def _choose(self, typed: str) -> None:
        self._chosen.picked = picked(typed)
        self._look_again()
