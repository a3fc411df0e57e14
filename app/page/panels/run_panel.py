"""Run, pause, step, reset and hold."""

from __future__ import annotations

from collections.abc import Callable

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.widgets import Post, add_buttons, add_menu, on_hold, on_press
from onpath.lessons.words import Words
from onpath.models.closed_loop.obstacles import DIRECTIONS

RATE_LABELS = {f"{rate:g}×": rate for rate in c.RATES}


class RunPanel:
    """Buttons that control time, and the brake."""

    def __init__(
        self, gui: viser.GuiApi, words: Words, post: Post, reset_view: Callable[[], None]
    ) -> None:
        self._words = words
        self._shown: tuple[object, ...] = ()
        self._hold = gui.add_button(
            words("run.hold_both"),
            icon=viser.Icon.HAND_STOP,
            hint=words("run.hold_hint"),
        )
        press = gui.add_button(
            words("run.press"),
            icon=viser.Icon.HAND_CLICK,
            color="gray",
            hint=words("run.press_hint"),
        )
        self._run = gui.add_button(
            words("run.pause"),
            icon=viser.Icon.PLAYER_PAUSE,
            color="gray",
            hint=words("run.run_hint"),
        )
        actions: dict[str, Callable[[], None]] = {
            words("run.step"): lambda: post(c.StepOnce()),
            words("run.reset"): lambda: post(c.Reset()),
            words("run.view"): reset_view,
        }
        add_buttons(gui, "", actions, lambda act: act())
        self._rate = add_menu(
            gui,
            words("run.rate"),
            RATE_LABELS,
            lambda rate: post(c.SetRate(rate)),
            shown="1×",
            hint=words("run.rate_hint"),
        )
        on_press(self._hold, lambda: post(c.Hold()))
        on_press(self._run, lambda: post(c.SetRunning()))
        on_hold(press, lambda: post(c.Hold(True)), lambda: post(c.Hold(False)))

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show a snapshot."""
        held, run = snapshot.held, snapshot.run
        shown = (held, run.copy, snapshot.running, run.rate, self._rate.value)
        if shown == self._shown:
            return
        self._shown = shown
        label = self._words("run.let_both_go" if held else "run.hold_both")
        if not run.copy:
            label = self._words("run.let_go" if held else "run.hold")
        if self._hold.label != label:
            self._hold.label = label
        label = self._words("run.pause" if snapshot.running else "run.run")
        if self._run.label != label:
            self._run.label = label
            self._run.icon = viser.Icon.PLAYER_PAUSE if snapshot.running else viser.Icon.PLAYER_PLAY
        rate = f"{run.rate:g}×"
        if self._rate.value != rate:
            self._rate.value = rate


class HoldDirection:
    """A menu for the direction in which brakes act."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        labels = {name: words(f"run.direction_{name}") for name in DIRECTIONS}
        self._labels, self._just_changed = labels, False

        def choose(name: str) -> None:
            self._just_changed = True
            post(c.SetHoldDirection(name))

        self._menu = add_menu(
            gui,
            words("run.direction"),
            {label: name for name, label in labels.items()},
            choose,
            shown=labels[first.run.hold_direction],
            hint=words("run.direction_hint"),
        )

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's direction; see `LawPanel.follow`."""
        late, self._just_changed = self._just_changed, False
        label = self._labels[snapshot.run.hold_direction]
        if not late and self._menu.value != label:
            self._menu.value = label
