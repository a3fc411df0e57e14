"""The plots beside the strip's chart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import viser
from viser import uplot

from onpath.app.common.palette import OF_SIDE
from onpath.app.lab.commands import Set
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.page.panels.phase_plot import NAME as PHASE_NAME
from onpath.app.page.panels.phase_plot import PhasePlot
from onpath.app.page.panels.widgets import Post, on_user_update
from onpath.app.viser_adapter.containers import beside
from onpath.app.viser_adapter.frame_channel import update_gui
from onpath.lessons.sides import displayed_names
from onpath.lessons.words import Words
from onpath.models.control.sides import DEFAULT_LAWS, LEFT
from onpath.models.layout import Layout
from onpath.models.systems.law_parameters import LEVEL_SET

PLOT_WINDOW = 10.0  # [s], of the axis of an empty plot
PADDING = (10, 12, 0, 0)
"""Above, right, below and left of a plot [px]: room for the halves of its outermost numbers."""
XI = ("xi", "xi_rate")  # fields whose unit is another one with a level set
LINES = (None, (6, 4), (2, 3))  # dash patterns of a robot's first, second and third line
MARKS = ("―", "╌", "┈")  # stand for these patterns in the legend, which shows colours only
HEIGHT, LARGE_HEIGHT = 200, 300  # of a chart, the latter for a projector, [px]
ROW = 22  # height of a row of the legend, [px]
PER_ROW = 2  # lines in a row of the legend
_PLAIN: uplot.Axis = {"ticks": {"show": False}}
_LARGE: uplot.Axis = {**_PLAIN, "font": '17px "Inter", Arial, sans-serif'}
AXES: tuple[uplot.Axis, ...] = (_PLAIN, {**_PLAIN, "space": 20})
"""The axes of time and of values; the small spacing gives low charts several numbers, too."""
LARGE: tuple[uplot.Axis, ...] = (_LARGE, {**_LARGE, "size": 60})
"""The same for a projector."""

Fields = tuple[tuple[str, int], ...]
"""Data available for plotting; see `PageKey.fields`."""


@dataclass(frozen=True, slots=True)
class Plot:
    """One of the plots.

    Attributes:
        name: identifier in the message catalogue and in lessons.
        field: name of the field in a snapshot's samples that it needs.
    """

    name: str
    field: str


@dataclass(frozen=True, slots=True)
class TimePlot(Plot):
    """Description of a plot over time.

    Attributes:
        scale: factor from SI to displayed units.
        lines: names of the field's components; one name for a single line.
        least: minimum range of the axis, so that a ripple of a micrometre does not fill the chart,
            and the axis has numbers when the robot is at rest.
    """

    scale: float
    lines: Callable[[Fields], list[str]]
    least: tuple[float, float]


def _numbered(symbol: str, field: str) -> Callable[[Fields], list[str]]:
    def names(fields: Fields) -> list[str]:
        size = dict(fields)[field]
        return [f"{symbol}{i + 1}" for i in range(size)] if size > 1 else [""]

    return names


def _of_xi(field: str, *symbols: str) -> Callable[[Fields], list[str]]:
    """A single line is named after its robot; the two lines of a space curve have symbols."""

    def names(fields: Fields) -> list[str]:
        return list(symbols) if dict(fields)[field] > 1 else [""]

    return names


def _alone(_: Fields) -> list[str]:
    """A single line is named after its robot."""
    return [""]


PHASE = Plot(PHASE_NAME, "xi_rate")
"""See `PhasePlot`."""
MORE: dict[str, Plot] = {
    plot.name: plot
    for plot in (
        PHASE,
        TimePlot("speed", "speed", 1e3, _alone, least=(0.0, 10.0)),
        TimePlot("torques", "u", 1.0, _numbered("u", "u"), least=(-0.01, 0.01)),
        TimePlot("across", "xi", 1e3, _of_xi("xi", "ξ₁", "ξ₃"), least=(-1.0, 1.0)),
        TimePlot("across_rate", "xi_rate", 1e3, _of_xi("xi_rate", "ξ₂", "ξ₄"), least=(-10.0, 10.0)),
        TimePlot("place", "theta", 1.0, _alone, least=(-0.1, 0.1)),
        TimePlot("rate", "theta_rate", 1.0, _alone, least=(-0.1, 0.1)),
        TimePlot("modes", "modes", 1e3, _numbered("f", "modes"), least=(-0.01, 0.01)),
        TimePlot("deflection", "deflection", 1e3, _alone, least=(-0.01, 0.01)),
        TimePlot("energy", "internal_energy", 1e3, _alone, least=(0.0, 0.005)),
        TimePlot("force", "force", 1.0, _numbered("F", "force"), least=(-0.1, 0.1)),
    )
}


def _at_least(limits: tuple[float, float]) -> uplot.Scale:
    """Axis range that grows with the data but has a minimum extent."""
    low, high = ({"pad": 0.1, "soft": limit, "mode": 1} for limit in limits)
    return uplot.Scale(range={"min": low, "max": high})


class LivePlot:
    """One uPlot chart.

    Args:
        level_set: whether ξ₁ is an area, [m²], instead of a distance.
        large: whether it is shown with a projector.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        words: Words,
        fields: Fields,
        plot: TimePlot,
        level_set: bool = False,
        large: bool = False,
    ) -> None:
        self._gui, self._words, self._has_xi = gui, words, plot.field in XI
        in_level_set = level_set and self._has_xi
        self._shown = -1.0
        # with a level set only the first line is drawn: the others have another unit
        self._names, self._laws = [""] if in_level_set else plot.lines(fields), DEFAULT_LAWS
        least = plot.least
        if in_level_set:  # s is 100 mm² at 1 mm beside a circle of 50 mm
            least = (100 * least[0], 100 * least[1])
        self._scale = plot.scale**2 if in_level_set else plot.scale
        begin = Layout(fields).slices[plot.field].start
        self._lines = slice(begin, begin + min(len(self._names), len(LINES)))
        nothing = np.full(2, np.nan)
        lines = len(self._series()) - 1
        self._empty = (np.array([0.0, PLOT_WINDOW]), *[nothing] * lines)
        kind = (
            "-level_set" if in_level_set else "-space" if self._has_xi and self._names[1:] else ""
        )
        self._title = words(f"axis.{plot.name}{kind}")
        height = LARGE_HEIGHT if large else HEIGHT
        self._height = height if lines <= PER_ROW else height - ROW
        self._least, self._axes = least, LARGE if large else AXES
        self._handle = self._chart(None)

    def _chart(self, order: float | None) -> viser.GuiUplotHandle:
        """An empty chart."""
        return self._gui.add_uplot(
            self._empty,
            self._series(),
            title=self._title,
            scales={"x": uplot.Scale(time=False), "y": _at_least(self._least)},
            axes=self._axes,
            legend=uplot.Legend(live=False),
            height=self._height,
            padding=PADDING,
            order=order,
        )

    def _rename(self) -> None:
        """Put a new chart in the place of this one.

        viser's chart keeps its range as a share of that of the data, and loses it if names and data
        change at once: the time axis would then reach far beyond the data.
        """
        former = self._handle
        with beside(self._gui, former):
            self._handle = self._chart(former.order)
        former.remove()

    def _series(self) -> tuple[uplot.Series, ...]:
        """Time and the lines of each side."""
        series = [uplot.Series(label=self._words("plots.time"))]
        names = displayed_names(self._laws, self._words)
        for side, title in names.items():
            for name, dash, mark in zip(self._names, LINES, MARKS, strict=False):
                label = f"{title} {name} {mark}" if name else title
                width = 4 if side == LEFT else 2  # so that one line stays visible under the other
                line = uplot.Series(label=label, stroke=OF_SIDE[side].hex, width=width)
                if dash is not None:
                    line["dash"] = dash
                series.append(line)
        return tuple(series)

    def follow(self, snapshot: PageSnapshot) -> None:
        """Plot the last seconds up to the displayed time."""
        if snapshot.laws != self._laws:
            self._laws = snapshot.laws
            self._rename()
            self._shown = -1.0
        if snapshot.time == self._shown:
            return
        self._shown, times = snapshot.time, snapshot.plots.times
        since = np.searchsorted(times, snapshot.plots.across_since) if self._has_xi else 0
        times = times[since:]
        if len(times) < 2:  # the lines of the run before a reset disappear
            update_gui(self._handle, "data", self._empty)
            return
        values = snapshot.plots.values[since:, :, self._lines].astype(float) * self._scale
        lines = np.array([times, *values.reshape(len(times), -1).T])  # one line after the other
        finite = lines if np.isfinite(lines).all() else np.nan_to_num(lines)
        update_gui(self._handle, "data", tuple(finite))

    def remove(self) -> None:
        """Remove the chart from the page."""
        self._handle.remove()


def _shown(fields: Fields, words: Words) -> dict[str, Plot | None]:
    """Plots available for this robot by displayed name; the first entry is "none"."""
    some = {words(f"plot.{p.name}"): p for p in MORE.values() if p.field in dict(fields)}
    return {words("plots.none"): None, **some}


def add_plot(
    gui: viser.GuiApi,
    words: Words,
    fields: Fields,
    plot: Plot,
    level_set: bool = False,
    large: bool = False,
) -> LivePlot | PhasePlot:
    """Add one of the selectable plots; see `LivePlot`."""
    if not isinstance(plot, TimePlot):
        return PhasePlot(gui, words)
    return LivePlot(
        gui=gui,
        words=words,
        fields=fields,
        plot=plot,
        level_set=level_set,
        large=large,
    )


class MorePlots:
    """A selectable plot.

    Args:
        post: receives a command that says whether the phase plane is shown.
    """

    def __init__(self, gui: viser.GuiApi, words: Words, fields: Fields, post: Post) -> None:
        self._gui, self._words, self._fields = gui, words, fields
        self._plot: LivePlot | PhasePlot | None = None
        self._plots = _shown(fields, words)
        self._folder = gui.add_folder(words("plots.more"), expand_by_default=False)
        with self._folder:
            self._choice = gui.add_dropdown(
                words("plots.show"), list(self._plots), hint=words("plots.show_hint")
            )
        on_user_update(
            self._choice, lambda name: post(Set("phase", self._plots.get(name) is PHASE))
        )
        self._drawn: tuple[Plot | None, bool] = None, False

    def follow(self, snapshot: PageSnapshot) -> None:
        """Update the selected plot."""
        chosen = self._plots[self._choice.value]
        level_set = snapshot.parameters["across"] == LEVEL_SET
        if (chosen, level_set) != self._drawn:
            self._drawn = chosen, level_set
            if self._plot is not None:
                self._plot.remove()
                self._plot = None
            if chosen is not None:
                with self._folder:
                    self._plot = add_plot(
                        gui=self._gui,
                        words=self._words,
                        fields=self._fields,
                        plot=chosen,
                        level_set=level_set,
                    )
        if self._plot is not None:
            self._plot.follow(snapshot)
