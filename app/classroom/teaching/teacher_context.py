"""The services and the selections of the teacher's page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from onpath.app.classroom.classroom import Classroom
from onpath.lessons.progress import Answer, Progress
from onpath.lessons.words import Words


@dataclass(slots=True)
class TeacherChoices:
    """Selections on one teacher's page, kept when the page is rebuilt; see also `Display`.

    Attributes:
        followed: lab code of the student whose lab is shown; empty for the teacher's own lab.
        message: the outcome of deleting a student.
        picked: numbers of the sketches to show; empty for all.
        numbered: sketches in order of arrival, by lesson, step and round; `picked` counts them.
    """

    followed: str = ""
    message: str = ""
    picked: tuple[int, ...] = ()
    numbered: dict[tuple[str, int, bool], list[Answer]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class TeacherContext:
    """The context of one teacher's page.

    Attributes:
        address: where students join the class.
        is_local: whether only this machine can open it.
        progress: the teacher's own progress through the lessons.
        presents: whether the teacher presents, with large type for a projector.
        why_still: why the displayed lab is missing or stopped; empty if it runs.
        send_setup: sends the set-up of the teacher's own lab to all students.
        delete: deletes the student of a lab code, with everything that is stored of them.
        forget: deletes the labs of all students of the class, and ends it; returns their number.
        stop: returns to the ordinary lab page.
    """

    classroom: Classroom
    chosen: TeacherChoices
    address: str
    is_local: bool
    progress: Callable[[], Progress]
    presents: Callable[[], bool]
    why_still: Callable[[Words], str]
    send_setup: Callable[[], None]
    delete: Callable[[str], None]
    forget: Callable[[], int]
    stop: Callable[[], None]
