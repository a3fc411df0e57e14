"""The messages of the player of a step, wherever it is played; see assets/web/parts/step.ts."""

from __future__ import annotations

from onpath.lessons.words import Words

_PLAIN = (
    *("lesson.playing", "lesson.replay", "lesson.play", "lesson.skip_run", "lesson.predict_before"),
    *(
        "lesson.right",
        "lesson.not_quite",
        "lesson.once_more",
        "lesson.no_number",
        "answer.check",
        "answer.keep",
        "answer.before",
        "answer.price",
        "sketch.looked_for",
        "sketch.own",
        "sketch.run",
        "sketch.seen",
        "sketch.unseen",
        "answer.price_followed",
        "answer.price_second",
        "answer.carried",
        "answer.line",
        "formula.missing",
        "formula.between",
        "formula.bracket",
        "formula.unclear",
    ),
    *("answer.sending", "answer.sent"),
    *("lesson.committed", "lesson.drawn", "lesson.skipped", "lesson.passed", "report.right"),
    "lesson.happened",
    *(
        "site.draw_first",
        "site.draw_keys",
        "site.skipped",
        "site.again",
        "site.link_only_lab",
        "site.symbols",
    ),
)
_FILLED = {
    "chart.point": ("time",),
    "formula.refused": ("place", "reason"),
    "formula.exponent": ("most",),
    "formula.function": ("name",),
    "formula.unknown": ("names",),
    "formula.long": ("most",),
    "site.sketch": ("quantity", "unit", "seconds"),
}
"""Messages whose values the page fills in."""


def player_words(words: Words) -> dict[str, str]:
    """Key -> text of every message."""
    return {key: words(key) for key in _PLAIN} | words.unfilled(_FILLED)
