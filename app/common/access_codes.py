"""Session codes, which a student can note down and enter on another machine."""

from __future__ import annotations

import re
import secrets

from onpath.models.errors import CodedError

ALPHABET = "23456789abcdefghjkmnpqrstuvwxyz"  # no characters that are easily confused
LENGTH, GROUP = 12, 4  # 59 bits, which cannot be guessed
_BETWEEN = re.compile(r"[\s.,_\-\u2010-\u2015]+")


def new_code() -> str:
    """A random code in its stored form: lower case, without separators."""
    return "".join(secrets.choice(ALPHABET) for _ in range(LENGTH))


def shown(code: str) -> str:
    """A code in its displayed form, "abcd-efgh-jkmn"."""
    return "-".join(code[i : i + GROUP] for i in range(0, LENGTH, GROUP))


def normalised(text: str) -> str:
    """The stored form of a code that a user typed.

    Raises:
        ValueError: it is not a code.
    """
    code = _BETWEEN.sub("", text[:100]).lower()
    if len(code) != LENGTH:
        raise CodedError("error.session_code_length", length=LENGTH, example=shown(_EXAMPLE))
    strange = sorted(set(code) - set(ALPHABET))
    if strange:
        raise CodedError("error.session_code_letters", example=shown(_EXAMPLE))
    return code


def is_code(text: str) -> bool:
    """Whether a text is a code as `normalised` accepts it."""
    try:
        normalised(text)
    except ValueError:
        return False
    return True


_EXAMPLE = "k7mf2xqa9tzr"
