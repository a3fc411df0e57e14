"""Converts a class to what is stored of it and back. What is invalid is left out with a warning."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Any

import msgspec

from onpath.app.classroom.admission import cleaned
from onpath.app.classroom.classroom import MOST_MEMBERS, ClassState, Member, Orders, Push
from onpath.app.common.error_log import log_warning
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.setups.stored import from_data, to_data
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress

SETTLED = 5.0  # [s] after a push was given to a lab, by when the lab is stored with it
Count = Annotated[int, msgspec.Meta(ge=0)]
Stored = dict[str, Any]


class StoredMember(msgspec.Struct, frozen=True):
    """A student, without the progress, which is stored with the lab."""

    session: Annotated[str, msgspec.Meta(min_length=1, max_length=64)]
    number: Count
    name: str
    taken: Count


class StoredClass(msgspec.Struct, frozen=True):
    """A class; `push` and `members` are checked one by one."""

    joined: Count
    frozen: bool
    pushes: Count
    push: Stored | None
    passes: Annotated[list[str], msgspec.Meta(max_length=10_000)]
    members: list[Any]
    pace: Pace | None = None


def to_stored(state: ClassState, now: float) -> Stored:
    """What is stored of a class.

    A push given to a lab within the last `SETTLED` seconds counts as not given yet: if this
    process ends now, the lab may be stored without it.

    Args:
        now: time by the class's clock, [s].
    """
    orders = state.orders
    members = [
        StoredMember(session, each.number, each.name, _settled(each, now))
        for session, each in state.members.items()
    ]
    push = None if orders.push is None else push_data(orders.push)
    passes = sorted(state.passes)
    kept = StoredClass(
        state.joined, orders.frozen, orders.pushes, push, passes, members, orders.pace
    )
    return msgspec.to_builtins(kept)


def _settled(member: Member, now: float) -> int:
    """Number of the last push that the stored lab has for certain."""
    return member.taken if now - member.given > SETTLED else max(member.taken - 1, 0)


def from_stored(data: Stored | None, progress: Callable[[str], Progress], now: float) -> ClassState:
    """The class as it was stored; empty if there is nothing, or it is invalid.

    Args:
        progress: finds the progress of a session code.
        now: time by the class's clock, [s].
    """
    if data is None:
        return ClassState()
    try:
        kept = msgspec.convert(data, StoredClass)
    except msgspec.ValidationError as error:
        log_warning("a class cannot be read, it is begun anew: %s", error)
        return ClassState()
    members: dict[str, Member] = {}
    for each in kept.members[:MOST_MEMBERS]:
        if (read := _member(each)) is not None:
            session, member = read
            members[session] = replace(member, progress=progress(session), active=now)
    joined = max([kept.joined, *(member.number for member in members.values())])
    orders = Orders(kept.frozen, kept.pushes, read_push(kept.push), kept.pace)
    return ClassState(joined, orders, frozenset(kept.passes), members)


def _member(data: Any) -> tuple[str, Member] | None:
    try:
        kept = msgspec.convert(data, StoredMember)
        name = cleaned(kept.name)
    except ValueError as error:
        log_warning("a student of the class cannot be read: %s", error)
        return None
    return kept.session, Member(kept.number, name, connected=False, taken=kept.taken)


def push_data(push: Push) -> Stored:
    """What a teacher has sent, as it is stored."""
    if isinstance(push, TakeSetup):
        return {"setup": to_data(push.setup)}
    return {"lesson": push.lesson, "step": push.step, "route": push.route, "again": push.again}


def read_push(data: Stored | None) -> Push | None:
    """The inverse of `push_data`; None if there is nothing, or it is invalid."""
    if data is None:
        return None
    try:
        if "setup" in data:
            return TakeSetup(from_data(data["setup"]))
        return msgspec.convert(data, TakeStep)
    except ValueError as error:
        log_warning("what the teacher has sent cannot be read: %s", error)
        return None
