"""Friction and delay from a log are settings: the same motion on the command line and in Python."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import onpath
from onpath.app.cli.assignments import assignments
from onpath.app.cli.main import run_command
from onpath.app.cli.serve import Serve
from onpath.models.control.settable import with_values
from onpath.models.studies.arena import trials_of
from onpath.models.studies.log_identification import FileEstimate
from onpath.models.studies.parameter_estimate import BaseParameter, Estimate
from onpath.models.systems.catalogue import ROBOTS
from tests.support.arm_logs import DRY, Logger, motion_of

PLACES = {"t": 1, "q1": 2, "q2": 3, "tau1": 4, "tau2": 5}
EARLY = 0.004  # [s]


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """Of an arm whose torques act later than they are logged."""
    motion, _ = motion_of("five_bar")
    file = tmp_path / "arm.csv"
    rows = Logger(late=-EARLY).rows(motion, seed=1)
    np.savetxt(file, np.column_stack(rows), delimiter=",")
    return file


def test_a_log_gives_the_settings_of_every_command(
    log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = onpath.identify("five_bar", log, columns=PLACES)
    assert found.settings["coulomb"] == pytest.approx(DRY, rel=0.2)
    assert found.settings["delay"] == pytest.approx(1e3 * EARLY, abs=0.3)
    columns = ",".join(f"{name}={place}" for name, place in PLACES.items())
    assert run_command(["identify", str(log), "--column", columns, "--json"]) == 0
    file = tmp_path / "arm.json"
    file.write_text(capsys.readouterr().out, encoding="utf-8")

    settings: dict[str, Any] = found.settings
    run = onpath.simulate(hold=(0.2, 0.5), duration=0.7, **settings)
    times = "hold_from=0.2,hold_to=0.5,duration=0.7"
    told = ["experiment", "obstruction", "--law", "path_following", "--json", "--set", times]
    assert run_command([*told, "--set", f"@{file}"]) == 0
    laws = json.loads(capsys.readouterr().out)["laws"]
    assert laws["path_following"] == run.summary()

    lab = Serve(set=(f"@{file}",))._settings(ROBOTS["five_bar"])  # pyright: ignore[reportPrivateUsage]
    assert {name: float(value) for name, value in lab.items()} == found.settings
    for each in (settings, assignments((f"@{file}",))):
        parameters = trials_of(("five_bar",), 1, 1, each)[0][1].experiment(False).parameters
        assert parameters.coulomb == run.experiment.parameters.coulomb
        assert parameters.delay == run.experiment.parameters.delay


@given(st.floats(1e-4, 0.1), st.floats(1e-3, 200))
def test_what_a_log_tells_of_an_arm_can_be_set(delay: float, friction: float) -> None:
    """Also of a large arm and a slow controller."""
    late = BaseParameter("delay", -delay, 0.0, -delay, -delay)
    dry = BaseParameter("c1", friction, 0.0, friction, friction)
    rows = np.zeros((1, 7))
    found = Estimate((dry,), (), 0.0, late, rows[:, 0], rows, rows)
    zeros = np.zeros(7)
    file = FileEstimate("seven_axes", (), (), 1.0, True, found, None, zeros, zeros, {})
    parameters = with_values(ROBOTS["seven_axes"].parameters(), file.settings)
    assert parameters.delay / parameters.control_rate == pytest.approx(delay, rel=1e-3)
    assert parameters.coulomb == pytest.approx(friction, rel=1e-3)


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"settings": 3}', '{"settings": {"delay": "x"}}']
)
def test_another_file_is_refused_in_a_sentence(text: str, tmp_path: Path) -> None:
    file = tmp_path / "other.json"
    file.write_text(text)
    with pytest.raises(ValueError, match="expected a file of onpath identify --json"):
        assignments((f"@{file}",))


def test_a_setting_that_no_robot_has_is_refused_before_the_arena(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="coulom"):
        onpath.arena("five_bar", rounds=1, coulom=0.1)
