"""Gains and task, with the settling behaviour of each channel and a warning if it is unstable."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np
import viser

from onpath.app.lab.commands import Identify, Pulse, ResetParameters
from onpath.app.lab.snapshots.page_snapshot import (
    LawPlaces,
    PageSnapshot,
    ParameterValues,
    parameters_of,
)
from onpath.app.page.panels.pole_picture import pole_picture
from onpath.app.page.panels.widgets import (
    OwnGainWidgets,
    ParameterWidgets,
    Post,
    SwitchedParameter,
    on_press,
)
from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words
from onpath.models.control.law_poles import channels_of
from onpath.models.control.laws.own import is_text
from onpath.models.control.place import Place
from onpath.models.control.poles import Channel
from onpath.models.control.settable import specs
from onpath.models.errors import Message
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters, declared
from onpath.models.systems.robots import RobotEntry

BASIC = ["speed", "K1", "K2", "K5"]
ADVANCED = ["speed_profile", "profile_period", "ramp", "task", "target"]
ADVANCED += ["K3", "tracker_integral", "K4", "across"]

LAST_OF_MODEL = "error_b2"
Channels = dict[str, tuple[Channel, ...] | Message]
"""The channels of each law, or why it has none, by the title of its side ("" for both)."""


class GainsPanel:
    """The basic controls, with the remaining ones in folders."""

    def __init__(self, gui: viser.GuiApi, words: Words, post: Post, first: PageSnapshot) -> None:
        self._words = words
        self._shown: tuple[ParameterValues, dict[str, str], LawPlaces] | None = None
        self._widgets = [
            ParameterWidgets(gui, words, post, names=BASIC, first=first),
            ParameterWidgets(gui, words, post, names=own_of(ROBOTS[first.key.robot]), first=first),
            OwnGainWidgets(gui, words, post, first),
        ]
        self._settling = gui.add_markdown("")
        self._picture = gui.add_html("")
        pulse = gui.add_button(  # the effect of a gain shows when something disturbs the robots
            words("gains.pulse"),
            icon=viser.Icon.WAVE_SINE,
            color="gray",
            hint=words("gains.pulse_hint"),
        )
        on_press(pulse, lambda: post(Pulse()))
        with gui.add_folder(words("gains.advanced"), expand_by_default=False):
            self._widgets.append(ParameterWidgets(gui, words, post, names=ADVANCED, first=first))
            reset = gui.add_button(words("gains.defaults"), color="gray", icon=viser.Icon.RESTORE)
            on_press(reset, lambda: post(ResetParameters()))
        with gui.add_folder(words("gains.realism"), expand_by_default=False):
            gui.add_markdown(words("gains.ideal"))
            for name, spec in specs(ROBOTS[first.key.robot].parameters).items():
                if spec.group != "realism":
                    continue
                if spec.on is None:
                    widgets = ParameterWidgets(gui, words, post, names=[name], first=first)
                else:
                    widgets = SwitchedParameter(gui, words, post, name=name, first=first)
                self._widgets.append(widgets)
                if name == LAST_OF_MODEL:
                    add_identify(gui, words, post)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Show the lab's values and the resulting settling behaviour."""
        now = snapshot.parameters, snapshot.run.laws, snapshot.places
        if now == self._shown:
            return
        self._shown = now
        for widgets in self._widgets:
            widgets.follow(snapshot)
        laws = tuple(snapshot.run.laws.items())
        places = snapshot.places if snapshot.places.of else None
        shown = _text_and_picture(parameters_of(snapshot), laws, places, self._words)
        self._settling.content, self._picture.content = shown


def own_of(entry: RobotEntry) -> list[str]:
    """The parameters that only this robot has and no other panel or folder shows."""
    if entry.flexible_link is not None:
        return []  # its panel has them
    own = {n: s for n, s in declared(entry.parameters).items() if n not in declared(Parameters)}
    return [name for name, spec in own.items() if spec.group not in ("realism", "path")]


def add_identify(gui: viser.GuiApi, words: Words, post: Post) -> None:
    """Add the button that identifies the controllers' model from measurements."""
    label, hint = words("gains.identify"), words("gains.identify_hint")
    button = gui.add_button(label, color="gray", icon=viser.Icon.RULER_MEASURE, hint=hint)
    on_press(button, lambda: post(Identify()))


@lru_cache(maxsize=256)
def _text_and_picture(
    parameters: Parameters,
    laws: tuple[tuple[str, str], ...],
    places: LawPlaces | None,
    words: Words,
) -> tuple[str, str]:
    """The lines of the poles, and their picture. Cached: a class mostly looks at the same gains."""
    places_of = {} if places is None else places.of
    channels = channels_by_owner(parameters, dict(laws), places_of, words)
    return "\n\n".join(lines_of_poles(channels, words)), pole_picture(channels, words)


def channels_by_owner(
    parameters: Parameters, laws: Mapping[str, str], places: Mapping[str, Place], words: Words
) -> Channels:
    """The channels of the laws by the title of their side; those that both share are under ""."""
    found, titles = Channels(), side_titles(laws, words)
    for side, law in laws.items():
        channels = channels_of(law, parameters, places.get(side))
        differs = side in places or is_text(law) or isinstance(channels, Message)
        found[titles[side] if differs else ""] = channels
    return found


def lines_of_poles(found: Channels, words: Words) -> list[str]:
    """A line of Markdown for each channel of the laws, or why a law has none."""
    lines = list[str]()
    for title, channels in found.items():
        if isinstance(channels, Message):
            lines.append(f"**{title}:** {words.sentence(channels)}")
            continue
        lines += [_line(channel, words, f"{title}: " if title else "") for channel in channels]
    return lines


def _line(channel: Channel, words: Words, prefix: str) -> str:
    name = prefix + words(f"gains.{channel.name}")
    poles = words("gains.poles", poles=channel.pole_words())
    if channel.at is not None:
        place = f"{np.degrees(channel.at) % 360:.0f}"
        poles = words("gains.poles_at", poles=channel.pole_words(), place=place)
    mark = "" if channel.stable or channel.message else "⚠️ "
    return f"**{name}:** {mark}{words.sentence(channel.behaviour())} <br/>{poles}"
