"""What `make test` promises: all parts, and the same verdict every time."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import settings

from tests.support.checkout import ROOT


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
@pytest.mark.parametrize("fails", ["--ignore=tests", "tests/in_browser ", "nothing", "every"])
def test_both_parts_run_whatever_the_other_says(tmp_path: Path, fails: str) -> None:
    pytest_of_ours = tmp_path / "pytest"
    pytest_of_ours.write_text(
        f'#!/bin/sh\necho ran\ncase "every $*" in *{fails}*) exit 1;; esac\n', "utf-8"
    )
    pytest_of_ours.chmod(0o755)
    command = ["make", "-o", "venv/.installed", "VENV=venv", f"PYTEST={pytest_of_ours}", "test"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout.count("ran") == 2
    assert (done.returncode == 0) == (fails == "nothing")


def test_examples_are_at_random_only_when_asked(request: pytest.FixtureRequest) -> None:
    fuzzing = request.config.getoption("--hypothesis-profile") == "fuzz"
    assert settings.default is not None and settings.default.derandomize is not fuzzing
