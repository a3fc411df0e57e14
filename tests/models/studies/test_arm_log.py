"""A log of a real arm: any names, units and locale, uneven times, torques late by nobody knows."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import savemat

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.identification import identification_data
from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.studies.exciting_motion import planned_motion
from onpath.models.studies.linear_model import MotionRecord
from onpath.models.studies.parameter_estimate import conditioning, dependent_names
from onpath.models.studies.record_file import log_columns, read_records
from onpath.models.systems.catalogue import ROBOTS
from tests.support.arm_logs import (
    COLUMNS,
    DRY,
    UNITS,
    Logger,
    estimate_of,
    motion_of,
    random_log,
    shares_allowed,
    write_log,
)
from tests.support.cases import drawn
from tests.support.checkout import ROOT

QUANTITIES = {"t": "t_s", "q1": "q1_rad", "q2": "q2_rad", "tau1": "tau1_Nm", "tau2": "tau2_Nm"}
OPTIONS = [f"--column={name}={column}" for name, column in COLUMNS.items()]
OPTIONS += [f"--unit={name}={unit}" for name, unit in UNITS.items()]


def truth(robot: str, plant: np.ndarray, dry: float = DRY) -> dict[str, float]:
    entry = ROBOTS[robot]
    system = entry.make(entry.parameters()).system
    known = dict(zip(system.parameter_names, plant.tolist(), strict=True))
    return known | {f"c{i + 1}": dry for i in range(system.m)}


@pytest.fixture
def log(tmp_path: Path) -> Path:
    motion, _ = motion_of("five_bar")
    path = tmp_path / "arm.csv"
    write_log(path, *Logger().rows(motion, seed=1))
    return path


@pytest.mark.thorough
def test_a_log_in_other_units_and_another_locale_gives_the_arm(log: Path) -> None:
    result = onpath.identify("five_bar", log, columns=COLUMNS, units=UNITS)
    true = truth("five_bar", motion_of("five_bar")[1])
    assert set(result.values) >= {"M11", "M22", "b1", "b2", "c1", "c2"}
    for name, value in result.values.items():
        assert value == pytest.approx(true[name], rel=0.05, abs=3e-3), name
    assert result.delay == pytest.approx(Logger.late, abs=5e-4)
    assert result.found.measured and result.found.laws == ()


@pytest.mark.thorough
def test_the_command_says_the_same_as_python_and_draws(
    log: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / "residuals.svg"
    assert run_command(["identify", str(log), *OPTIONS, "--json", "--plot", str(picture)]) == 0
    data = json.loads(capsys.readouterr().out)
    result = onpath.identify("five_bar", log, columns=COLUMNS, units=UNITS)
    told = {each["name"]: tuple(each["interval"]) for each in data["parameters"]}
    assert told.keys() == result.intervals.keys()
    for name, interval in result.intervals.items():
        assert told[name] == pytest.approx(interval, rel=1e-5, abs=1e-9)
    assert data["torque_late_s"] == pytest.approx(result.delay, rel=1e-2)
    assert picture.read_text("utf-8").startswith("<?xml")
    assert run_command(["identify", str(log), *OPTIONS]) == 0
    assert capsys.readouterr().out.strip() == repr(result)


def test_residuals_are_small_where_the_model_is_right(log: Path) -> None:
    found = onpath.identify("five_bar", log, columns=COLUMNS, units=UNITS).found.estimate
    assert found.torque.shape == found.residual.shape == (len(found.times), 2)
    share = np.linalg.norm(found.residual) / np.linalg.norm(found.torque)
    assert share == pytest.approx(found.unexplained)
    assert share < 0.05


def test_uneven_times_give_what_even_ones_give() -> None:
    """Without noise, only the interpolation is left."""
    entry = ROBOTS["five_bar"]
    motion, plant = motion_of("five_bar", dry=0.0)
    true = truth("five_bar", plant, dry=0.0)
    for seed, uneven in enumerate((0.0, 0.5, 0.99)):
        exact = Logger(uneven=uneven, angle_noise=0, torque_noise=0)
        values = found_in(exact.rows(motion, seed), entry.name, plant)
        for name, (value, _, _) in values.items():
            true_value = exact.late if name == "delay" else true[name]
            assert value == pytest.approx(true_value, rel=5e-3, abs=5e-4), (uneven, name)


def inertias_off(logger: Logger, seeds: range) -> Array:
    """Mean error of M11 and M22 in logs without friction, as a share of them."""
    motion, plant = motion_of("five_bar", dry=0.0)
    true = truth("five_bar", plant, dry=0.0)
    found = [found_in(logger.rows(motion, seed), "five_bar", plant) for seed in seeds]
    shares = [[x[name][0] / true[name] - 1 for name in ("M11", "M22")] for x in found]
    return np.array(shares).mean(axis=0)


def test_torques_that_change_within_a_row_are_not_taken_for_constant() -> None:
    """Without noise. If they were constant, inertias would seem 0.5 % too small here."""
    exact = Logger(rate=100, uneven=0.3, angle_noise=0, torque_noise=0)
    assert np.abs(inertias_off(exact, range(1))).max() < 1.5e-3


def test_noise_of_the_angles_does_not_bias_inertias() -> None:
    """If its effect in the regressor was left in, they would seem 4 to 6 % too small here."""
    noisy = Logger(rate=100, uneven=0.3, angle_noise=6e-3)
    assert np.abs(inertias_off(noisy, range(8))).max() < 0.025


def found_in(
    rows: tuple[np.ndarray, np.ndarray, np.ndarray], robot: str, plant: np.ndarray
) -> dict[str, tuple[float, float, float]]:
    """Estimates with their intervals, of a log that went through a file."""
    result = estimate_of(rows, robot, plant)
    assert result.delay is not None and not any(each.others for each in result.found)
    return {each.name: (each.value, each.low, each.high) for each in (*result.found, result.delay)}


LOGGERS = (
    Logger(rate=1000, uneven=0.0, late=0.004),
    Logger(rate=500, uneven=0.6, late=-0.013, angle_noise=5e-4, torque_noise=0.02, counts=4000),
    Logger(rate=100, uneven=0.6, late=0.023, torque_noise=0.02),
    Logger(rate=200, uneven=0.3, late=0.007, angle_noise=1e-3, torque_noise=0.05),
)


def covered(robot: str, logger: Logger, seeds: range) -> list[bool]:
    """Whether each interval of each log contains the truth."""
    motion, plant = motion_of(robot)
    true = truth(robot, plant) | {"delay": logger.late}
    each = [found_in(logger.rows(motion, seed), robot, plant) for seed in seeds]
    return [low <= true[n] <= high for found in each for n, (_, low, high) in found.items()]


@pytest.mark.thorough
@pytest.mark.parametrize("robot", drawn(["five_bar", "two_link_arm"], 1))
def test_of_logs_of_one_motion_as_many_intervals_contain_the_truth_as_they_say(robot: str) -> None:
    each = [covered(robot, logger, range(12)) for logger in LOGGERS]
    assert 0.90 <= np.mean(np.concatenate(each)) <= 1
    assert all(np.mean(of_logger) > 0.85 for of_logger in each)


@pytest.mark.thorough
@pytest.mark.parametrize("robot", ["five_bar", "two_link_arm"])
def test_intervals_contain_the_truth_where_motors_stick(robot: str) -> None:
    """Friction is not as the estimate assumes; tests/bench/intervals.py counts for each value."""
    logs = [log for log in (random_log(robot, seed) for seed in range(15)) if log]
    shares = [share for log in logs for share in shares_allowed(robot, log).values()]
    assert len(shares) > 100 and np.mean(np.array(shares) <= 1) >= 0.9


def test_a_motion_that_is_too_short_has_no_intervals(tmp_path: Path) -> None:
    motion, _ = motion_of("five_bar")
    t, q, u = Logger(rate=500).rows(motion, seed=1)
    path = tmp_path / "short.csv"
    write_log(path, t[:600], q[:600], u[:600])
    result = onpath.identify("five_bar", path, columns=COLUMNS, units=UNITS)
    assert all(np.isinf(low) and np.isinf(high) for low, high in result.intervals.values())
    assert "± ?" in repr(result) and "too little of the motion" in repr(result)
    assert identification_data(result.found)["parameters"][0]["interval"] is None


def test_the_advised_motion_tells_what_the_log_does_not(tmp_path: Path) -> None:
    """One joint swings in a single wave, and the other rests."""
    t = np.arange(0, 6, 2e-3)
    q1 = np.pi / 2 + 0.011 * np.sin(2 * np.pi * t)
    q = np.column_stack([q1, np.full(len(t), np.pi)])
    u = np.column_stack([0.1 * np.cos(q1) + 0.02 * np.gradient(np.gradient(q1, t), t), 0 * t])
    path = tmp_path / "poor.csv"
    write_log(path, t, q, u)
    result = onpath.identify("five_bar", path, columns=COLUMNS, units=UNITS)
    found, motion = result.found.estimate, result.found.motion
    assert found.unexcited or any(each.others for each in found.found)
    assert motion is not None and not motion.left
    assert "q2" in motion.moving and {"M22", "b2"} <= {*motion.identified}
    assert f"would also tell {', '.join(motion.identified)}" in repr(result)


def test_the_log_of_the_examples_gives_the_arm_of_which_it_is(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """The command of models/studies/README.md; assets/examples/make_arm_log.py has the truth."""
    text = (ROOT / "models" / "studies" / "README.md").read_text("utf-8")
    (block,) = [each for each in text.split("```sh") if "assets/examples/arm.csv" in each]
    program, *command = shlex.split(block.split("```")[0])
    command = [each.replace("assets", str(ROOT / "assets")) for each in command]
    assert program == "onpath" and run_command([*command, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    true = {"M11": 0.0226, "M22": 0.012, "b1": 0.05, "b2": 0.03, "c1": 0.03, "c2": 0.03}
    told = {each["name"]: each["interval"] for each in data["parameters"]}
    for name, value in (true | dict.fromkeys(("M12", "G1", "G2"), 0.0)).items():
        assert told[name][0] <= value <= told[name][1], name
    assert set(data["settings"]) == {"coulomb"}  # torques that are logged late are no delay
    low, high = data["torque_late_interval_s"]
    assert low <= 0.0128 <= high


def test_a_rich_log_needs_no_other_motion(log: Path) -> None:
    assert onpath.identify("five_bar", log, columns=COLUMNS, units=UNITS).found.motion is None
    entry = ROBOTS["five_bar"]
    made = entry.make(entry.parameters())
    records = [each for _, each in read_records(log, made, log_columns(made, COLUMNS, UNITS))]
    assert dependent_names(made.system, records, motion_of("five_bar")[1], ("M11", "M22")) == ()


def lines(rows: int = 3000) -> list[list[str]]:
    t = 2e-3 * np.arange(rows)
    q = 0.5 * np.column_stack([np.sin(5 * t), np.sin(4 * t)])
    body = np.column_stack([t, q, np.cos(5 * t), np.cos(4 * t)])
    return [list(QUANTITIES), *([f"{x:.9g}" for x in row] for row in body)]


def changed(row: int, column: int, text: str) -> str:
    table = lines()
    table[row][column] = text
    return "\n".join(map(",".join, table))


PLACES = {name: place for place, name in enumerate(("t", "q1", "q2", "tau1", "tau2"), 1)}


def saved(kind: str, folder: Path, t: Array, q: Array, u: Array) -> Path:
    """A log as other programs save it, without names of columns."""
    whole, path = np.column_stack([t, q, u]), folder / f"log.{kind}"
    arrays = {
        "t": t,
        "q": q,
        "tau": u,
        "note": np.array(["by hand"]),
        "rate": np.array(500.0),
        **{f"k{i}": np.array(1.0) for i in range(9)},
    }
    if kind == "csv":
        np.savetxt(path, whole, delimiter=",")
    elif kind == "txt":
        np.savetxt(path, whole, header="t q1 q2 tau1 tau2")
    elif kind == "asc":  # as MATLAB's save -ascii
        path.write_text("\n".join("".join(f"{x:16.7e}" for x in row) for row in whole))
    elif kind == "pandas.csv":
        names = ",".join(map(str, range(5)))
        np.savetxt(path, whole, delimiter=",", header=names, comments="")
    elif kind == "npy":
        np.save(path, whole)
    elif kind == "npz":
        np.savez(path, **arrays)
    else:
        savemat(path, {**arrays, "q": q.T})  # one matrix lies on its side
    return path


@pytest.mark.parametrize("kind", ["csv", "txt", "asc", "npy", "npz", "mat"])
def test_a_log_without_names_gives_what_one_with_names_does(kind: str, tmp_path: Path) -> None:
    motion, _ = motion_of("five_bar")
    t, q, u = Logger().rows(motion, seed=1)
    write_log(tmp_path / "named.csv", t, q, u)
    named = onpath.identify("five_bar", tmp_path / "named.csv", columns=COLUMNS, units=UNITS)
    given = None if kind in ("npz", "mat") else PLACES
    found = onpath.identify("five_bar", saved(kind, tmp_path, t, q, u), columns=given)
    assert found.values == pytest.approx(named.values, rel=1e-3, abs=1e-5)


def test_names_that_are_numbers_are_names(tmp_path: Path) -> None:
    """pandas names columns 0, 1, 2: there, 1 is the second."""
    motion, _ = motion_of("five_bar")
    t, q, u = Logger().rows(motion, seed=1)
    plain = onpath.identify("five_bar", saved("csv", tmp_path, t, q, u), columns=PLACES)
    counted = {name: place - 1 for name, place in PLACES.items()}
    found = onpath.identify("five_bar", saved("pandas.csv", tmp_path, t, q, u), columns=counted)
    assert found.values == plain.values


def test_times_in_nanoseconds_since_1970_are_read(tmp_path: Path) -> None:
    motion, _ = motion_of("five_bar")
    t, q, u = Logger().rows(motion, seed=1)
    path, begin = tmp_path / "bag.csv", 1_764_490_000_000_000_000
    rows = zip(t, q, u, strict=True)
    path.write_text(
        "\n".join(
            ",".join([str(begin + round(1e9 * time)), *(f"{x:.9g}" for x in (*angles, *torques))])
            for time, angles, torques in rows
        )
    )
    plain = onpath.identify("five_bar", saved("csv", tmp_path, t, q, u), columns=PLACES)
    found = onpath.identify("five_bar", path, columns=PLACES, units={"t": "ns"})
    for name, (low, high) in plain.intervals.items():
        assert abs(found.values[name] - plain.values[name]) < 0.1 * (high - low), name


@pytest.mark.parametrize("kind", ["csv", "npy"])
def test_a_column_that_is_not_there_is_asked_for_by_its_number(kind: str, tmp_path: Path) -> None:
    path = saved(kind, tmp_path, np.arange(9.0), np.zeros((9, 2)), np.zeros((9, 2)))
    for columns in ({}, {"t": 1}, PLACES | {"q2": 6}, PLACES | {"q2": 0}):
        with pytest.raises(CodedError, match=r"--column t=1 --column q1=2"):
            onpath.identify("five_bar", path, columns=columns, units={"t": "s"})


def test_hostile_arrays_are_refused(tmp_path: Path) -> None:
    pickled, cut = tmp_path / "a.npy", tmp_path / "b.npz"
    np.save(pickled, np.array([{}], dtype=object), allow_pickle=True)
    np.savez(cut, t=np.arange(9.0))
    cut.write_bytes(cut.read_bytes()[:-30])
    (tmp_path / "c.mat").write_bytes(b"MATLAB 7.3 MAT-file" + bytes(200))
    np.savez(tmp_path / "d.npz", note=np.array(["nothing"]))
    bad = np.zeros((900, 5))
    bad[:, 0], bad[7, 2] = np.arange(900), np.nan
    np.save(tmp_path / "e.npy", bad)
    for name, said in (
        ("a.npy", "Object"),
        ("b.npz", "zip"),
        ("c.mat", "cannot be read"),
        ("d.npz", "no vector"),
    ):
        with pytest.raises(CodedError, match=said):
            onpath.identify("five_bar", tmp_path / name, columns=PLACES)
    with pytest.raises(CodedError, match="line 8, column 3: nan is out of range"):
        onpath.identify("five_bar", tmp_path / "e.npy", columns=PLACES)


@pytest.mark.thorough
def test_a_second_log_judges_the_values(tmp_path: Path) -> None:
    """Of the same arm, it is explained as well as the first; of another arm, it is not."""
    shares = list[float]()
    for place, (robot, preset) in enumerate((("five_bar", "circle"), ("two_link_arm", "clover"))):
        (folder := tmp_path / str(place)).mkdir()
        motions = motion_of("five_bar")[0], motion_of(robot, preset)[0]
        files = [
            saved("csv", folder, *Logger().rows(each, seed)).rename(folder / f"{seed}.csv")
            for seed, each in enumerate(motions)
        ]
        first, second = files
        found = onpath.identify("five_bar", first, columns=PLACES, validate=second)
        assert f"in {second} is not explained by these values" in repr(found)
        own = found.found.estimate.unexplained
        shares.append(found.unexplained[str(second)] / own)
    assert shares[0] < 2 and shares[1] > 5, shares


HOSTILE = {
    "an infinite angle": (changed(40, 1, "1e999"), "line 41, column q1"),
    "a huge angle": (changed(40, 2, "1e8"), "line 41, column q2"),
    "a huge torque": (changed(40, 3, "-9e8"), "line 41, column tau1"),
    "not a number": (changed(7, 4, "nan"), "line 8, column tau2"),
    "a formula": (changed(7, 4, "=1+1"), "line 8, column tau2"),
    "a comma in a number": (changed(7, 4, '"0,5"'), "line 8, column tau2"),
    "time goes back": (changed(100, 0, "0.1"), "line 101, column t"),
    "time stands still": (changed(100, 0, lines()[99][0]), "line 101, column t"),
    "an endless time": (changed(100, 0, "1e19"), "line 102, column t"),
    "a time from another world": (changed(100, 0, "1e21"), "line 101, column t"),
    "too slow": ("\n".join(map(",".join, [lines()[0], *lines()[1::10]])), "column t"),
    "one row": ("\n".join(map(",".join, lines()[:2])), "line 2"),
    "too short": ("\n".join(map(",".join, lines(30))), ""),
    "a cell less": (changed(9, 4, "").rstrip(",").replace(",\n", "\n"), "line 10"),
    "a column twice": (changed(0, 2, "q1"), "line 1"),
    "a column less": (changed(0, 2, "other"), "line 1: there is no column q2"),
    "nothing": ("", "line 1"),
    "only names": (",".join(QUANTITIES), "line 1"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_log_is_refused_in_one_line_with_its_place(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, place = HOSTILE[name]
    path = tmp_path / "log.csv"
    path.write_text(text)
    options = [f"--column={each}={each}" for each in QUANTITIES]
    assert run_command(["identify", str(path), *options]) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith("onpath: ") and said.err.count("\n") == 1
    assert place in said.err and len(said.err) < 300


@given(st.data())
@settings(deadline=None, max_examples=10)
def test_at_a_gap_another_record_begins_and_a_repeated_row_counts_once(data: st.DataObject) -> None:
    """The records are those of the file that is cut there and has each row once."""
    made = ROBOTS["five_bar"].make(ROBOTS["five_bar"].parameters())
    known = log_columns(made, {name: name for name in QUANTITIES}, {})
    first = data.draw(st.integers(100, 1400))
    last = first + data.draw(st.integers(60, 500))
    again = data.draw(st.lists(st.integers(1, 90), max_size=3, unique=True))
    table = lines()

    def read(rows: list[list[str]]) -> list[MotionRecord]:
        with TemporaryDirectory() as folder:
            path = Path(folder, "log.csv")
            path.write_text("\n".join(map(",".join, [table[0], *rows])), encoding="utf-8")
            return [record for _, record in read_records(path, made, known)]

    repeated = [row for i, row in enumerate(table[1:first], 1) for _ in range(1 + (i in again))]
    before, after = read([*repeated, *table[last:]])
    for found, (wanted,) in ((before, read(table[1:first])), (after, read(table[last:]))):
        assert found.q == pytest.approx(wanted.q, abs=1e-9)
        assert found.u == pytest.approx(wanted.u, abs=1e-9)
        assert found.dt == pytest.approx(wanted.dt)
    assert before.start == 0
    assert after.start == pytest.approx(float(table[last][0]) - float(table[1][0]))


@pytest.mark.parametrize(
    ("columns", "units", "said"),
    [
        ({"q3": "x"}, {}, "q2, q1"),
        ({"t": "t"}, {"q9": "deg"}, "q2, q1"),
        ({}, {"q1": "degrees"}, "deg"),
        ({}, {"tau1": "A"}, "unit of tau1"),
        ({}, {"tau1": 0}, "must not be 0"),
        ({}, {"tau1": float("nan")}, "must not be 0"),
        ({"force1": "F"}, {}, "there is no column F"),
        ({"t": "Time"}, {}, "there is no column Time"),
    ],
)
def test_wrong_names_and_units_are_refused(
    columns: dict[str, str], units: dict[str, str | float], said: str, tmp_path: Path
) -> None:
    path = tmp_path / "log.csv"
    path.write_text("\n".join(map(",".join, lines())))
    named = {name: name for name in QUANTITIES} | columns
    with pytest.raises(CodedError, match=said):
        onpath.identify("five_bar", path, columns=named, units=units)


def test_forces_count_if_the_log_has_them(tmp_path: Path) -> None:
    """J^T F of a force that balances the motors' torques leaves nothing to explain."""
    path, table = tmp_path / "log.csv", lines()
    table[0] += ["Fx", "Fz"]
    for row in table[1:]:
        row += ["0.5", "-0.25"]
    path.write_text("\n".join(map(",".join, table)))
    made = ROBOTS["five_bar"].make(ROBOTS["five_bar"].parameters())
    names = {name: name for name in QUANTITIES}
    columns = log_columns(made, names | {"force1": "Fx", "force2": "Fz"}, {})
    ((_, record),) = read_records(path, made, columns)
    assert np.array_equal(record.force, np.tile([0.5, -0.25], (3000, 1)))
    ((_, record),) = read_records(path, made, log_columns(made, names, {}))
    assert not record.force.any()


@pytest.mark.parametrize("robot", drawn(["five_bar", "planar_arm", "rod_gantry", "spatial_arm"], 2))
def test_the_motion_to_record_next_can_be_played_and_tells_all(robot: str) -> None:
    """It rests at both ends, keeps off the limits, and is no faster than asked for."""
    entry = ROBOTS[robot]
    made = entry.make(entry.parameters())
    rng = np.random.default_rng(1)
    centre = made.rest(made.frame.lift(rng.uniform(-0.01, 0.01, 2)))
    fastest = rng.uniform(0.3, 2, made.system.n)
    motion = planned_motion(entry, centre, fastest)
    assert made.fault(motion.q, motion.v, entry.parameters()) is None
    assert np.all(np.abs(motion.v) <= fastest.max() * (1 + 1e-9))
    assert np.allclose(motion.q[[0, -1]], centre) and np.all(motion.v[[0, -1]] == 0)
    rates = np.gradient(motion.q, motion.t, axis=0)
    assert np.abs(rates - motion.v)[1:-1].max() < 5e-3 * fastest.max()
    steps, none = np.diff(motion.t), 0.0 * motion.q[:, : made.system.m]
    record = MotionRecord(steps[0], motion.q, motion.v, none, 0.0 * made.endpoint(motion.q))
    plant = made.plant(entry.parameters())
    assert conditioning(made.system, [record], plant) == (motion.told, motion.condition)
    assert motion.told >= made.system.m + 2 and motion.condition < 30


@pytest.mark.thorough
def test_command_and_python_write_the_same_motion_to_record_next(log: Path, tmp_path: Path) -> None:
    file, again = tmp_path / "next.csv", tmp_path / "again.csv"
    assert run_command(["identify", str(log), *OPTIONS, "--motion", str(file)]) == 0
    onpath.identify("five_bar", log, columns=COLUMNS, units=UNITS).motion_to_csv(again)
    assert file.read_bytes() == again.read_bytes()
    names, *rows = file.read_text("utf-8").splitlines()
    assert names == "t_s,q1_rad,q2_rad,q1_rate_rad_s,q2_rate_rad_s" and len(rows) == 1601
