"""Codes that people note down, send and type: of a lab, of a class, a teacher's key.

Word processors, mail programs and phones change what passes through them: dashes, widths, quotes,
invisible characters, wrapped lines. `as_meant` undoes that, for share codes too.
"""

from __future__ import annotations

import re
import secrets
import unicodedata
from functools import lru_cache

from onpath.app.common.visible_text import is_visible, without_surplus_marks
from onpath.models.errors import CodedError

ALPHABET = "23456789abcdefghjkmnpqrstuvwxyz"  # no characters that are easily confused
LENGTH, GROUP = 12, 4  # 59 bits, which cannot be guessed
LONGEST_TYPED = 1000  # part of a text that is searched for a code, [characters]
_DASHES = frozenset("\u2212\u2043\u02d7\u30fc\u2500")  # besides those of category Pd
_EXAMPLE = "k7mf2xqa9tzr"
_GAP = r"[^a-z0-9-]*"
_SHOWN = re.compile(
    rf"(?<![a-z0-9-])[{ALPHABET}]{{{LENGTH}}}(?![a-z0-9-])"
    rf"|(?<![a-z0-9-])[{ALPHABET}]{{{GROUP}}}"
    rf"(?:{_GAP}-{_GAP}[{ALPHABET}]{{{GROUP}}}){{{LENGTH // GROUP - 1}}}(?![a-z0-9-])"
)


def new_code() -> str:
    """A random code in its stored form: lower case, without separators."""
    return "".join(secrets.choice(ALPHABET) for _ in range(LENGTH))


def shown(code: str) -> str:
    """A code in its displayed form, "abcd-efgh-jkmn"."""
    return "-".join(code[i : i + GROUP] for i in range(0, LENGTH, GROUP))


def as_meant(text: str) -> str:
    """A text in which all dashes, widths and blanks are plain, and nothing is invisible.

    Anything but an ASCII letter or digit, a dash or a blank, such as a quote or a bracket, becomes
    "|". Surplus marks are removed first: normalisation takes time quadratic in their number.
    """
    return "".join(map(_plain, unicodedata.normalize("NFKC", without_surplus_marks(text))))


@lru_cache(maxsize=1024)  # one letter may stand for 18 others, and a text be full of them
def _plain(character: str) -> str:
    if character.isspace():
        return " "
    if character.isascii() and character.isalnum():
        return character
    if character in _DASHES or unicodedata.category(character) == "Pd":
        return "-"
    return "|" if is_visible(character) else ""


def normalised(text: str) -> str:
    """The stored form of a code that a user typed or pasted, possibly with words around it.

    Raises:
        ValueError: it is not a code, or there are several.
    """
    plain = as_meant(text[:LONGEST_TYPED]).lower()
    code = _letters(plain)
    if len(code) != LENGTH:
        codes = {_letters(each) for each in _SHOWN.findall(plain)}
        if len(codes) != 1:
            raise CodedError("error.lab_code_length", length=LENGTH, example=shown(_EXAMPLE))
        (code,) = codes
    strange = sorted(set(code) - set(ALPHABET))
    if strange:
        raise CodedError("error.lab_code_letters", example=shown(_EXAMPLE))
    return code


def short_code(text: str, length: int) -> str:
    """The stored form of a code of `length` characters without groups; see `normalised`.

    If several words might be the code, it is the one in capitals or with a digit; if that does not
    decide, the result is all letters and digits of the text, which are no code.
    """
    plain = as_meant(text[:LONGEST_TYPED])
    whole = _letters(plain.lower())
    words = {word for word in re.findall(r"[A-Za-z0-9]+", plain) if len(word) == length}
    fit = {word for word in words if set(word.lower()) <= set(ALPHABET)}
    clear = {word.lower() for word in fit if word.isupper() or not word.isalpha()}
    candidates = {word.lower() for word in fit}
    for each in (candidates, clear):
        if len(whole) != length and len(each) == 1:
            return each.pop()
    return whole


def _letters(plain: str) -> str:
    return re.sub(r"[^A-Za-z0-9]+", "", plain)


def is_code(text: str) -> bool:
    """Whether a text is a code as `normalised` accepts it."""
    try:
        normalised(text)
    except ValueError:
        return False
    return True
