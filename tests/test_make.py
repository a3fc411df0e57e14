"""What `make test` promises: all tests, and the same verdict every time."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import settings

from tests.support.checkout import ROOT


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
@pytest.mark.parametrize("verdict", [0, 1])
def test_all_tests_run_at_once_and_their_verdict_is_make_s(tmp_path: Path, verdict: int) -> None:
    pytest_of_ours = tmp_path / "pytest"
    pytest_of_ours.write_text(f'#!/bin/sh\necho "ran $#"\nexit {verdict}\n', "utf-8")
    pytest_of_ours.chmod(0o755)
    command = ["make", "-o", "venv/.installed", "VENV=venv", f"PYTEST={pytest_of_ours}", "test"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout.splitlines().count("ran 0") == 1  # without arguments: nothing is left out
    assert (done.returncode == 0) == (verdict == 0)


def test_examples_are_at_random_only_when_asked(request: pytest.FixtureRequest) -> None:
    fuzzing = request.config.getoption("--hypothesis-profile") == "fuzz"
    assert settings.default is not None and settings.default.derandomize is not fuzzing
