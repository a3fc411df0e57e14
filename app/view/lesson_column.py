"""What the page's data channel tells of the lessons: the open step, and what is measured in it."""

from __future__ import annotations

from onpath.app.channel.messages import encoded
from onpath.app.common.background import Submit
from onpath.app.lab.snapshots.page_snapshot import LessonSnapshot
from onpath.app.view.lesson_message import lesson_message, measured
from onpath.app.view.lesson_view import LessonView
from onpath.lessons.course import Course
from onpath.lessons.words import Words
from onpath.models.systems.robots import Robot

EVERY = 3  # snapshots between two messages while a demonstration draws its curves


class LessonColumn:
    """Makes the messages when the lessons have changed.

    Args:
        student: code of the lab; decides the order of options, see `option_order`.
        submit: runs a function in another thread.

    Attributes:
        message: the open step, as JSON; empty until it has been made.
        measured: verdicts and curves, as JSON.
    """

    def __init__(self, course: Course, words: Words, student: str, submit: Submit) -> None:
        self._course, self._words, self._student = course, words, student
        self._submit = submit
        self._made_for = -1, "", False  # version of the lessons, robot, whether it is presented
        self.message = self.measured = b""
        self._turn = 0

    def lacks(self, version: int, robot: Robot, presenting: bool) -> bool:
        """Whether no message is being made for these; see `LessonSnapshot`."""
        return self._made_for != (version, robot.name, presenting)

    def make(self, shown: LessonSnapshot, robot: Robot) -> None:
        """Make the message of the open step."""
        self._made_for = shown.version, robot.name, shown.presenting
        run = self._view(shown)
        self._submit(lambda: self._tell(run, robot))

    def measure(self, shown: LessonSnapshot) -> None:
        """Make the message of what is measured."""
        run = self._view(shown)
        self._turn += 1
        if run.lesson is not None and not (run.playing and self._turn % EVERY):
            self.measured = encoded(measured(run))

    def _view(self, shown: LessonSnapshot) -> LessonView:
        return LessonView(self._course, self._words, shown, self._student)

    def _tell(self, run: LessonView, robot: Robot) -> None:
        self.message = encoded(lesson_message(run, robot))
