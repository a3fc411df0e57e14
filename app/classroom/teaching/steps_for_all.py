"""The steps of a course in the order in which a class goes through them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from onpath.app.classroom.classroom import Display, Orders
from onpath.app.lab.commands import DemonstrateStep, TakeStep
from onpath.lessons.course import Course
from onpath.lessons.schema import Step


@dataclass(frozen=True, slots=True)
class StepsForAll:
    """Steps before and after one another, in the lessons, or on the route that was sent last.

    Steps that are meant for some answers only are passed over: students come to them by themselves.
    """

    course: Course
    language: str

    def shown(self, display: Display) -> tuple[str, int]:
        """Lesson and index of the displayed step, or of one that exists."""
        if not self.course.has(display.lesson):
            return next(iter(self.course.lessons)), 0
        return display.lesson, min(display.step, self._count(display.lesson) - 1)

    def beside(self, display: Display, orders: Orders, by: int) -> TakeStep | None:
        """The next step for all (`by` is 1) or the one before (-1); None if there is none.

        A lesson that is displayed and has not been sent begins with its first step. In a concept
        test everybody goes on by themselves.
        """
        sent = orders.step
        name, at = "" if sent is None else sent.route, self.shown(display)
        if by > 0 and at[1] == 0 and (sent is None or (sent.lesson, sent.step) != at):
            return TakeStep(*at, name)
        return None if at[0] in self.course.tests else self._after(at, name, by)

    def _after(self, at: tuple[str, int] | None, name: str, by: int) -> TakeStep | None:
        while at is not None:
            at = self._moved(at, name, by)
            if at is not None and not self._steps(at[0])[at[1]].when:
                return TakeStep(at[0], at[1], name)
        return None

    def demonstration(self, display: Display) -> DemonstrateStep | None:
        """The displayed step's demonstration, or that of the run after it; None if it has none."""
        lesson, index = self.shown(display)
        steps = self._steps(lesson)
        for at in range(index, min(index + 2, len(steps))):
            if steps[at].script is not None and (at == index or steps[at].kind == "run"):
                return DemonstrateStep(lesson, at)
        return None

    def _moved(self, at: tuple[str, int], route: str, by: int) -> tuple[str, int] | None:
        lesson, index = at
        if route in self.course.routes:
            found = self.course.routes[route].beside(lesson, index, by)
        else:
            found = lesson, index + by
        if found is None or found[1] in range(self._count(found[0])):
            return found
        lessons = list(self.course.lessons)
        if lesson not in lessons or lessons.index(lesson) + by not in range(len(lessons)):
            return None
        other = lessons[lessons.index(lesson) + by]
        return other, 0 if by > 0 else self._count(other) - 1

    def _steps(self, lesson: str) -> Sequence[Step]:
        return self.course.lesson(lesson, self.language).steps

    def _count(self, lesson: str) -> int:
        return len(self._steps(lesson))
