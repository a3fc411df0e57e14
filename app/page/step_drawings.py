"""What a lesson's step draws in the scene: it switches it on when the step is opened."""

from __future__ import annotations

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.lesson_view import LessonView
from onpath.app.page.overlays import Overlays
from onpath.lessons.course import Course
from onpath.lessons.words import Words

Place = tuple[str, int]


class StepDrawings:
    """Switches drawings on and off with the steps; in between the student may switch them.

    Args:
        overlays: what is switched.
    """

    def __init__(self, overlays: Overlays, course: Course, words: Words) -> None:
        self._overlays, self._course, self._words = overlays, course, words
        self._version = -1
        self._place: Place | None = None  # a page built anew switches off what a step left on

    def follow(self, snapshot: PageSnapshot) -> None:
        """Draw what the open step asks for, if another step was open before."""
        if snapshot.lesson.version == self._version:
            return
        self._version = snapshot.lesson.version
        view = LessonView(self._course, self._words, snapshot.lesson)
        place = (view.progress.lesson, view.index) if view.lesson is not None else ("", -1)
        if place == self._place:
            return
        self._place, switches, wanted = place, self._overlays.switches, view.setup.show
        for name in {*switches.of_step, *wanted}:
            setattr(switches, name, name in wanted)
        switches.of_step, self._overlays.marks = wanted, view.setup.marks
