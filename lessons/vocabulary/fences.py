"""The names of a lesson's fenced blocks, and the answer to one that is nearly such a name."""

from __future__ import annotations

import re
from collections.abc import Iterator
from difflib import get_close_matches

FENCES = ("step", "scene", "script", "predict", "task", "quiz", "number", "open")
"""Blocks of TOML."""
KNOWN = (*FENCES, "fold", "when")
LANGUAGES = ("scheme", "opencl", "openscad")
"""Languages of code whose names are like those of blocks."""
FIRST = re.compile(r"[^\W\d_]+")


def fence_faults(info: str) -> Iterator[str]:
    """The fault of a fence that would be shown as code, and is not meant so.

    Args:
        info: what stands after the marks that begin it.
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
