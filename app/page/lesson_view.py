"""A student's lessons as a page draws them: a snapshot's state, with the course's texts."""

from __future__ import annotations

from onpath.app.lab.page_snapshot import LessonState
from onpath.lessons.course import Course
from onpath.lessons.place import CoursePlace
from onpath.lessons.words import Words


class LessonView(CoursePlace):
    """A place in the course, and what the lab says of the open step.

    Attributes:
        version, playing, verdicts, truth: see `LessonState`.
    """

    def __init__(self, course: Course, words: Words, state: LessonState) -> None:
        super().__init__(course, state.progress, words)
        self.version, self.playing = state.version, state.playing
        self.verdicts, self.truth = state.verdicts, state.truth
