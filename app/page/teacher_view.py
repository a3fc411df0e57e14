"""The teacher's tab: the class on the left, one's own lab or a student's in the scene."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.classroom.mirror import Mirror
from onpath.app.lab import commands as c
from onpath.app.lab.lesson_commands import CloseLesson
from onpath.app.lab.session import Session
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
        session: Session,
        desk: PageContext,
        teaching: TeacherContext,
    ) -> None:
        self._own, self._teaching = session, teaching
        session.post(CloseLesson())
        super().__init__(client, session, desk)

    def show(self, session: Session, achieved: float, frame: int, stride: float) -> None:
        """See `app.simulation.simulation_thread.Display`."""
        lab = self._teaching.followed()
        if lab is None:
            super().show(session, achieved, frame, stride)
        else:
            if isinstance(lab, Mirror):
                lab.keep_up()
            super().show(lab.session, lab.achieved, frame, stride)

    def _page(self, session: Session) -> tuple[object, ...]:
        words = self._own.lessons.words
        return id(session), session.robot, words.language

    def _poster(self, session: Session) -> Callable[[c.Command], None]:
        return session.post if session is self._own else _ignore

    def _build_panels(self, session: Session, post: Callable[[c.Command], None]) -> None:
        gui, own = self._client.gui, self._own
        self._parts = []
        if session is own:
            self._parts.append(TeacherControls(gui, own, self._teaching))
            self._build_numbers(session)
            self._build_distance(session)
            self._parts += self._controls(own, post).everything()
        else:
            self._parts.append(FollowedStudent(gui, own, self._teaching))
            self._build_numbers(session)
            self._build_distance(session)
        submit = self._rebuilds.submit
        self._parts.append(TeacherPanel(self._client, own, self._teaching, submit))


def _ignore(_: c.Command) -> None:
    """Nobody's hands but the student's."""
