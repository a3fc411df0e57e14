"""Keys for all that a mouse can do, and the window that lists them."""

from __future__ import annotations

from dataclasses import dataclass

import viser
from viser._messages import HotkeyKey, KeyModifier

from app import commands as c
from app.panels.widgets import Post

NUDGE = 0.001  # [m], of a control point
TUG = 0.005  # [m], of the hand


@dataclass(frozen=True, slots=True)
class Key:
    """One key: viser's name for it, how it is written, what it does."""

    hotkey: HotkeyKey
    shown: str
    does: str
    command: c.Command
    modifier: KeyModifier | None = None


KEYS = (
    Key("space", "space", "Run or pause", c.SetRunning()),
    Key("arrowright", "→", "One step; with a point selected, move it right", c.Arrow(NUDGE, 0.0)),
    Key("arrowleft", "←", "Move the selected point left", c.Arrow(-NUDGE, 0.0)),
    Key("arrowup", "↑", "Move the selected point up", c.Arrow(0.0, NUDGE)),
    Key("arrowdown", "↓", "Move the selected point down", c.Arrow(0.0, -NUDGE)),
    Key("R", "R", "Reset both robots", c.Reset()),
    Key("H", "H", "Hold back, or let go", c.Hold()),
    Key("N", "N", "Select the next control point", c.SelectNext()),
    Key("escape", "Esc", "Select no point", c.SelectPoint(None)),
    Key("insert", "Ins", "Add a control point after the selected one", c.AddPoint()),
    Key("delete", "Del", "Remove the selected control point", c.RemovePoint()),
    Key("Z", "Ctrl Z", "Undo a change of the path", c.Undo(), "cmd/ctrl"),
    Key("Y", "Ctrl Y", "Redo it", c.Redo(), "cmd/ctrl"),
    Key("A", "A", "Pull the end-points left", c.Tug(-TUG, 0.0)),
    Key("D", "D", "Pull the end-points right", c.Tug(TUG, 0.0)),
    Key("W", "W", "Pull the end-points up", c.Tug(0.0, TUG)),
    Key("S", "S", "Pull the end-points down", c.Tug(0.0, -TUG)),
    Key("X", "X", "Let the end-points go", c.Release()),
    Key("B", "B", "Look back one second more", c.LookBack(1.0)),
    Key("F", "F", "Look forward one second", c.LookBack(-1.0)),
    Key("G", "G", "Go on from the instant looked at", c.GoOn()),
)


def add_keys(gui: viser.GuiApi, post: Post) -> None:
    """Make the keys work; they are also in viser's command palette."""
    for key in KEYS:
        handle = gui.add_command(key.does, hotkey=key.hotkey, modifier=key.modifier)

        async def triggered(_: object, command: c.Command = key.command) -> None:
            post(command)

        handle.on_trigger(triggered)


HELP = """**Hold both back** and watch: the tracker (orange) is torn off its path, because its point
runs on by the clock. The follower (blue) waits on its path and goes on when you let go.

- **Drag an end-point** to pull it. *Copy to both* pulls the other one by the same way.
- **Drag a small grey ball** to bend the path while it runs.
- **Ring**: what the controller aims at. The tracker's is a point that runs by the clock, the
  follower's is the closest point of the path.
- **Arrow**: the force of hand or hold on the end-point.

| Key | What it does |
|---|---|
"""


def help_text() -> str:
    """The help window's text."""
    return HELP + "\n".join(f"| **{key.shown}** | {key.does} |" for key in KEYS)
