"""Records of a class and the interface through which pages and labs use it.

`app.classroom.local_classroom` implements it for one process, `app.classroom.shared_classroom`
for several.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Protocol

from onpath.app.classroom.admission import cleaned, not_among
from onpath.app.common.visible_text import comparison_key
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress
from onpath.models.errors import CodedError

MOST_MEMBERS = 300
Push = TakeSetup | TakeStep
NOTHING_DONE = Progress()


@dataclass(frozen=True, slots=True)
class Member:
    """A student's record in the class.

    Attributes:
        number: serial number by order of joining; unlike the session code it may be shown.
        name: the nickname; may hold any printable characters, so it must be escaped.
        progress: progress through the lessons at the last update.
        connected: whether a browser is connected to the lab.
        active: time of the last command in the lab, by the class's clock, [s].
        taken: number of the last push applied by the lab; 0 for none.
        gains: the lab's K1 to K5 at the last update; empty before the first one.
    """

    number: int
    name: str
    progress: Progress = NOTHING_DONE
    connected: bool = True
    active: float = 0.0
    taken: int = 0
    gains: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Orders:
    """The teacher's current orders.

    Attributes:
        frozen: whether all labs are stopped.
        pushes: number of pushes so far.
        push: the last one, which later joiners receive as well; None if there is none.
        pace: the steps within which students may go; None if they may go anywhere.
    """

    frozen: bool = False
    pushes: int = 0
    push: Push | None = None
    pace: Pace | None = None


class Classroom(Protocol):
    """A class. Thread-safe.

    Reads are cached. `look`, `admit`, `is_pass`, `revoke`, `join`, `leave` and `end` may block on
    a database and may raise OSError.
    """

    @property
    def clock(self) -> Callable[[], float]:
        """Monotonic time with an arbitrary origin, [s]; independent of the system clock."""
        ...

    @property
    def code(self) -> str:
        """The class code that students type to join."""
        ...

    @property
    def orders(self) -> Orders:
        """The current orders."""
        ...

    def admit(self, typed: str, who: str) -> str:
        """Issue a pass for a teacher's browser in exchange for the key.

        Args:
            who: session code of the browser.

        Raises:
            ValueError: a wrong key, or too many wrong keys.
        """
        ...

    def is_pass(self, shown: str | None) -> bool:
        """Whether a browser's pass is valid."""
        ...

    def revoke(self, shown: str | None) -> None:
        """Revoke a browser's pass."""
        ...

    def join(self, session: str, typed: str, name: str) -> Member:
        """Add a student, or change the nickname of one who has already joined.

        Args:
            session: code of the student's lab.
            typed: the class code.

        Raises:
            ValueError: a wrong code or too many of them, no nickname, or the class is full.
        """
        ...

    def leave(self, session: str) -> None:
        """Remove a student and all of the student's data from the class."""
        ...

    def member(self, session: str) -> Member | None:
        """The member of a session code, if any."""
        ...

    def members(self) -> dict[str, Member]:
        """All members by session code, in order of joining."""
        ...

    def look(self) -> None:
        """Synchronize this process's state of the class with the other processes."""
        ...

    def is_elsewhere(self, session: str) -> bool:
        """Whether another process last owned the lab, so that the local state is outdated."""
        ...

    def note(self, session: str, **changes: object) -> None:
        """Update a member; without effect if the student has left."""
        ...

    def freeze(self, on: bool) -> None:
        """Stop or resume all labs."""
        ...

    def push(self, push: Push | None) -> None:
        """Send a set-up or a step to all members once, and to those who join later.

        It remains in effect until another is sent or the class ends. Sending None clears it
        without changing any lab; later joiners then keep their own set-up.
        """
        ...

    def end(self) -> int:
        """End the class: remove all members and choose a new code for the next class.

        Returns the number of members removed.
        """
        ...


def seated(members: Mapping[str, Member], session: str, name: str, new: Member) -> Member:
    """Create or rename a member with a unique name.

    Args:
        members: current members of the class.
        session: code of the student's lab.
        name: nickname as typed.
        new: initial record of a student who has not joined yet.

    Raises:
        ValueError: no nickname, or the class is full.
    """
    name, old = cleaned(name), members.get(session)
    if old is None and len(members) >= MOST_MEMBERS:
        raise CodedError("error.class_full")
    others = {comparison_key(member.name) for code, member in members.items() if code != session}
    return replace(old or new, name=not_among(others, name))


def noted(member: Member, changes: Mapping[str, object]) -> Member:
    """An updated copy of a member; see `Classroom.note`."""
    return replace(member, **changes)  # pyright: ignore[reportArgumentType]
