"""Converts a class to its stored form and back; invalid parts are left out, with a warning."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Annotated, Any

import msgspec

from onpath.app.classroom.admission import cleaned
from onpath.app.classroom.classroom import (
    MOST_MEMBERS,
    MOST_VOTES,
    ClassState,
    Display,
    Identification,
    Member,
    Orders,
    Push,
)
from onpath.app.common.error_log import log_warning
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.setups.stored import from_data, to_data
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress
from onpath.lessons.votes import Vote

SETTLED = 5.0  # [s] after a push is given to a lab; by then the lab is stored with it
Count = Annotated[int, msgspec.Meta(ge=0)]
Stored = dict[str, Any]


class StoredMember(msgspec.Struct, frozen=True):
    """A student without progress, which is stored with the lab."""

    session: Annotated[str, msgspec.Meta(min_length=1, max_length=64)]
    number: Count
    name: str
    taken: Count
    aside: bool = False
    identification: str = ""
    word: str = ""


class StoredClass(msgspec.Struct, frozen=True):
    """A class; `push`, `step`, `members`, `display` and `votes` are checked one by one."""

    joined: Count
    frozen: bool
    pushes: Count
    push: Stored | None
    passes: Annotated[list[str], msgspec.Meta(max_length=10_000)]
    members: list[Any]
    step: Stored | None = None
    pace: Pace | None = None
    display: Any = None
    votes: list[Any] = []
    days: Count = 0
    asks: Identification = ""
    phones: Annotated[list[str], msgspec.Meta(max_length=10_000)] = []


def to_stored(state: ClassState, now: float) -> Stored:
    """The stored form of a class.

    A push that was given to a lab within the last `SETTLED` seconds counts as not yet given: if the
    process ends now, the lab may have been stored without it.

    Args:
        now: time on the class's clock, [s].
    """
    orders = state.orders
    members = [
        StoredMember(
            session=lab,
            number=each.number,
            name=each.name,
            taken=_settled(each, now),
            aside=each.aside,
            identification=each.identification,
            word=each.word,
        )
        for lab, each in state.members.items()
    ]
    stored = StoredClass(
        joined=state.joined,
        frozen=orders.frozen,
        pushes=orders.pushes,
        push=None if orders.push is None else push_data(orders.push),
        step=None if orders.step is None else push_data(orders.step),
        passes=sorted(state.passes),
        members=members,
        pace=orders.pace,
        display=asdict(state.display),
        votes=[asdict(each) for each in state.votes],
        days=state.days,
        asks=state.asks,
        phones=list(state.phones),
    )
    return msgspec.to_builtins(stored)


def _settled(member: Member, now: float) -> int:
    """Number of the last push that the stored lab certainly has."""
    return member.taken if now - member.given > SETTLED else max(member.taken - 1, 0)


def from_stored(data: Stored | None, progress: Callable[[str], Progress], now: float) -> ClassState:
    """The class as it was stored; empty if there is none, or if it is invalid.

    Args:
        progress: returns the progress of a lab code.
        now: time on the class's clock, [s].
    """
    if data is None:
        return ClassState()
    try:
        kept = msgspec.convert(data, StoredClass)
    except msgspec.ValidationError as error:
        log_warning("a class cannot be read and starts again: %s", error)
        return ClassState()
    members: dict[str, Member] = {}
    for each in kept.members[:MOST_MEMBERS]:
        if (read := _member(each)) is not None:
            lab, member = read
            members[lab] = replace(member, progress=progress(lab), active=now)
    joined = max([kept.joined, *(member.number for member in members.values())])
    step = read_push(kept.step or kept.push)  # an older row has the push alone
    orders = Orders(
        frozen=kept.frozen,
        pushes=kept.pushes,
        push=read_push(kept.push),
        step=step if isinstance(step, TakeStep) else None,
        pace=kept.pace,
    )
    return ClassState(
        joined=joined,
        orders=orders,
        display=_display(kept.display),
        passes=frozenset(kept.passes),
        members=members,
        votes=tuple(filter(None, map(_vote, kept.votes[-MOST_VOTES:]))),
        days=kept.days,
        asks=kept.asks,
        phones=tuple(kept.phones),
    )


def _member(data: Any) -> tuple[str, Member] | None:
    try:
        kept = msgspec.convert(data, StoredMember)
        name = cleaned(kept.name)
    except ValueError as error:
        log_warning("a student of the class cannot be read: %s", error)
        return None
    return kept.session, Member(
        number=kept.number,
        name=name,
        connected=False,
        taken=kept.taken,
        aside=kept.aside,
        identification=kept.identification,
        word=kept.word,
    )


def _display(data: Any) -> Display:
    try:
        display = msgspec.convert(data or {}, Display)
        msgspec.convert(display.step, Count)
    except ValueError as error:
        log_warning("what the teacher's page showed cannot be read: %s", error)
        return Display()
    return display


def _vote(data: Any) -> Vote | None:
    try:
        return msgspec.convert(data, Vote)
    except ValueError as error:
        log_warning("a vote of the class cannot be read: %s", error)
        return None


def push_data(push: Push) -> Stored:
    """The stored form of what a teacher has sent."""
    if isinstance(push, TakeSetup):
        return {"setup": to_data(push.setup)}
    return {"lesson": push.lesson, "step": push.step, "route": push.route, "again": push.again}


def read_push(data: Stored | None) -> Push | None:
    """The inverse of `push_data`; None if there is none, or if it is invalid."""
    if data is None:
        return None
    try:
        if "setup" in data:
            return TakeSetup(from_data(data["setup"]))
        return msgspec.convert(data, TakeStep)
    except ValueError as error:
        log_warning("what the teacher has sent cannot be read: %s", error)
        return None
