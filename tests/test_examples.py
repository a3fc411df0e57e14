"""The examples run as they are, from any folder, and are short."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from onpath.models.arrays import Array
from tests.support.checkout import ROOT

pytest.importorskip("svgpathtools")

FOLDER = ROOT / "assets" / "examples"
EXAMPLES = sorted(FOLDER.glob("*.py"))
LINES = {
    "contouring_mpc": 35,
    "controller": 15,
    "make_arm_log": 21,
    "plant": 64,
    "predictive_path_following": 60,
}
"""The most lines of an example that needs more than the others."""


@pytest.mark.thorough
@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.stem)
def test_an_example_runs_and_prints_its_result(file: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, str(file)], cwd=tmp_path, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() and "Traceback" not in done.stderr
    code = [line for line in file.read_text("utf-8").splitlines() if line.strip()]
    assert len(code) <= LINES.get(file.stem, 13)  # about ten lines besides imports
    for written in tmp_path.glob("*.csv"):
        made, shipped = (_numbers(path) for path in (written, FOLDER / written.name))
        step = 1.001 * np.array([0.1, 360 / 5000, 360 / 5000, 1e-4, 1e-4])  # of its last digits
        assert made.shape == shipped.shape and np.all(np.abs(made - shipped) <= step)


def _numbers(path: Path) -> Array:
    rows = path.read_text("utf-8").replace(",", ".").splitlines()[1:]
    return np.array([row.split(";") for row in rows], dtype=float)


def test_there_is_an_example_of_each_kind() -> None:
    kinds = {"points", "drawing", "tool", "crossing", "robot_from_file", "posture", "fewer_motors"}
    assert kinds <= {file.stem for file in EXAMPLES}
