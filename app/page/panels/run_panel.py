"""Run, pause, step, reset, hold: what a first-time user reaches for."""

from __future__ import annotations

import time
from collections.abc import Callable

import viser

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.page.panels.widgets import Post, on_press, on_user_update

PRESS_ENDS = 0.35  # [s] without a hold message: the button was let go
RATE_LABELS = {f"{rate:g}×": rate for rate in c.RATES}


class RunPanel:
    """Transport and hold."""

    def __init__(
        self, gui: viser.GuiApi, lab: Lab, post: Post, reset_view: Callable[[], None]
    ) -> None:
        self._post, self._words = post, lab.words
        self._pressed_at: float | None = None
        words = self._words
        self._hold = gui.add_button(
            words("run.hold_both"),
            icon=viser.Icon.HAND_STOP,
            color="orange",
            hint=words("run.hold_hint"),
        )
        self._press = gui.add_button(
            words("run.press"),
            icon=viser.Icon.HAND_CLICK,
            color="gray",
            hint=words("run.press_hint"),
        )
        self._run = gui.add_button(
            words("run.pause"), icon=viser.Icon.PLAYER_PAUSE, hint=words("run.run_hint")
        )
        row: dict[str, Callable[[], None]] = {
            words("run.step"): lambda: post(c.StepOnce()),
            words("run.reset"): lambda: post(c.Reset()),
            words("run.view"): reset_view,
        }
        group = gui.add_button_group("", list(row))
        self._rate = gui.add_dropdown(
            words("run.rate"), list(RATE_LABELS), initial_value="1×", hint=words("run.rate_hint")
        )
        on_press(self._hold, lambda: post(c.Hold()))
        on_press(self._run, lambda: post(c.SetRunning()))
        on_press(group, lambda: row[group.value]())
        on_user_update(self._rate, lambda label: post(c.SetRate(RATE_LABELS[label])))
        self._press.on_hold(self._held_down)

    def follow(self, lab: Lab) -> None:
        """Show what is; ends a press that has been let go."""
        held = bool(lab.session.grips.held)
        label = self._words("run.let_both_go" if held else "run.hold_both")
        if not lab.session.copy:
            label = self._words("run.let_go" if held else "run.hold")
        if self._hold.label != label:
            self._hold.label = label
            self._hold.color = "red" if held else "orange"
        label = self._words("run.pause" if lab.session.running else "run.run")
        if self._run.label != label:
            self._run.label = label
            runs = lab.session.running
            self._run.icon = viser.Icon.PLAYER_PAUSE if runs else viser.Icon.PLAYER_PLAY
        rate = f"{lab.session.rate:g}×"
        if self._rate.value != rate:
            self._rate.value = rate
        if self._pressed_at is not None and time.monotonic() - self._pressed_at > PRESS_ENDS:
            self._pressed_at = None
            self._post(c.Hold(False))

    async def _held_down(self, _: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if self._pressed_at is None:
            self._post(c.Hold(True))
        self._pressed_at = time.monotonic()
