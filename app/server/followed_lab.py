"""The student's lab that a teacher follows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from onpath.app.classroom.classroom import Classroom
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.simulation.scheduled_lab import ScheduledLab
from onpath.lessons.words import Words


class Followed(Protocol):
    """Another lab than its own that a page shows."""

    def find(self) -> tuple[ScheduledLab, int] | None:
        """The lab, and the number of its student, see `PageKey`; None: the page shows its own."""
        ...


@dataclass(frozen=True, slots=True)
class FollowedLab:
    """The lab chosen on one teacher's page.

    Attributes:
        lab: finds a lab by its code; returns None if there is none.
    """

    classroom: Classroom
    chosen: TeacherChoices
    lab: Callable[[str], ScheduledLab | None]

    def find(self) -> tuple[ScheduledLab, int] | None:
        """The lab and its student's number, if the student is still in the class."""
        code = self.chosen.followed
        member = self.classroom.member(code) if code else None
        lab = None if member is None else self.lab(code)
        return None if member is None or lab is None else (lab, member.number)

    def why_still(self, words: Words) -> str:
        """Why the lab is missing or stopped; empty if it runs."""
        member = self.classroom.member(self.chosen.followed)
        if member is None:
            return ""
        if not member.connected:
            return words("class.absent")
        found = self.find()
        if found is None:
            return words("class.absent")
        return "" if found[0].is_seen else words("class.hidden")
