"""What the teacher's page must know of the class, and what is chosen on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from onpath.app.classroom.classroom import Classroom
from onpath.lessons.progress import Progress
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
        progress: the teacher's own way through the lessons.
        why_still: why the lab that the teacher looks at is not there or stands still; empty if it
            runs.
        send_setup: send the set-up of the teacher's own lab to all.
        forget: delete all that is kept, and end the class; returns how many labs there were.
        stop: back to a lab's own page.
    """

    classroom: Classroom
    chosen: TeacherChoices
    progress: Callable[[], Progress]
    why_still: Callable[[Words], str]
    send_setup: Callable[[], None]
    forget: Callable[[], int]
    stop: Callable[[], None]
