"""What the teacher's page must know of the class, and what is chosen on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from onpath.app.classroom.classroom import Classroom
from onpath.app.simulation.simulation_thread import ScheduledLab
from onpath.lessons.words import Words


@dataclass(slots=True)
class TeacherChoices:
    """On one teacher's page; outlives its rebuilding.

    Attributes:
        lesson, step: whose prediction is shown.
        revealed: with the truth.
        followed: session code of the student whose lab is shown; empty for one's own.
    """

    lesson: str = ""
    step: int = 0
    revealed: bool = False
    followed: str = ""


@dataclass(frozen=True, slots=True)
class TeacherContext:
    """For one teacher's page.

    Attributes:
        lab: of a session code, here or mirrored; None when there is nothing to show.
        forget: delete all that is kept, and end the class; returns how many labs there were.
        stop: back to a lab's own page.
    """

    classroom: Classroom
    chosen: TeacherChoices
    lab: Callable[[str], ScheduledLab | None]
    forget: Callable[[], int]
    stop: Callable[[], None]

    def followed(self) -> ScheduledLab | None:
        """The lab that the teacher looks at, if the student is still in the class."""
        code = self.chosen.followed
        if not code or self.classroom.member(code) is None:
            return None
        return self.lab(code)

    def why_still(self, words: Words) -> str:
        """Why the lab that the teacher looks at is not there or stands still; empty if it runs."""
        member = self.classroom.member(self.chosen.followed)
        if member is None:
            return ""
        if not member.connected:
            return words("class.absent")
        lab = self.followed()
        if lab is None:
            return words("class.fetching")
        return "" if lab.is_seen else words("class.hidden")
