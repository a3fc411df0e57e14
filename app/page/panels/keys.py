"""Keyboard shortcuts for all mouse actions, and the window that lists them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

import viser

from onpath.app.lab import commands as c
from onpath.app.page.panels.widgets import Post
from onpath.app.viser_adapter.hotkeys import HotkeyKey, KeyModifier
from onpath.lessons.words import Words

NUDGE = 0.001  # [m], step of a control point
TUG = 0.005  # [m], step of the pulling hand
SHIFT = 0.002  # [m], step of the wall


@dataclass(frozen=True, slots=True)
class Key:
    """One keyboard shortcut.

    Attributes:
        name: of its action in the message catalogue.
        hotkey: viser's name for it.
        written: names of its keys, for display.
        command: sent to the lab; None for an action of this tab alone.
        modifier: viser's name for a key to be held down with it, or None.
    """

    name: str
    hotkey: HotkeyKey
    written: str
    command: c.Command | None
    modifier: KeyModifier | None = None

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
    Key("undo", "Z", "Ctrl Z", c.Undo(), modifier="cmd/ctrl"),
    Key("redo", "Y", "Ctrl Y", c.Redo(), modifier="cmd/ctrl"),
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


class Keys:
    """The shortcuts of a page, which also appear in viser's command palette.

    They stay while the page is built anew, so that none that is pressed meanwhile is lost.
    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._gui, self._handles = gui, dict[str, viser.CommandHandle]()
        self._acts = dict[str, Callable[[], None]]()

    def renew(
        self, words: Words, post: Post, page_actions: Mapping[str, Callable[[], None]]
    ) -> None:
        """Register the shortcuts, or change what they do and how they are called.

        Args:
            page_actions: the actions of the keys without a command, by name.
        """
        posts = {k.name: partial(post, k.command) for k in KEYS if k.command is not None}
        self._acts = {**page_actions, **posts}
        for key in KEYS:
            if key.name in self._handles:
                self._handles[key.name].label = key.does(words)
            else:
                self._handles[key.name] = self._added(key, words)

    def close(self) -> None:
        """Forget what the shortcuts do."""
        self._acts.clear()

    def _added(self, key: Key, words: Words) -> viser.CommandHandle:
        handle = self._gui.add_command(key.does(words), hotkey=key.hotkey, modifier=key.modifier)

        async def triggered(_: object) -> None:
            if key.name in self._acts:
                self._acts[key.name]()

        handle.on_trigger(triggered)
        return handle


def help_text(words: Words) -> str:
    """Text of the help window."""
    rows = [f"| **{key.shown(words)}** | {key.does(words)} |" for key in KEYS]
    return "\n".join([words("help.text"), *rows])
