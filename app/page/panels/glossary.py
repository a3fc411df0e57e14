"""The glossary in the window of the help."""

from __future__ import annotations

from onpath.app.common.templates import render
from onpath.lessons.glossary import glossary
from onpath.lessons.words import Words


def glossary_html(words: Words) -> str:
    """Both directions of the glossary, each folded: in the lessons' order, and alphabetically."""
    entries = glossary(words.language)
    back = sorted(entries, key=lambda entry: entry.term.casefold())
    return render(
        "panel/glossary.html",
        plain=[(entry.plain, entry.term, entry) for entry in entries],
        terms=[(entry.term, entry.plain, entry) for entry in back],
        words=words,
    )
