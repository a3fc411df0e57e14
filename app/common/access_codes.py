"""Session codes that a student can note down and enter elsewhere."""

from __future__ import annotations

import re
import secrets

from onpath.models.errors import CodedError

ALPHABET = "23456789abcdefghjkmnpqrstuvwxyz"  # nothing that looks like something else
LENGTH, GROUP = 12, 4  # 59 bits: not to be guessed
_BETWEEN = re.compile(r"[\s.,_\-\u2010-\u2015]+")


def new_code() -> str:
    """A code as it is kept: lower case, in one piece."""
    return "".join(secrets.choice(ALPHABET) for _ in range(LENGTH))


def shown(code: str) -> str:
    """A code as it is shown, "abcd-efgh-jkmn"."""
    return "-".join(code[i : i + GROUP] for i in range(0, LENGTH, GROUP))


def normalised(text: str) -> str:
    """A code as it is kept, from what somebody typed.

    Raises:
        ValueError: it is no code.
    """
    code = _BETWEEN.sub("", text[:100]).lower()
    if len(code) != LENGTH:
        raise CodedError("error.session_code_length", length=LENGTH, example=shown(_EXAMPLE))
    strange = sorted(set(code) - set(ALPHABET))
    if strange:
        raise CodedError("error.session_code_letters", example=shown(_EXAMPLE))
    return code


_EXAMPLE = "k7mf2xqa9tzr"
