"""What live plots show."""

from __future__ import annotations

import re
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from viser import uplot

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page import plots
from onpath.lessons.record import QUANTITIES
from onpath.lessons.words import ENGLISH, Words, languages
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import RobotEntry
from tests.support.lab import do, loop_cache, run


def over_time(name: str) -> plots.TimePlot:
    """A plot over time by name."""
    plot = plots.MORE[name]
    assert isinstance(plot, plots.TimePlot)
    return plot


def test_a_reset_empties_the_plot(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else a step would begin with the curves of the one before, which may tell the answer."""
    lab, shown = Lab(loop_cache()), list[tuple[np.ndarray, ...]]()
    first = take_page_snapshot(lab, 1.0)
    gui: Any = SimpleNamespace(add_uplot=lambda data, *_, **__: shown.append(data))
    plot = plots.LivePlot(gui, ENGLISH, first.key.fields, over_time("across"))
    monkeypatch.setattr(plots, "update_gui", lambda _, __, data: shown.append(data))
    do(lab, c.Hold(True))
    run(lab, 0.5)
    plot.follow(take_page_snapshot(lab, 1.0))
    assert all(line.flags.c_contiguous for line in shown[-1])  # as frames send arrays fastest
    assert shown[-1][0][-1] > 0.4 and max(line.max() for line in shown[-1][1:]) > 1.0
    do(lab, c.Reset())
    plot.follow(take_page_snapshot(lab, 1.0))
    for data, empty in zip(shown[-1], shown[0], strict=True):
        assert np.array_equal(data, empty, equal_nan=True)
    times, *lines = shown[-1]
    assert times[0] < times[-1] and np.isnan(lines).all()  # the axis of time is there, no curve


@pytest.mark.parametrize("language", ["en", "de"])
def test_a_plot_has_the_unit_that_texts_and_checks_have(language: str) -> None:
    words = Words(language)
    units = {"torques": QUANTITIES["torque"], **QUANTITIES}
    for name in plots.MORE.keys() & units.keys():
        assert words(f"axis.{name}").endswith(f"[{units[name]}]")


def test_the_speed_is_plotted_in_millimetres_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    lab, shown = Lab(loop_cache()), list[tuple[np.ndarray, ...]]()
    first = take_page_snapshot(lab, 1.0)
    gui: Any = SimpleNamespace(add_uplot=lambda data, *_, **__: shown.append(data))
    plot = plots.LivePlot(gui, ENGLISH, first.key.fields, over_time("speed"))
    monkeypatch.setattr(plots, "update_gui", lambda _, __, data: shown.append(data))
    run(lab, 2.0)
    plot.follow(take_page_snapshot(lab, 1.0))
    omega, radius = lab.simulation.parameters.speed, 50.0  # [rad/s], of the circle [mm]
    assert shown[-1][2][-1] == pytest.approx(omega * radius, rel=0.02)


def test_of_two_lines_that_coincide_both_are_seen_and_no_number_is_cut() -> None:
    made = list[dict[str, Any]]()

    def add_uplot(_: object, series: Sequence[uplot.Series], **options: Any) -> None:
        made.append({"series": series, **options})

    fields = take_page_snapshot(Lab(loop_cache()), 1.0).key.fields
    for name in ("speed", "across"):
        gui: Any = SimpleNamespace(add_uplot=add_uplot)
        plots.LivePlot(gui, ENGLISH, fields, over_time(name))
        under, above = made[-1]["series"][1:]
        assert under["width"] >= above["width"] + 2 and under["stroke"] != above["stroke"]
        above_the_axis, right_of_it, *_ = made[-1]["padding"]
        assert min(above_the_axis, right_of_it) >= 9  # half of a number, [px]


def test_the_legend_tells_the_lines_of_a_robot_apart() -> None:
    """uPlot's legend has colours only."""
    made = list[Sequence[uplot.Series]]()
    gui: Any = SimpleNamespace(add_uplot=lambda _, series, **__: made.append(series))
    fields = take_page_snapshot(Lab(loop_cache()), 1.0).key.fields
    plots.LivePlot(gui, ENGLISH, fields, over_time("torques"))
    plots.LivePlot(gui, ENGLISH, fields, over_time("speed"))
    labels = [series.get("label", "") for series in made[0][1:]]
    assert [label.split()[-2:] for label in labels] == 2 * [["u1", "―"], ["u2", "╌"]]
    assert made[1][1].get("label") == "Tracker"


@settings(max_examples=3)
@given(entry=st.sampled_from(list(ROBOTS.values())))
@pytest.mark.parametrize("language", languages())
def test_a_symbol_means_one_thing_in_all_plots(entry: RobotEntry, language: str) -> None:
    """ξ₁ and ξ₃ are distances and ξ₂ and ξ₄ rates, in titles, in legends and in the phase plane."""
    shown = dict[str, Any]()

    def add_uplot(_: object, series: Sequence[uplot.Series], **options: Any) -> Any:
        shown[options["title"]] = [str(each.get("label")) for each in series[1:]]
        return SimpleNamespace()

    gui: Any = SimpleNamespace(add_uplot=add_uplot)
    fields = take_page_snapshot(Lab(loop_cache(), entry), 1.0).key.fields
    of = dict[str, set[str]]()
    for name in "across", "across_rate":
        shown.clear()
        plots.add_plot(gui, Words(language), fields, plots.MORE[name])
        ((title, labels),) = shown.items()
        titled, told = (set(re.findall("ξ.", each)) for each in (title, " ".join(labels)))
        assert titled == told or (not told and len(titled) == 1)
        of[name] = titled
    space = dict(fields)["xi"] > 1
    assert of["across"] == ({"ξ₁", "ξ₃"} if space else {"ξ₁"})
    assert of["across_rate"] == ({"ξ₂", "ξ₄"} if space else {"ξ₂"})


def test_every_plot_over_time_of_robots_at_rest_has_numbers_on_its_axis() -> None:
    """Else what is left of zero, 1e-17, would be drawn at full height beside numbers like -0."""
    for plot in plots.MORE.values():
        if isinstance(plot, plots.TimePlot):
            assert plot.least[0] <= 0 < plot.least[1]
