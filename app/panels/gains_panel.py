"""Gains and task, with what they mean: how each channel settles, and a warning when it does not."""

from __future__ import annotations

import viser

from app.commands import Identify, ResetParameters
from app.panels.widgets import ParameterWidgets, Post, SwitchedParameter, on_press
from app.session import Session
from models.parameters import Parameters, specs
from models.poles import Channel, channels

BASIC = ["speed", "K1", "K2", "K5"]
ADVANCED = ["task", "target", "K3", "K4", "across"]

LAST_OF_MODEL = "error_b2"


class GainsPanel:
    """The controls that a first-time user sees, and the rest in folders."""

    def __init__(self, gui: viser.GuiApi, session: Session, post: Post) -> None:
        parameters = session.parameters
        self._shown: Parameters | None = None
        self._widgets = [ParameterWidgets(gui, parameters, BASIC, post)]
        self._words = gui.add_markdown("")
        with gui.add_folder("Advanced", expand_by_default=False):
            self._widgets.append(ParameterWidgets(gui, parameters, ADVANCED, post))
            reset = gui.add_button("Reset to defaults", icon=viser.Icon.RESTORE)
            on_press(reset, lambda: post(ResetParameters()))
        with gui.add_folder("Realism", expand_by_default=False):
            gui.add_markdown("All off: an ideal robot and an exact model. *Values illustrative.*")
            for name, spec in specs(parameters).items():
                if spec.group != "realism":
                    continue
                if spec.on is None:
                    self._widgets.append(ParameterWidgets(gui, parameters, [name], post))
                else:
                    self._widgets.append(SwitchedParameter(gui, parameters, name, post))
                if name == LAST_OF_MODEL:
                    add_identify(gui, post)

    def follow(self, session: Session) -> None:
        """Show the session's values and what follows from them."""
        if session.parameters is self._shown:
            return
        self._shown = session.parameters
        for widgets in self._widgets:
            widgets.follow(session.parameters)
        self._words.content = "\n\n".join(_line(ch) for ch in channels(session.parameters))


def add_identify(gui: viser.GuiApi, post: Post) -> None:
    """The button that fits the controllers' model to what was measured."""
    hint = "Estimates M and b from the follower's last 3 s, and lets both controllers believe it."
    button = gui.add_button("Identify M and b", icon=viser.Icon.RULER_MEASURE, hint=hint)
    on_press(button, lambda: post(Identify()))


def _line(channel: Channel) -> str:
    poles = ", ".join(_pole(p) for p in channel.poles if p.imag >= -1e-9)
    mark = "" if channel.stable else "⚠️ "
    return f"**{channel.name.capitalize()}:** {mark}{channel.words()} <br/>poles {poles} 1/s"


def _pole(pole: complex) -> str:
    if abs(pole.imag) < 1e-6 * max(1.0, abs(pole)):
        return f"{pole.real:.3g}"
    return f"{pole.real:.3g} ± {pole.imag:.3g}i"
