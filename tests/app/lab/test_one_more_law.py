"""A law is one file: with one more file in the registry's folder, all is there, and tests pass."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.support.checkout import ROOT


def run_tests(*which: str) -> None:
    """Run tests in a process that has the laws of tests/data/one_more_law, too."""
    command = [sys.executable, "-m", "pytest", "-q", "-n", "0", "-p", "tests.support.one_more_law"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    environment.pop("PYTEST_ADDOPTS", None)
    found = subprocess.run(
        [*command, *which], cwd=ROOT, env=environment, capture_output=True, text=True, check=False
    )
    assert found.returncode == 0, found.stdout


def test_the_readme_shows_this_law() -> None:
    law = (ROOT / "tests" / "data" / "one_more_law" / "sliding_mode.py").read_text("utf-8")
    assert f"```python\n{law}```" in (ROOT / "models" / "README.md").read_text("utf-8")


@pytest.mark.thorough
def test_a_law_is_one_file() -> None:
    run_tests("tests/app/lab/one_more_law.py")


@pytest.mark.thorough
def test_no_list_and_no_test_has_to_be_changed_for_it() -> None:
    """Of those that know the list of laws."""
    run_tests(
        *("-m", "not thorough"),
        "tests/test_architecture.py",
        "tests/lessons/test_names_listed.py",
        "tests/app/view/test_words.py",
        "tests/app/notebook/test_same_motion.py",
        "tests/models/control/laws/test_laws.py",
        "tests/models/systems/test_parameters.py",
    )
