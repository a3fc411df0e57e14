"""The paper's figures: what its text says of them is true of the runs."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.studies.paper_figures import FIGURES, figure_summary

RADIUS = 0.05


@cache
def runs(number: int) -> list[Trajectory]:
    return FIGURES[number].runs()


def test_all_figures_with_results_are_there() -> None:
    assert list(FIGURES) == [2, 3, 5, 6, 7]


def test_figure_2_does_not_cut_across_and_set_point_regulation_does() -> None:
    follower, set_point = runs(2)
    y = follower.fields["y"]
    radius, angle = np.hypot(*y.T), np.unwrap(np.arctan2(*y.T[::-1]))
    arrived = int(np.argmax(radius >= RADIUS))
    assert radius[:arrived].min() > 0.59 * RADIUS  # outwards to the circle
    assert np.abs(radius[arrived:] - RADIUS).max() < 3e-3  # and then along it
    assert np.pi / 2 - angle[arrived] > 1.5
    assert angle[-1] == pytest.approx(np.pi / 2, abs=1e-3)
    straight = set_point.fields["y"]
    chord = np.array([0.0, RADIUS]) - straight[0]
    off = np.abs((straight - straight[0]) @ [-chord[1], chord[0]]) / np.linalg.norm(chord)
    assert off.max() < 1e-4 and np.hypot(*straight.T).min() < 0.2 * RADIUS
    assert straight[-1] == pytest.approx([0.0, RADIUS], abs=1e-5)


@pytest.mark.parametrize("number", [3, 5])
def test_the_transformed_states_are_those_of_the_level_set(number: int) -> None:
    fields = runs(number)[0].fields
    y, xi, xi_rate = fields["y"], fields["xi"][:, 0], fields["xi_rate"][:, 0]
    assert xi == pytest.approx((y**2).sum(-1) - RADIUS**2, abs=3e-7)
    middle = np.abs(np.gradient(xi_rate, 1e-3)).max() * 1e-3
    assert np.gradient(xi, 1e-3)[1:-1] == pytest.approx(xi_rate[1:-1], abs=middle)


def test_figure_3_settles_at_the_place_on_the_circle() -> None:
    fields = runs(3)[0].fields
    assert fields["theta"][-1, 0] == pytest.approx(np.pi / 2, abs=1e-4)
    for name in ("xi", "xi_rate", "theta_rate", "u"):
        assert np.abs(fields[name][-1]).max() < 1e-3 * np.abs(fields[name]).max() + 1e-9, name


def test_figure_5_waits_on_the_path_and_resumes_without_leaving_it() -> None:
    (run,) = runs(5)
    t, fields = run.t, run.fields
    assert np.array_equal(run.held, (t > 2.9995) & (t < 4.9995))
    assert run.distance.max() == pytest.approx(2.2e-3, abs=5e-5)
    assert run.distance[run.held][-1] < 1e-6  # (18): back on the path while it is held
    assert np.abs(fields["theta_rate"][(t > 3.5) & run.held]).max() < 1e-3
    free = (t > 1.5) & (t < 3) | (t > 6.5)
    assert fields["theta_rate"][free, 0] == pytest.approx(2 * np.pi, abs=0.01)
    assert np.all(fields["speed_ref"] == pytest.approx(2 * np.pi))


@pytest.mark.parametrize("number", [6, 7])
def test_figures_6_and_7_bring_the_tip_to_the_ellipse_and_turn_round(number: int) -> None:
    (run,) = runs(number)
    t, fields = run.t, run.fields
    y = fields["y"]
    circle = y[:, 1] ** 2 + y[:, 2] ** 2 - RADIUS**2
    plane = y[:, 0] - 0.1 * y[:, 1] - 0.5
    assert fields["xi"] == pytest.approx(np.column_stack([circle, plane]), abs=1e-4)
    settled = t > 2.5
    assert np.abs(circle[settled]).max() < 1e-5 and np.abs(plane[settled]).max() < 1e-5
    expected = np.where(
        t < 3, 2 * (1 - np.exp(-5 * t)), -2 + (4 - 2 * np.exp(-15)) * np.exp(-5 * (t - 3))
    )
    assert fields["theta_rate"][:, 0] == pytest.approx(expected, abs=0.02)
    modes = fields["q"][:, 3:]
    assert modes.shape[1] == 3 and 1e-6 < np.abs(modes).max() < 1e-2  # η1, of dimension 6: bounded


@pytest.mark.parametrize("number", FIGURES)
def test_what_is_printed_says_where_the_settings_come_from(number: int) -> None:
    figure = FIGURES[number]
    result = figure_summary(figure, runs(number))
    assert list(result["laws"]) == list(figure.laws) and result["figure"] == number
    assert result["given"] and result["illustrative"]
    assert all(values["stopped_at_s"] is None for values in result["laws"].values())
