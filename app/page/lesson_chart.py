"""A prediction and the truth on the same axes."""

from __future__ import annotations

import numpy as np
import viser
from viser import uplot

from onpath.app.common.palette import OF_SIDE, SELECTED
from onpath.app.page.plots import PADDING
from onpath.lessons.progress import Answer, Truth
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Sketch
from onpath.lessons.sides import ROLES, robot_names
from onpath.lessons.words import Words


class PredictionChart:
    """One uPlot chart, with a legend of the curves that are drawn.

    Args:
        laws: control laws under which the prediction is tested.
        truth: the measured curves so far, or None.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        sketch: Sketch,
        answer: Answer | None,
        laws: dict[str, str],
        words: Words,
        truth: Truth | None = None,
    ) -> None:
        self._sketch, self._shown = sketch, truth
        self._answer = answer if answer is not None and answer.times else None
        unit, names = QUANTITIES[sketch.quantity], robot_names(laws, words)
        lines = list[uplot.Series]()
        if truth is not None:
            for side, role in ROLES.items():
                colour = OF_SIDE[side].hex
                lines.append(uplot.Series(label=names[role], stroke=colour, width=2))
        if self._answer is not None:
            yours = words("lesson.yours")
            lines.append(uplot.Series(label=yours, stroke=SELECTED.hex, width=4))
        self._handle = gui.add_uplot(
            self._data(truth),
            (uplot.Series(label=words("plots.time")), *lines),
            title=f"{words(f'quantity.{sketch.quantity}')} [{unit}]",
            scales={
                "x": uplot.Scale(time=False, auto=False, range=(0.0, sketch.seconds)),
                "y": uplot.Scale(auto=False, range=(sketch.bottom, sketch.top)),
            },
            legend=uplot.Legend(live=False),
            height=230,
            padding=PADDING,
        )

    def show(self, truth: Truth | None) -> None:
        """Plot the data up to now. A chart that was made without a truth never shows one."""
        if truth is not None and self._shown is not None and truth != self._shown:
            self._shown = truth
            self._handle.data = self._data(truth)

    def remove(self) -> None:
        """Remove the chart from the page."""
        self._handle.remove()

    def _data(self, truth: Truth | None) -> tuple[np.ndarray, ...]:
        """Times and the drawn curves, NaN where a curve has no data yet."""
        curves = list[Curve]()
        if truth is not None:
            curves += [(truth.times, getattr(truth, role)) for role in ROLES.values()]
        if self._answer is not None:
            curves.append((self._answer.times, self._answer.values))
        return together(self._sketch.seconds, *curves)


Curve = tuple[tuple[float, ...], tuple[float, ...]]
"""Times and values."""


def together(seconds: float, *curves: Curve) -> tuple[np.ndarray, ...]:
    """Resample curves on the union of their times and the ends of the axis; no point is lost."""
    at = np.unique(np.concatenate([[0.0, seconds], *[times for times, _ in curves]]))
    return (at, *[_resampled(at, times, values) for times, values in curves])


def _resampled(at: np.ndarray, times: tuple[float, ...], values: tuple[float, ...]) -> np.ndarray:
    if len(times) < 2:
        return np.full(len(at), np.nan)
    return np.interp(at, times, values, left=np.nan, right=np.nan)
