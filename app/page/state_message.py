"""What a page's data channel tells besides samples: names, captions, messages, settings of time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.narration import Said
from onpath.app.viser_adapter.data_channel import VERSION
from onpath.lessons.sides import ROLES, law_text, robot_names, side_titles
from onpath.lessons.words import Words
from onpath.models.control.laws.registry import law_named


def state_message(
    snapshot: PageSnapshot, captions: Mapping[str, str], said: Said, height: float, apart: float
) -> dict[str, Any]:
    """The message of a lab's state, in the page's language; see app/viser_adapter/README.md.

    Args:
        captions: of the robots, by side; see `app.scene.captions.Captions`.
        said: what the page says.
        height: that the canvas shows, see `Page.seen_height`, [m].
        apart: distance between the robots in the picture, [m].
    """
    words, laws, run = Words(snapshot.key.language), snapshot.laws, snapshot.run
    titles = side_titles(laws, words)
    named = robot_names(laws, words)
    names = {side: named[ROLES[side]] for side in laws} if snapshot.key.in_lesson else titles
    return {
        "is": "state",
        "v": VERSION,
        "language": snapshot.key.language,
        "robot": snapshot.key.robot,
        "laws": list(laws.values()),
        "titles": [titles[side] for side in laws],
        "names": [names[side] for side in laws],
        "texts": [law_text(law, words) for law in laws.values()],
        "captions": [captions.get(side, "") for side in laws],
        "clocks": [law_named(law).by_clock for law in laws.values()],
        "stopped": [side in snapshot.stopped for side in laws],
        "rate": run.rate,
        "achieved": round(snapshot.achieved_speed / run.rate, 1) * run.rate,
        "together": run.copy,
        "undo": run.can_undo_going_on,
        "message": snapshot.message,
        "level": snapshot.message_level if snapshot.message else "",
        "said": said,
        "presenting": snapshot.key.presenting,
        "height": round(height, 3),
        "apart": round(apart, 3),
        "frozen": words("class.frozen") if run.frozen else "",
        "own": not snapshot.key.student,
    }
