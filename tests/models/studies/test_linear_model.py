"""From a record of its motion, the parameters of any robot whose model is linear in them."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onpath.app.cli.main import run_command
from onpath.app.exports.files import csv_bytes
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.trajectory import MEASURED, write_csv
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.studies.experiments import experiments, run
from onpath.models.studies.linear_model import MotionRecord, linear_model
from onpath.models.studies.parameter_estimate import estimate
from onpath.models.studies.record_file import read_records
from onpath.models.studies.table_file import LONGEST_LINE
from onpath.models.systems.catalogue import ROBOTS
from tests.support.cases import drawn
from tests.support.lab import do
from tests.support.lab import run as run_lab
from tests.support.passive_chain import Shape, passive_chain

RIGID = [name for name, entry in ROBOTS.items() if entry.flexible_link is None]
MADE = {name: ROBOTS[name].make(ROBOTS[name].parameters()).system for name in RIGID}
TURNING = [
    name
    for name, system in MADE.items()
    if system.n <= 3 and all(each.endswith("_rad") for each in system.coordinate_names)
]
"""Those without slides, for which the errors of the angles would be 3 mm, and without a wrist."""


@cache
def text_of(robot: str, **values: float) -> str:
    """The CSV of an obstruction with a payload that the controller does not know."""
    chosen = experiments(robot)["obstruction"].with_values({"duration": 6.0, **values})
    file = io.StringIO()
    write_csv(file, chosen.robot(), [run(chosen, "path_following")])
    return file.getvalue()


def record(robot: str, folder: Path, **values: float) -> MotionRecord:
    path = folder / "motion.csv"
    path.write_text(text_of(robot, **values))
    entry = ROBOTS[robot]
    return dict(read_records(path, entry.make(entry.parameters())))["path_following"]


def found(robot: str, motion: MotionRecord):
    entry = ROBOTS[robot]
    made = entry.make(entry.parameters())
    return estimate(made.system, [motion], made.plant(entry.parameters()))


@pytest.mark.parametrize("robot", ["five_bar", "two_link_arm"])
def test_a_file_gives_the_robot_back_to_four_digits(robot: str, tmp_path: Path) -> None:
    result = found(robot, record(robot, tmp_path, payload=0.05))
    entry = ROBOTS[robot]
    loaded = entry.parameters()
    made = entry.make(loaded)
    plant = made.plant(replace(loaded, payload=0.05))  # type: ignore[call-arg]
    true = dict(zip(made.system.parameter_names, plant.tolist(), strict=True))
    assert {each.name for each in result.found} == set(linear_model(made.system).names)
    for each in result.found:
        assert not each.others
        assert each.value == pytest.approx(true[each.name], rel=2e-4, abs=2e-5), each.name
    assert result.unexplained < 1e-4 and not result.unexcited


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "two_link_arm"])
def test_errors_of_noisy_encoders_are_as_large_as_stated(robot: str, tmp_path: Path) -> None:
    clean = record(robot, tmp_path, payload=0.05)
    exact = {each.name: each.value for each in found(robot, clean).found}
    z = list[float]()
    for seed in range(12):
        rng = np.random.default_rng(seed)
        step = 2 * np.pi / 20000
        q = step * np.floor((clean.q + 1e-4 * rng.normal(size=clean.q.shape)) / step + 0.5)
        v = clean.v + 5e-3 * rng.normal(size=clean.v.shape)
        result = found(robot, replace(clean, q=q, v=v))
        for each in result.found:
            assert each.value == pytest.approx(exact[each.name], rel=0.02, abs=5e-3)
            z.append((each.value - exact[each.name]) / each.error)
    assert 0.5 < np.sqrt(np.mean(np.square(z))) < 2.0


def test_dry_friction_is_found_where_there_is_some(tmp_path: Path) -> None:
    result = found("five_bar", record("five_bar", tmp_path, coulomb=0.04))
    values = {each.name: each.value for each in result.found}
    assert values["c1"] == pytest.approx(0.04, rel=0.01)
    assert values["c2"] == pytest.approx(0.04, rel=0.01)


NOISY = {"encoder_counts": 2000, "sensor_noise": 5e-4}
FILTERED = {**NOISY, "observer_time": 0.0}  # with the observer, the delay found is 1 ms off


@pytest.mark.thorough
@pytest.mark.parametrize("values", [{"encoder_counts": 500}, {"sensor_noise": 1e-3}, NOISY])
@pytest.mark.parametrize("robot", RIGID)
def test_the_file_has_the_angles_that_the_loop_reads(robot: str, values: dict[str, float]) -> None:
    """The loop keeps them in its state after each tick."""
    chosen = experiments(robot)["obstruction"].with_values({"duration": 0.1, "seed": 3} | values)
    own = run(chosen, "path_following")
    made, curve = chosen.robot(), chosen.curve()
    kernel = kernel_of(made, kind_of("path_following", chosen.parameters, curve))
    state = first_state(made, kernel, curve, own.fields["q"][0])
    settings = settings_vector(made, kernel, chosen.parameters, curve, FREE)
    loop = InterpretedLoop(kernel)
    for k in range(100):
        state, rows = loop.run(state, settings, curve.table(), 1)
        assert np.array_equal(kernel.log.unpack(rows)["q"][0], own.fields["q"][k])
        read = kernel.state.unpack(state)["encoder"]
        assert read == pytest.approx(own.fields[MEASURED][k], abs=1e-12)


@pytest.mark.thorough
@pytest.mark.parametrize("robot", drawn(RIGID, 2))
def test_measured_angles_are_written_and_used(
    robot: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "motion.csv"
    for values, angles in ((NOISY, "measured"), (dict[str, float](), "true")):
        path.write_text(text_of(robot, **values))
        assert ("_measured_" in path.read_text().splitlines()[0]) is bool(values)
        assert run_command(["identify", str(path), "--robot", robot, "--json"]) == 0
        data = json.loads(capsys.readouterr().out)
        assert data["angles"] == angles
        assert (data["unexplained"] > 1e-3) is bool(values)  # not the true motion
        assert run_command(["identify", str(path), "--robot", robot]) == 0
        table = capsys.readouterr().out
        assert f"from the {angles} angles" in table and "95 %" in table


@pytest.mark.thorough
def test_a_record_of_another_robot_or_in_degrees_is_doubted(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "motion.csv"
    text = text_of("five_bar")
    names, *rows = (line.split(",") for line in text.splitlines())
    angles = [i for i, name in enumerate(names) if name.startswith(("q1", "q2"))]
    for row in rows:
        for i in angles:
            row[i] = repr(float(np.degrees(float(row[i]))))
    degrees = "\n".join(",".join(row) for row in [names, *rows])
    cases = (text, "five_bar", False), (text, "two_link_arm", True), (degrees, "five_bar", True)
    for content, robot, doubted in cases:
        path.write_text(content)
        assert run_command(["identify", str(path), "--robot", robot]) == 0
        assert (f"is the robot {robot}, and" in capsys.readouterr().out) is doubted


def test_runs_with_and_without_exact_sensors_are_written_together() -> None:
    known = experiments()["obstruction"].with_values({"duration": 0.05})
    runs = [run(each, "path_following") for each in (known.with_values(NOISY), known)]
    file = io.StringIO()
    write_csv(file, known.robot(), runs)
    rows = [line.split(",") for line in file.getvalue().splitlines()]
    assert all(len(row) == len(rows[0]) for row in rows)
    assert all(row[2:4] == row[-2:] for row in rows[51:])  # exact sensors read what is


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("robot", "values"),
    drawn([*((name, {}) for name in RIGID), *((name, FILTERED) for name in TURNING)], 3),
)
def test_a_delay_of_the_logged_torques_changes_no_parameter(
    robot: str, values: dict[str, float], tmp_path: Path
) -> None:
    motion = record(robot, tmp_path, **values)
    cut: dict[str, Any] = {
        name: getattr(motion, name)[100:-100] for name in ("q", "v", "u", "force")
    }
    if motion.noise is not None:
        q, v = motion.noise
        cut["noise"] = q[100:-100], v[100:-100]
    in_time = found(robot, replace(motion, **cut))
    assert in_time.delay is not None
    near = 5e-4 + (in_time.delay.high - in_time.delay.low) / 2  # that is 0 without sensors
    assert abs(in_time.delay.value) < near
    for ticks in (-37, -8, 5, 20, 71):
        late = np.roll(motion.u, ticks, axis=0)[100:-100]
        result = found(robot, replace(motion, **cut | {"u": late}))
        assert result.delay is not None
        assert result.delay.value == pytest.approx(1e-3 * ticks, abs=near)
        for each, other in zip(result.found, in_time.found, strict=True):
            assert each.name == other.name
            assert each.value == pytest.approx(other.value, rel=0.01, abs=2 * other.error + 1e-4)


def test_a_delay_that_acts_like_friction_is_not_stated() -> None:
    """In a single wave, a delay of the torque is a change of the friction."""
    t, omega = np.linspace(0, 5.999, 6000), 2 * np.pi
    q1, v1 = 0.011 * np.sin(omega * t), 0.011 * omega * np.cos(omega * t)
    torque = -0.02 * omega**2 * q1 + 0.05 * v1
    q, v = np.stack([q1, 0 * t + 1], axis=1), np.stack([v1, 0 * t], axis=1)
    u = np.stack([torque, 0 * t], axis=1)
    assert found("five_bar", MotionRecord(1e-3, q, v, u, 0 * q)).delay is None


@pytest.mark.parametrize("dt", [0.8e-3, 1.7e-3, 3.3e-3, 4.7e-3])
def test_a_time_step_that_does_not_divide_the_window_changes_nothing(dt: float) -> None:
    t = dt * np.arange(round(6 / dt) + 1)
    q = np.stack([np.sin(5 * t) + 0.3 * np.sin(11 * t), 2 + np.sin(4 * t + 1)], axis=1)
    v = np.stack([5 * np.cos(5 * t) + 3.3 * np.cos(11 * t), 4 * np.cos(4 * t + 1)], axis=1)
    moment = np.array([0.02, 0.01]) * v + np.array([0.05, 0.03]) * q  # its rate is the torque
    u = np.diff(moment, axis=0) / dt
    rows = MotionRecord(dt, q[:-1], v[:-1], u, 0 * u)
    values = {each.name: each.value for each in found("five_bar", rows).found}
    for name, value in {"M11": 0.02, "M22": 0.01, "b1": 0.05, "b2": 0.03}.items():
        assert values[name] == pytest.approx(value, rel=2e-4)


def test_what_the_motion_does_not_tell_apart_is_estimated_as_a_sum() -> None:
    """In one small wave about the upright link, the weight acts as an inertia of G1 / ω²."""
    t, omega = 1e-3 * np.arange(4001), 2 * np.pi
    away = 0.011 * np.sin(omega * t)
    q1, v1 = np.pi / 2 + away, 0.011 * omega * np.cos(omega * t)
    gained, turned = np.diff(v1) / 1e-3, np.diff(q1) / 1e-3  # means over a step
    torque = 0.02 * gained + 0.05 * turned - 0.1 * (away[1:] + away[:-1]) / 2
    still = np.full(4000, np.pi)
    q, v = np.stack([q1[:-1], still], axis=1), np.stack([v1[:-1], 0 * still], axis=1)
    u = np.stack([torque, 0 * still], axis=1)
    result = found("five_bar", MotionRecord(1e-3, q, v, u, 0 * q))
    true = {"M11": 0.02, "G1": 0.1, "b1": 0.05}
    assert {"M22", "b2"} <= {*result.unexcited}
    sums = [each for each in result.found if each.name in ("M11", "G1")]
    (each,) = sums
    ((other, share),) = [pair for pair in each.others if pair[0] in ("M11", "G1")]
    assert share == pytest.approx(omega ** (-2 if other == "G1" else 2), rel=1e-3)
    assert each.value == pytest.approx(true[each.name] + share * true[other], rel=1e-3)
    assert f" + {share:.3g} {other}" in each.label()


def test_a_robot_that_is_not_linear_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "motion.csv").write_text(text_of("five_bar"))
    assert run_command(["identify", str(tmp_path / "motion.csv"), "--robot", "flexible"]) == 2
    assert "not linear" in capsys.readouterr().err


def test_the_command_prints_a_table_and_json(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "motion.csv"
    path.write_text(text_of("five_bar", payload=0.05))
    assert run_command(["identify", str(path)]) == 0
    table = capsys.readouterr().out
    assert "M11" in table and "0.0245" in table
    assert run_command(["identify", str(path), "--json", "--law", "path_following"]) == 0
    data = json.loads(capsys.readouterr().out)
    values = {each["name"]: each["value"] for each in data["parameters"]}
    assert values["M11"] == pytest.approx(0.0246, rel=1e-3) and data["not_excited"] == []


@pytest.mark.thorough
def test_the_file_of_a_lab_is_read_with_its_sides_and_typed_laws(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    typed = "across = -K1*min(xi, 1) - K2*dxi; along = -9*(theta - theta_r) - 6*(dtheta - speed)"
    lab, path = Lab(LoopCache(at_once=True)), tmp_path / "lab.csv"
    do(lab, c.Set("speed", 9.0), c.ChoosePath("clover"))
    run_lab(lab, 3.0)
    do(lab, c.TypeLaw(LEFT, typed), c.TypeLaw(RIGHT, typed), c.Hold(on=True))
    run_lab(lab, 1.0)
    do(lab, c.Hold(on=False))
    run_lab(lab, 2.0)
    path.write_bytes(csv_bytes(lab.simulation.robot, lab.simulation.history.all()))
    laws = [law for law, _ in read_records(path, lab.simulation.robot)]
    assert laws == ["trajectory_tracking", typed, "path_following", typed]
    for more, seconds in ([], 12), (["--law", typed], 6):
        assert run_command(["identify", str(path), "--json", *more]) == 0
        told = json.loads(capsys.readouterr().out)
        assert typed in told["laws"] and told["seconds"] == pytest.approx(seconds, abs=0.1)
        values = {each["name"]: each["value"] for each in told["parameters"]}
        assert values["b2"] == pytest.approx(0.03, rel=1e-3)  # of the five-bar robot


def damaged(text: str) -> dict[str, str]:
    lines = text.splitlines()
    cells = lines[700].split(",")
    return {
        "empty": "",
        "no header": "\n".join(lines[1:]),
        "only the header": lines[0] + "\n",
        "prose": "Dear reader,\nthis is not a table.\n",
        "a line of 10 MB": lines[0] + "\n" + "7" * 10_000_000 + "\n",
        "a header of 10 MB": "t_s,law," + "x," * 5_000_000,
        "not a number": "\n".join([*lines[:700], ",".join(["nan", *cells[1:]]), *lines[701:]]),
        "infinite": "\n".join([*lines[:700], ",".join([*cells[:2], "1e400", *cells[3:]])]),
        "text in a cell": "\n".join([*lines[:700], ",".join([*cells[:3], "abc", *cells[4:]])]),
        "a cell less": "\n".join([*lines[:700], ",".join(cells[:-1])]),
        "a column less": "\n".join(",".join(line.split(",")[:-6]) for line in lines),
        "time stands still": "\n".join([*lines[:700], *[lines[700]] * 900]),
        "too short": "\n".join(lines[:300]),
        "every tenth of a second": "\n".join([lines[0], *lines[1::100]]),
        "at rest": "\n".join(
            [lines[0], *(f"{k / 1000:g},{lines[1].split(',', 1)[1]}" for k in range(3000))]
        ),
        "zeros": "\0" * 5000,
    }


@pytest.mark.parametrize("name", list(damaged(",,,\n" * 702)))
def test_a_damaged_file_is_refused_in_one_line(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "damaged.csv"
    path.write_text(damaged(text_of("five_bar", payload=0.05))[name])
    assert run_command(["identify", str(path)]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith("onpath: ") and said.err.count("\n") == 1
    assert len(said.err) < 300 < LONGEST_LINE


def test_a_file_that_is_not_there_or_not_text(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["identify", str(tmp_path / "none.csv")]) == 2
    (tmp_path / "noise.csv").write_bytes(np.random.default_rng(0).bytes(100_000))
    assert run_command(["identify", str(tmp_path / "noise.csv")]) == 2
    assert run_command(["identify", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 3


def test_every_rigid_robot_says_whether_it_is_linear() -> None:
    for name in RIGID:
        entry = ROBOTS[name]
        assert linear_model(entry.make(entry.parameters()).system).names


def test_a_robot_without_parameters_has_nothing_to_identify() -> None:
    chain = passive_chain(Shape(joints=(0, 2, 1), motors=2, gravity=9.81, start=(0.3, 0.5, -0.2)))
    with pytest.raises(ValueError, match="depend on no parameter"):
        linear_model(chain.system)
