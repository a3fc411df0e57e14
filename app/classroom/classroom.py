"""A class in memory: its members, its teachers' passes, and a teacher's orders. Thread-safe.

class_keeper.py keeps it in the database; class_sync.py synchronizes it with the labs.
"""

from __future__ import annotations

import hashlib
import hmac
import re
import secrets
import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from typing import Literal, get_args

from onpath.app.classroom.admission import (
    Admission,
    class_code_of,
    cleaned,
    identified,
    new_pass,
    not_among,
    word_hash,
)
from onpath.app.common.access_codes import new_code
from onpath.app.common.visible_text import comparison_key
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress
from onpath.lessons.votes import Vote, vote_on
from onpath.models.errors import CodedError

MOST_MEMBERS = 300
MOST_VOTES = 1000
MOST_ASKING = 8  # pages that may ask at once to become a teacher's
NUMBER_LASTS = 120.0  # [s] for which a number lets a page in
Push = TakeSetup | TakeStep
NOTHING_DONE = Progress()
Identification = Literal["", "email", "idnumber", "username"]
"""By what learning platforms know a student, as Moodle names it."""
IDENTIFICATIONS: dict[str, Identification] = {each: each for each in get_args(Identification)}


@dataclass(frozen=True, slots=True)
class Member:
    """A student's record in the class.

    Attributes:
        number: serial number by order of joining; unlike the lab code it may be shown.
        name: the nickname; may hold any printable characters, so it must be escaped.
        progress: progress through the lessons at the last update.
        connected: whether a browser is connected to the lab.
        active: time of the last command in the lab, on the class's clock, [s].
        taken: number of the last push given to the lab; 0 for none.
        given: time of that push, on the class's clock, [s].
        gains: the lab's K1 to K5 at the last update; empty before the first one.
        aside: whether the teacher has set the student aside, who was away; it ends with the return.
        identification: what the student typed when asked for it; see `ClassState.asks`.
        word: the keyed hash of a word that the student has made up, or empty; see `word_hash`.
    """

    number: int
    name: str
    progress: Progress = NOTHING_DONE
    connected: bool = True
    active: float = 0.0
    taken: int = 0
    given: float = -inf
    gains: tuple[float, ...] = ()
    aside: bool = False
    identification: str = ""
    word: str = ""


@dataclass(frozen=True, slots=True)
class Orders:
    """The teacher's current orders.

    Attributes:
        frozen: whether all labs are stopped.
        pushes: number of pushes so far.
        push: the last one, which later joiners receive as well; None if there is none.
        step: the last step that was sent; a set-up after it leaves the class there.
        pace: the steps to which students are kept; None if they may go anywhere.
    """

    frozen: bool = False
    pushes: int = 0
    push: Push | None = None
    step: TakeStep | None = None
    pace: Pace | None = None


@dataclass(frozen=True, slots=True)
class Display:
    """What all teachers' pages of the class show of its answers.

    Attributes:
        lesson, step: where the displayed question is asked; the lesson may be gone, or "".
        shown: whether the answers themselves are shown, and not only their number.
        revealed: whether the truth is shown as well.
        since: seconds since 1970, before which neither is: the vote is still closing.
    """

    lesson: str = ""
    step: int = 0
    shown: bool = False
    revealed: bool = False
    since: float = 0.0

    def seen(self, now: float) -> Display:
        """What is shown now, [s]."""
        return self if now >= self.since else replace(self, shown=False, revealed=False)


@dataclass(frozen=True, slots=True)
class ClassState:
    """Everything about a class that is stored.

    Attributes:
        joined: number of students who have ever joined.
        passes: hashes of the teachers' passes.
        phones: of those, the ones that were given by a number; see `Classroom.let_in`.
        members: students by lab code, in order of joining.
        votes: on the questions that were put to the class.
        days: after so many days without a change, the class is deleted; 0: as many as may be.
        asks: by what students are to identify themselves; empty: they are not asked.
    """

    joined: int = 0
    orders: Orders = field(default_factory=Orders)
    display: Display = field(default_factory=Display)
    passes: frozenset[str] = frozenset()
    phones: tuple[str, ...] = ()
    members: Mapping[str, Member] = field(default_factory=dict)
    votes: tuple[Vote, ...] = ()
    days: int = 0
    asks: Identification = ""


@dataclass(frozen=True, slots=True)
class Asking:
    """A page that asks to become a teacher's.

    Attributes:
        grant: gives it its pass.
        until: by the class's clock, [s].
    """

    grant: Callable[[str], None]
    until: float


@dataclass(slots=True)
class Classroom:
    """A class.

    Attributes:
        clock: monotonic time, [s].
        now: seconds since 1970, by which answers are late.
        key: the teacher's key, in the stored form of `app.common.access_codes`.
        most_days: the most days for which a class is kept without a change; 0: it is not stored.
        code: the class code, the same in every process with this key; it is in the class's address.
        state: everything that is stored; replaced at each change.
        claims: labs of students who say that a place is theirs whose lab is away -> that lab.
        ordered: called when labs are to follow an order at once; others they follow a quarter of
            a second later, see `class_sync.SYNC_INTERVAL`. A vote is late by its own time.
    """

    clock: Callable[[], float] = time.monotonic
    now: Callable[[], float] = field(default=time.time, kw_only=True)
    key: str = field(default_factory=new_code, repr=False)
    most_days: int = field(default=0, kw_only=True)
    code: str = field(init=False)
    state: ClassState = field(default_factory=ClassState)
    claims: dict[str, str] = field(default_factory=dict[str, str], init=False)
    ordered: Callable[[], object] = field(default=lambda: None, init=False)
    _asking: dict[int, Asking] = field(default_factory=dict[int, Asking], init=False)
    _lock: threading.RLock = field(default_factory=threading.RLock)
    _door: Admission = field(init=False)

    def __post_init__(self) -> None:
        self.code = class_code_of(self.key)
        self._door = Admission(self.clock)

    def restore(self, state: ClassState) -> None:
        """Replace everything by a stored state."""
        with self._lock:
            self.state = state

    # Teachers

    def admit(self, typed: str, who: str) -> str:
        """Issue a pass for a teacher's browser in exchange for the key.

        Args:
            who: lab code of the browser.

        Raises:
            ValueError: the key is wrong, or too many keys have been.
        """
        self._door.check_key(typed, [self.key], who)
        new = new_pass()
        with self._lock:
            self.state = replace(self.state, passes=self.state.passes | {_hash(new)})
        return new

    def is_pass(self, shown: str | None) -> bool:
        """Whether a browser's pass is valid."""
        given = _hash(shown or "")
        return any([hmac.compare_digest(given, each) for each in self.state.passes])

    def revoke(self, shown: str | None) -> None:
        """Revoke a browser's pass."""
        self._revoke(_hash(shown or ""))

    def _revoke(self, given: str) -> None:
        with self._lock:
            phones = tuple(each for each in self.state.phones if each != given)
            passes = self.state.passes - {given}
            self.state = replace(self.state, passes=passes, phones=phones)

    def ask_in(self, grant: Callable[[str], None]) -> int:
        """A page asks to become a teacher's, without a key.

        Args:
            grant: called with its pass when it is let in.

        Returns:
            The number that the page is to show, for `NUMBER_LASTS` seconds; 0 if too many ask.
        """
        with self._lock:
            known = self.asking
            if len(known) >= MOST_ASKING:
                return 0
            number = 0
            while not number or number in known:
                number = 1000 + secrets.randbelow(9000)
            self._asking[number] = Asking(grant, self.clock() + NUMBER_LASTS)
            return number

    @property
    def asking(self) -> list[int]:
        """The numbers of the pages that ask to become a teacher's, the longest waiting first."""
        with self._lock:
            now = self.clock()
            self._asking = {n: each for n, each in self._asking.items() if each.until > now}
            return list(self._asking)

    def let_in(self, number: int) -> None:
        """Make the page that shows a number a teacher's; a number counts once.

        Raises:
            ValueError: no page shows it any more.
        """
        with self._lock:
            asking = self._asking.get(number) if number in self.asking else None
            if asking is None:
                raise CodedError("error.number_is_gone")
            del self._asking[number]
            new = new_pass()
            given, state = _hash(new), self.state
            passes, phones = state.passes | {given}, (*state.phones, given)
            self.state = replace(state, passes=passes, phones=phones)
        asking.grant(new)

    def take_back(self, number: int) -> None:
        """A page does not ask any more."""
        with self._lock:
            self._asking.pop(number, None)

    def throw_out(self, number: int) -> None:
        """Revoke the pass of a phone, by its number among them, from 1 on."""
        phones = self.state.phones
        if number in range(1, len(phones) + 1):
            self._revoke(phones[number - 1])

    # Members

    def join(self, lab: str, typed: str, name: str) -> Member:
        """Add a student, or change the nickname of one who has already joined.

        Args:
            lab: code of the student's lab.
            typed: the class code.

        Raises:
            ValueError: the code is wrong, or too many have been; the nickname is empty; or the
                class is full.
        """
        self._door.check_code(typed, [self.code], lab)
        with self._lock:
            old = self.state
            new = Member(old.joined + 1, "", active=self.clock())
            member = seated(old.members, lab, name, new)
            members, joined = {**old.members, lab: member}, max(old.joined, member.number)
            self.state = replace(old, members=members, joined=joined)
            return member

    def rename(self, lab: str, name: str) -> None:
        """Change a student's nickname. Does nothing if the student has left.

        Raises:
            ValueError: the nickname is empty.
        """
        with self._lock:
            old = self.state.members.get(lab)
            if old is not None:
                self.note(lab, name=seated(self.state.members, lab, name, old).name)

    def leave(self, lab: str) -> None:
        """Remove a student and all of the student's data from the class."""
        with self._lock:
            others = {code: each for code, each in self.state.members.items() if code != lab}
            self.state = replace(self.state, members=others)
            self.claims.pop(lab, None)

    def former_place(self, lab: str) -> str:
        """The lab that is away whose student had the nickname that this one asked for; or "".

        Whoever joins under a name that is taken gets a number behind it; see `not_among`.
        """
        members = self.state.members
        own = members.get(lab)
        name = "" if own is None else re.sub(r" \d+$", "", own.name)
        if own is None or name == own.name:
            return ""
        wanted = comparison_key(name)
        away = (code for code, each in members.items() if not each.connected and code != lab)
        return next((code for code in away if comparison_key(members[code].name) == wanted), "")

    def claim(self, lab: str) -> None:
        """A student says that the former place is the student's own; a teacher decides."""
        with self._lock:
            if former := self.former_place(lab):
                self.claims[lab] = former

    def reject(self, lab: str) -> None:
        """A student stays somebody else than the one in the former place."""
        with self._lock:
            self.claims.pop(lab, None)

    def member(self, lab: str) -> Member | None:
        """The member of a lab code, if any."""
        return self.state.members.get(lab)

    def members(self) -> dict[str, Member]:
        """All members by lab code, in order of joining."""
        return dict(self.state.members)

    def present(self) -> dict[str, Member]:
        """The members whom the teacher has not set aside."""
        return {lab: each for lab, each in self.state.members.items() if not each.aside}

    def set_aside(self) -> int:
        """Set aside everybody who is away, until they come back. Returns how many they are."""
        with self._lock:
            away = [lab for lab, each in self.present().items() if not each.connected]
            for lab in away:
                self.note(lab, aside=True)
            return len(away)

    def ask_for(self, identification: Identification) -> None:
        """Ask students to identify themselves; what they typed for something else is deleted."""
        with self._lock:
            if identification != self.state.asks:
                for lab in self.state.members:
                    self.note(lab, identification="")
                self.state = replace(self.state, asks=identification)

    def identify(self, lab: str, typed: str) -> None:
        """Note what identifies a student elsewhere, if the teacher has asked for it."""
        with self._lock:
            if self.state.asks:
                self.note(lab, identification=identified(typed))

    def link(self, lab: str, word: str) -> None:
        """Note a word that a student has made up, which links two tests over months; or none.

        Raises:
            ValueError: it is too short.
        """
        self.note(lab, word=word_hash(self.key, word))

    def note(self, lab: str, **changes: object) -> None:
        """Update a member. Does nothing if the student has left."""
        with self._lock:
            old = self.state.members.get(lab)
            if old is not None:
                new = replace(old, **changes)  # pyright: ignore[reportArgumentType]
                self.state = replace(self.state, members={**self.state.members, lab: new})

    # Orders

    @property
    def orders(self) -> Orders:
        """The current orders."""
        return self.state.orders

    def freeze(self, on: bool) -> None:
        """Stop or resume all labs."""
        with self._lock:
            self.state = replace(self.state, orders=replace(self.orders, frozen=on))
        self.ordered()

    def push(self, push: Push | None, asks: Iterable[str] = ()) -> None:
        """Send a set-up or a step to all members once, and to those who join later.

        It remains in effect until another one is sent or the class ends. None clears it without
        changing any lab; students who join later then keep their own set-up. A step that is sent
        is displayed, too, with its answers hidden: nobody should follow the majority. The votes on
        what it asks are open, and those before are closed.

        Args:
            asks: the items that the class votes on; see `Given.item`.
        """
        with self._lock:
            new = replace(self.orders, pushes=self.orders.pushes + (push is not None), push=push)
            if isinstance(push, TakeStep):
                self.show(Display(push.lesson, push.step))
                self.close(self.open_votes)
                self._ask(push, asks)
                pace = new.pace
                stays = pace is not None and pace.holds(push.lesson, push.step)
                new = replace(new, step=push, pace=pace if stays else None)
            self.state = replace(self.state, orders=new)
        self.ordered()

    def _ask(self, step: TakeStep, items: Iterable[str]) -> None:
        """Open the votes on items of a step; one that was closed stays so, and is only asked again
        after a discussion."""
        votes = [Vote(step.lesson, item, step.step, again=step.again) for item in items]
        known = () if step.again else self.votes
        self._put([e for e in votes if vote_on(known, e.lesson, e.item) is None])

    @property
    def votes(self) -> tuple[Vote, ...]:
        """The votes on the questions that were put to the class."""
        return self.state.votes

    @property
    def open_votes(self) -> tuple[Vote, ...]:
        """The votes that are not closed yet."""
        now = self.now()
        return tuple(each for each in self.votes if each.is_open(now))

    def close(self, votes: Iterable[Vote], wait: float = 0.0) -> None:
        """Close votes: whoever answers after `wait`, [s], is late."""
        closes = self.now() + wait
        with self._lock:
            self._put([replace(each, closes=closes) for each in votes])

    def open_again(self, votes: Iterable[Vote]) -> None:
        """Open votes that were closed by mistake: what was answered meanwhile counts."""
        with self._lock:
            self._put([replace(each, closes=None) for each in votes])
            self.show(replace(self.display, shown=False, revealed=False, since=0.0))

    def _put(self, votes: Sequence[Vote]) -> None:
        """Keep votes in place of earlier ones on the same questions."""
        others = [
            each
            for each in self.votes
            if not any(each.is_about(new.lesson, new.item, new.again) for new in votes)
        ]
        self.state = replace(self.state, votes=(*others, *votes)[-MOST_VOTES:])

    @property
    def display(self) -> Display:
        """What the teachers' pages show now."""
        return self.state.display

    def show(self, display: Display) -> None:
        """Show something else on all teachers' pages."""
        with self._lock:
            self.state = replace(self.state, display=display)

    def keep_within(self, pace: Pace | None) -> None:
        """Keep students within a range of steps; None lets them go anywhere.

        Students outside the range, including those who join later, are brought to its first step.
        Sending a step outside the range ends it.
        """
        with self._lock:
            self.state = replace(self.state, orders=replace(self.orders, pace=pace))

    @property
    def days(self) -> int:
        """For how many days without a change the class is kept; 0 if it is not stored."""
        return min(self.state.days or self.most_days, self.most_days)

    def keep_for(self, days: int) -> None:
        """Delete the class after fewer days without a change than it could be kept."""
        with self._lock:
            self.state = replace(self.state, days=days)

    def end(self) -> int:
        """End the class: remove all members, and return their number. Code and key stay."""
        with self._lock:
            old = self.state
            orders = replace(old.orders, frozen=False, push=None, step=None, pace=None)
            self.claims.clear()
            self.state = replace(old, members={}, orders=orders, display=Display(), votes=())
            return len(old.members)


def seated(members: Mapping[str, Member], lab: str, name: str, new: Member) -> Member:
    """A new or renamed member, with a unique name.

    Args:
        members: current members of the class.
        lab: code of the student's lab.
        name: nickname as typed.
        new: initial record of a student who has not joined yet.

    Raises:
        ValueError: the nickname is empty, or the class is full.
    """
    name, old = cleaned(name), members.get(lab)
    if old is None and len(members) >= MOST_MEMBERS:
        raise CodedError("error.class_full")
    others = {comparison_key(member.name) for code, member in members.items() if code != lab}
    return replace(old or new, name=not_among(others, name))


def _hash(shown: str) -> str:
    return hashlib.sha256(shown[:100].encode(errors="replace")).hexdigest()
