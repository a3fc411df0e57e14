"""The services and the selections of the teacher's page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.commands import TakeStep
from onpath.lessons.given import Answer
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress
from onpath.lessons.words import Words


@dataclass(slots=True)
class TeacherChoices:
    """Selections on one teacher's page, kept when the page is rebuilt; see also `Display`.

    Attributes:
        followed: lab code of the student whose lab is shown; empty for the teacher's own lab.
        message: the outcome of deleting a student.
        picked: numbers of the sketches to show; empty for all.
        numbered: sketches in order of arrival, by lesson, step and round; `picked` counts them.
        pace: the steps that are chosen, whether or not the class is kept within them; None before.
        pair: which of `PAIRS` of gains are the axes.
        route: the route that is chosen; empty for the first one.
        setup: the share code that was sent last.
        peeks: whether the answers are shown here before they are on the wall.
        told: the outcome of the last order.
        refused: why the last value of a field was refused, by field.
    """

    followed: str = ""
    message: str = ""
    picked: tuple[int, ...] = ()
    numbered: dict[tuple[str, int, bool], list[Answer]] = field(default_factory=dict)
    pace: Pace | None = None
    pair: int = 0
    route: str = ""
    setup: str = ""
    peeks: bool = False
    told: str = ""
    refused: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class TeacherContext:
    """The context of one teacher's page.

    Attributes:
        may_lead: whether the page is still a teacher's.
        address: where students join the class.
        is_local: whether only this machine can open it.
        progress: the teacher's own progress through the lessons.
        has_lab: whether the page shows a lab: the teacher's own, or that of a student.
        presents: whether the teacher presents, with large type for a projector.
        why_still: why the displayed lab is missing or stopped; empty if it runs.
        prepare: prepares a step that the class may be taken to.
        send_setup: sends the set-up of the teacher's own lab to all students.
        delete: deletes the student of a lab code, with everything that is stored of them.
        give_place: gives a student, by lab code, the former place that the student claims.
        forget: deletes the labs of all students of the class, and ends it; returns their number.
        stop: returns to the ordinary lab page.
    """

    classroom: Classroom
    chosen: TeacherChoices
    may_lead: Callable[[], bool]
    address: str
    is_local: bool
    has_lab: bool
    progress: Callable[[], Progress]
    presents: Callable[[], bool]
    why_still: Callable[[Words], str]
    prepare: Callable[[TakeStep], None]
    send_setup: Callable[[], None]
    delete: Callable[[str], None]
    give_place: Callable[[str], None]
    forget: Callable[[], int]
    stop: Callable[[], None]

    def pace(self, displayed: str) -> Pace:
        """The steps that are chosen, else those within which the class is kept.

        Args:
            displayed: the lesson whose first step is chosen if there are neither.
        """
        return self.chosen.pace or self.classroom.orders.pace or Pace(displayed, 0, 0)
