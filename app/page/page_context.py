"""What a page must know of the server: its session's code, how to go to another's, the class."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ClassSeat:
    """A lab's place in the class.

    Attributes:
        name: the nickname; empty while the student has not joined.
        join: with the class code and a nickname; raises ValueError with words.
        leave: the class, not the lab.
        teach: open the teacher's page, with the key; raises ValueError with words.
    """

    name: Callable[[], str]
    join: Callable[[str, str], object]
    leave: Callable[[], None]
    teach: Callable[[str], None]


@dataclass(frozen=True, slots=True)
class PageContext:
    """For one client.

    Attributes:
        code: of its session.
        keeps: whether labs outlive the server.
        enter: go to the session of a code; raises ValueError with words.
        seat: in the class, or None where there is no class.
    """

    code: str
    keeps: bool
    enter: Callable[[str], None]
    seat: ClassSeat | None = None
