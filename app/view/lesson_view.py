"""View of a student's lessons: the state in a snapshot combined with the course's texts."""

from __future__ import annotations

from onpath.app.common.templates import Markup
from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.snapshots.page_snapshot import LessonSnapshot
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.adaptive.branches import is_shown, question_before
from onpath.lessons.adaptive.own_numbers import filled
from onpath.lessons.course import Course
from onpath.lessons.option_order import option_order
from onpath.lessons.schema import Choice, Quiz, Text
from onpath.lessons.words import Words

NO_SETUP = StepSetup()


class LessonView(LessonState):
    """A student's position in the lessons and the lab's results for the open step.

    Args:
        student: code of the lab; decides the order of options.

    Attributes:
        playing, verdicts, truth, pace, votes, presenting: see `LessonSnapshot`.
    """

    def __init__(
        self, course: Course, words: Words, shown: LessonSnapshot, student: str = ""
    ) -> None:
        super().__init__(course, shown.progress, words)
        self._student = student
        self.version, self.playing = shown.version, shown.playing
        self.verdicts, self.truth = shown.verdicts, shown.truth
        self.pace, self.votes, self.presenting = shown.pace, shown.votes, shown.presenting

    @property
    def setup(self) -> StepSetup:
        """Set-up of the open step."""
        lesson = self.lesson
        return NO_SETUP if lesson is None else lesson.setup_at(self.index)

    def text(self, block_index: int, block: Text) -> Markup | None:
        """A text of the open step with the student's numbers; None if it belongs to other answers.

        Args:
            block_index: index among the step's blocks.
        """
        lesson = self.lesson
        if lesson is None or not is_shown(
            block.when, lesson.steps, self.notes, self.index, block_index
        ):
            return None
        asked = question_before(lesson.steps, self.index, block_index)
        if block.when and asked is not None and self.is_voted_on(asked[0]):
            return None
        return filled(block.html, lesson.steps, self.index, self.notes, self.words)

    def order(self, block: Choice | Quiz, key: str = "") -> tuple[int, ...]:
        """The order in which the options of a question are shown; see `option_order`.

        In a presentation, where a whole class reads the same page, it is the author's.

        Args:
            key: of a quiz in the notes; empty for the open step's prediction.
        """
        if not key:
            found = self.prediction()
            key = "" if found is None else found[0]
        student = "" if self.presenting else self._student
        return option_order(len(block.options), f"{self.progress.lesson} {key}", student)
