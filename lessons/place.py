"""Where a student is in the course: what follows from the lessons and from what is kept."""

from __future__ import annotations

from onpath.lessons.course import Course
from onpath.lessons.progress import Answer, Notes, Progress
from onpath.lessons.schema import Lesson, Prediction, Step, StepSetup
from onpath.lessons.words import Words

NO_SETUP = StepSetup()


class CoursePlace:
    """A student's place in the course.

    Attributes:
        course: all lessons there are.
        progress: what is kept.
        words: of the student's language.
    """

    def __init__(self, course: Course, progress: Progress, words: Words) -> None:
        self.course, self.progress, self.words = course, progress, words

    @property
    def lesson(self) -> Lesson | None:
        """The open one."""
        name = self.progress.lesson
        if name not in self.course.lessons:
            return None
        return self.course.lesson(name, self.progress.language)

    @property
    def notes(self) -> Notes:
        """On the open lesson."""
        return self.progress.notes.get(self.progress.lesson, Notes())

    @property
    def index(self) -> int:
        """Of the open step."""
        return self.left_at(self.progress.lesson)

    def left_at(self, name: str) -> int:
        """The step of a lesson that was last open; 0 if there is no such lesson."""
        if name not in self.course.lessons:
            return 0
        last = len(self.course.lesson(name, self.progress.language).steps) - 1
        return min(self.progress.notes.get(name, Notes()).step, last)

    @property
    def step(self) -> Step | None:
        """The open one."""
        lesson = self.lesson
        return lesson.steps[self.index] if lesson else None

    @property
    def setup(self) -> StepSetup:
        """Of the open step."""
        lesson = self.lesson
        return NO_SETUP if lesson is None else lesson.scene_at(self.index)

    def prediction(self) -> tuple[str, Prediction] | None:
        """The one that belongs to the open step, here or in the step before, and its key."""
        lesson = self.lesson
        if lesson is None:
            return None
        for index in (self.index, self.index - 1):
            step = lesson.steps[index] if index >= 0 else None
            if step is not None and (step is self.step or self.step_is("run")):
                for prediction in step.predictions():
                    return str(index), prediction
        return None

    def step_is(self, kind: str) -> bool:
        """Whether the open step is of a kind."""
        return self.step is not None and self.step.kind == kind

    def answer(self) -> Answer | None:
        """To the open step's prediction; None while there is none."""
        found = self.prediction()
        return None if found is None else self.notes.answers.get(found[0])

    @property
    def waits(self) -> bool:
        """Whether a prediction is still to be made, or skipped."""
        return self.prediction() is not None and self.answer() is None

    def has_played(self) -> bool:
        """Whether the lab has done what the open step shows, now or earlier."""
        return str(self.index) in self.notes.played
