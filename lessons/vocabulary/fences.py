"""The fenced blocks of a lesson: their names, their places, and the faults of misspelt names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import get_close_matches

FENCES = (
    *("step", "scene", "script", "predict", "task", "quiz", "number", "open", "derivation"),
    "equations",
)
"""Blocks of TOML."""
KNOWN = (*FENCES, "watch", "notes", "fold", "when")
LANGUAGES = ("scheme", "opencl", "openscad")
"""Programming languages with names similar to those of blocks."""
FIRST = re.compile(r"[^\W\d_]+")


def fence_faults(info: str) -> Iterator[str]:
    """The fault of a block that would be shown as code although it is meant as one of `KNOWN`.

    Args:
        info: the text after the opening marks (```).
    """
    found = FIRST.match(info.strip())
    word = found[0].lower() if found else ""
    if not word or word in LANGUAGES:
        return
    begun = [name for name in KNOWN if word.startswith(name)]
    for name in begun or get_close_matches(word, KNOWN, 1):
        if info.strip() == name or (re.match(rf"{name}\s", info) and name not in FENCES):
            yield f"block {name!r} stands at the margin, not in a list, quotation, fold or branch"
        elif word == name and name in FENCES and info.startswith(name):
            yield f"unknown block {info.strip()!r}: nothing stands after {name}"
        else:
            yield f"unknown block {info.strip()!r}: did you mean {name}"
