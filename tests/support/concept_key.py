"""What must be in nothing that a student gets before the concept test is over."""

from __future__ import annotations

import re
from collections.abc import Iterable
from html import unescape

from onpath.lessons.concept_test.concept_test import questions
from onpath.lessons.schema import Lesson

TAG = re.compile(r"<[^>]*>")
SPACES = re.compile(r"\s+")


def key_of(forms: Iterable[Lesson]) -> list[str]:
    """Why each option of each question is right or wrong, and at which belief it aims."""
    blocks = [block for form in forms for block in questions(form).values()]
    told = [option.answer for block in blocks for option in block.options]
    return [plain(text) for text in (*told, *(block.misconception for block in blocks))]


def asked_in(forms: Iterable[Lesson]) -> list[str]:
    """The questions."""
    return [plain(block.question) for form in forms for block in questions(form).values()]


def plain(text: str) -> str:
    """A text without tags, entities, escapes and line breaks."""
    bare = unescape(unescape(TAG.sub("", text))).replace('\\"', '"').replace("\\n", " ")
    return SPACES.sub(" ", bare).strip()


def found_in(texts: Iterable[str], received: str) -> list[str]:
    """Which of some plain texts are in something that was received."""
    bare = plain(received)
    return [text for text in texts if text in bare]
