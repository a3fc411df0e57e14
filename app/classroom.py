"""A class: who is in it, what the teacher wants, who may teach. No viser in it; any thread.

What a class is stands in `Classroom` alone, behind a few methods that exchange immutable records
under session codes: one that keeps them in a database serves several processes.
"""

from __future__ import annotations

import hmac
import secrets
import threading
import time
import unicodedata
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from app.class_commands import TakeSetup, TakeStep
from app.codes import ALPHABET, new_code, normalised
from lessons.progress import Progress

LONGEST_NAME = 24  # [characters]
CODE_LENGTH = 4  # of a class code: short enough for a projector
MOST_MEMBERS = 300
TRIES, WITHIN = 5, 60.0  # wrong codes that one lab may type in so many seconds
ALL_TRIES = 1000  # the same, of all labs together: 59 bits stay secret, no one locks others out
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
        taken: number of the last push that the lab has taken.
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
        push: the last one.
    """

    frozen: bool = False
    pushes: int = 0
    push: Push | None = None


class Throttle:
    """Counts failures, and refuses who has too many of them.

    Args:
        most: failures by one, within a time, [s].
        most_of_all: by everybody together.
    """

    def __init__(
        self,
        clock: Callable[[], float] = time.monotonic,
        most: int = TRIES,
        most_of_all: int = ALL_TRIES,
    ) -> None:
        self._clock, self._most, self._most_of_all = clock, most, most_of_all
        self._failures: list[tuple[float, str]] = []

    def check(self, who: str) -> None:
        """Pass, or not.

        Raises:
            ValueError: not now; the right code is refused as well.
        """
        since = self._clock() - WITHIN
        self._failures = [failure for failure in self._failures if failure[0] > since]
        own = sum(failed == who for _, failed in self._failures)
        if own >= self._most or len(self._failures) >= self._most_of_all:
            raise ValueError("too many wrong codes: wait a minute")

    def count(self, who: str) -> None:
        """One failure more."""
        self._failures.append((self._clock(), who))


@dataclass(slots=True)
class Classroom:
    """One class.

    Attributes:
        code: what students type to join.
        key: what the teacher types, as `app.codes` keeps it.
    """

    clock: Callable[[], float] = time.monotonic
    code: str = ""
    key: str = field(default_factory=new_code, repr=False)
    _members: dict[str, Member] = field(default_factory=dict)
    _orders: Orders = Orders()
    _joined: int = 0
    _passes: set[str] = field(default_factory=set)
    _lock: threading.RLock = field(default_factory=threading.RLock)
    _throttle: Throttle = field(init=False)

    def __post_init__(self) -> None:
        self.code = self.code or _new_class_code()
        self._throttle = Throttle(self.clock)

    # Who may teach

    def admit(self, typed: str, who: str) -> str:
        """A pass for a teacher's browser, for the key.

        Args:
            who: who types it: a session code.

        Raises:
            ValueError: this is not the key, or there have been too many that were not.
        """
        try:
            key = normalised(typed)
        except ValueError:
            key = ""
        self._check(key, self.key, who, "this is not the teacher's key")
        new = secrets.token_urlsafe(18)
        with self._lock:
            self._passes.add(new)
        return new

    def is_pass(self, shown: str | None) -> bool:
        """Whether a browser may teach."""
        given = (shown or "")[:100].encode(errors="replace")
        with self._lock:
            return any([hmac.compare_digest(given, own.encode()) for own in self._passes])

    def revoke(self, shown: str | None) -> None:
        """A browser teaches no more."""
        with self._lock:
            self._passes.discard(shown or "")

    def _check(self, typed: str, right: str, who: str, refusal: str) -> None:
        with self._lock:
            self._throttle.check(who)
            if not hmac.compare_digest(typed.encode(errors="replace"), right.encode()):
                self._throttle.count(who)
                raise ValueError(refusal)

    # Who is in it

    def join(self, session: str, typed: str, name: str) -> Member:
        """A student comes in; one who is in already takes another nickname.

        Args:
            session: code of the student's lab.
            typed: the class code.

        Raises:
            ValueError: a wrong code or too many of them, no nickname, or the class is full.
        """
        code = "".join(typed[:40].split()).lower()
        self._check(code, self.code, session, "this is not the class code on the projector")
        name = cleaned(name)
        with self._lock:
            old = self._members.get(session)
            if old is None and len(self._members) >= MOST_MEMBERS:
                raise ValueError("this class is full")
            others = {m.name.casefold() for s, m in self._members.items() if s != session}
            name = _not_among(others, name)
            if old is None:
                self._joined += 1
                taken = self._orders.pushes
                old = Member(self._joined, name, active=self.clock(), taken=taken)
            self._members[session] = member = replace(old, name=name)
            return member

    def leave(self, session: str) -> None:
        """A student goes, and with it all that the class knew."""
        with self._lock:
            self._members.pop(session, None)

    def member(self, session: str) -> Member | None:
        """The student of a lab."""
        return self._members.get(session)

    def members(self) -> dict[str, Member]:
        """All students by session code, in the order in which they joined."""
        with self._lock:
            return dict(self._members)

    def note(self, session: str, **changes: object) -> None:
        """What has changed of a student; nothing happens when it has left."""
        with self._lock:
            old = self._members.get(session)
            if old is not None:
                self._members[session] = replace(old, **changes)  # pyright: ignore[reportArgumentType]

    # What the teacher wants

    @property
    def orders(self) -> Orders:
        """What holds now."""
        return self._orders

    def freeze(self, on: bool) -> None:
        """All labs stand still, or go on."""
        with self._lock:
            self._orders = replace(self._orders, frozen=on)

    def push(self, push: Push) -> None:
        """Send all who are in the class a set-up or a step; who comes later has it not."""
        with self._lock:
            self._orders = replace(self._orders, pushes=self._orders.pushes + 1, push=push)

    def end(self) -> int:
        """The class is over: nobody is in it, and another code opens the next one.

        Returns how many were in it.
        """
        with self._lock:
            count = len(self._members)
            self._members.clear()
            self._orders = replace(self._orders, frozen=False, push=None)
            self.code = _new_class_code()
            return count


def cleaned(name: str) -> str:
    """A nickname as it is kept.

    Raises:
        ValueError: nothing is left of it.
    """
    text = unicodedata.normalize("NFC", name[:200])
    seen = "".join(c if unicodedata.category(c)[0] not in "CZ" else " " for c in text)
    short = " ".join(seen.split())[:LONGEST_NAME].strip()
    if not short:
        raise ValueError("a nickname has at least one character")
    return short


def _not_among(others: set[str], name: str) -> str:
    """A name with a number, where somebody else has it already."""
    count, unique = 1, name
    while unique.casefold() in others:
        count += 1
        tail = f" {count}"
        unique = name[: LONGEST_NAME - len(tail)].rstrip() + tail
    return unique


def _new_class_code() -> str:
    return "".join(secrets.choice(ALPHABET) for _ in range(CODE_LENGTH))
