"""`onpath compare` on the command line."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import pytest

from onpath.app.cli.main import run_command

PAIR = ["--law", "path_following", "--law", "trajectory_tracking", "--obstruction", "wall"]


@pytest.mark.thorough
def test_table_json_csv_and_picture_tell_the_same(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows, picture = tmp_path / "a.csv", tmp_path / "a.png"
    arguments = ["compare", *PAIR, "--csv", str(rows), "--plot", str(picture)]
    assert run_command(arguments) == 0
    table = capsys.readouterr().out
    assert run_command([*arguments, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)["laws"]
    with rows.open(newline="") as file:
        read = list(csv.DictReader(file))
    for law in PAIR[1], PAIR[3]:
        own = [row for row in read if row["law"] == law]
        largest = 1000 * max(o["max_distance_m"] for o in data[law]["wall"])
        assert largest == pytest.approx(1000 * max(float(row["max_distance_m"]) for row in own))
        assert f"{largest:.2f}" in table
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_laws_under_weak_motors_run_with_and_without_the_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = tmp_path / "a.csv"
    arguments = ["compare", *PAIR[:4], "--obstruction", "too_fast", "--csv", str(rows)]
    assert run_command(arguments) == 0
    assert "too_fast_cut" in capsys.readouterr().out
    assert run_command([*arguments, "--json"]) == 0
    data = json.loads(capsys.readouterr().out)["laws"]
    with rows.open(newline="") as file:
        read = {(row["law"], row["obstruction"]) for row in csv.DictReader(file)}
    for law in PAIR[1], PAIR[3]:
        assert list(data[law]) == ["too_fast", "too_fast_cut"]
        assert data[law]["too_fast"] != data[law]["too_fast_cut"]
        assert {(law, "too_fast"), (law, "too_fast_cut")} <= read


TYPED = "across = -K1*xi - K2*dxi - K3*int_xi; along = -K5*(dtheta - speed)"
SLOW = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed/2)"


def test_typed_laws_are_compared_like_the_others(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Path following as a user types it has the numbers of path following."""
    rows, picture = tmp_path / "a.csv", tmp_path / "a.png"
    laws = ["--law", "path_following", "--law", TYPED.replace("; ", "\n"), "--law", SLOW]
    arguments = ["compare", *laws, "--obstruction", "brake", "--csv", str(rows)]
    assert run_command([*arguments, "--plot", str(picture)]) == 0
    table = capsys.readouterr().out
    assert f"own 1: {TYPED}" in table and f"own 2: {SLOW}" in table
    found: dict[str, list[dict[str, str]]] = {}
    with rows.open(newline="") as file:
        for row in csv.DictReader(file):
            found.setdefault(row.pop("law"), []).append(row)
    assert len(found[TYPED]) == 8 and found[TYPED] == found["path_following"]
    assert all(float(row["delay_s"]) > 2 for row in found[SLOW])
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_law_that_stops_says_so_everywhere(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    fails, rows, picture = "u1 = 9; u2 = 0", tmp_path / "a.csv", tmp_path / "a.png"
    arguments = ["compare", "--law", fails, "--law", "path_following", "--obstruction", "none"]
    assert run_command([*arguments, "--csv", str(rows), "--plot", str(picture)]) == 0
    table = capsys.readouterr().out
    assert re.search(r"own +stopped\n", table) and "inf" not in table and "0.00!" not in table
    assert run_command([*arguments, "--json"]) == 0
    text = capsys.readouterr().out
    (outcome,) = json.loads(text, parse_constant=lambda name: pytest.fail(name))["laws"][fails][
        "none"
    ]
    assert outcome["max_distance_m"] is outcome["delay_s"] is None and outcome["stopped_at_s"] > 0
    with rows.open(newline="") as file:
        own, other = csv.DictReader(file)
    assert float(own["max_distance_m"]) == float("inf") > float(other["max_distance_m"])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--law", "path_folowing"], "did you mean path_following"),
        (["--law", "set_point"], "does not take part"),
        (["--law", "across = xi.real; along = 0"], "column"),
        (["--law", "across = 0"], "along"),
        (["--law", "u1 = 0; u2 = 0; u3 = 0"], "does not suit"),
        (["--set", "speed_profile=sine"], "constant speed"),
        (["--obstruction", "moon"], "unknown obstruction"),
        (["--robot", "hexapod"], "unknown robot"),
        (["--radius", "nan"], "--radius"),
        (["--radius", "0.05", "--path", "clover"], "has no radius to set"),
        (["--robot", "spatial_arm", "--set", "rise=0.03"], "plane path"),
        (["--set", "speed=0"], "speed along the path"),
        (["--set", "K1=inf"], "K1"),
        (["--plot", "a.gif"], "expected a name ending in"),
    ],
)
def test_bad_input_is_refused_in_one_line(
    arguments: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["compare", *arguments]) == 2
    captured = capsys.readouterr()
    assert message in captured.err and captured.err.count("\n") == 1 and not captured.out
