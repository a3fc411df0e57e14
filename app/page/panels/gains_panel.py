"""Gains and task, with what they mean: how each channel settles, and a warning when it does not."""

from __future__ import annotations

import viser

from onpath.app.lab.commands import Identify, ResetParameters
from onpath.app.lab.lab import Lab
from onpath.app.page.panels.widgets import ParameterWidgets, Post, SwitchedParameter, on_press
from onpath.lessons.words import Words
from onpath.models.control.poles import Channel, channels
from onpath.models.systems.parameters import Parameters, specs

BASIC = ["speed", "K1", "K2", "K5"]
ADVANCED = ["task", "target", "K3", "K4", "across"]

LAST_OF_MODEL = "error_b2"


class GainsPanel:
    """The controls that a first-time user sees, and the rest in folders."""

    def __init__(self, gui: viser.GuiApi, lab: Lab, post: Post) -> None:
        self._words = words = lab.words
        self._shown: Parameters | None = None
        self._widgets = [ParameterWidgets(gui, lab, BASIC, post)]
        self._settling = gui.add_markdown("")
        with gui.add_folder(words("gains.advanced"), expand_by_default=False):
            self._widgets.append(ParameterWidgets(gui, lab, ADVANCED, post))
            reset = gui.add_button(words("gains.defaults"), icon=viser.Icon.RESTORE)
            on_press(reset, lambda: post(ResetParameters()))
        with gui.add_folder(words("gains.realism"), expand_by_default=False):
            gui.add_markdown(words("gains.ideal"))
            for name, spec in specs(lab.session.parameters).items():
                if spec.group != "realism":
                    continue
                if spec.on is None:
                    self._widgets.append(ParameterWidgets(gui, lab, [name], post))
                else:
                    self._widgets.append(SwitchedParameter(gui, lab, name, post))
                if name == LAST_OF_MODEL:
                    add_identify(gui, lab, post)

    def follow(self, lab: Lab) -> None:
        """Show the session's values and what follows from them."""
        if lab.session.parameters is self._shown:
            return
        self._shown = lab.session.parameters
        for widgets in self._widgets:
            widgets.follow(lab.session.parameters)
        lines = [_line(channel, self._words) for channel in channels(lab.session.parameters)]
        self._settling.content = "\n\n".join(lines)


def add_identify(gui: viser.GuiApi, lab: Lab, post: Post) -> None:
    """The button that fits the controllers' model to what was measured."""
    words = lab.words
    label, hint = words("gains.identify"), words("gains.identify_hint")
    button = gui.add_button(label, icon=viser.Icon.RULER_MEASURE, hint=hint)
    on_press(button, lambda: post(Identify()))


def _line(channel: Channel, words: Words) -> str:
    name, poles = words(f"gains.{channel.name}"), words("gains.poles", poles=channel.pole_words())
    mark = "" if channel.stable else "⚠️ "
    return f"**{name}:** {mark}{words.sentence(channel.words())} <br/>{poles}"
