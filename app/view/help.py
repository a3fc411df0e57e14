"""The glossary, for the help."""

from __future__ import annotations

from onpath.app.channel.sheet_messages import GlossaryEntry, HelpSheet
from onpath.lessons.glossary import glossary
from onpath.lessons.words import Words


def help_sheet(words: Words) -> HelpSheet:
    """The glossary in the lessons' order."""
    return HelpSheet(
        glossary=[
            GlossaryEntry(
                plain=entry.plain,
                term=entry.term,
                means=entry.means,
                lesson=words("glossary.lesson", number=entry.lesson),
            )
            for entry in glossary(words.language)
        ]
    )
