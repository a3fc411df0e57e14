"""Admission to a class: limits wrong codes, and cleans nicknames."""

from __future__ import annotations

import hashlib
import hmac
import secrets
import time
from collections.abc import Callable, Iterable

from onpath.app.common.access_codes import ALPHABET, normalised, short_code
from onpath.app.common.throttle import Throttle
from onpath.app.common.visible_text import comparison_key, readable, shortened
from onpath.models.errors import CodedError

LONGEST_NAME = 24  # [characters that are seen as one]
CODE_LENGTH = (
    6  # of a class code: short enough for a projector, long enough not to be guessed; `Admission`
)


class Admission:
    """Checks codes and keys, with a limit on failures per tab. Thread-safe.

    A tab that has failed too often must wait, even with the right code. Other tabs are not
    affected: a whole school may share one address, and so may all users of a proxy, so that a limit
    in total or per address would let one student lock out the class. Failures with the class code
    and with the teacher's key are counted separately.

    The guesses per minute are thus `TRIES` times the number of tabs that somebody opens in it. Each
    is a connection and a page that is built: about 340 tabs, hence 1700 guesses, per minute and
    process. Of the 31^6 = 8.9e8 class codes, 1700 guesses a minute find the right one with a
    probability of 0.02 % in a lesson of 90 minutes (17 % of 31^4, with four characters), and it
    opens a seat that the teacher sees. There are 31^12 = 7.9e17 keys.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._codes, self._keys = Throttle(clock), Throttle(clock)

    def check_key(self, typed: str, keys: Iterable[str], who: str) -> str:
        """Check a teacher's key; returns the one that was entered.

        Args:
            typed: what was entered.
            keys: in their stored form, see `app.common.access_codes`.
            who: session code of the tab.

        Raises:
            ValueError: the key is wrong, or this tab has failed too often.
        """
        try:
            given = normalised(typed)
        except ValueError:
            given = ""
        with self._keys.attempt(who):
            return _found(given, keys, CodedError("error.not_the_key"))

    def check_code(self, typed: str, codes: Iterable[str], who: str) -> str:
        """Check a class code; see `check_key`."""
        given = short_code(typed, CODE_LENGTH)
        with self._codes.attempt(who):
            return _found(given, codes, CodedError("error.not_the_class_code"))


def _found(typed: str, right: Iterable[str], refusal: CodedError) -> str:
    """Compare in constant time, so that timing does not reveal partial matches."""
    given = typed.encode(errors="replace")
    found = [each for each in right if hmac.compare_digest(given, each.encode())]
    if not found:
        raise refusal
    return found[0]


def new_pass() -> str:
    """A random pass, which a teacher's browser stores and presents."""
    return secrets.token_urlsafe(18)


def cleaned(name: str) -> str:
    """A nickname in the form in which it is stored: what can be seen of it, in NFC.

    At most `MOST_MARKS` combining marks are kept on one character.

    Raises:
        ValueError: no visible character remains.
    """
    short = shortened(" ".join(readable(name[:200], lambda _: " ").split()), LONGEST_NAME).strip()
    if not short:
        raise CodedError("error.no_nickname")
    return short


def not_among(others: set[str], name: str) -> str:
    """The name, with a number appended if it is taken.

    Args:
        others: names of the others, as `comparison_key` has them.
    """
    count, unique = 1, name
    while comparison_key(unique) in others:
        count += 1
        tail = f" {count}"
        unique = shortened(name, LONGEST_NAME - len(tail)).rstrip() + tail
    return unique


def new_class_code() -> str:
    """A random class code."""
    return "".join(secrets.choice(ALPHABET) for _ in range(CODE_LENGTH))


def class_code_of(key: str) -> str:
    """The class code that belongs to a teacher's key, the same in every process.

    Whoever tries keys needs a twentieth of a second for each, and 2^29 of them have the same code.
    """
    number, digits = int.from_bytes(_derived(key, b"onpath class code"), "big"), []
    for _ in range(CODE_LENGTH):
        number, digit = divmod(number, len(ALPHABET))
        digits.append(ALPHABET[digit])
    return "".join(digits)


def class_id_of(key: str) -> str:
    """The name of a class in the database, which does not reveal the key."""
    return _derived(key, b"onpath").hex()


def _derived(key: str, purpose: bytes) -> bytes:
    return hashlib.scrypt(key.encode(), salt=purpose, n=2**14, r=8, p=1, dklen=20)
