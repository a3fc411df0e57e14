"""Which characters of a text a reader can see, and what names look alike."""

from __future__ import annotations

import unicodedata

MOST_MARKS = 3  # combining marks on one letter; Vietnamese has two, Thai and Hebrew up to three
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


def comparison_key(name: str) -> str:
    """A form in which names are equal that differ in width, ligatures or case alone."""
    return unicodedata.normalize("NFKC", name).casefold()
