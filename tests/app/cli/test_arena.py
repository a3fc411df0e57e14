"""`onpath arena`: a page, a CSV and figures, with custom laws, also if it is interrupted."""

from __future__ import annotations

import csv
import re
import shlex
from collections import Counter
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onpath.app.cli.main import run_command
from onpath.app.common.workers import Job
from onpath.app.exports.arena_page import described
from onpath.lessons.words import Words
from onpath.models.studies.arena import CONDITIONS, MEASURES, OBSTRUCTIONS, trials_of
from onpath.models.studies.path_text import curve_from_text
from tests.support.cases import drawn
from tests.support.catalogues import COMPLETE
from tests.support.checkout import ROOT
from tests.support.robot_files import PLANAR, urdf

EXAMPLES = ROOT / "assets" / "examples"
LAWS = [f"{EXAMPLES / 'own_function.py'}:Patient", f"{EXAMPLES / 'own_law.py'}:SlidingMode"]
BROKEN = """
import os
def raising(now):
    return (1 / 0 if now.t > 0.3 else 0), 0
def dying(now):
    return os._exit(7) if now.t > 4.6 else (-now.theta_rate, 0)  # in the pull alone
"""


@pytest.fixture
def files(tmp_path: Path) -> list[str]:
    return ["--html", str(tmp_path / "a.html"), "--csv", str(tmp_path / "a.csv"), "--processes=1"]


@pytest.mark.thorough
def test_an_arena_of_laws_of_ones_own(files: list[str], tmp_path: Path, capsys: Any) -> None:
    broken = tmp_path / "broken.py"
    broken.write_text(BROKEN)
    laws = ",".join([*LAWS, "path_following", f"{broken}:raising", f"{broken}:dying"])
    given = ["arena", "--only", "--law", laws, "--robot", "five_bar", "--rounds", "1"]
    assert run_command([*given, *files[:-1]]) == 0
    told = capsys.readouterr().out
    page = (tmp_path / "a.html").read_text("utf-8")
    assert "broken.py, line 4" in page and "has died" in page  # and nothing else has stopped
    rows = list(csv.DictReader((tmp_path / "a.csv").open(encoding="utf-8", newline="")))
    assert len(rows) == 5 * 2 * 5
    stopped = {row["law"] for row in rows if row["stopped_at_s"]}
    assert stopped == {"raising", "dying"} and "`Patient`" in told
    marks, links = re.findall(r' id="([^"]+)"', page), re.findall(r'href="#([^"]+)"', page)
    assert links and set(links) <= set(marks) and len(marks) == len(set(marks))
    figures = set(re.findall(r'href="(a-figures/[^"]+)"', page))
    assert figures and all((tmp_path / figure).stat().st_size > 1e5 for figure in figures)
    assert not any("Patient" in figure for figure in figures)  # it is shown as recorded
    assert "<animate " in page and "<script" not in page
    assert all(abs(float(x)) < 1e4 for x in re.findall(r'points="([-\d.]+),', page))


@pytest.mark.thorough
def test_a_robot_from_a_file_enters_beside_another(
    files: list[str], tmp_path: Path, capsys: Any
) -> None:
    """Its processes, its figure and the commands of its runs know it."""
    arm = tmp_path / "own.urdf"
    arm.write_text(urdf("own", PLANAR), "utf-8")
    given = ["--robot", str(arm), "--armature", "0.001", "--robot", "five_bar"]
    law = ["--law=path_following", "--only", "--rounds", "1"]
    assert run_command(["arena", *law, *given, *files]) == 0
    rows = list(csv.DictReader((tmp_path / "a.csv").open(encoding="utf-8", newline="")))
    robots = Counter(row["robot"] for row in rows)
    (name,) = robots.keys() - {"five_bar"}
    assert robots == {name: 10, "five_bar": 10} and name.startswith("own_")
    assert not any(row["reason"] for row in rows)
    page = (tmp_path / "a.html").read_text("utf-8")
    assert f"a-figures/{name}-path_following.html" in page and f"--robot {arm} --armature" in page
    (row,) = [
        r for r in rows if (r["robot"], r["obstruction"], r["at_limit"]) == (name, "wall", "cut")
    ]
    capsys.readouterr()
    assert run_command(shlex.split(row["command"])[1:]) == 0
    (shown,) = re.findall(r"max distance +([\d.]+) mm", capsys.readouterr().out)
    assert float(shown) == pytest.approx(1e3 * float(row["distance_m"]), abs=0.01)


@pytest.mark.thorough
def test_the_command_behind_a_number_gives_that_number(
    files: list[str], tmp_path: Path, capsys: Any
) -> None:
    given = ["arena", "--law", LAWS[1], "--only", "--robot=five_bar", "--rounds=1", "--no-figures"]
    assert run_command([*given, *files]) == 0
    rows = list(csv.DictReader((tmp_path / "a.csv").open(encoding="utf-8", newline="")))
    (row,) = [r for r in rows if r["obstruction"] == "wall" and r["at_limit"] == "cut"]
    capsys.readouterr()
    assert run_command(shlex.split(row["command"])[1:]) == 0
    (shown,) = re.findall(r"max distance +([\d.]+) mm", capsys.readouterr().out)
    assert float(shown) == pytest.approx(1e3 * float(row["distance_m"]), abs=0.01)


@pytest.mark.thorough
def test_an_interrupted_arena_has_what_all_laws_have_finished(
    files: list[str], tmp_path: Path, capsys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    results, rounds = Job.results, 0

    def interrupted(self: Job[Any, Any]) -> Iterator[tuple[int, Any]]:
        nonlocal rounds
        rounds += 1
        for result in results(self):
            yield result
            if rounds == 2:
                raise KeyboardInterrupt

    monkeypatch.setattr(Job, "results", interrupted)
    given = ["arena", "--law", f"{LAWS[1]},path_following", "--only", "--robot=five_bar", *files]
    assert run_command(given) == 130
    shown = capsys.readouterr()
    assert "interrupted" in shown.err and "5 trials" in shown.out
    assert "5 trials of 15" in (tmp_path / "a.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--robot", "five_bat"], "did you mean five_bar"),
        (["--rounds", "0"], "too small"),
        (["--only"], "give laws"),
        (["my_law.py:Law"], "onpath arena --law my_law.py:Law"),
        (["--law", "set_point"], "set_point: it does not move along a path"),
        (
            ["--law", "velocity_field", "--robot", "seven_axes"],
            "velocity_field: it does not suit",
        ),
        (["--language", "xx"], "there are de, en"),
        (["--law", "nothing.py:Law"], "there is no such file"),
        (["--robot", "nothing.urdf"], "nothing.urdf"),
        (["--robot", "five_bar", "--tip", "tip"], "need --robot FILE"),
    ],
)
def test_an_impossible_option_is_refused(options: list[str], words: str, capsys: Any) -> None:
    assert run_command(["arena", *options]) == 2
    assert words in capsys.readouterr().err


@pytest.mark.thorough
def test_the_page_in_german(files: list[str], tmp_path: Path) -> None:
    given = [
        "arena",
        "--law=path_following",
        "--only",
        "--robot=five_bar",
        "--rounds=1",
        "--no-figures",
    ]
    assert run_command([*given, "--language", "de", *files]) == 0
    page = (tmp_path / "a.html").read_text("utf-8")
    assert "Bahnfolgeregelung" in page and re.search(r">\d+,\d\d</a>", page)


@pytest.mark.parametrize("language", COMPLETE)
def test_everything_that_the_page_names_has_words(language: str) -> None:
    words = Words(language)
    for name in (*MEASURES, "cut", "remedy", "torques"):
        assert words(f"arena.{name}")
    for name in (*MEASURES, "stops"):
        assert words(f"arena.{name}_text")


@pytest.mark.thorough
@pytest.mark.parametrize("language", COMPLETE)
def test_a_trial_is_described_with_its_numbers(language: str) -> None:
    words, found = Words(language), set[str]()
    for trial in chain.from_iterable(trials_of(("five_bar", "seven_axes", "rod_gantry"), 12, 1)):
        told, values = described(trial, words), trial.values
        found |= {trial.obstruction, trial.condition}
        if trial.released is not None:
            assert words.number(trial.released) in str(told["obstruction"])
        if trial.condition == "payload":
            assert words.number(values["payload"]) in str(told["condition"])
        if trial.obstruction == "hand":
            (away,) = re.findall(r"(\d+) mm", str(told["obstruction"]))
            hand = np.array([[values["push_z1"], values["push_z2"]]])
            curve = curve_from_text(trial.path)
            near = np.linalg.norm(curve.at(np.linspace(-np.pi, np.pi, 5000)) - hand, axis=1).min()
            assert float(away) == pytest.approx(1e3 * near, abs=1.0)
    assert found == {*OBSTRUCTIONS, *CONDITIONS}


@pytest.mark.thorough
def test_rows_of_the_table_of_our_laws_are_what_the_arena_gives(
    files: list[str], capsys: Any
) -> None:
    """Those of two laws, others every day: only the ranks depend on the other laws."""
    text = (ROOT / "models" / "studies" / "README.md").read_text("utf-8")
    shown = text.partition("<!-- made by `onpath arena` -->")[2].partition("<!-- end -->")[0]
    laws = drawn(sorted(set(re.findall(r"^\| `(\w+)`", shown, re.MULTILINE))), 2)
    assert run_command(["arena", f"--law={','.join(laws)}", "--only", "--no-figures", *files]) == 0
    given = rows_without_ranks(capsys.readouterr().out)
    assert given == [row for row in rows_without_ranks(shown) if row[1] in laws], laws


def rows_without_ranks(table: str) -> list[list[str]]:
    """Heading, law, remedy and numbers of each row, in the order of the laws' names."""
    heading, rows = "", list[list[str]]()
    for line in table.splitlines():
        if line.startswith("| `"):
            cells = re.sub(r" \(\d+\)", "", line).split("|")[1:]
            rows.append([heading, *(cell.strip(" `") for cell in cells)])
        elif line and not line.startswith("|"):
            heading = line
    return sorted(rows)
