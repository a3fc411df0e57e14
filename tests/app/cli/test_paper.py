"""`onpath paper`: every figure is drawn, twice the same, and errors are one clear line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from onpath.app.cli.main import run_command
from onpath.app.exports.paper_figures import paper_figure
from onpath.models.studies.paper_figures import FIGURES
from onpath.models.systems.catalogue import ROBOTS

pytestmark = pytest.mark.thorough


@pytest.mark.parametrize("number", FIGURES)
def test_the_same_figure_has_the_same_bytes(
    number: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outputs = []
    for kind in ("png", "png", "svg", "svg"):
        file = tmp_path / f"figure.{kind}"
        assert run_command(["paper", str(number), "--plot", str(file), "--json"]) == 0
        outputs.append((file.read_bytes(), capsys.readouterr().out))
    assert outputs[0] == outputs[1] and outputs[2] == outputs[3]
    assert outputs[0][0].startswith(b"\x89PNG") and len(outputs[0][0]) > 20_000
    result = json.loads(outputs[0][1])
    assert result["figure"] == number and list(result["laws"]) == list(FIGURES[number].laws)


def test_the_text_names_settings_and_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_command(["paper", "5"]) == 0
    text = capsys.readouterr().out
    for words in ("from the paper's text", "illustrative", "2π rad/s", "max distance while held"):
        assert words in text


def test_the_obstruction_is_shaded_and_the_reference_drawn() -> None:
    figure = FIGURES[5]
    drawn = paper_figure(figure, figure.runs())
    assert len(drawn.axes) == 5
    for axes in drawn.axes:
        (shade,) = axes.patches
        assert shade.get_extents().transformed(axes.transData.inverted()).intervalx == (
            pytest.approx([3.0, 5.0], abs=2e-3)
        )
    speed = drawn.axes[3].lines
    assert np.asarray(speed[1].get_ydata()) == pytest.approx(2 * np.pi)


def test_the_modes_are_told_apart_and_all_are_seen() -> None:
    """Each has a dash and a shade of its own, and its legend says how much larger it is drawn."""
    figure = FIGURES[7]
    runs = figure.runs()
    modes = [a for a in paper_figure(figure, runs).axes if "eta_1" in a.get_ylabel()]
    assert len(modes) == 2
    for axes in modes:
        assert len(axes.lines) == 3
        assert len({(line.get_linestyle(), line.get_color()) for line in axes.lines}) == 3
        assert len({line.get_color() for line in axes.lines}) == 3
        heights = [float(np.abs(np.asarray(line.get_ydata())).max()) for line in axes.lines]
        assert min(heights) >= 0.0999 * max(heights)
    places, m = runs[0].fields["q"], figure.planned().robot().system.m
    for j, line in enumerate(modes[0].lines):
        _, _, times = str(line.get_label()).partition(", ")
        larger = float(times.rstrip("×") or 1)
        drawn, mode = np.asarray(line.get_ydata()), places[:, m + j]
        shape = drawn[np.abs(mode).argmax()] / larger / mode[np.abs(mode).argmax()]
        np.testing.assert_allclose(drawn, larger * shape * mode, atol=1e-9)


@pytest.mark.parametrize(
    "arguments",
    [
        ["figure"],
        ["paper", "4"],
        ["paper", "two"],
        ["paper", "2", "3"],
        ["paper", "2", "--plot", "x.txt"],
        ["paper", "2", "--plot", "missing/x.png"],
        ["paper", "2", "--json", "yes"],
        ["paper", "2", "--robot", "five_bar"],
        ["paper", "rank", "--robot", "five_baz"],
        ["paper", "rank", "--set", "K1"],
        ["paper", "rank", "--set", "weight=3"],
        ["paper", "rank", "--set", "payload=heavy"],
        ["paper", "rank", "--set", "K1=300"],
        ["paper", "crossing", "--set", "K1=300"],
        ["paper", "crossing", "--robot", "five_bar"],
    ],
)
def test_errors_are_one_line(
    arguments: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run_command(arguments) == 2
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith("onpath: ") and said.err.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_rank_test_is_drawn_for_every_robot(
    robot: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outputs = []
    for number in range(2):
        file = tmp_path / f"{number}.png"
        assert run_command(["paper", "rank", "--robot", robot, "--plot", str(file), "--json"]) == 0
        outputs.append((file.read_bytes(), capsys.readouterr().out))
    assert outputs[0] == outputs[1] and len(outputs[0][0]) > 20_000
    result = json.loads(outputs[0][1])
    assert result["robot"] == robot and 0 < result["home"] <= 1.001 * result["largest"]
    assert run_command(["paper", "rank", "--robot", robot]) == 0
    text = capsys.readouterr().out
    assert result["unit"] in text and f"{result['home']:g}" in text


def test_the_rank_test_has_the_parameters_that_are_set(capsys: pytest.CaptureFixture[str]) -> None:
    homes = []
    for given in ([], ["--set", "payload=0.2"]):
        assert run_command(["paper", "rank", *given, "--json"]) == 0
        homes.append(json.loads(capsys.readouterr().out)["home"])
    assert homes[1] < homes[0]


def test_the_crossing_is_drawn_with_the_jumps_that_are_printed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "crossing.png"
    assert run_command(["paper", "crossing", "--json", "--plot", str(target)]) == 0
    runs = json.loads(capsys.readouterr().out)["runs"]
    assert [each["jumps"] > 0 for each in runs.values()] == [False, False, True]
    assert target.stat().st_size > 20_000
