"""Gestures that pass every task of the course."""

from __future__ import annotations

import html
import re

from onpath.lessons.task_schema import Task
from tests.support.browser import Tab
from tests.support.hands import Choose, DragBall, Enter, Gesture, Key, Press, Pull, Slide, Wait

HOLD, LET_GO, RESET = Press("Hold both back"), Press("Let both go"), Press("Reset")
TWO_BULGES = (DragBall((0, 50), (0, 65)), DragBall((0, -50), (0, -65)))
TWO_HOLDS = (HOLD, Wait(2.2), LET_GO, Wait(2), HOLD, Wait(2.2), LET_GO, Wait(3.2))
FOUR_PLACES = 4 * (Key("h"), Wait(2.6), Key("h"), Wait(0.4))
"""Holds that catch the arm somewhere; three of four places are good."""

# In the order of the course; there is no reset between the tasks of one step.
SOLUTIONS: dict[str, dict[str, tuple[Gesture, ...]]] = {
    "01-path-or-timetable": {
        "hold-two-seconds": (Enter("K1", 600), Enter("K2", 50), Key("h"), Wait(3), Key("h")),
        "thirty-times": (Enter("K1", 800), Enter("K2", 57), Enter("K5", 5), HOLD, Wait(3), LET_GO),
        "push-across": (Key("d", 6), Wait(1), Key("x"), Wait(2)),
    },
    "01b-let-the-clock-wait": {
        "wait-in-time": (Enter("Clock waits", 80), *FOUR_PLACES),
        "throw-it-off": (Enter("Speed", 10), Wait(2), Enter("Speed", -10), Wait(2)),
        "keep-it-on": (
            *(Enter("Speed", 6.3), Enter("Speed ramp", 20), RESET),
            *(Wait(2), Enter("Speed", -6.3), Wait(2)),
        ),
    },
    "02-what-is-the-error": {
        "half-a-round-late": (RESET, Wait(1), HOLD, Wait(1.9), LET_GO, Wait(2)),
        "the-other-side": (Pull(-70, 0, seconds=1), Wait(2)),
        "deeper-than-deep": (Enter("Target", 90), Wait(2), Key("s", 12), Wait(0.5), Key("x")),
    },
    "03-the-five-bar": {
        "dear": (DragBall((35, 35), (67, 67)), Wait(3)),
        "cheap": (Press("the circle"), DragBall((-35, 35), (-67, 67)), Wait(3)),
        "carry": (Enter("K1", 1600), Enter("K2", 80), Enter("K5", 30), Wait(4)),
    },
    "04-across-and-along": {
        "rail": (Enter("K1", 900), Enter("K2", 60), RESET, Key("w", 5), Wait(2), Key("x")),
        "spring-board": (
            *(Enter("K1", 100), Enter("K2", 20), Enter("K4", 400), Enter("K5", 40)),
            *(RESET, Key("d", 4), Wait(1), Key("x"), Wait(2)),
        ),
    },
    "04b-poles-and-gains": {
        "no-overshoot": (
            *(Enter("K4", 100), Enter("K5", 20), RESET),
            *(Key("w", 6), Wait(1), Key("x"), Wait(2)),
        ),
        "enough": (Wait(5), Enter("K1", 900), Enter("K2", 60), RESET, Wait(4)),
    },
    "05-invariance": {
        "tour": (
            *(RESET, Enter("K4", 100), Enter("K5", 20)),
            *(Slide("Target", 178, near=3), Wait(2), Slide("Target", 0, near=3), Wait(2)),
        ),
        "obstruction": (
            *(Press("run round the circle"), Enter("K1", 2000), Enter("K2", 90), RESET),
            *(Wait(1), HOLD, Wait(2.2), LET_GO, Wait(2)),
        ),
    },
    "06-exact-cancellation": {
        "quiet-and-close": (Enter("K3", 2000), RESET, Wait(5)),
        "excite": (Enter("Speed", 6), Wait(3), Press("Identify M and b"), Wait(4)),
        "excite-well": (
            Press("the same with coarse encoders, at a crawl"),
            *(Enter("Speed", 5), Wait(1), Enter("Speed", -5), Wait(1), Enter("Speed", 5), Wait(1)),
            Press("Identify M and b"),
        ),
    },
    "06b-friction-and-the-integral": {
        "lower-the-jumps": (Enter("K1", 1000), Enter("K2", 63), Wait(8)),
        "get-it-going": (Enter("K5", 20), Wait(4)),
    },
    "07-flexible-link": {
        "choose-alpha": (Enter("α", 0.7), Wait(4)),
        "broken-promise": (
            *(Choose("Modes", "1"), Enter("α", 0.8), Wait(3), Choose("Modes", "3"), Wait(0.5)),
        ),
        "hold-the-tip": (
            *(Choose("Output", "composite"), RESET, Wait(3), HOLD, Wait(2.2), LET_GO),
        ),
        "turn-gently": (
            *(Choose("Output", "redefined"), RESET, Wait(2)),
            *(Enter("K5", 1), Enter("Speed", -2), Wait(4)),
        ),
    },
    "07b-where-the-theorem-decides": {"quiet-fans": (Enter("Drag", 1.5), Wait(16))},
    "08-challenge": {
        "own-path": (
            *(*TWO_BULGES, Enter("K1", 1600), Enter("K2", 80), Enter("K5", 5)),
            *(RESET, Wait(3.4), *TWO_HOLDS),
        ),
        "clover": (
            *(Enter("Speed", 4), Enter("K1", 2500), Enter("K2", 100), Enter("K5", 5)),
            *(RESET, Wait(3), *TWO_HOLDS),
        ),
        "real-one": (
            *(*TWO_BULGES, Enter("Speed", 5.2), Enter("K1", 2500), Enter("K2", 100)),
            *(Enter("K3", 8000), Enter("K5", 7), RESET, Wait(3.3), *TWO_HOLDS),
        ),
    },
    "09-read-the-paper": {
        "level-set": (
            *(Choose("Measured across", "level set"), Wait(1)),
            *(Key("d", 8), Wait(1), Key("x"), Wait(2)),
        ),
    },
    "09b-the-theorem-and-section-iii": {
        "experiment-one": (
            *(Wait(1), Key("w", 5), Key("a", 3), Wait(1)),
            *(Enter("Target", 90), Key("x"), Wait(3)),
        ),
    },
    "09c-sections-iv-and-v": {
        "two-readings": (
            *(Wait(1), Enter("Speed", -2), Wait(2.5), Choose("Plant", "lagrangian"), Wait(0.5)),
        ),
    },
}


def passed(tab: Tab, task: Task) -> bool:
    """Whether the page shows a task as passed."""
    box = tab.page.locator(".op-box").filter(has_text=first_words(task))
    return box.filter(has_text="✓ Passed").count() == 1


def verdicts(tab: Tab, task: Task) -> list[str]:
    """The lab's verdicts on a task, in words."""
    return [verdict.words for verdict in tab.lab.lessons.verdicts.get(task.id, [])]


def first_words(task: Task) -> str:
    """The first words of a task's text, as the page shows them."""
    return html.unescape(re.sub(r"<[^>]+>", "", task.text))[:40]
