"""The teacher's tab: the class on the left, one's own lab or a student's in the scene."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.classroom.mirror import Mirror
from onpath.app.lab import commands as c
from onpath.app.lab.commands import CloseLesson
from onpath.app.lab.lab import Lab
from onpath.app.page.page import Page
from onpath.app.page.page_context import PageContext
from onpath.app.page.panels.teacher_controls import FollowedStudent, TeacherControls
from onpath.app.page.panels.teacher_panel import TeacherPanel
from onpath.app.page.teacher_context import TeacherContext


class TeacherView(Page):
    """What a teacher sees; a followed lab is shown and not touched."""

    def __init__(
        self,
        client: viser.ClientHandle,
        lab: Lab,
        desk: PageContext,
        teaching: TeacherContext,
    ) -> None:
        self._own, self._teaching = lab, teaching
        lab.post(CloseLesson())
        super().__init__(client, lab, desk)

    def show(self, lab: Lab, achieved: float, frame: int, stride: float) -> None:
        """See `app.simulation.simulation_thread.Display`."""
        followed = self._teaching.followed()
        if followed is None:
            super().show(lab, achieved, frame, stride)
        else:
            if isinstance(followed, Mirror):
                followed.keep_up()
            super().show(followed.lab, followed.achieved, frame, stride)

    def _page(self, lab: Lab) -> tuple[object, ...]:
        words = self._own.words
        return id(lab), lab.session.robot, words.language

    def _poster(self, lab: Lab) -> Callable[[c.Command], None]:
        return lab.post if lab is self._own else _ignore

    def _build_panels(self, lab: Lab, post: Callable[[c.Command], None]) -> None:
        gui, own = self._client.gui, self._own
        self._parts = []
        if lab is own:
            self._parts.append(TeacherControls(gui, own, self._teaching))
            self._build_numbers(lab)
            self._build_distance(lab)
            self._parts += self._controls(own, post).everything()
        else:
            self._parts.append(FollowedStudent(gui, own, self._teaching))
            self._build_numbers(lab)
            self._build_distance(lab)
        submit = self._exporter.submit
        self._parts.append(TeacherPanel(self._client, own, self._teaching, submit))


def _ignore(_: c.Command) -> None:
    """Nobody's hands but the student's."""
