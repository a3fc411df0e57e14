"""The teacher's choice of a route, and the button that opens it for all."""

from __future__ import annotations

import viser

from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.commands import TakeStep
from onpath.app.page.panels.widgets import note, on_press
from onpath.lessons.course import Course
from onpath.lessons.words import Words


class RouteSender:
    """A menu of routes, if there are any, and a button that sends the chosen one."""

    def __init__(
        self, gui: viser.GuiApi, words: Words, course: Course, classroom: Classroom
    ) -> None:
        self._words, self._course, self._class = words, course, classroom
        self._names = {
            route.text(route.title, words.language): name for name, route in course.routes.items()
        }
        if self._names:
            self._menu = gui.add_dropdown(words("route.route"), list(self._names))
            send = gui.add_button(words("route.send"), color="gray", icon=viser.Icon.SEND)
            self._message = gui.add_html("")
            on_press(send, self._send)

    def _send(self) -> None:
        name = self._names[self._menu.value]
        first = self._course.routes[name].stop[0]
        self._class.push(TakeStep(first.lesson, first.steps[0] - 1, name))
        message = self._words("class.sent", count=len(self._class.members()))
        self._message.content = note(message)
