"""Run, pause, step, reset, hold: what a first-time user reaches for."""

from __future__ import annotations

import time

import viser

from app import commands as c
from app.panels.widgets import Post, on_press, on_user_update
from app.session import Session

PRESS_ENDS = 0.35  # [s] without a hold message: the button was let go
RATE_LABELS = {f"{rate:g}×": rate for rate in c.RATES}


class RunPanel:
    """Transport and hold."""

    def __init__(self, gui: viser.GuiApi, session: Session, post: Post) -> None:
        self._post = post
        self._pressed_at: float | None = None
        self._hold = gui.add_button(
            "Hold both back",
            icon=viser.Icon.HAND_STOP,
            color="orange",
            hint="Holds the end-points back along the path until pressed again. Key: H",
        )
        self._press = gui.add_button(
            "Hold while pressed",
            icon=viser.Icon.HAND_CLICK,
            color="gray",
            hint="Holds the end-points back as long as the mouse button is down.",
        )
        self._run = gui.add_button(
            "Pause", icon=viser.Icon.PLAYER_PAUSE, hint="Simulated time stops. Key: space"
        )
        self._row = gui.add_button_group("", ["Step", "Reset"])
        self._rate = gui.add_dropdown(
            "Time runs at",
            list(RATE_LABELS),
            initial_value="1×",
            hint="Simulated seconds per second",
        )
        on_press(self._hold, lambda: post(c.Hold()))
        on_press(self._run, lambda: post(c.SetRunning()))
        on_press(self._row, self._row_pressed)
        on_user_update(self._rate, lambda label: post(c.SetRate(RATE_LABELS[label])))
        self._press.on_hold(self._held_down)

    def follow(self, session: Session) -> None:
        """Show what is; ends a press that has been let go."""
        held = bool(session.held)
        label = "Let both go" if held else "Hold both back"
        if not session.copy:
            label = "Let go" if held else "Hold back"
        if self._hold.label != label:
            self._hold.label = label
            self._hold.color = "red" if held else "orange"
        label = "Pause" if session.running else "Run"
        if self._run.label != label:
            self._run.label = label
            self._run.icon = viser.Icon.PLAYER_PAUSE if session.running else viser.Icon.PLAYER_PLAY
        rate = f"{session.rate:g}×"
        if self._rate.value != rate:
            self._rate.value = rate
        if self._pressed_at is not None and time.monotonic() - self._pressed_at > PRESS_ENDS:
            self._pressed_at = None
            self._post(c.Hold(False))

    def _row_pressed(self) -> None:
        self._post(c.Step() if self._row.value == "Step" else c.Reset())

    async def _held_down(self, _: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if self._pressed_at is None:
            self._post(c.Hold(True))
        self._pressed_at = time.monotonic()
