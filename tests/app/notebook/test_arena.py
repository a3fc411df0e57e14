"""`onpath.arena` gives the numbers of the command, also for laws that only exist in Python."""

from __future__ import annotations

import csv
import math
import warnings
from pathlib import Path
from typing import Any

import pytest

import onpath
from onpath.app.cli.main import run_command
from onpath.app.exports.arena_run import Arena
from onpath.app.notebook.arena import ArenaResult
from onpath.models.studies.arena import MEASURES
from onpath.models.systems.catalogue import ROBOTS
from tests.support.checkout import ROOT

FILE = ROOT / "assets" / "examples" / "own_law.py"
FEW: dict[str, Any] = {"robot": "five_bar", "only": True, "rounds": 1, "processes": 1}


def softly(now: Any) -> tuple[float, float]:
    return -now.K5 * (now.theta_rate - now.speed), -300 * now.xi[0] - 30 * now.xi_rate[0]


@pytest.mark.thorough
def test_it_gives_the_numbers_of_the_command(tmp_path: Path, capsys: Any) -> None:
    laws = [f"{FILE}:SlidingMode", "path_following"]
    given = ["--only", "--robot=five_bar", "--rounds=1", "--seed=4", "--processes=1"]
    files = ["--html", str(tmp_path / "a.html"), "--csv", str(tmp_path / "a.csv"), "--no-figures"]
    assert run_command(["arena", f"--law={','.join(laws)}", *given, *files]) == 0
    shown = capsys.readouterr().out
    html, table = tmp_path / "b.html", tmp_path / "b.csv"
    result = onpath.arena(law=laws, **FEW, seed=4, html=html, csv=str(table), figures=False)
    assert isinstance(result, ArenaResult) and repr(result) == shown.rstrip("\n")
    assert table.read_bytes() == (tmp_path / "a.csv").read_bytes()
    pages = [path.read_text("utf-8").splitlines() for path in (html, tmp_path / "a.html")]
    different = [(a, b) for a, b in zip(*pages, strict=True) if a != b]
    assert (
        len(different) == 1 and "onpath.arena(law=[" in different[0][0]
    )  # the line with the command
    rows = list(csv.DictReader(table.open(encoding="utf-8", newline="")))
    assert len(result.runs) == len(rows) == 20
    for run, row in zip(result.runs, rows, strict=True):
        assert all((row[name] == "") == (run[name] is None) for name in MEASURES)


def test_its_table_has_the_worst_value_of_the_runs() -> None:
    result = onpath.arena(law="path_following", **FEW, seed=2)
    assert [(row["law"], row["at_limit"]) for row in result.table] == [
        ("path_following", "cut"),
        ("path_following", "remedy"),
    ]
    for row in result.table:
        runs = [run for run in result.runs if run["at_limit"] == row["at_limit"]]
        assert row["stops"] == sum(run["stopped_at_s"] is not None for run in runs)
        for name in MEASURES:
            values = [run[name] for run in runs if run[name] is not None]
            worst = min(values) if name == "force_N" else max(values, key=abs)
            assert row[name] == worst and row[f"{name}_rank"] in (1, 2)


@pytest.mark.thorough
def test_a_law_of_this_process_has_the_numbers_that_it_has_in_a_file(tmp_path: Path) -> None:
    source = "class Here:\n    gains = ('K5',)\n    def command(self, view):\n" + (
        "        across = -300 * view.output.xi - 30 * view.output.xi_rate\n"
        "        return onpath.followed(view, onpath.tangential(view), across)\n"
    )
    (tmp_path / "here.py").write_text(f"import onpath\n{source}", "utf-8")
    names: dict[str, Any] = {"onpath": onpath}
    exec(source, names)
    html = tmp_path / "a.html"
    result = onpath.arena(
        law=[f"{tmp_path / 'here.py'}:Here", names["Here"], softly], **FEW, html=html
    )
    laws = list(dict.fromkeys(run["law"] for run in result.runs))
    assert laws == ["Here", "Here_2", "softly"]
    filed, here, called = ([r for r in result.runs if r["law"] == law] for law in laws)
    for one, other in zip(filed, here, strict=True):
        assert [one[name] for name in MEASURES] == [other[name] for name in MEASURES]
        assert one["command"] and not other["command"]
    assert all(row["stops"] == 0 for row in result.table) and len(called) == 10
    figures = {file.name for file in (tmp_path / "a-figures").iterdir()}
    assert figures == {"five_bar-Here.html", "five_bar-Here_2.html"}


TEXT = """
import onpath
class Law:
    gains = ("K5",)
    own_gains = (onpath.own_gain("{0}", {1}, "1/s²", (0, 900, 1), "pull", label="P"),)
    def command(self, view):
        across = -view.own_gains["{0}"] * view.output.xi - 40 * view.output.xi_rate
        return onpath.followed(view, onpath.tangential(view), across)
"""


@pytest.mark.thorough
def test_a_file_may_have_changed_since_its_law_was_added(tmp_path: Path) -> None:
    """Also with a law of the same name in another file, and with other gains."""
    changing, other = tmp_path / "changing.py", tmp_path / "other.py"
    other.write_text(TEXT.format("other_here", 300), "utf-8")
    worst = list[float]()
    for gain, value in (("stiff_here", 800), ("soft_here", 50)):
        changing.write_text(TEXT.format(gain, value), "utf-8")
        onpath.simulate(law=f"{changing}:Law", duration=0.1)
        result = onpath.arena(law=[f"{changing}:Law", f"{other}:Law"], **FEW)
        assert all(row["stops"] == 0 for row in result.table)
        worst += [result.table[0]["force_N"], result.table[2]["force_N"]]
    assert worst[0] > worst[1] == worst[3] > worst[2]


def test_two_laws_cannot_have_different_gains_of_one_name(tmp_path: Path) -> None:
    """Their values are kept by name, so that both would have that of the second."""
    laws = list[str]()
    for value in (300, 500):
        (tmp_path / f"pull_{value}.py").write_text(TEXT.format("both_here", value), "utf-8")
        laws.append(f"{tmp_path / f'pull_{value}.py'}:Law")
    with pytest.raises(ValueError, match=r"Law_\d+ has another gain 'both_here' than Law"):
        onpath.arena(law=laws, **FEW)


def test_an_interrupted_arena_returns_what_it_has(monkeypatch: pytest.MonkeyPatch) -> None:
    run, given = Arena.run, dict(FEW, rounds=2)

    def interrupted(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Arena, "run", lambda self: run(self, interrupted))
    with pytest.warns(UserWarning, match="interrupted"):
        result = onpath.arena(law="path_following", **given)
    assert len(result.runs) == 10 and "5 trials" in repr(result)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"robot": "five_bat"}, "did you mean five_bar"),
        ({"law": "path_folowing"}, "did you mean path_following"),
        ({"rounds": 0}, "too small"),
        ({"only": True}, "give laws"),
        ({"language": "xx"}, "there are de, en"),
    ],
)
def test_an_impossible_argument_is_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        onpath.arena(**given)


def test_a_robot_may_be_given_as_it_is() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        result = onpath.arena(law="path_following", **{**FEW, "robot": ROBOTS["two_link_arm"]})
    (row, _) = result.table
    assert row["robot"] == "two_link_arm" and math.isfinite(row["distance_m"])
