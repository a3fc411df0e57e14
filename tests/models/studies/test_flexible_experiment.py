"""The paper's section IV, headless: what holds the actual tip on the ellipse and what does not."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from onpath.app.cli.main import run_command
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.studies.experiments import experiments, run, summary
from onpath.models.systems.flexible_robot import UNSTABLE


def flexible(law: str = "path_following", **values: object) -> Trajectory:
    text = {name: str(value) for name, value in values.items()}
    return run(experiments()["flexible"].with_values(text), law)


def test_half_of_the_deflection_keeps_the_tip_within_a_millimetre() -> None:
    log = flexible()
    assert log.stopped_at is None
    assert log.distance[0] == pytest.approx(0.0105, abs=1e-3)
    assert log.distance[log.t >= 2].max() < 1e-3
    assert np.abs(log.fields["xi"][log.t >= 1]).max() < 1e-6  # what is controlled is on the path
    rate = log.fields["theta_rate"][:, 0]
    assert rate[log.t == 3.0][0] == pytest.approx(2.0, rel=0.01)
    assert rate[-1] == pytest.approx(-2.0, rel=0.01)


@pytest.mark.parametrize("law", ["path_following", "trajectory_tracking"])
def test_the_actual_tip_as_output_diverges_at_once_and_says_why(law: str) -> None:
    log = flexible(law, alpha=1)
    assert log.stopped_at is not None and log.stopped_at < 0.1
    assert log.reason == str(UNSTABLE)
    assert np.isfinite(log.fields["q"]).all()


def test_unit_modes_keep_the_actual_tip_on_the_path() -> None:
    log = flexible(alpha=1, plant="unit_modes", rho=0.2)
    assert log.stopped_at is None
    assert log.distance[-1] < 1e-5
    assert log.fields["theta_rate"][-1, 0] == pytest.approx(-2.0, rel=0.02)


@pytest.mark.parametrize("modes", [1, 2, 6])
def test_the_number_of_modes_hardly_matters_below_critical_alpha(modes: int) -> None:
    log = flexible(modes=modes, duration=2.5)
    assert log.fields["q"].shape[1] == 3 + modes
    assert log.distance[log.t >= 2].max() < 1e-3


def test_a_hold_that_outlasts_the_turn_keeps_its_place_and_the_robot_then_runs_back() -> None:
    values = {"hold_from": "0.8", "hold_to": "1.6", "reverse_at": "1.2", "duration": "2.5"}
    log = run(experiments()["obstruction"].with_values(values), "path_following")
    theta, rate = log.fields["theta"][:, 0], log.fields["theta_rate"][:, 0]
    first, second = log.held & (log.t < 1.2), log.held & (log.t > 1.25)
    assert np.ptp(theta[first]) < 0.1 and abs(rate[first][-1]) < 0.05
    assert abs(theta[second].mean() - theta[first].mean()) < 0.2
    assert rate[-1] == pytest.approx(-2 * np.pi, rel=0.01)


def test_summary_says_that_it_diverged() -> None:
    chosen = experiments()["flexible"].with_values({"alpha": "1"})
    result = summary(chosen, [run(chosen, "path_following")])["laws"]["path_following"]
    assert 0 < result["stopped_at_s"] < 0.1


def test_csv_has_the_modal_coordinates(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "flexible.csv"
    options = ["--set", "modes=2", "--set", "duration=0.05", "--csv", str(file)]
    assert run_command(["experiment", "flexible", *options]) == 0
    assert "path following" in capsys.readouterr().out
    names = file.read_text().splitlines()[0].split(",")
    assert names[2:15] == [
        *("q1_rad", "q2_rad", "q3_rad", "f1_m1.5", "f2_m1.5"),
        *("q1_rate_rad_s", "q2_rate_rad_s", "q3_rate_rad_s", "f1_rate_m1.5_s", "f2_rate_m1.5_s"),
        *("y1_m", "y2_m", "y3_m"),
    ]


# The zero-dynamics command ------------------------------------------------------------------------


def test_table_has_a_critical_alpha_for_each_number_of_modes(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run_command(["zero-dynamics", "--json"]) == 0
    modes = json.loads(capsys.readouterr().out)["modes"]
    assert list(modes) == [str(n) for n in range(1, 7)]
    for row in modes.values():
        real = row["largest_real_part_1_s"]
        assert real["1"] > 0 > real["0.5"]
        assert 0.7 < row["critical_alpha"] < 1


def test_critical_alpha_grows_with_one_over_rho_unit_modes(
    capsys: pytest.CaptureFixture[str],
) -> None:
    limits = list[float]()
    for rho in ("0.2", "0.4"):
        options = ["--set", "plant=unit_modes", "--set", f"rho={rho}", "--json"]
        assert run_command(["zero-dynamics", *options]) == 0
        limits.append(json.loads(capsys.readouterr().out)["modes"]["3"]["critical_alpha"])
    assert limits[0] == pytest.approx(2 * limits[1], rel=1e-3)


@pytest.mark.thorough
def test_picture_is_drawn(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "zero.png"
    assert run_command(["zero-dynamics", "--at", "0.02", "-0.03", "--plot", str(file)]) == 0
    assert "critical alpha" in capsys.readouterr().out
    assert file.stat().st_size > 20_000


@pytest.mark.parametrize(
    "arguments", [["--set", "rh=1"], ["--at", "3", "3"], ["--plot", "x.gif"], ["--set", "rho=9"]]
)
def test_bad_input_is_one_line(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(["zero-dynamics", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("onpath: ") and err.count("\n") == 1
