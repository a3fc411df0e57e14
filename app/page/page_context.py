"""What a page must know of the server: how to ask its lab for something, the course, the class."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from onpath.app.page.panels.widgets import Post
from onpath.lessons.course import Course


@dataclass(frozen=True, slots=True)
class ClassSeat:
    """A lab's place in the class.

    Attributes:
        join: with the class code and a nickname; raises ValueError with words.
        leave: the class, not the lab.
        teach: open the teacher's page, with the key; raises ValueError with words.
    """

    join: Callable[[str, str], object]
    leave: Callable[[], None]
    teach: Callable[[str], None]


@dataclass(frozen=True, slots=True)
class PageContext:
    """For one client.

    Attributes:
        code: of its lab.
        post: takes the commands for its lab.
        course: all lessons there are.
        keeps: whether labs outlive the server.
        enter: go to the lab of a code; raises ValueError with words.
        seat: in the class, or None where there is no class.
    """

    code: str
    post: Post
    course: Course
    keeps: bool
    enter: Callable[[str], None]
    seat: ClassSeat | None = None
