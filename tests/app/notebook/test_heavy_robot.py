"""Without a torque limit no torque is cut; beyond what its file states, every run says so."""

from __future__ import annotations

import json
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.comparison import outcomes_of
from onpath.app.exports.standalone.figure_choice import chosen
from onpath.app.exports.standalone.figure_data import figure_data
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.view.comparing import compared
from onpath.lessons.labels import robot_text
from onpath.lessons.words import ENGLISH, Words
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import fastest_batch, translate_loop
from onpath.models.control.settable import with_values
from onpath.models.paths.curves import circle
from onpath.models.studies.arena import run_under
from onpath.models.studies.experiments import Experiment, on_path
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.efforts import efforts
from onpath.models.systems.robots import RobotEntry
from tests.support.lab import do, loop_cache, run
from tests.support.robot_files import HEAVY, urdf

STATED = "3000 N m, 3000 N m, 2000 N m, 1000 N m, 1000 N m, 500 N m"
LAWS = ("path_following", "trajectory_tracking")


@pytest.fixture(scope="module")
def heavy(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RobotEntry]:
    entry = onpath.robot(written(tmp_path_factory.mktemp("heavy")))
    yield entry
    del ROBOTS[entry.name]


def written(folder: Path) -> Path:
    file = folder / "heavy.urdf"
    file.write_text(urdf("heavy", HEAVY), "utf-8")
    return file


def along(entry: RobotEntry, **values: float | str) -> Experiment:
    return on_path(entry, entry.parameters(), circle(0.1)).with_values({"duration": 1.0, **values})


@pytest.mark.thorough
@pytest.mark.parametrize("law", LAWS)
def test_an_arm_of_a_tonne_follows_its_path_with_the_torques_that_this_takes(
    heavy: RobotEntry, law: str
) -> None:
    """With an exact model it moves as a light one does."""
    moved = run_under(along(heavy, speed=6.0, start_along=0.6), law)
    assert moved.stopped_at is None and moved.distance.max() < 1e-5
    assert np.abs(moved.fields["u"]).max() > 3000  # the file's largest effort


@pytest.mark.thorough
@settings(max_examples=10)
@given(st.sampled_from(LAWS), st.floats(1, 20), st.booleans(), st.sampled_from([0.0, 0.01]))
def test_every_engine_gives_the_same_torques(
    heavy: RobotEntry, law: str, speed: float, pulled: bool, coulomb: float
) -> None:
    values = {"speed": speed, "coulomb": coulomb}
    parameters, curve = with_values(heavy.parameters(), values), circle(0.1)
    robot, push = heavy.make(parameters), Push(np.array([0.3, 0.1, -0.2])) if pulled else FREE
    kernel = kernel_of(robot, kind_of(law, parameters, curve, push))
    given = settings_vector(robot, kernel, parameters, curve, push)
    assert np.isfinite(given).all()
    state = first_state(robot, kernel, curve, robot.rest(np.array([0.1, 0.02, 0.0])))
    runs = [
        loop.run(state, given, curve.table(), 60)[1]
        for loop in (InterpretedLoop(kernel), translate_loop(kernel))
    ]
    assert np.array_equal(runs[0], runs[1])
    many = fastest_batch(kernel)
    _, rows = many.run_many([state] * 4, [given] * 4, [curve.table()] * 4, 60)
    assert rows[0] == pytest.approx(runs[0], rel=1e-6, abs=1e-6)
    assert np.abs(kernel.log.unpack(runs[0])["u"]).max() > 1000


def test_a_run_that_asks_for_more_says_so_and_one_within_its_limits_does_not(
    heavy: RobotEntry, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    held = {"duration": 1.0, "hold": (0.5, 0.8)}
    with pytest.warns(UserWarning, match=r"joint2 gave \d+ N m, more than the 3000 N m"):
        free = onpath.simulate(heavy, "circle 0.1", **held)
    speed, spring = 0.1 * 2 * np.pi, heavy.parameters().K1  # a brake pushes it aside, as any arm
    assert free.max_distance < 0.41 * speed / np.sqrt(spring)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", "standing still on this path already takes")
        cut = onpath.simulate(heavy, "circle 0.1", torque_limit=100, duration=0.4, speed=0.2)
    limits = efforts(heavy.make(heavy.parameters()))
    assert limits is not None
    assert (np.abs(cut.torque).max(axis=0) <= limits * (1 + 1e-12)).all()
    arguments = ["--robot", str(written(tmp_path)), "--path", "circle 0.1", "--law", LAWS[0]]
    settings = ["--set", "duration=1", "--set", "hold_from=0.4", "--set", "hold_to=0.6"]
    assert run_command(["experiment", "obstruction", *arguments, *settings]) == 0
    assert "path following: the motor of joint2 gave" in capsys.readouterr().err


@pytest.mark.thorough
def test_a_comparison_says_which_law_asks_for_more_and_of_which_motor(
    heavy: RobotEntry, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    command = ["compare", "--robot", str(written(tmp_path)), "--path", "circle 0.1", "--json"]
    command += ["--law", LAWS[0], "--obstruction", "none", "--set", "speed=6"]
    assert run_command([*command, "--set", "torque_limit=100"]) == 0
    printed = capsys.readouterr()
    assert "more than the" not in printed.err
    assert json.loads(printed.out)["beyond_efforts"] == {}
    assert run_command(command) == 0
    printed = capsys.readouterr()
    told = json.loads(printed.out)["beyond_efforts"][LAWS[0]]
    assert told.startswith("the motor of joint") and f"path following: {told}" in printed.err
    parameters = with_values(heavy.parameters(), {"speed": 6.0})
    found = {LAWS[0]: outcomes_of(heavy.name, parameters, circle(0.1), LAWS[0], "none")}
    (row,) = compared(found, LAWS[:1], "none", heavy.make(parameters), Words("de")).rows
    assert "der Motor von joint" in row.beyond


@pytest.mark.thorough
def test_the_lab_says_so_once_in_a_run(heavy: RobotEntry) -> None:
    lab = Lab(loop_cache())
    do(lab, c.ChooseRobot(heavy.name), c.Set("speed", 10.0))
    said = lab.messages
    run(lab, 0.5)
    assert "more than the" in lab.message and lab.message_level == "warning"
    shown = lab.messages
    assert said < shown <= said + 2  # one for each robot
    run(lab, 0.5)
    assert lab.messages == shown
    do(lab, c.Reset())
    run(lab, 0.5)
    assert lab.messages > shown and "more than the" in lab.message


def test_what_the_file_states_is_shown(heavy: RobotEntry) -> None:
    assert heavy.text.endswith(f"Largest torques of the motors by its file: {STATED}.")
    for name in ("planar_arm", "seven_axes"):
        texts = [robot_text(ROBOTS[name], words) for words in (ENGLISH, Words("de"))]
        assert all("N m" in text for text in texts) and texts[0] != texts[1]
    figure = chosen(heavy.name, LAWS, {"circle": circle(0.1)})
    data = json.loads(json.dumps(figure_data(figure, ENGLISH), allow_nan=False))
    assert [each["most"] for each in data["efforts"]] == [link.effort for link in HEAVY]


def test_a_robot_without_a_file_has_nothing_to_say() -> None:
    entry = ROBOTS["two_link_arm"]
    assert efforts(entry.make(entry.parameters())) is None
