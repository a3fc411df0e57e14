"""A sketched prediction and the truth on the same axes, as an image for a page."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping, Sequence
from threading import Lock
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from onpath.app.common.palette import OF_SIDE, SELECTED
from onpath.lessons.action_schema import RobotName
from onpath.lessons.given import Answer
from onpath.lessons.progress import Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Sketch
from onpath.lessons.sides import ROLES
from onpath.lessons.words import Words

SIZE = (6.6, 2.9)  # [in], width and height of a plot
ONE_AT_A_TIME = Lock()  # rc_context changes global state shared by all threads


def draw_prediction(
    sketch: Sketch,
    answer: Answer | None,
    truth: Truth | None,
    words: Words,
    names: Mapping[RobotName, str],
) -> str:
    """Data URI of an SVG: the sketch as a thick line, the robots as solid and dashed lines.

    Args:
        names: names of the robots.
    """
    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.subplots()
    if answer is not None and answer.times:
        style = {"color": SELECTED.hex, "linewidth": 4.5, "solid_capstyle": "round"}
        _draw(axes, sketch, answer.times, answer.values, label=words("lesson.yours"), **style)
    if truth is not None:
        for (side, role), dashes in zip(ROLES.items(), ("-", "--"), strict=True):
            style = {"color": OF_SIDE[side].hex, "linestyle": dashes, "linewidth": 1.8}
            values = getattr(truth, role)
            _draw(axes, sketch, truth.times, values, label=names[role], **style)
    _label(axes, sketch, words)
    return _data_uri(figure)


def _draw(
    axes: Axes, sketch: Sketch, times: Sequence[float], values: Sequence[float], **style: Any
) -> None:
    """Plot a curve, with values far outside the axes clipped."""
    span = sketch.top - sketch.bottom
    shown = np.clip(values, sketch.bottom - span, sketch.top + span)
    axes.plot(np.clip(times, -sketch.seconds, 2 * sketch.seconds), shown, **style)


def _label(axes: Axes, sketch: Sketch, words: Words) -> None:
    """Set limits, labels, grid and legend."""
    axes.set_xlim(0.0, sketch.seconds)
    axes.set_ylim(sketch.bottom, sketch.top)
    axes.set_xlabel("t [s]")
    quantity = words(f"quantity.{sketch.quantity}")
    axes.set_ylabel(f"{quantity}\n[{QUANTITIES[sketch.quantity]}]")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(lambda value, _: words.number(value, 3))
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    if axes.lines:
        axes.legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=3, frameon=False)


def _data_uri(figure: Figure) -> str:
    file = io.BytesIO()
    with ONE_AT_A_TIME, matplotlib.rc_context({"svg.hashsalt": "onpath"}):
        figure.savefig(file, format="svg", metadata={"Date": None})
    return "data:image/svg+xml;base64," + base64.b64encode(file.getvalue()).decode()
