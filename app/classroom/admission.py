"""Admission to a class: limits failed attempts at codes and keys, and cleans nicknames."""

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

LONGEST_NAME = 24  # [visible characters] of a student's name
LONGEST_ID = 200  # [characters] of what identifies a student elsewhere
SHORTEST_WORD = 6
WORD_DIGITS = 16  # hexadecimal ones, of the hash of a word
CODE_LENGTH = 6
"""Of a class code: short enough for a projector, long enough not to be guessed; see `Admission`."""


class Admission:
    """Checks codes and keys, with a limit on failures per tab. Thread-safe.

    A tab that has failed too often must wait, even with the right code. Other tabs are not
    affected: a whole school may share one address, and so may all users of a proxy, so that a limit
    in total or per address would let one student lock out the class. Failures with the class code
    and with the teacher's key are counted separately.

    An attacker therefore has `TRIES` guesses for each tab opened. A process builds the pages of
    about 340 tabs a minute, which makes 1700 guesses a minute. In a lesson of 90 minutes, these
    find one of the 31^6 = 8.9e8 class codes with a probability of 0.02 % (it would be 17 % with
    four characters), and whoever finds it gets a seat that the teacher sees. There are
    31^12 = 7.9e17 keys.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._codes, self._keys = Throttle(clock), Throttle(clock)

    def check_key(self, typed: str, keys: Iterable[str], who: str) -> str:
        """Check a teacher's key; return the one that matches.

        Args:
            typed: the text entered.
            keys: valid keys, in the stored form of `app.common.access_codes`.
            who: lab code of the tab.

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
    """A nickname as it is stored: its visible characters, in NFC.

    Each character keeps at most `MOST_MARKS` combining marks.

    Raises:
        ValueError: no visible character remains.
    """
    short = shortened(" ".join(readable(name[:200], lambda _: " ").split()), LONGEST_NAME).strip()
    if not short:
        raise CodedError("error.no_nickname")
    return short


def identified(typed: str) -> str:
    """What identifies a student elsewhere, as it is stored; it may be empty."""
    return "".join(each for each in typed[:LONGEST_ID] if each.isprintable()).strip()


def word_hash(key: str, word: str) -> str:
    """The keyed hash of a word that a student makes up; empty without a word.

    Whoever does not know the teacher's key cannot tell which words have a hash. Capitals and
    blanks do not count, so that a word is the same months later.

    Raises:
        ValueError: the word is too short.
    """
    plain = comparison_key(word[:LONGEST_ID]).replace(" ", "")
    if not plain:
        return ""
    if len(plain) < SHORTEST_WORD:
        raise CodedError("error.word_too_short", least=SHORTEST_WORD)
    return hmac.new(key.encode(), f"word {plain}".encode(), "sha256").hexdigest()[:WORD_DIGITS]


def not_among(others: set[str], name: str) -> str:
    """The name, with a number appended if it is taken.

    Args:
        others: comparison keys of the other names, from `comparison_key`.
    """
    count, unique = 1, name
    while comparison_key(unique) in others:
        count += 1
        tail = f" {count}"
        unique = shortened(name, LONGEST_NAME - len(tail)).rstrip() + tail
    return unique


def class_code_of(key: str) -> str:
    """The class code that belongs to a teacher's key, the same in every process.

    Trying a key takes a twentieth of a second, and about 9e8 keys share each code.
    """
    number, digits = int.from_bytes(_derived(key, b"onpath class code"), "big"), []
    for _ in range(CODE_LENGTH):
        number, digit = divmod(number, len(ALPHABET))
        digits.append(ALPHABET[digit])
    return "".join(digits)


def class_id_of(key: str) -> str:
    """The identifier of a class in the database, which does not reveal the key."""
    return _derived(key, b"onpath").hex()


def _derived(key: str, purpose: bytes) -> bytes:
    return hashlib.scrypt(key.encode(), salt=purpose, n=2**14, r=8, p=1, dklen=20)
