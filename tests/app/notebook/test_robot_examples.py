"""The examples with robots of assets/examples, as a reader runs them."""

from __future__ import annotations

import subprocess
import sys

import pytest

from onpath.assets import asset_path

EXAMPLES = {
    "robot_from_file": ("7 joints, from seven_axes.urdf.", "to 100 %"),
    "posture": ("100 1/s²", "0 1/s²", "mm off"),
}
TOLD = ("default:the motor of joint1 gave", "default:the file says nothing of a pose")
"""An arm without a posture runs away with torques that its motors do not have, as it says; and a
pose of which only one joint is given is chosen."""


@pytest.mark.thorough
@pytest.mark.parametrize("name", EXAMPLES)
def test_an_example_runs_and_prints_what_it_promises(name: str) -> None:
    file = asset_path(f"examples/{name}.py")
    done = subprocess.run(
        [sys.executable, "-W", "error", *(w for each in TOLD for w in ("-W", each)), str(file)],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    for text in EXAMPLES[name]:
        assert text in done.stdout
    assert sum(line.strip() != "" for line in file.read_text("utf-8").splitlines()) <= 13
