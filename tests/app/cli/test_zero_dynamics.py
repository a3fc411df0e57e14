"""`onpath zero-dynamics` for every robot; test_flexible_experiment has the flexible one's table."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

from onpath.app.cli.main import run_command
from onpath.models.systems.catalogue import ROBOTS

GANTRY, CART = "rod_gantry", "cart_pendulum"
G, LENGTH = 9.81, 0.2
PERCUSSION = 2 * LENGTH / 3


@pytest.fixture
def study(capsys: pytest.CaptureFixture[str]) -> Any:
    def study(robot: str, **values: float | str) -> Any:
        given = [word for name, value in values.items() for word in ("--set", f"{name}={value}")]
        assert run_command(["zero-dynamics", "--robot", robot, "--json", *given]) == 0
        return json.loads(capsys.readouterr().out)

    return study


@pytest.mark.parametrize("seed", range(8))
def test_exponents_of_the_gantry_are_those_in_closed_form(study: Any, seed: int) -> None:
    """±sqrt(g / ((α - 1) L)), with L the distance to the rod's centre of percussion."""
    rng = np.random.default_rng(seed)
    rod, payload = rng.uniform(0.02, 0.5), rng.uniform(0, 0.3)
    alpha = round(rng.choice([0.0, 0.5, 0.9, 1.1, 1.3]) + rng.uniform(-0.05, 0.05), 4)
    found = study(GANTRY, pivot=0, rod=rod, payload=payload, alpha=alpha)
    square = G / ((alpha - 1) * PERCUSSION)
    expected = math.sqrt(square) if square > 0 else 1j * math.sqrt(-square)
    (first, *_) = [complex(*each) for each in found["exponents_1_s"]]
    assert min(abs(first - expected), abs(first + expected)) < 1e-6 * abs(expected)
    assert found["growth_rate_1_s"] == pytest.approx(max(0.0, np.real(expected)), rel=1e-6)
    assert found["critical_alpha"] == pytest.approx(1, abs=1e-5)


def test_the_upright_pendulum_falls_over(study: Any) -> None:
    found = study(CART, pendulum="upright", pivot=0)
    assert found["growth_rate_1_s"] == pytest.approx(math.sqrt(1.5 * G / LENGTH), rel=1e-6)
    assert "critical_alpha" not in found
    assert study(CART)["growth_rate_1_s"] < 0


def test_the_table_says_in_words_what_will_happen(capsys: pytest.CaptureFixture[str]) -> None:
    for alpha, words in (("0.9", "stable: "), ("1.1", "unstable: ")):
        run_command(["zero-dynamics", "--robot", GANTRY, "--set", f"alpha={alpha}"])
        lines = capsys.readouterr().out.splitlines()
        assert lines[2].startswith(words) and "critical alpha: 1.0000" in lines
        assert lines[-1].endswith("singular")


@pytest.mark.parametrize(
    "robot",
    [
        n
        for n, e in ROBOTS.items()
        if e.make(e.parameters()).system.n == e.make(e.parameters()).system.m
    ],
)
def test_a_robot_with_a_motor_for_each_coordinate_has_none(
    robot: str, capsys: pytest.CaptureFixture[str], study: Any
) -> None:
    assert study(robot) == {"robot": robot, "exponents_1_s": []}
    assert run_command(["zero-dynamics", "--robot", robot]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert line.startswith(robot) and "no zero dynamics" in line


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--robot", "gantry"], "unknown robot 'gantry'"),
        (["--robot", GANTRY, "--set", "alpha=1"], "singular"),
        (["--robot", GANTRY, "--set", "alhpa=1"], "did you mean alpha"),
        (["--robot", GANTRY, "--at", "2", "2"], "out of reach"),
        (["--robot", GANTRY, "--plot", "a.png"], "only the zero dynamics of the flexible"),
        (["--robot", "five_bar", "--set", "K9=1"], "K9"),
    ],
)
def test_bad_input_is_one_line(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["zero-dynamics", *arguments]) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.startswith("onpath: ") and err.count("\n") == 1 and words in err
