"""The messages of our own part of the lab's page; see assets/web/pages/lab.ts."""

from __future__ import annotations

from functools import cache

from onpath.app.channel.file_inbox import MOST_BYTES, MOST_LOG_BYTES
from onpath.app.channel.messages import WordsMessage, encoded
from onpath.app.steps.player_words import player_words
from onpath.app.view.first_minute import INVITATIONS
from onpath.app.view.forms import form_words
from onpath.app.view.shell_words import FILLED, SHELL
from onpath.lessons.words import Words

CHART = (
    *("chart.title", "chart.held", "chart.pulled", "chart.centre", "chart.table", "chart.time"),
    *("chart.acts", "chart.look", "chart.look_hint", "chart.yours", "chart.draw"),
    "chart.pending",
    *("chart.log", "chart.remove_log"),
    *("plots.menu", "plots.menu_hint", "plot.phase", "plot.phase_name"),
)
"""Messages of the plots, which figures and lessons have."""
_PLAIN = (
    *CHART,
    "chart.first",
    *("lens.closest", "lens.reference", "lens.straight"),
    *("run.hold_both", "run.hold", "run.let_both_go", "run.let_go", "run.hold_hint"),
    *("run.run", "run.pause", "run.run_hint", "run.rate", "plots.time", "plots.time_hint"),
    *("run.step", "run.reset", "key.right", "key.reset"),
    *("past.go_on", "past.undo", "past.undo_hint"),
    *("transport.go_on_hint", "transport.back", "transport.back_hint"),
    *("lesson.lessons", "help.close"),
    *("breakdown.slowly", "breakdown.end", "breakdown.reset", "invite.skip"),
    *(f"invite.{invitation.name}" for invitation in INVITATIONS),
    *(f"invite.{each.explained}" for each in INVITATIONS if each.explained),
    *(
        "page.scene",
        "stage.paused",
        "invite.lesson_button",
    ),
    *("remote.title", "remote.plain"),
    *("plant.name", "plant.start", "plant.start_hint", "plant.stop", "plant.stop_hint"),
    *("plant.at_fault", "plant.zero", "plant.hold", "plant.damp", "plant.safety"),
    "plant.watching",
    *SHELL,
)
_FILLED = {
    "chart.at": ("time", "values"),
    "stage.building": ("robot",),
    "stage.past": ("time",),
    "lens.name": ("law",),
    "readout.running": ("time", "speed"),
    "readout.paused": ("time", "speed"),
    **FILLED,
}
"""Messages whose values the page fills in."""


@cache
def words_message(language: str) -> bytes:
    """The message with the texts of a language: key -> text of every message."""
    words = Words(language)
    messages = player_words(words) | {key: words(key) for key in _PLAIN}
    messages |= words.unfilled(_FILLED)
    messages["log.hint"] = words("log.hint", most=f"{MOST_LOG_BYTES / 1e6:g}")
    messages["design.upload_hint"] = words("design.upload_hint", most=f"{MOST_BYTES / 1e6:g}")
    texts = messages | form_words(words)
    return encoded(WordsMessage(language, texts))
