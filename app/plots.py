"""Live plots of one client: the distance, always there, and one more on demand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import viser
from viser import uplot

from app.node_update import update_plot
from app.palette import CONTROLLERS
from app.session import Session
from app.snapshot import FollowerName, TrackerName

WINDOW = 10.0  # [s]
POINTS = 160
LINES = (None, (6, 4), (2, 3))  # dash patterns of a robot's first, second and third line
SHORT = {TrackerName: "tracking", FollowerName: "following"}


@dataclass(frozen=True, slots=True)
class Plot:
    """What is drawn over time.

    Attributes:
        field: of the session's samples.
        scale: from SI to what is shown.
        lines: names of the field's entries; one name for a single line.
    """

    label: str
    field: str
    scale: float
    lines: Callable[[Session], list[str]]


def _numbered(symbol: str, field: str) -> Callable[[Session], list[str]]:
    def names(session: Session) -> list[str]:
        size = dict(session.sample_layout.fields)[field]
        return [f"{symbol}{i + 1}" if size > 1 else symbol for i in range(size)]

    return names


DISTANCE = Plot("distance to the path [mm]", "distance", 1e3, lambda _: ["distance"])
MORE = {
    "speed along the path": Plot("speed [m/s]", "speed", 1.0, lambda _: ["speed"]),
    "torques": Plot("torque [N m]", "u", 1.0, _numbered("u", "u")),
    "ξ₁ across": Plot("ξ₁ [mm]", "xi", 1e3, _numbered("ξ", "xi")),
    "ξ₂ rate across": Plot("ξ₂ [mm/s]", "xi_rate", 1e3, _numbered("ξ'", "xi_rate")),
    "η₁ place along": Plot("η₁ = θ [rad]", "theta", 1.0, lambda _: ["θ"]),
    "η₂ rate along": Plot("η₂ = θ' [rad/s]", "theta_rate", 1.0, lambda _: ["θ'"]),
    "modes of the link": Plot("each mode, at the tip [mm]", "modes", 1e3, _numbered("f", "modes")),
    "deflection of the tip": Plot("deflection [mm]", "deflection", 1e3, lambda _: ["w"]),
    "internal energy": Plot("energy in the link [mJ]", "internal_energy", 1e3, lambda _: ["E"]),
    "force": Plot("force [N]", "force", 1.0, _numbered("F", "force")),
}


class LivePlot:
    """One uPlot chart."""

    def __init__(self, gui: viser.GuiApi, session: Session, plot: Plot, height: int) -> None:
        self._plot = plot
        self._shown = -1.0
        series = [uplot.Series(label="t [s]")]
        names = plot.lines(session)
        for robot in session.runs:
            for name, dash in zip(names, LINES, strict=False):
                label = SHORT[robot] if len(names) == 1 else f"{SHORT[robot]} {name}"
                line = uplot.Series(label=label, stroke=CONTROLLERS[robot].hex, width=2)
                if dash is not None:
                    line["dash"] = dash
                series.append(line)
        self._lines = min(len(names), len(LINES))
        self._handle = gui.add_uplot(
            tuple(np.zeros(2) for _ in series),
            tuple(series),
            title=plot.label,
            scales={"x": uplot.Scale(time=False)},
            legend=uplot.Legend(live=False),
            height=height,
        )

    def follow(self, session: Session) -> None:
        """Draw the last seconds, up to the instant that is shown."""
        now = session.time if session.viewing is None else session.viewing
        if now == self._shown:
            return
        self._shown = now
        times, samples = session.history.samples(now - WINDOW, now, POINTS)
        if len(times) < 2:
            return
        begin = session.sample_layout.slices[self._plot.field].start
        values = samples[:, :, begin : begin + self._lines].astype(float) * self._plot.scale
        lines = np.vstack([times, values.reshape(len(times), -1).T])
        update_plot(self._handle, lines if np.isfinite(lines).all() else np.nan_to_num(lines))

    def remove(self) -> None:
        """Take it off the page."""
        self._handle.remove()


def _shown(session: Session) -> list[str]:
    """Names of the plots that this robot has something for."""
    fields = dict(session.sample_layout.fields)
    return [name for name, plot in MORE.items() if plot.field in fields]


class MorePlots:
    """A plot to choose."""

    NONE = "none"

    def __init__(self, gui: viser.GuiApi, session: Session) -> None:
        self._gui = gui
        self._plot: LivePlot | None = None
        self._folder = gui.add_folder("More plots", expand_by_default=False)
        with self._folder:
            self._choice = gui.add_dropdown(
                "Show",
                [self.NONE, *_shown(session)],
                initial_value=self.NONE,
                hint="Over the last 10 s",
            )
        self._drawn = self.NONE

    def follow(self, session: Session) -> None:
        """Draw the chosen plot."""
        if self._choice.value != self._drawn:
            self._drawn = self._choice.value
            if self._plot is not None:
                self._plot.remove()
                self._plot = None
            if self._drawn in MORE:
                with self._folder:
                    self._plot = LivePlot(self._gui, session, MORE[self._drawn], height=200)
        if self._plot is not None:
            self._plot.follow(session)
