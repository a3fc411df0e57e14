"""Where a student stands in the lessons: the open step, what was predicted, what is passed.

It knows no lab: `app.lab.lesson_run` plays the steps on one.
"""

from __future__ import annotations

from typing import Any

from msgspec.structs import replace

from onpath.lessons.course import Course
from onpath.lessons.progress import Answer, Notes, Progress
from onpath.lessons.schema import Lesson, Prediction, Quiz, Step
from onpath.lessons.words import Words
from onpath.models.errors import CodedError


class LessonState:
    """The lessons as one student goes through them.

    Attributes:
        course: all lessons there are.
        progress: what is kept.
        words: of the student's language.
        version: changes whenever the page must be drawn anew.
    """

    def __init__(
        self, course: Course, progress: Progress | None = None, words: Words | None = None
    ) -> None:
        self.course = course
        self.progress = progress or Progress()
        self.words = words or Words(self.progress.language)
        self.version = 0

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

    @property
    def locked(self) -> str:
        """Why time must not run: a prediction is to be made first. Empty when it may."""
        return self.words("lesson.locked") if self.waits else ""

    def has_played(self) -> bool:
        """Whether the lab has done what the open step shows, now or earlier."""
        return str(self.index) in self.notes.played

    def hint(self, task: str) -> None:
        """One hint more."""
        shown = self.notes.hints.get(task, 0) + 1
        self.note(hints={**self.notes.hints, task: shown})

    def answer_quiz(self, block: int, option: int) -> None:
        """Choose an option of the quiz that is the open step's block.

        Raises:
            ValueError: there is no such quiz or option.
        """
        step = self.step
        quiz = step.blocks[block] if step and block in range(len(step.blocks)) else None
        if not isinstance(quiz, Quiz) or option not in range(len(quiz.options)):
            raise CodedError("lesson.no_such_option")
        self.note(quiz={**self.notes.quiz, f"{self.index}.{block}": option})

    def set_language(self, language: str) -> None:
        """Of texts and interface."""
        self.words = Words(language)
        self.progress = replace(self.progress, language=self.words.language)
        self.version += 1

    def set_presenting(self, on: bool) -> None:
        """Large type, or not."""
        self.progress = replace(self.progress, presenting=on)
        self.version += 1

    def note_answer(self, answer: Answer) -> None:
        """Keep the answer to the open step's prediction."""
        found = self.prediction()
        assert found is not None
        self.note(answers={**self.notes.answers, found[0]: answer})

    def note(self, **changes: Any) -> None:
        """Change what is kept of the open lesson."""
        notes = {**self.progress.notes, self.progress.lesson: replace(self.notes, **changes)}
        self.progress = replace(self.progress, notes=notes)
        self.version += 1
