"""Who may come into a class: wrong codes are counted, nicknames made fit to be shown."""

from __future__ import annotations

import hmac
import secrets
import threading
import time
import unicodedata
from collections.abc import Callable

from app.codes import ALPHABET, normalised

LONGEST_NAME = 24  # [characters]
CODE_LENGTH = 4  # of a class code: short enough for a projector
TRIES, WITHIN = 5, 60.0  # wrong codes that one lab may type in so many seconds
ALL_TRIES = 1000  # the same, of all labs together: 59 bits stay secret, no one locks others out


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


class Door:
    """Compares what was typed with what is right, for who has not failed too often; any thread."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._throttle, self._lock = Throttle(clock), threading.Lock()

    def check_key(self, typed: str, key: str, who: str) -> None:
        """Pass, with the teacher's key.

        Args:
            key: as `app.codes` keeps it.
            who: who types: a session code.

        Raises:
            ValueError: this is not the key, or there have been too many that were not.
        """
        try:
            given = normalised(typed)
        except ValueError:
            given = ""
        self._check(given, key, who, "this is not the teacher's key")

    def check_code(self, typed: str, code: str, who: str) -> None:
        """Pass, with the class code; see `check_key`."""
        given = "".join(typed[:40].split()).lower()
        self._check(given, code, who, "this is not the class code on the projector")

    def _check(self, typed: str, right: str, who: str, refusal: str) -> None:
        with self._lock:
            self._throttle.check(who)
            if not hmac.compare_digest(typed.encode(errors="replace"), right.encode()):
                self._throttle.count(who)
                raise ValueError(refusal)


def new_pass() -> str:
    """What a teacher's browser keeps and shows."""
    return secrets.token_urlsafe(18)


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


def not_among(others: set[str], name: str) -> str:
    """A name with a number, where somebody else has it already."""
    count, unique = 1, name
    while unique.casefold() in others:
        count += 1
        tail = f" {count}"
        unique = name[: LONGEST_NAME - len(tail)].rstrip() + tail
    return unique


def new_class_code() -> str:
    """What students type."""
    return "".join(secrets.choice(ALPHABET) for _ in range(CODE_LENGTH))
