"""Logs of real arms on the axes of simulated runs."""

from __future__ import annotations

from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from matplotlib.colors import to_rgb

import onpath
from onpath.app.cli.main import run_command
from onpath.app.common.palette import INK
from onpath.models.studies.log_motion import LOG, read_motions

COMPARED = ("q", "y", "theta", "theta_rate", "xi", "u")


@pytest.mark.parametrize(
    "robot, law, path",
    [
        ("five_bar", "path_following", "clover"),
        ("spatial_arm", "path_following", "circle"),
        ("planar_arm", "path_following", "segment"),
    ],
)
def test_the_log_of_a_run_is_that_run(tmp_path: Path, robot: str, law: str, path: str) -> None:
    """All that is drawn follows from the joints and torques that a log has."""
    file = tmp_path / "arm.csv"
    run = onpath.simulate(robot, path, law, hold=(0.5, 0.8), duration=1.0)
    run.to_csv(file)
    (log,) = read_motions(file, run.experiment, {}, {})
    for name in COMPARED:
        own, there = log.fields[name], run.trajectory.fields[name]
        apart = own - there[:, : own.shape[1]]
        turns = 2 * np.pi * np.round(apart / (2 * np.pi)) if name == "theta" else 0.0
        assert np.abs(apart - turns).max() < 1e-5 * max(1.0, np.abs(there).max()), name
    assert np.abs(log.distance - run.distance).max() < 1e-7
    assert np.abs(log.speed - run.speed).max() < 1e-5
    assert log.t == pytest.approx(run.t)


def test_a_log_with_other_columns_units_and_rates_is_drawn_beside_the_run(tmp_path: Path) -> None:
    """A run that is written as a controller would log it: 250 rows a second, in ms and degrees."""
    run = onpath.simulate(duration=1.0)
    rows = slice(None, None, 4)
    numbers = np.column_stack([1e9 + 1e3 * run.t, np.degrees(run.q), run.torque])[rows]
    file = tmp_path / "arm.csv"
    np.savetxt(file, numbers, delimiter=";", header="ms;a;b;M1;M2", comments="", fmt="%.12f")
    columns = {"t": "ms", "q1": "a", "q2": "b", "tau1": "M1", "tau2": "M2"}
    units = {"t": "ms", "q1": "deg", "q2": "deg"}
    (log,) = read_motions(file, run.experiment, columns, units)
    assert np.abs(log.distance - run.distance[rows]).max() < 1e-6
    figure = run.plot(log=file, columns=columns, units=units)
    space = figure.axes[0]
    (drawn,) = [line for line in space.lines if line.get_label() == LOG]
    assert np.allclose(np.array(drawn.get_data()).T, 1e3 * run.y[rows], atol=1e-3)
    assert to_rgb(drawn.get_color()) == to_rgb(INK.hex)
    np.savetxt(file, np.delete(numbers, slice(80, 140), axis=0), fmt="%.12f")
    places = {name: place for place, name in enumerate(columns, 1)}
    space = run.plot(log=file, columns=places, units=units).axes[0]
    legend = space.get_legend() or space.figure.legends[0]
    assert [text.get_text() for text in legend.get_texts()].count(LOG) == 1
    assert sum(to_rgb(line.get_color()) == to_rgb(INK.hex) for line in space.lines) > 4


def test_a_log_is_drawn_from_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, picture = tmp_path / "arm.csv", tmp_path / "both.png"
    common = ["experiment", "position", "--law", "path_following", "--set", "duration=0.5"]
    assert run_command([*common, "--csv", str(file)]) == 0
    assert run_command([*common, "--log", str(file)]) == 2 and "--plot" in capsys.readouterr().err
    assert run_command([*common, "--log", str(file), "--plot", str(picture)]) == 0
    assert matplotlib.image.imread(picture).shape[2] == 4
    wrong = [*common, "--log", str(file), "--plot", str(picture), "--column", "q9=1"]
    assert run_command(wrong) == 2 and "q9" in capsys.readouterr().err
