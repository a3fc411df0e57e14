"""The drawings and marks that a lesson's step asks for when it is opened."""

from __future__ import annotations

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.view.lesson_view import NO_SETUP, LessonView
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.course import Course
from onpath.lessons.words import Words


class StepDrawings:
    """Switches drawings on and off with the steps; in between, the student may switch them.

    Args:
        switches: names of the drawings that are switched on.

    Attributes:
        setup: of the open step.
    """

    def __init__(self, switches: set[str], course: Course) -> None:
        self._switches, self._course = switches, course
        self._version, self._step = -1, ("", -1)
        self._switched = frozenset[str]()  # by the last step
        self.setup: StepSetup = NO_SETUP

    def follow(self, snapshot: PageSnapshot) -> None:
        """Draw what the open step asks for, if another step was open before."""
        if snapshot.lesson.version == self._version:
            return
        self._version = snapshot.lesson.version
        view = LessonView(self._course, Words(snapshot.key.language), snapshot.lesson)
        step = ("", -1) if view.lesson is None else (view.progress.lesson, view.index)
        if step == self._step:
            return
        self._step, self.setup = step, view.setup
        self._switches -= self._switched
        self._switched = frozenset(view.setup.show)
        self._switches |= self._switched
