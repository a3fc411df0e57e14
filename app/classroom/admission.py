"""Who may come into a class: wrong codes are counted, nicknames made fit to be shown."""

from __future__ import annotations

import hmac
import secrets
import time
import unicodedata
from collections.abc import Callable

from onpath.app.common.access_codes import ALPHABET, normalised
from onpath.app.common.throttle import Throttle
from onpath.models.errors import CodedError

LONGEST_NAME = 24  # [characters]
CODE_LENGTH = (
    6  # of a class code: short enough for a projector, too long to be guessed; see `Admission`
)


class Admission:
    """Compares what was typed with what is right, for who has not failed too often; any thread.

    A tab that has failed too often is told to wait, with the right code as well. Other tabs are
    not, however many have failed: behind one address there may be a whole school, and before one
    there may be a proxy, so that a limit of all or of an address would let one student lock the
    class out. The class code and the teacher's key are counted apart.

    So the guesses of a minute are `TRIES` times the tabs that somebody opens in it, each of them
    a connection and a page to be built: about 340 tabs, 1700 guesses, a minute and process where
    pages are built as fast as they can be. That is why a class code is as long as it is: of its
    31^6 = 8.9e8 possibilities, 1700 guesses a minute find one with a chance of 0.02 % in a lesson
    of 90 minutes (17 % of the 31^4 that four characters have), and it opens a seat that the
    teacher sees. The key has 31^12 = 7.9e17 possibilities.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._codes, self._keys = Throttle(clock), Throttle(clock)

    def check_key(self, typed: str, key: str, who: str) -> None:
        """Pass, with the teacher's key.

        Args:
            key: as `app.common.access_codes` keeps it.
            who: who types: a session code.

        Raises:
            ValueError: this is not the key, or there have been too many that were not.
        """
        try:
            given = normalised(typed)
        except ValueError:
            given = ""
        with self._keys.attempt(who):
            _compare(given, key, CodedError("error.not_the_key"))

    def check_code(self, typed: str, code: str, who: str) -> None:
        """Pass, with the class code; see `check_key`."""
        given = "".join(typed[:40].split()).lower()
        with self._codes.attempt(who):
            _compare(given, code, CodedError("error.not_the_class_code"))


def _compare(typed: str, right: str, refusal: CodedError) -> None:
    """In a time that does not tell how much is right."""
    if not hmac.compare_digest(typed.encode(errors="replace"), right.encode()):
        raise refusal


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
        raise CodedError("error.no_nickname")
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
