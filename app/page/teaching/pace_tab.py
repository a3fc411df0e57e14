"""Tab of the teacher's page: where everybody is, and within which steps the class may go."""

from __future__ import annotations

import viser

from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.pace_html import pace_view
from onpath.app.classroom.teaching.lesson_labels import lesson_titles, step_titles
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.page.panels.widgets import note, on_press, on_user_update, put
from onpath.lessons.course import Course
from onpath.lessons.pace import Pace
from onpath.lessons.words import Words


class PaceTab:
    """A lesson, a first and a last step, and for each step a bar of the students who are there."""

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        course: Course,
        classroom: Classroom,
    ) -> None:
        self._words, self._course, self._class = words, course, classroom
        pace, self._names = self._class.orders.pace, lesson_titles(course, words)
        titles = {name: title for title, name in self._names.items()}
        shown, _ = StepsForAll(course, words.language).shown(classroom.display)
        self._lesson = pace.lesson if pace else shown
        steps = self._steps()
        menu = gui.add_dropdown(
            words("class.lesson"), list(self._names), initial_value=titles[self._lesson]
        )
        first, last = (pace.first, pace.last) if pace else (0, 0)
        self._first = gui.add_dropdown(words("pace.first"), steps, initial_value=steps[first])
        self._last = gui.add_dropdown(words("pace.last"), steps, initial_value=steps[last])
        keep = gui.add_button(words("pace.keep"), icon=viser.Icon.ARROWS_HORIZONTAL)
        self._end = gui.add_button(words("pace.end"), color="gray", icon=viser.Icon.LOCK_OPEN)
        self._message = gui.add_html("")
        self._shown = gui.add_html("")
        on_user_update(menu, self._choose)
        on_press(keep, self._keep)
        on_press(self._end, self._let_go)

    def look(self, large: bool) -> None:
        """Show where everybody is now."""
        pace, words = self._class.orders.pace, self._words
        lesson = self._course.lesson(self._lesson, words.language)
        students = [member.progress for member in self._class.members().values()]
        view = pace_view(lesson, students, pace, words, large)
        put(self._shown, content=view)
        message = note(words("pace.none"))
        if pace is not None:
            titles = {name: title for title, name in self._names.items()}
            message = note(
                words(
                    "pace.kept",
                    lesson=titles[pace.lesson],
                    first=pace.first + 1,
                    last=pace.last + 1,
                )
            )
        put(self._message, content=message)
        put(self._end, visible=pace is not None)

    def _steps(self) -> list[str]:
        return step_titles(self._course.lesson(self._lesson, self._words.language), self._words)

    def _choose(self, title: str) -> None:
        self._lesson = self._names[title]
        steps = self._steps()
        for menu in (self._first, self._last):
            menu.options = steps
            menu.value = steps[0]

    def _keep(self) -> None:
        steps = self._steps()
        first, last = sorted(steps.index(menu.value) for menu in (self._first, self._last))
        self._class.keep_within(Pace(self._lesson, first, last))

    def _let_go(self) -> None:
        self._class.keep_within(None)
