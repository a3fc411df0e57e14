"""How the motion under control laws settles: in words, and as poles in the complex plane."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import lru_cache

import numpy as np

from onpath.lessons.sides import side_titles
from onpath.lessons.words import Words
from onpath.models.control.law_poles import channels_of
from onpath.models.control.laws.own import is_text
from onpath.models.control.place import Place
from onpath.models.control.poles import Channel
from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters

WARNS = "⚠ "
"""Begins a line that warns, as in assets/web/core/words.ts."""


@lru_cache(maxsize=256)
def poles_of(
    parameters: Parameters,
    laws: tuple[tuple[str, str], ...],
    places: tuple[tuple[str, Place], ...],
    words: Words,
) -> tuple[str, str]:
    """The lines about the poles, and their points. Cached: a class mostly looks at the same gains.

    Args:
        laws: of the sides.
        places: of the sides whose poles vary along the path.
    """
    found, titles = dict[str, tuple[Channel, ...] | Message](), side_titles(dict(laws), words)
    varies = dict(places)
    for side, law in laws:
        channels = channels_of(law, parameters, varies.get(side))
        differs = side in varies or is_text(law) or isinstance(channels, Message)
        found[titles[side] if differs else ""] = channels
    return "\n".join(_lines(found, words)), "\n".join(_points(found))


def _lines(found: Mapping[str, tuple[Channel, ...] | Message], words: Words) -> Iterator[str]:
    """A line for each channel, or why a law has none."""
    for title, channels in found.items():
        prefix = f"{title}: " if title else ""
        if isinstance(channels, Message):
            yield prefix + words.sentence(channels)
            continue
        for channel in channels:
            listed = words.written(channel.pole_words().replace("-", "−"))
            poles = words("gains.poles", poles=listed)
            if channel.at is not None:
                place = f"{np.degrees(channel.at) % 360:.0f}"
                poles = words("gains.poles_at", poles=listed, place=place)
            warns = "" if channel.stable or channel.message else WARNS
            name = words(f"gains.{channel.name}")
            yield f"{warns}{prefix}{name}: {words.sentence(channel.behaviour())}; {poles}"


def _points(found: Mapping[str, tuple[Channel, ...] | Message]) -> Iterator[str]:
    """A line for each pole: its channel, its real and its imaginary part."""
    for channels in found.values():
        if not isinstance(channels, Message):
            for channel in channels:
                for pole in channel.poles.tolist():
                    yield f"{channel.name} {pole.real:.6g} {pole.imag:.6g}"
