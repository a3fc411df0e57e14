"""A class as rows of the database. Whatever is read back is checked, and never stops a class."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
import sqlalchemy as sa

from onpath.app.classroom.admission import cleaned
from onpath.app.classroom.classroom import NOTHING_DONE, Member, Push
from onpath.app.common.error_log import log_warning
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.setup import from_data, to_data
from onpath.lessons.progress import Progress, read_progress

Count = Annotated[int, msgspec.Meta(ge=0)]


class ClassRow(msgspec.Struct, frozen=True):
    """A class.

    Attributes:
        changes: how many there have been, of itself and of its members.
        joined: how many have ever joined.
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
        changed: the class's `changes` when this was written.
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
    """A class as it is kept; None if it cannot be read."""
    try:
        return msgspec.convert(row, ClassRow, from_attributes=True)
    except msgspec.ValidationError as error:
        log_warning("a class cannot be read, it is begun anew: %s", error)
        return None


class ProgressCache:
    """Students' progress as text and back, each text read once."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[str, Progress]] = {}

    def text(self, session: str, progress: Progress) -> str:
        """As it is kept."""
        text = msgspec.json.encode(progress).decode()
        self._known[session] = text, progress
        return text

    def read(self, session: str, text: str) -> Progress:
        """What was kept; the same object until it is another."""
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
        """Forget all others."""
        self._known = {code: known for code, known in self._known.items() if code in sessions}


def read_member(row: sa.Row[Any], ways: ProgressCache, since: float) -> tuple[str, Member] | None:
    """A session code and the student of it; None if it cannot be read.

    Args:
        since: seconds since 1970 when the class's clock began.
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
    """What a teacher sends, as it is kept; empty for nothing."""
    if push is None:
        return ""
    if isinstance(push, TakeStep):
        return msgspec.json.encode({"lesson": push.lesson, "step": push.step}).decode()
    return msgspec.json.encode({"setup": to_data(push.setup)}).decode()


def read_push(text: str) -> Push | None:
    """The inverse of `push_text`; None if there is nothing or it cannot be read."""
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
