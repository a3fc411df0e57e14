"""Keyboard shortcuts for everything that the mouse can do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from onpath.app.channel.sheet_messages import ShownKey
from onpath.app.lab import commands as c
from onpath.app.lab.commands.command_codec import message_of
from onpath.lessons.words import Words

NUDGE = 0.001  # [m], step of a control point
TUG = 0.005  # [m], step of the pulling hand
SHIFT = 0.002  # [m], step of the wall
OF_PAGE: dict[str, dict[str, Any]] = {"view": {"is": "view"}, "summary": {"is": "summary"}}
"""What a page sends for keys without a command, by their name."""


@dataclass(frozen=True, slots=True)
class Key:
    """One keyboard shortcut.

    Attributes:
        name: of its action in the message catalogue.
        hotkey: viser's name for it.
        written: names of its keys, for display.
        command: sent to the lab; None for an action of this tab alone.
        control: whether the control or command key is held down with it.
    """

    name: str
    hotkey: str
    written: str
    command: c.Command | None
    control: bool = False

    def does(self, words: Words) -> str:
        """Description of the action."""
        return words(f"key.{self.name}")

    def shown(self, words: Words) -> str:
        """Name of the shortcut on a keyboard of the given language."""
        return " ".join(words.get(f"keyname.{key}", key) for key in self.written.split())


KEYS = (
    Key("run", "space", "space", c.SetRunning()),
    Key("right", "arrowright", "→", c.NudgePoint(NUDGE, 0.0)),
    Key("left", "arrowleft", "←", c.NudgePoint(-NUDGE, 0.0)),
    Key("up", "arrowup", "↑", c.NudgePoint(0.0, NUDGE)),
    Key("down", "arrowdown", "↓", c.NudgePoint(0.0, -NUDGE)),
    Key("reset", "R", "R", c.Reset()),
    Key("hold", "H", "H", c.Hold()),
    Key("next", "N", "N", c.SelectNext()),
    Key("none", "escape", "Esc", c.SelectPoint(None)),
    Key("add", "insert", "Ins", c.AddPoint()),
    Key("remove", "delete", "Del", c.RemovePoint()),
    Key("undo", "Z", "Ctrl Z", c.Undo(), control=True),
    Key("redo", "Y", "Ctrl Y", c.Redo(), control=True),
    Key("pull_left", "A", "A", c.MoveHand(-TUG, 0.0)),
    Key("pull_right", "D", "D", c.MoveHand(TUG, 0.0)),
    Key("pull_up", "W", "W", c.MoveHand(0.0, TUG)),
    Key("pull_down", "S", "S", c.MoveHand(0.0, -TUG)),
    Key("let_go", "X", "X", c.Release()),
    Key("wall", "M", "M", c.Set("wall")),
    Key("wall_left", "J", "J", c.NudgeWall(right=-SHIFT)),
    Key("wall_right", "L", "L", c.NudgeWall(right=SHIFT)),
    Key("wall_up", "I", "I", c.NudgeWall(up=SHIFT)),
    Key("wall_down", "K", "K", c.NudgeWall(up=-SHIFT)),
    Key("wall_turn", "T", "T", c.NudgeWall(turn=c.TURN)),
    Key("wall_turn_back", "V", "V", c.NudgeWall(turn=-c.TURN)),
    Key("back", "B", "B", c.LookBack(1.0)),
    Key("forward", "F", "F", c.LookBack(-1.0)),
    Key("go_on", "G", "G", c.GoOn()),
    Key("undo_go_on", "U", "U", c.UndoGoOn()),
    Key("slowly", "P", "P", c.ReplayBreakdown()),
    Key("earlier", "E", "E", c.UseEarlierSettings()),
    Key("summary", "Q", "Q", None),
    Key("view", "home", "Home", None),
    Key("lesson", "O", "O", None),
)


def shown_keys(words: Words, first_lesson: str) -> list[ShownKey]:
    """All shortcuts, with what a page sends for them.

    Args:
        first_lesson: name of the lesson that a key opens; empty without lessons.
    """
    sent = {key.name: message_of(key.command) for key in KEYS if key.command is not None}
    sent |= OF_PAGE
    if first_lesson:
        sent["lesson"] = message_of(c.OpenLesson(first_lesson))
    return [
        ShownKey(
            name=key.name,
            key=key.hotkey.replace("space", " ").lower(),
            control=key.control,
            shown=key.shown(words),
            does=key.does(words),
            send=sent[key.name],
        )
        for key in KEYS
        if key.name in sent
    ]
