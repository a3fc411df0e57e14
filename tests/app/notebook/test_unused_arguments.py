"""An argument that a call does not use is named, or refused; never ignored silently."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import pytest

import onpath
from onpath.app.cli.main import run_command

SHORT: dict[str, Any] = {"duration": 0.02}


@pytest.mark.parametrize(
    ("given", "named"),
    [
        ({"K4": 30.0}, "path following: K4"),
        ({"target": 1.0, "K1": 500.0, "seed": 3}, "path following: target, seed"),
        ({"clock_offset": 0.1}, "path following: clock_offset"),
        ({"law": "set_point", "speed": 3.0}, "set point: speed"),
        ({"law": "set_point", "profile": "0:0,1:3"}, "set point: profile"),
        ({"law": "set_point", "reverse_at": 0.01}, "set point: reverse_at"),
        ({"robot": "flexible", "alpha": 0.3}, "path following: alpha"),
        ({"robot": "flexible", "output": "redefined", "tip_damping": 0.5}, "tip_damping"),
        ({"law": "across = -xi; along = 0", "K4": 3.0}, "across = -xi; along = 0: K4"),
    ],
)
def test_a_run_names_what_has_no_effect(given: dict[str, Any], named: str) -> None:
    with pytest.warns(UserWarning) as told:
        onpath.simulate(**SHORT, **given)
    (warning,) = told
    assert str(warning.message).startswith("no effect under ") and warning.filename == __file__
    assert str(warning.message).endswith(named)


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"K1": 500.0, "K5": 3.0, "speed": 1.0},
        {"K4": 30.0, "target": 1.0, "task": "position"},
        {"seed": 3, "sensor_noise": 1e-4},
        {"law": "waiting_clock", "clock_offset": 0.1},
        {"robot": "flexible", "alpha": 0.3, "output": "redefined"},
        {"robot": "spatial_arm", "rise": 0.02},
    ],
)
def test_a_run_is_silent_about_what_it_uses(given: dict[str, Any]) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        onpath.simulate(**SHORT, **given)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"hold_at": 1.0}, "hold_at: it needs an interval"),
        ({"hold_direction": "both"}, "hold_direction: it needs an interval"),
        ({"hold": (9, 10)}, "hold_from .9 s.: the run ends at 8 s"),
        ({"reverse_at": 9}, "reverse_at .9 s.: the run ends at 8 s"),
        ({"profile": "0:3", "speed": 2.0}, "speed: the profile says the speed already"),
        ({"rise": 0.03}, "unknown parameter 'rise'"),
    ],
)
def test_what_contradicts_itself_is_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        onpath.simulate(**given)


@pytest.mark.thorough
def test_a_figure_names_what_no_law_of_it_uses(tmp_path: Path) -> None:
    file, circle = tmp_path / "a.html", {"path": "circle", "sliders": ()}
    with pytest.warns(UserWarning, match="no effect under trajectory tracking, .*: K4$"):
        onpath.figure(K4=30.0, K5=3.0, **circle)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        onpath.figure("flexible", output="redefined", alpha=0.3, **circle)
    command = ["figure", str(file), "--robot=flexible", "--set=output=redefined"]
    assert run_command(command) == 0


@pytest.mark.parametrize("command", [["experiment", "obstruction"], ["compare"]])
def test_a_command_does_so_on_the_error_stream(
    command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    how = ["--obstruction=none"] if command == ["compare"] else ["--set=duration=4"]
    pair = ["--law=path_following", "--law=trajectory_tracking"] if how[0][2] == "o" else []
    assert run_command([*command, *how, *pair, "--set=K4=30", "--set=K5=3", "--json"]) == 0
    told = capsys.readouterr().err
    assert told.startswith("onpath: no effect under ") and told.endswith(": K4\n")
