"""Tab of the teacher's page: a diagram of everyone's gains."""

from __future__ import annotations

import viser

from onpath.app.classroom.gains_html import PAIRS, gains_view
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.page.panels.widgets import add_menu, put
from onpath.lessons.words import Words


class GainsTab:
    """A choice of two gains, and a point for each student."""

    def __init__(self, gui: viser.GuiApi, words: Words, teaching: TeacherContext) -> None:
        self._words, self._class, self._pair = words, teaching.classroom, PAIRS[0]
        pairs = {words("gains.pair", across=x, up=y): (x, y) for x, y in PAIRS}
        add_menu(gui, words("gains.axes"), pairs, self._choose)
        self._shown = gui.add_html("")

    def look(self, large: bool) -> None:
        """Show everyone's gains as they are now."""
        gains = [member.gains for member in self._class.members().values()]
        put(self._shown, content=gains_view(self._pair, gains, self._words, large))

    def _choose(self, pair: tuple[str, str]) -> None:
        self._pair = pair
