"""What `make test` promises: all parts, and the same verdict every time."""

from __future__ import annotations

import os
import re
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
        f'#!/bin/sh\necho ran\ncase "every $* " in *"{fails}"*) exit 1;; esac\n', "utf-8"
    )
    pytest_of_ours.chmod(0o755)
    command = ["make", "-o", "venv/.tools", "VENV=venv", f"PYTEST={pytest_of_ours}", "test"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.stdout.count("ran") == 2
    assert (done.returncode == 0) == (fails == "nothing")


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
def test_bytecode_is_kept_in_the_environment(tmp_path: Path) -> None:
    """Else every process that a test starts compiles all of OnPath."""
    (tmp_path / "bin").mkdir()
    pytest_of_ours = tmp_path / "bin" / "pytest"
    told = "echo $PYTHONPYCACHEPREFIX ${PYTHONDONTWRITEBYTECODE-is kept}"
    pytest_of_ours.write_text(f"#!/bin/sh\n{told}\n", "utf-8")
    pytest_of_ours.chmod(0o755)
    command = ["make", "-o", f"{tmp_path}/.tools", f"VENV={tmp_path}", "test"]
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        command, cwd=ROOT, env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.count(f"{tmp_path}/bytecode is kept\n") == 2


PIP = """#!/bin/sh
case "$*" in
    *"-m venv"*) for place; do :; done; rm -rf "$place"; mkdir -p "$place/bin"
        cp "$0" "$place/bin/pip"; cp "$0" "$place/bin/onpath"; cp "$0" "$place/bin/pytest";;
    *install*) echo "installed ${4}";;
esac
"""


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
def test_running_installs_the_lab_and_testing_adds_the_tools(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").touch()
    python = tmp_path / "python"
    python.write_text(PIP, "utf-8")
    python.chmod(0o755)

    def made(target: str) -> list[str]:
        command = ["make", "-f", str(ROOT / "Makefile"), f"PYTHON={python}", target]
        done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
        return re.findall(r"^installed (.*)$", done.stdout, re.MULTILINE)

    assert made("run") == ["."]
    assert made("run") == []
    assert made("test") == [".[dev]"]
    assert made("test") == made("run") == []
    later = (tmp_path / ".venv" / ".tools").stat().st_mtime + 10
    os.utime(tmp_path / "pyproject.toml", (later, later))
    os.utime(tmp_path, (later, later))
    assert made("run") == ["."]
    assert not (tmp_path / ".venv" / ".tools").exists()


@pytest.mark.skipif(shutil.which("make") is None, reason="needs make")
def test_fuzz_asks_for_random_examples_of_the_property_tests() -> None:
    command = ["make", "-o", "venv/.tools", "VENV=venv", "PYTEST=echo asked:", "ARGS=", "fuzz"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    (asked,) = re.findall(r"^asked: (.*)$", done.stdout, re.MULTILINE)
    assert asked.split() == ["-m", "hypothesis", "--hypothesis-profile", "fuzz"]


def test_minutes_of_attacks_are_where_make_looks_for_them() -> None:
    """`make thorough` collects them in one folder, which is sooner than in all of them."""
    files = (ROOT / "tests").rglob("test_*.py")
    marked = {file for file in files if re.search(r"mark\.soak\b", file.read_text("utf-8"))}
    assert {file.parent for file in marked} == {ROOT / "tests" / "bench"}


def test_examples_are_at_random_only_when_asked(request: pytest.FixtureRequest) -> None:
    fuzzing = request.config.getoption("--hypothesis-profile") == "fuzz"
    assert settings.default is not None and settings.default.derandomize is not fuzzing
