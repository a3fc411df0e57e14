"""A robot that stops is explained by its cause, and a caution comes before the run."""

from __future__ import annotations

import pytest

import onpath
from onpath.app.lab.commands.robots import ChooseRobot
from onpath.app.lab.commands.settings import Set
from onpath.app.lab.commands.time import SetRunning
from tests.support.lab import do, new_lab, run


@pytest.mark.parametrize(
    ("robot", "settings", "cause"),
    [
        ("five_bar", {"K2": 190, "control_rate": 50}, "unstable across the path"),
        ("five_bar", {"K5": 100, "control_rate": 50, "look_ahead": "half_interval"}, None),
        ("flexible", {"control_rate": 100, "output": "composite"}, "at least 200 Hz"),
        (
            "five_bar",
            {"error_M11": 40, "error_M22": 40, "control_rate": 50, "K1": 1600, "K2": 80},
            "model is wrong",
        ),
    ],
)
def test_the_reason_of_a_stop_names_its_cause(
    robot: str, settings: dict[str, float | str], cause: str | None
) -> None:
    made = onpath.simulate(robot, law="path_following", duration=4, **settings)  # type: ignore[arg-type]
    if cause is None:
        assert made.reason == "" or "Likely cause" in made.reason
    else:
        assert made.stopped_at is not None and cause in made.reason


def test_the_lab_says_before_the_run_that_a_control_is_too_slow() -> None:
    lab = new_lab()
    do(lab, ChooseRobot("flexible"), SetRunning(False), Set("control_rate", 100))
    run(lab, 0.05)
    assert lab.message_level == "warning" and "200 Hz" in lab.message
    do(lab, Set("control_rate", 1000))
    run(lab, 0.05)
    assert "200 Hz" not in lab.message
