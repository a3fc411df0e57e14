"""`onpath lessons play` prints what happens in a step, as numbers that are those of the motion."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onpath.app.cli.main import run_command
from onpath.lessons.action_schema import Action, Laws, Script
from onpath.lessons.record import QUANTITIES
from onpath.lessons.step_numbers import action_text, parts_of
from tests.support.format_texts import FORMAT_LESSON, FORMAT_REFERENCE
from tests.support.lesson_texts import LESSON, REFERENCE, write_lesson
from tests.support.stated_numbers import shown

pytestmark = pytest.mark.thorough

Capture = pytest.CaptureFixture[str]


def played(capsys: Capture, *arguments: str) -> dict[str, Any]:
    """What a step does, from the JSON."""
    assert run_command(["lessons", "play", *arguments, "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_the_numbers_are_those_of_the_motion(capsys: Capture) -> None:
    """The same step, simulated every millisecond."""
    told = played(capsys, "1", "3")
    assert told["setup"]["set"] == {"K3": 0} and told["title"] == "Held from 3 s to 5 s"
    (run,) = told["runs"]
    motion = shown("01", told["title"])
    for part in run["parts"]:
        for robot in ("tracker", "follower"):
            own, numbers = motion[robot], part["numbers"][robot]
            # a frame's sample is that of the last tick before it
            rows = own.during(max(part["begin"] - 1e-3, 0.0), part["end"] + 2e-3)
            for quantity in ("distance", "across"):
                said, column = numbers[quantity], getattr(own, quantity)[rows]
                single = 1e-6 * np.abs(column).max()  # samples are kept in single precision
                there = own.during(said["max_at"] - 1e-3, said["max_at"] + 2e-3)
                around = getattr(own, quantity)[there]
                assert around.min() - single <= said["max"] <= around.max() + single
                assert column.min() - single <= said["min"] <= said["final"] <= said["max"]
                assert said["max"] <= column.max() + single
    slow, quick = ["rate 0.25"], ["rate 1.0"]
    actions = [part["actions"] for part in run["parts"]]
    assert actions == [[], slow, ["hold"], quick, ["hold off"], []]


def test_the_parts_are_the_times_between_the_actions() -> None:
    times = np.arange(0.0, 4.001, 0.01)
    distance = np.where(times < 1.5, 5.0, 0.5)
    script = Script((Action(at=2.0, hold=True), Action(at=1.0, pull=(3.0, 0.0))), until=4.0)
    values = {"tracker": {"distance": distance}, "follower": {"distance": distance + 1}}
    *parts, whole = parts_of(script, times, values)  # type: ignore[arg-type]
    assert [(p.begin, p.end) for p in parts] == [(0.0, 1.0), (1.0, 2.0), (2.0, 4.0)]
    assert (whole.begin, whole.end) == (0.0, 4.0)
    assert [p.settled["tracker"] for p in parts] == [None, pytest.approx(0.5), 0.0]
    assert [p.settled["follower"] for p in parts] == [None, None, None]
    largest = [p.numbers["tracker"]["distance"].max for p in parts]
    assert largest == [5.0, 5.0, 0.5] and whole.numbers["tracker"]["distance"].max == 5.0


@pytest.mark.parametrize(
    ("action", "text"),
    [
        (Action(set={"K1": 900, "K2": 8}), "set K1 = 900, K2 = 8"),
        (Action(hold=False), "hold off"),
        (Action(pull=(3.0, 0.0), only="follower"), "pull (3.0, 0.0) (follower)"),
        (Action(laws=Laws(left="waiting_clock")), "laws left = waiting_clock"),
        (Action(path="ellipse"), "path ellipse"),
    ],
)
def test_an_action_is_named_with_its_values(action: Action, text: str) -> None:
    assert action_text(action) == text


def test_a_task_is_played_as_solved_and_as_failed(tmp_path: Path, capsys: Capture) -> None:
    write_lesson(tmp_path)
    told = played(capsys, "1", "7", "--lessons", str(tmp_path))
    runs = {run["title"]: run for run in told["runs"]}
    assert list(runs) == ["hold.solution", "hold.failure"]
    assert [run["passed"] for run in runs.values()] == [True, False]
    assert told["setup"]["path"] == "ellipse"
    assert run_command(["lessons", "play", "01-a", "7", "--lessons", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "task passed" in text and "task not passed" in text and "hold.solution, 3 s" in text


def test_times_go_on_through_a_reset(tmp_path: Path, capsys: Capture) -> None:
    script = "until = 3.0\ndo = [{ at = 1.0, hold = true }, { at = 2.0, reset = true }]"
    text = LESSON.replace(
        "until = 2.0\ndo = [{ at = 0.5, hold = true }, { at = 1.5, hold = false }]", script
    )
    write_lesson(tmp_path, text.replace("seconds = 2.0", "seconds = 3.0"))
    (run,) = played(capsys, "1", "3", "--lessons", str(tmp_path))["runs"]
    first, held, again, _ = run["parts"]
    assert again["actions"] == ["reset"]
    assert held["numbers"]["tracker"]["distance"]["max"] > 30
    # the same beginning as at first
    assert again["numbers"]["tracker"]["distance"]["final"] < 0.1
    assert first["numbers"]["tracker"]["distance"]["final"] < 0.1


def test_what_a_step_draws_and_where_it_starts_is_printed(tmp_path: Path, capsys: Capture) -> None:
    write_lesson(tmp_path, FORMAT_LESSON, FORMAT_REFERENCE)
    assert run_command(["lessons", "play", "1", "1", "--lessons", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "plot: phase, torques" in text and "show: tube, errors" in text
    assert "start: place = 0.5, across = 10.0" in text and "marks: [at = [50" not in text
    assert run_command(["lessons", "play", "1", "3", "--lessons", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "rate 0.25" in text and "start across = 5" in text and "across_rate [mm/s]" in text


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["01-pat-or-timetable", "1"], "did you mean 01-path-or-timetable"),
        (["1", "99"], "has steps 1 to 12"),
        (["1", "0"], "has steps 1 to 12"),
        (["99", "1"], "unknown lesson '99'"),
    ],
)
def test_a_missing_step_is_named_in_the_error(
    capsys: Capture, arguments: list[str], said: str
) -> None:
    assert run_command(["lessons", "play", *arguments]) == 2
    assert said in capsys.readouterr().err


def test_a_lesson_with_problems_or_without_a_reference_is_not_played(
    tmp_path: Path, capsys: Capture
) -> None:
    write_lesson(tmp_path, reference=REFERENCE.replace("hold.", "other."))
    assert run_command(["lessons", "play", "1", "7", "--lessons", str(tmp_path)]) == 2
    assert "reference.toml" in capsys.readouterr().err


def test_text_shows_the_quantities_of_the_step_and_all_on_demand(capsys: Capture) -> None:
    assert run_command(["lessons", "play", "2", "3"]) == 0
    some = capsys.readouterr().out
    assert "lag [mm] follower" in some and "energy" not in some
    assert run_command(["lessons", "play", "7", "3", "--all"]) == 0
    every = capsys.readouterr().out
    assert all(f"{quantity} [" in every for quantity in QUANTITIES)
