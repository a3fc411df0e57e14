"""View of a student's lessons: the state of a snapshot combined with the course's texts."""

from __future__ import annotations

from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.snapshots.page_snapshot import LessonSnapshot
from onpath.lessons.course import Course
from onpath.lessons.schema import StepSetup
from onpath.lessons.words import Words

NO_SETUP = StepSetup()


class LessonView(LessonState):
    """A student's position in the lessons and the lab's results for the open step.

    Attributes:
        playing, verdicts, truth: see `LessonSnapshot`.
    """

    def __init__(self, course: Course, words: Words, shown: LessonSnapshot) -> None:
        super().__init__(course, shown.progress, words)
        self.version, self.playing = shown.version, shown.playing
        self.verdicts, self.truth = shown.verdicts, shown.truth

    @property
    def laws_shown(self) -> dict[str, str]:
        """Control laws under which the open step's prediction is put to the test."""
        lesson, found = self.lesson, self.prediction()
        return {} if lesson is None or found is None else lesson.laws_shown(int(found[0]))

    @property
    def setup(self) -> StepSetup:
        """Set-up of the open step."""
        lesson = self.lesson
        return NO_SETUP if lesson is None else lesson.scene_at(self.index)
