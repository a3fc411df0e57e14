"""Which characters of a text a reader can see, and which names look alike."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable

MOST_MARKS = 3  # combining marks on one letter; Vietnamese has two, Thai and Hebrew up to three
JOINERS = "\u200d", "\u200c"  # zero-width joiner and non-joiner
SELECTOR = "\ufe0f"  # asks for a symbol in colours
VIRAMA = 9  # canonical combining class of the sign that joins consonants
_KEYCAPS = frozenset("0123456789#*")
_SKINS = frozenset(map(chr, range(0x1F3FB, 0x1F400)))
_FLAGS = frozenset(map(chr, range(0x1F1E6, 0x1F200)))  # two letters are a flag
_BLANK = frozenset("\u2800\U00016fe4\U0001d159")  # drawn, but without ink
_IGNORABLE = (  # Default_Ignorable_Code_Point, beyond those of category C (Unicode 16)
    *(range(0x034F, 0x0350), range(0x115F, 0x1161), range(0x17B4, 0x17B6)),
    *(range(0x180B, 0x1810), range(0x3164, 0x3165), range(0xFE00, 0xFE10)),
    *(range(0xFFA0, 0xFFA1), range(0xE0100, 0xE01F0)),
)


def is_visible(character: str) -> bool:
    """Whether a character alone leaves a mark on the screen; spaces do not."""
    if unicodedata.category(character)[0] in "CZ" or character in _BLANK:
        return False
    return not any(ord(character) in each for each in _IGNORABLE)


def without_surplus_marks(text: str) -> str:
    """The text without combining marks that stand alone, or are too many on one character."""
    kept, marks = list[str](), MOST_MARKS  # at the beginning there is nothing that bears a mark
    for character in text:
        is_mark = unicodedata.category(character)[0] == "M"
        if not is_mark:
            marks = MOST_MARKS if character.isspace() else 0
        elif marks >= MOST_MARKS:
            continue
        else:
            marks += 1
        kept.append(character)
    return "".join(kept)


def readable(text: str, space: Callable[[str], str]) -> str:
    """The visible part of a text, in NFC, with the joiners that scripts and emoji are spelt with.

    A joiner is kept where it has an effect: between two letters or symbols that are not ASCII, and
    after a virama; a variation selector after a symbol or the base of a keycap.

    Args:
        space: returns what replaces an invisible character, such as " " or nothing.
    """
    while (seen := _seen(text, space)) != text:  # omissions change which characters are adjacent
        text = seen
    return text


def _seen(text: str, space: Callable[[str], str]) -> str:
    kept = list[str]()
    for at, character in enumerate(text):
        before, after = kept[-1] if kept else "", text[at + 1 : at + 2]
        if is_visible(character) or _joins(character, before, after):
            kept.append(character)
        elif character not in JOINERS and character != SELECTOR:
            kept.append(space(character))
    return without_surplus_marks(unicodedata.normalize("NFC", "".join(kept)))


def _joins(character: str, before: str, after: str) -> bool:
    if character == SELECTOR:
        return before in _KEYCAPS or unicodedata.category(before or " ")[0] == "S"
    if character not in JOINERS or before <= "\x7f":
        return False
    if unicodedata.combining(before) == VIRAMA:
        return unicodedata.category(after or " ")[0] != "M"
    return before not in JOINERS and after > "\x7f" and unicodedata.category(after)[0] in "LS"


def clusters(text: str) -> list[str]:
    """What readers see as single characters: a letter with its marks, a conjunct, one emoji."""
    result = list[str]()
    for character in text:
        if result and _continues(result[-1], character):
            result[-1] += character
        else:
            result.append(character)
    return result


def _continues(before: str, character: str) -> bool:
    if unicodedata.category(character)[0] == "M" or character in (*JOINERS, *_SKINS):
        return True
    last = before[-1]
    if last == JOINERS[0] or unicodedata.combining(last) == VIRAMA:
        return unicodedata.category(character)[0] in "LS"
    return character in _FLAGS and before in _FLAGS


def shortened(text: str, most: int) -> str:
    """The first `most` clusters of a text, with four code points each at most on average."""
    kept, room = list[str](), 4 * most
    for each in clusters(text)[:most]:
        room -= len(each)
        if room < 0:
            break
        kept.append(each)
    return "".join(kept)


def comparison_key(name: str) -> str:
    """A form in which names that differ only in width, ligatures, joiners or case are equal."""
    plain = "".join(c for c in name if c not in JOINERS and c != SELECTOR)
    return unicodedata.normalize("NFKC", plain).casefold()
