"""Robots with fewer motors than coordinates, in all that a user can do with them."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import numpy as np
import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_data import stop_texts
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.lessons.words import Words
from onpath.models.control.sides import SIDES
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FLEXIBLE, ROBOTS
from onpath.models.systems.system import MechanicalSystem
from tests.support.lab import FOLLOWER, assert_sound, do, new_lab, run
from tests.support.suitable_laws import laws_for

GANTRY, CART = ROBOTS["rod_gantry"], ROBOTS["cart_pendulum"]
UNSTABLE = "zero dynamics are unstable"
SINGULAR = "decoupling matrix is singular at the start"
SUITABLE = list(dict.fromkeys([*laws_for(GANTRY.name), *laws_for(CART.name)]))


@pytest.fixture
def lab() -> Lab:
    lab = new_lab()
    do(lab, c.ChooseRobot(GANTRY.name), c.SetRunning(False))
    return lab


def choose(lab: Lab, alpha: float) -> str:
    """What the lab says when α has been chosen, before it runs."""
    do(lab, c.Set("alpha", alpha))
    run(lab, 0.0)
    return lab.message


def test_the_lab_says_before_the_run_what_will_happen(lab: Lab) -> None:
    assert choose(lab, 0.9) == ""
    assert UNSTABLE in choose(lab, 1.1) and lab.message_level == "warning"
    assert SINGULAR in choose(lab, 1.0)
    assert choose(lab, 0.8) == ""


def test_the_lab_says_it_when_the_robot_or_the_law_is_chosen(lab: Lab) -> None:
    do(lab, c.ChooseRobot(CART.name), c.Set("pendulum", "upright"))
    assert UNSTABLE in lab.message
    do(lab, c.ChooseRobot("five_bar"))
    run(lab, 0.05)
    assert UNSTABLE not in lab.message


def test_the_lab_says_it_in_german(lab: Lab) -> None:
    do(lab, c.SetLanguage("de"))
    assert "Nulldynamik ist instabil" in choose(lab, 1.1)
    assert "Entkopplungsmatrix ist am Start singulär" in choose(lab, 1.0)


def test_nothing_is_said_while_a_prediction_is_pending(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Lab, "locked", Message("lesson.locked"))
    assert choose(lab, 1.1) == ""
    monkeypatch.undo()
    assert UNSTABLE in choose(lab, 1.2)


def test_a_stop_has_the_forecast_as_its_cause(lab: Lab) -> None:
    choose(lab, 1.0)
    do(lab, c.SetRunning(True))
    run(lab, 0.3)
    for side in SIDES:
        stopped = lab.simulation.runs[side].diverged
        assert stopped is not None
        assert f"Likely cause: the {SINGULAR}" in str(stopped.reason)
    assert SINGULAR in lab.message and lab.message_level == "error"


@pytest.mark.thorough
@pytest.mark.parametrize("law", SUITABLE)
@pytest.mark.parametrize("robot", [GANTRY.name, CART.name])
def test_it_runs_under_every_law_that_suits_it(robot: str, law: str) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot(robot))
    if not lab.simulation.suits(law):
        with pytest.raises(CodedError, match="not possible with this robot"):
            onpath.simulate(robot, law=law)
        return
    do(lab, c.ChooseLaw(FOLLOWER, law))
    run(lab, 0.5)
    assert_sound(lab)
    assert lab.simulation.runs[FOLLOWER].diverged is None
    assert onpath.simulate(robot, law=law, duration=0.5).stopped_at is None


@pytest.mark.parametrize("robot", [GANTRY.name, CART.name])
@pytest.mark.parametrize(
    "realism",
    [
        {"encoder_counts": 20000.0},
        {"sensor_noise": 1e-5},
        {"coulomb": 0.05},
        {"stiction": 0.08},
        {"delay": 1.0},
        {"torque_limit": 5.0},
        {"control_rate": 500, "look_ahead": "half_interval"},
    ],
)
def test_it_runs_with_every_kind_of_realism(robot: str, realism: dict[str, float]) -> None:
    made = onpath.simulate(robot, duration=1.0, **realism)  # type: ignore[arg-type]
    assert made.stopped_at is None
    assert np.abs(made.trajectory.fields["xi"]).max() < 5e-3


def test_encoders_are_on_the_joint_without_a_motor_too(tmp_path: Path) -> None:
    file = tmp_path / "gantry.csv"
    made = onpath.simulate(GANTRY.name, duration=0.2, encoder_counts=2000.0)
    made.to_csv(file)
    head, *rows = file.read_text().splitlines()
    at = head.split(",").index("phi_measured_rad")
    angles = {round(float(row.split(",")[at]) / (2 * np.pi / 2000), 6) for row in rows}
    assert len(angles) > 1 and all(angle == round(angle) for angle in angles)


def test_only_a_flexible_link_has_modes() -> None:
    systems = {name: entry.make(entry.parameters()).system for name, entry in ROBOTS.items()}
    for name, system in systems.items():
        assert bool(system.modes) == bool(ROBOTS[name].flexible_link)
    flexible: MechanicalSystem = systems[FLEXIBLE.name]
    assert flexible.joints == flexible.m == 3
    assert systems[GANTRY.name].joints == systems[GANTRY.name].n == 3


def test_python_warns_and_refuses() -> None:
    with pytest.warns(UserWarning, match=UNSTABLE):
        onpath.simulate(GANTRY.name, alpha=1.1, duration=0.05)
    with pytest.raises(CodedError, match=SINGULAR):
        onpath.simulate(GANTRY.name, alpha=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        onpath.simulate(GANTRY.name, alpha=0.9, duration=0.05)


@pytest.mark.parametrize(
    "words",
    [
        ["experiment", "position", "--set", "duration=0.05", "--json"],
        ["compare", "--obstruction", "none", "--law", "path_following", "--json"],
    ],
)
def test_the_command_line_says_it_and_refuses(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    own = [*words, "--robot", GANTRY.name, "--set"]
    run_command([*own, "alpha=1.1"])
    told = capsys.readouterr()
    assert UNSTABLE in told.err and json.loads(told.out)
    run_command([*own, "alpha=0.9"])
    assert capsys.readouterr().err == ""
    assert run_command([*own, "alpha=1.0"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert SINGULAR in line


def test_the_export_of_a_figure_says_it_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = ["figure", str(tmp_path / "gantry.html"), "--robot", GANTRY.name, "--set"]
    assert run_command([*own, "alpha=1.1"]) == 0
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("onpath: ") and UNSTABLE in line


def test_a_figure_warns_refuses_and_tells_the_cause_on_its_page() -> None:
    with pytest.raises(CodedError, match=SINGULAR):
        onpath.figure(GANTRY.name, "circle", alpha=1.0)
    with pytest.warns(UserWarning, match=UNSTABLE):
        shown = onpath.figure(GANTRY.name, "circle", alpha=1.1)
    assert UNSTABLE in shown.html
    for alpha, told in ((1.1, True), (0.9, False)):
        figure = chosen(GANTRY.name, paths={"circle": circle(0.05)}, values={"alpha": alpha})
        texts = stop_texts(figure, figure.laws[0], circle(0.05), False, Words("en"))
        assert any(UNSTABLE in text for text in texts) == told
