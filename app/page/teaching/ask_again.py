"""Peer instruction: the class answers, discusses, and answers again."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.classroom.results import prediction_at
from onpath.app.lab.commands import TakeStep
from onpath.app.page.panels.widgets import note, on_press, on_user_update
from onpath.app.page.teacher_context import TeacherContext
from onpath.lessons.course import Course
from onpath.lessons.words import Words


class AskAgain:
    """A switch that shows or hides the answers, and a button that asks for second ones.

    Asking again hides the answers, so that nobody follows the majority during the discussion.

    Args:
        look_again: updates the answers on the page.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        course: Course,
        teaching: TeacherContext,
        look_again: Callable[[], None],
    ) -> None:
        self._words, self._course, self._teaching = words, course, teaching
        self._look_again = look_again
        again = gui.add_button(words("class.ask_again"), color="gray", icon=viser.Icon.REPEAT)
        self._message = gui.add_html("")
        self._shown = gui.add_checkbox(words("class.show_answers"), teaching.chosen.shown)
        on_press(again, self._ask)
        on_user_update(self._shown, self._show)

    def _show(self, on: bool) -> None:
        self._teaching.chosen.shown = on
        self._look_again()

    def _ask(self) -> None:
        words, chosen, classroom = self._words, self._teaching.chosen, self._teaching.classroom
        lesson = self._course.lesson(chosen.lesson, words.language)
        found = prediction_at(lesson, min(chosen.step, len(lesson.steps) - 1))
        if found is None:
            self._message.content = note(words("class.no_prediction"))
            return
        classroom.push(TakeStep(chosen.lesson, found[0], again=True))
        self._shown.value = False
        self._show(False)
        self._message.content = note(words("class.sent", count=len(classroom.members())))
