"""Converts a class to rows of the database and back. Invalid rows are skipped with a warning."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
import sqlalchemy as sa

from onpath.app.classroom.admission import cleaned
from onpath.app.classroom.classroom import NOTHING_DONE, Member, Push
from onpath.app.common.error_log import log_warning
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.setups.setup import to_data
from onpath.app.lab.setups.stored import from_data
from onpath.lessons.progress import Progress, read_progress

Count = Annotated[int, msgspec.Meta(ge=0)]


class ClassRow(msgspec.Struct, frozen=True):
    """A class.

    Attributes:
        changes: number of changes of the class and its members.
        joined: number of students that have ever joined.
    """

    code: Annotated[str, msgspec.Meta(min_length=1, max_length=8)]
    changes: Count
    joined: Count
    frozen: Count
    pushes: Count
    push: str


class MemberRow(msgspec.Struct, frozen=True):
    """A student.

    Attributes:
        changed: the class's `changes` when this row was written.
        active: seconds since 1970.
    """

    session: str
    changed: Count
    number: Count
    name: str
    active: float
    taken: Count
    progress: str


def class_row(row: sa.Row[Any]) -> ClassRow | None:
    """The class in a row; None if it is invalid."""
    try:
        return msgspec.convert(row, ClassRow, from_attributes=True)
    except msgspec.ValidationError as error:
        log_warning("a class cannot be read, it is begun anew: %s", error)
        return None


class ProgressCache:
    """Converts students' progress to text and back; each text is parsed once."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[str, Progress]] = {}

    def text(self, session: str, progress: Progress) -> str:
        """The progress as text."""
        text = msgspec.json.encode(progress).decode()
        self._known[session] = text, progress
        return text

    def read(self, session: str, text: str) -> Progress:
        """The progress in a text; the same object as long as the text is the same."""
        known = self._known.get(session)
        if known is not None and known[0] == text:
            return known[1]
        try:
            progress = read_progress(msgspec.json.decode(text)) if text else NOTHING_DONE
        except (ValueError, RecursionError) as error:
            log_warning("a student's progress cannot be read: %s", error)
            progress = NOTHING_DONE
        self._known[session] = text, progress
        return progress

    def keep(self, sessions: set[str]) -> None:
        """Drop all other sessions."""
        self._known = {code: known for code, known in self._known.items() if code in sessions}


def read_member(row: sa.Row[Any], ways: ProgressCache, since: float) -> tuple[str, Member] | None:
    """Session code and student in a row; None if it is invalid.

    Args:
        since: seconds since 1970 at which the class's monotonic clock was 0.
    """
    try:
        kept = msgspec.convert(row, MemberRow, from_attributes=True)
        name = cleaned(kept.name)
    except ValueError as error:
        log_warning("a student of the class cannot be read: %s", error)
        return None
    progress, active = ways.read(kept.session, kept.progress), kept.active - since
    return kept.session, Member(kept.number, name, progress, False, active, kept.taken)


def push_text(push: Push | None) -> str:
    """What the teacher sends, as text; empty for nothing."""
    if push is None:
        return ""
    if isinstance(push, TakeStep):
        kept = {"lesson": push.lesson, "step": push.step, "route": push.route, "again": push.again}
        return msgspec.json.encode(kept).decode()
    return msgspec.json.encode({"setup": to_data(push.setup)}).decode()


def read_push(text: str) -> Push | None:
    """The inverse of `push_text`; None if there is nothing, or it is invalid."""
    if not text:
        return None
    try:
        kept = msgspec.json.decode(text, type=dict[str, Any])
        if "setup" in kept:
            return TakeSetup(from_data(kept["setup"]))
        return msgspec.convert(kept, TakeStep)
    except (ValueError, RecursionError) as error:
        log_warning("what the teacher has sent cannot be read: %s", error)
        return None
