"""Synchronizes the class with the labs of this process: progress and the teacher's orders.

It runs several times a second, and at once after a push or a freeze, in a separate thread. This
is safe because labs are changed only by commands and only their immutable parts are read.
"""

from __future__ import annotations

from collections.abc import Callable

from onpath.app.classroom.classroom import Classroom, Member, Orders
from onpath.app.common.periodic import Periodic
from onpath.app.lab.commands import DealForm, Freeze, HoldVotes, KeepWithin, SayLate
from onpath.app.lab.lab import Lab
from onpath.lessons.concept_test.concept_test import BEFORE, dealt_in_class, form_of, taken
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.votes import counted

SYNC_INTERVAL = 0.25  # [s] between rounds through the labs of a class
NOTHING = Notes()
GAINS = ("K1", "K2", "K3", "K4", "K5")
Find = Callable[[str], tuple[Lab, bool] | None]
"""The lab of a code and whether a browser is connected; None if it is not here."""


class ClassSync:
    """Keeps a class and its students' labs synchronized.

    Args:
        find: looks up a lab of this process.

    Attributes:
        rounds: the periodic synchronization.
    """

    def __init__(self, classroom: Classroom, find: Find) -> None:
        self._class, self._find = classroom, find
        self._asked: dict[str, int] = {}
        self._bound: dict[str, Lab] = {}
        self.rounds = Periodic("class", SYNC_INTERVAL, self.check)
        classroom.ordered = self.rounds.due.set

    def check(self) -> None:
        """Synchronize once: send orders to the labs and report their state to the class."""
        members = self._class.members()
        for code in [code for code in self._bound if code not in members]:
            self._release(code)
        for code in members:
            self._follow(code)

    def _release(self, code: str) -> None:
        """Release the lab of a student who has left the class."""
        lab = self._bound.pop(code)
        self._asked.pop(code, None)
        if lab.frozen:
            lab.post(Freeze(False))
        if lab.lessons.pace is not None:
            lab.post(KeepWithin(None))
        if lab.lessons.votes:
            lab.post(HoldVotes(()))

    def _follow(self, code: str) -> None:
        member = self._class.member(code)
        found = self._find(code)
        if member is None:
            return
        if found is None:
            if member.connected:
                self._class.note(code, connected=False)
            return
        lab, connected = found
        self._bound[code] = lab
        changes: dict[str, object] = {}
        if lab.lessons.progress is not member.progress:
            changes["progress"] = lab.lessons.progress
            if self._is_late(member.progress, lab.lessons.progress):
                lab.post(SayLate())
        if connected != member.connected:
            changes |= {"connected": connected, "aside": member.aside and not connected}
        gains = gains_of(lab)
        if gains != member.gains:
            changes["gains"] = gains
        if lab.asked != self._asked.get(code):
            self._asked[code], changes["active"] = lab.asked, self._class.clock()
        _deal(self._first_form(member), lab)
        orders = self._class.orders
        if orders.pushes > member.taken:
            changes["taken"], changes["given"] = orders.pushes, self._class.clock()
        _give(orders, lab, is_new=orders.pushes > member.taken)
        votes = self._class.open_votes
        if votes != lab.lessons.votes:
            lab.post(HoldVotes(votes))
        if changes:
            self._class.note(code, **changes)

    def _first_form(self, member: Member) -> int:
        """The form of the concept test that a member gets before the course: what was answered
        before it in another lab of the same word, or what is dealt."""
        same = self._class.members().values() if member.word else ()
        opened = [taken(each.progress, BEFORE) for each in same if each.word == member.word]
        known = next((form_of(name) for name in opened if name), None)
        return dealt_in_class(self._class.code, member.number) if known is None else known

    def _is_late(self, before: Progress, now: Progress) -> bool:
        """Whether an answer has come that does not count, since its vote is closed."""
        for vote in self._class.votes:
            known, found = (each.notes.get(vote.lesson, NOTHING) for each in (before, now))
            if found.given is known.given:
                continue
            new = [each for each in found.given if each not in known.given]
            came = [e for e in new if e.item == vote.item and bool(e.round) == vote.again]
            if came and counted(found, vote.item, vote, vote.again) is None:
                return True
        return False


def _deal(first: int, lab: Lab) -> None:
    """Give a lab the form of the concept test that comes first, unless it has it."""
    if first != lab.lessons.first_form:
        lab.post(DealForm(first))


def _give(orders: Orders, lab: Lab, is_new: bool) -> None:
    """Pass the teacher's orders on to a lab, as far as it does not follow them already.

    Args:
        is_new: whether this lab has not received the last push yet.
    """
    if is_new and orders.push is not None:
        lab.post(orders.push)
    if orders.frozen != lab.frozen:
        lab.post(Freeze(orders.frozen))
    if orders.pace != lab.lessons.pace:
        lab.post(KeepWithin(orders.pace))


def gains_of(lab: Lab) -> tuple[float, ...]:
    """The gains of a lab, in the order of `GAINS`. Safe, since its parameters are immutable."""
    parameters = lab.simulation.parameters
    return tuple(float(getattr(parameters, name)) for name in GAINS)
