"""The drawings in the scene that a lesson's step switches on when it is opened."""

from __future__ import annotations

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.overlays import Overlays
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.course import Course
from onpath.lessons.words import Words

StepKey = tuple[str, int]


class StepDrawings:
    """Switches drawings on and off with the steps; in between, the student may switch them.

    Args:
        overlays: the drawings.
        switched: names of the drawings that the last step switched on; kept while a page is
            rebuilt.
    """

    def __init__(
        self, overlays: Overlays, course: Course, words: Words, switched: set[str]
    ) -> None:
        self._overlays, self._course, self._words = overlays, course, words
        self._version, self._switched = -1, switched
        self._step: StepKey | None = None

    def follow(self, snapshot: PageSnapshot) -> None:
        """Draw what the open step asks for, if another step was open before."""
        if snapshot.lesson.version == self._version:
            return
        self._version = snapshot.lesson.version
        view = LessonView(self._course, self._words, snapshot.lesson)
        step = (view.progress.lesson, view.index) if view.lesson is not None else ("", -1)
        if step == self._step:
            return
        self._step, switches, wanted = step, self._overlays.switches, view.setup.show
        for name in self._switched.union(wanted):
            setattr(switches, name, name in wanted)
        self._switched.clear()
        self._switched.update(wanted)
        self._overlays.marks = view.setup.marks
