"""`onpath sweep` gives the table of `onpath.sweep`."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.summary_text import finite


def test_the_table_is_that_of_python(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "table.csv"
    given = ["--law=both", "--set=K1=400,900,control_rate=500", "--hold", "0.05", "0.08"]
    assert run_command(["sweep", *given, "--duration=0.1", "--csv", str(file), "--json"]) == 0
    laws = ["trajectory_tracking", "path_following"]
    made = onpath.sweep(law=laws, K1=[400, 900], control_rate=500, hold=(0.05, 0.08), duration=0.1)
    assert json.loads(capsys.readouterr().out) == finite(made.table)
    with file.open(encoding="utf-8", newline="") as opened:
        rows = list(csv.DictReader(opened))
    assert [(row["law"], row["K1"]) for row in rows] == [
        (n, k) for n in laws for k in ("400", "900")
    ]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--set", "K1=400,a"], "K1: 'a' is not a number"),
        (["--set", "K11=400"], "K5, K4? (onpath names lists all)\n"),
        (["--law", "zzz"], "unknown law 'zzz'"),
        (["--robot", "fivebar"], "flexible? (onpath names lists all)\n"),
        (["--hold", "1"], "--hold: expected 2 numbers, got '1'\n"),
        (["--hold", "1", "b"], "--hold: expected numbers, got '1', 'b'\n"),
        (["--duration", "a"], "--duration: 'a' is not a number\n"),
        (["--sett", "K1=3"], "unknown option '--sett': did you mean --set"),
        (["--csv", "x.txt"], "expected a name ending in .csv"),
    ],
)
def test_what_is_wrong_is_told(
    arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["sweep", *arguments]) == 2
    assert told in capsys.readouterr().err
