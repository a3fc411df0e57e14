"""A sketched curve and the true ones in words: their peaks."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from onpath.lessons.action_schema import RobotName
from onpath.lessons.given import Answer
from onpath.lessons.progress import Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Sketch
from onpath.lessons.sides import ROLES
from onpath.lessons.words import Words


def curve_words(
    block: Sketch,
    answer: Answer | None,
    truth: Truth | None,
    words: Words,
    names: Mapping[RobotName, str],
) -> str:
    """The peaks of the sketch and of what happened; empty if there is neither.

    Args:
        names: names of the robots.
    """
    unit, sentences = QUANTITIES[block.quantity], list[str]()
    if answer is not None and answer.times:
        value, time = _peak(answer.times, answer.values, words)
        sentences.append(words("report.drawn", value=value, unit=unit, time=time))
    if truth is not None:
        peaks = list[str]()
        for role in ROLES.values():
            value, time = _peak(truth.times, getattr(truth, role), words)
            peak = {"robot": names[role], "value": value, "unit": unit, "time": time}
            peaks.append(words("report.peak", **peak))
        sentences.append(words("report.happened", first=peaks[0], second=peaks[1]))
    return " ".join(sentences)


def _peak(times: tuple[float, ...], values: tuple[float, ...], words: Words) -> tuple[str, str]:
    """The value farthest from zero and its time, formatted."""
    at = int(np.argmax(np.abs(values)))
    return words.number(values[at], 3), words.number(times[at], 3)
