"""The services that a page needs from the server: the course, the class and limits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from onpath.app.channel.plant_messages import DrivePlant
from onpath.app.classroom.teaching.teacher_context import TeacherContext
from onpath.app.common.presses import Presses
from onpath.app.scene.client_scene import Look
from onpath.app.server.page_text import PageText
from onpath.app.view.sheets import NOTHING_TOLD, OwnPlace
from onpath.lessons.course import Course


@dataclass(frozen=True, slots=True)
class ClassSeat:
    """A lab's place in the class.

    Attributes:
        join: joins with the class code and a nickname; raises ValueError with a message. Returns
            the address of the class if its page is elsewhere, where a nickname is asked for.
        leave: leaves the class but stays in the lab.
        teach: opens the teacher's page, given the key; see `join`.
        away: the nickname of somebody away who may be the same student, else "", and whether the
            teacher has been asked for that place.
        ask_place: asks the teacher for it.
        forget: deletes the lab with everything that is stored of the student; raises ValueError or
            OSError with a message.
        identify: notes what identifies the student elsewhere.
        link: notes a word of the student's own; raises ValueError with a message.
        own: what the student has told of oneself.
        days: for how many days without a change the class is kept; 0 if it is not stored.
        code: the class code, if the page's address has it; else a student types it.
    """

    join: Callable[[str, str], str]
    leave: Callable[[], None]
    teach: Callable[[str], str]
    away: Callable[[], tuple[str, bool]] = lambda: ("", False)
    ask_place: Callable[[], None] = lambda: None
    forget: Callable[[], None] = lambda: None
    identify: Callable[[str], None] = lambda _: None
    link: Callable[[str], None] = lambda _: None
    own: Callable[[], OwnPlace] = lambda: NOTHING_TOLD
    days: Callable[[], int] = int
    code: str = ""


@dataclass(frozen=True, slots=True)
class PageContext:
    """The context of one client's page.

    Attributes:
        code: code of its lab; empty if nobody is to come back to it.
        course: all lessons.
        keep_days: number of days without use after which the lab is deleted; 0 if it lasts only
            as long as the server.
        enter: opens the lab of a code; raises ValueError with a message.
        choose_tip: gives the lab a robot from a file with another tip; raises ValueError.
        remark: shows a text as the lab's message.
        seat: the lab's place in the class, or None without a class.
        look: how the scene is to be drawn.
        privacy_url: the address of the site's privacy notice; empty if it has none.
        presses: limit what the tab asks for that takes long.
        teaching: of a teacher's page.
        text: what the page says.
        switches: names of what is drawn besides the robots; see `Overlays`.
        drive: of the page that drives a plant, or None.
    """

    code: str
    course: Course
    keep_days: int
    enter: Callable[[str], None]
    text: PageText
    choose_tip: Callable[[str, str], None]
    remark: Callable[[str], None]
    seat: ClassSeat | None = None
    look: Look = field(default_factory=Look)
    privacy_url: str = ""
    presses: Presses = field(default_factory=Presses)
    teaching: TeacherContext | None = None
    switches: set[str] = field(default_factory=set)
    drive: Callable[[DrivePlant], None] | None = None
