"""A custom law on the command line and in Python."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.models.errors import CodedError
from tests.support.csv_columns import read_csv

SHORT = ["experiment", "obstruction", "--set", "duration=1", "--set", "hold_from=0.4"]
SHORT += ["--set", "hold_to=0.6", "--set", "K3=0"]
TYPED = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)"


def table(arguments: list[str], file: Path) -> dict[str, np.ndarray]:
    assert run_command([*arguments, "--csv", str(file)]) == 0
    with file.open(encoding="utf-8", newline="") as lines:
        (run,) = read_csv(lines).values()
    return run


def test_typed_path_following_writes_the_same_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wanted = table([*SHORT, "--law", "path_following"], tmp_path / "a.csv")
    typed = table([*SHORT, "--law", TYPED], tmp_path / "b.csv")
    assert wanted.keys() == typed.keys() and len(wanted["t_s"]) == 1000
    for name, column in wanted.items():
        assert np.array_equal(column, typed[name]), name
    assert TYPED in capsys.readouterr().out


def test_a_law_with_commas_is_one_cell_of_the_file_and_one_law(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "across = -min(K1, 900)*xi - max(K2, 5)*dxi\nalong = 0"
    assert run_command([*SHORT, "--law", text, "--csv", str(tmp_path / "a.csv"), "--json"]) == 0
    with (tmp_path / "a.csv").open(newline="") as lines:
        (name,) = read_csv(lines)
    assert name == text.replace("\n", "; ")
    assert list(json.loads(capsys.readouterr().out)["laws"]) == [name]


def test_a_typed_law_is_drawn(tmp_path: Path) -> None:
    assert run_command([*SHORT, "--law", TYPED, "--plot", str(tmp_path / "a.svg")]) == 0
    assert (tmp_path / "a.svg").read_text().startswith("<?xml")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("across = xii; along = 0", "column 10: there is no 'xii': did you mean xi?"),
        ("across = xi", "there is no line that begins with along ="),
        ("u1 = 0; u2 = 0; u3 = 0", "not possible with this robot"),
        ("across = __import__('os').system('true'); along = 0", "there is no '__import__'"),
        ("=" * 10_000, "at most 500 characters"),
    ],
)
def test_bad_text_is_one_line_and_no_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, said: str
) -> None:
    assert run_command([*SHORT, "--law", text, "--csv", str(tmp_path / "a.csv")]) == 2
    error = capsys.readouterr().err
    assert said in error and "Traceback" not in error
    assert not list(tmp_path.iterdir())


@pytest.mark.filterwarnings("ignore:no effect under across")
def test_in_python_a_law_may_be_text() -> None:
    both = "path_following", TYPED
    wanted, typed = (onpath.simulate(law=law, duration=0.5, K3=0.0) for law in both)
    assert np.array_equal(wanted.q, typed.q) and np.array_equal(wanted.distance, typed.distance)
    assert typed.law == TYPED and TYPED in repr(typed)
    assert typed.summary()["stopped_at_s"] is None
    for law in ("across = y.real; along = 0", "across = 1", 3):
        with pytest.raises(CodedError):
            onpath.simulate(law=law)  # type: ignore[arg-type]
