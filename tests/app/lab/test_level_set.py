"""The paper's level set s(y) as what is measured across the path: where it exists, and its unit."""

from __future__ import annotations

import io
from collections.abc import Callable

import numpy as np
import pytest

from onpath.app.exports.figures import experiment_figure
from onpath.app.exports.replay import replay
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_record import Beginning, record_of
from onpath.app.notebook.simulate import ellipse, simulate
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.vocabulary.setups import setup_faults
from onpath.models.closed_loop.trajectory import header, write_csv
from onpath.models.studies.experiments import experiments
from onpath.models.studies.experiments import run as run_experiment
from tests.support.lab import do, new_lab, run

NONE = "has no level set"


def across(lab: Lab) -> str:
    return lab.simulation.parameters.across


def level_set(path: str = "circle") -> Lab:
    lab = new_lab()
    do(lab, c.ChoosePath(path))
    run(lab, 0.4)
    do(lab, c.Set("across", "level_set"))
    run(lab, 0.2)
    return lab


@pytest.mark.parametrize("path", ["clover", "segment", "rounded square"])
def test_without_a_level_set_it_is_refused_and_nothing_changes(path: str) -> None:
    lab = level_set(path)
    assert across(lab) == "distance" and NONE in lab.message and lab.message_level == "warning"
    assert not any(kept.kind.level_set for kept in lab.simulation.runs.values())


@pytest.mark.parametrize("path", ["circle", "ellipse"])
def test_with_a_level_set_it_is_used(path: str) -> None:
    lab = level_set(path)
    assert across(lab) == "level_set" and lab.message == ""
    assert all(kept.kind.level_set for kept in lab.simulation.runs.values())
    do(lab, c.ChoosePath("ellipse" if path == "circle" else "circle"))
    run(lab, 0.5)
    assert across(lab) == "level_set"


CHANGES: list[Callable[[], c.Command]] = [
    lambda: c.ChoosePath("clover"),
    lambda: c.ChoosePath("segment"),
    lambda: c.MovePoint(2, np.array([0.0, 0.06]), finished=False),
    lambda: c.MovePoint(2, np.array([0.0, 0.06])),
]


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("runs", [True, False])
def test_when_the_path_loses_it_the_distance_is_measured_and_this_is_said(
    change: Callable[[], c.Command], runs: bool
) -> None:
    lab = level_set()
    lab.simulation.running = runs
    do(lab, change())
    assert across(lab) == "distance" and NONE in lab.message
    lab.simulation.running = True
    run(lab, 0.5)
    assert not any(kept.kind.level_set for kept in lab.simulation.runs.values())


def test_experiments_refuse_it_in_words() -> None:
    with pytest.raises(ValueError, match=NONE):
        simulate(path="clover", duration=0.01, across="level_set")
    for angle in (0.0, 0.6):
        turned = simulate(path=ellipse(0.06, 0.04, angle=angle), duration=1.0, across="level_set")
        assert turned.distance.max() < 0.004


def test_a_lesson_that_wants_it_elsewhere_is_faulty() -> None:
    for path, faulty in (("clover", True), ("ellipse", False)):
        setup = StepSetup(path=path, set={"across": "level_set"})
        assert any(NONE in fault for fault in setup_faults(setup, "five_bar")) == faulty


def test_a_figure_tells_its_unit() -> None:
    for values, unit in (({}, "[mm]"), ({"across": "level_set"}, "[mm$^2$]")):
        chosen = experiments()["position"].with_values({"duration": 0.1, **values})
        figure = experiment_figure(chosen, [run_experiment(chosen, "path_following")])
        labels = [axes.get_ylabel() for axes in figure.axes]
        assert any("xi_1" in label and label.endswith(unit) for label in labels)


def test_what_had_another_unit_is_in_no_plot_picture_or_task() -> None:
    lab = new_lab(0.5)
    begin = Beginning(lab.simulation.run_number, 0.0)
    assert "across" in record_of(lab.simulation, begin).values["follower"]
    do(lab, c.Set("across", "level_set"))
    run(lab, 0.5)
    values = record_of(lab.simulation, begin).values["follower"]
    assert "distance" in values and not {"across", "across_rate"} & set(values)
    since = lab.simulation.across_since
    assert since == pytest.approx(0.5, abs=0.02)
    for parts in replay(lab.simulation.robot, lab.simulation.history.all()).values():
        assert len(parts) == 1 and parts[0].level_set
        lacks = np.isnan(parts[0].fields["xi"][:, 0])
        assert np.array_equal(lacks, parts[0].t < since - 1e-9)
    do(lab, c.Reset())
    assert lab.simulation.across_since == 0.0


def test_a_table_tells_its_unit() -> None:
    robot = experiments()["flexible"].robot()
    assert {"xi1_m", "xi1_rate_m_s", "xi2_m"} <= set(header(robot))
    assert {"xi1_m2", "xi1_rate_m2_s", "xi2_m", "xi2_rate_m_s"} <= set(header(robot, True))
    chosen = experiments()["position"].with_values({"duration": 0.01, "across": "level_set"})
    file = io.StringIO()
    write_csv(file, chosen.robot(), [run_experiment(chosen, "path_following")])
    assert ",xi1_m2,xi1_rate_m2_s," in file.getvalue().splitlines()[0]
