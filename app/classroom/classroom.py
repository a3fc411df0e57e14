"""A class as pages and labs see it: records of it, and what can be asked of one that is somewhere.

`app.classroom.local_classroom` has it in one process, `app.classroom.shared_classroom` in several.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from onpath.app.classroom.admission import cleaned, not_among
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.lessons.progress import Progress

MOST_MEMBERS = 300
Push = TakeSetup | TakeStep
NOTHING_DONE = Progress()


@dataclass(frozen=True, slots=True)
class Member:
    """A student as the class knows it.

    Attributes:
        number: counts up as students join; unlike the session's code it may be shown.
        name: the nickname; may hold any printable characters, so it must be escaped.
        progress: the way through the lessons when last looked at.
        connected: whether somebody looks at the lab.
        active: when something was last done in the lab, by the class's clock, [s].
        taken: number of the last push that the lab has taken; 0 for none.
    """

    number: int
    name: str
    progress: Progress = NOTHING_DONE
    connected: bool = True
    active: float = 0.0
    taken: int = 0


@dataclass(frozen=True, slots=True)
class Orders:
    """What the teacher wants now.

    Attributes:
        frozen: all labs stand still.
        pushes: how many there have been; 0 for none.
        push: the last one, which whoever joins takes as well; None if there is none to take.
    """

    frozen: bool = False
    pushes: int = 0
    push: Push | None = None


class Classroom(Protocol):
    """A class. From any thread.

    What is read is at hand; who waits for a database: `look`, `admit`, `is_pass`, `revoke`,
    `join`, `leave` and `end`, which then may raise OSError.
    """

    @property
    def clock(self) -> Callable[[], float]:
        """Seconds since whenever; what time does to the computer's clock does not matter."""
        ...

    @property
    def code(self) -> str:
        """What students type to join."""
        ...

    @property
    def orders(self) -> Orders:
        """What holds now."""
        ...

    def admit(self, typed: str, who: str) -> str:
        """A pass for a teacher's browser, for the key.

        Args:
            who: who types it: a session code.

        Raises:
            ValueError: this is not the key, or there have been too many that were not.
        """
        ...

    def is_pass(self, shown: str | None) -> bool:
        """Whether a browser may teach."""
        ...

    def revoke(self, shown: str | None) -> None:
        """A browser teaches no more."""
        ...

    def join(self, session: str, typed: str, name: str) -> Member:
        """A student comes in; one who is in already takes another nickname.

        Args:
            session: code of the student's lab.
            typed: the class code.

        Raises:
            ValueError: a wrong code or too many of them, no nickname, or the class is full.
        """
        ...

    def leave(self, session: str) -> None:
        """A student goes, and with it all that the class knew."""
        ...

    def member(self, session: str) -> Member | None:
        """The student of a lab."""
        ...

    def members(self) -> dict[str, Member]:
        """All students by session code, in the order in which they joined."""
        ...

    def look(self) -> None:
        """Bring what is known here up to date, and what is known only here to the others."""
        ...

    def is_elsewhere(self, session: str) -> bool:
        """Whether another process had a lab last: what is here of it is old."""
        ...

    def note(self, session: str, **changes: object) -> None:
        """What has changed of a student; nothing happens when it has left."""
        ...

    def freeze(self, on: bool) -> None:
        """All labs stand still, or go on."""
        ...

    def push(self, push: Push | None) -> None:
        """Send all who are in the class a set-up or a step, once; it stands for those who join.

        It stands until another is sent, until None is sent (then nobody's lab changes, and who
        joins begins on one's own), or until the class ends.
        """
        ...

    def end(self) -> int:
        """The class is over: nobody is in it, and another code opens the next one.

        Returns how many were in it.
        """
        ...


def seated(members: Mapping[str, Member], session: str, name: str, new: Member) -> Member:
    """A student with a name of its own.

    Args:
        members: who is in the class.
        session: code of the student's lab.
        name: as it was typed.
        new: what a student is who was not in it.

    Raises:
        ValueError: no nickname, or the class is full.
    """
    name, old = cleaned(name), members.get(session)
    if old is None and len(members) >= MOST_MEMBERS:
        raise ValueError("this class is full")
    others = {member.name.casefold() for code, member in members.items() if code != session}
    return replace(old or new, name=not_among(others, name))


def noted(member: Member, changes: Mapping[str, object]) -> Member:
    """A student of whom something is known anew; see `Classroom.note`."""
    return replace(member, **changes)  # pyright: ignore[reportArgumentType]
