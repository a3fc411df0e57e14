"""OnPath in a folder that has an app.py, models/ and lessons/ of its own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.support import stranger
from tests.support.checkout import ROOT


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """One whose code leaves a mark and stops whoever imports it."""
    stranger.fill(tmp_path)
    return tmp_path


def python(folder: Path, *arguments: str) -> str:
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env=stranger.environment(),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert not stranger.marks(folder)
    return done.stdout


def test_the_files_would_be_noticed(folder: Path) -> None:
    with pytest.raises(AssertionError, match="stranger's code"):
        python(folder, "-c", "import app")
    assert stranger.marks(folder)


@pytest.mark.thorough
def test_a_simulation_is_onpaths_own(folder: Path) -> None:
    code = "import onpath; print(onpath.simulate(duration=0.05).t.size, onpath.__file__)"
    size, file = python(folder, "-c", code).split()
    assert size == "50" and Path(file).parent == ROOT / "onpath"


@pytest.mark.thorough
def test_so_is_the_command_line(folder: Path) -> None:
    assert "zero-dynamics" in python(folder, "-m", "onpath", "--help")
    listed = python(folder, "-m", "onpath", "lessons", "list").splitlines()[1:]  # titles
    course = ROOT / "lessons" / "course"
    lessons = sorted(lesson.parent.name for lesson in course.glob("*/en.md"))
    for form in ("inventory", "inventory-b"):  # the questions before and after the course
        lessons.remove(form)
    lessons.remove("lecture")  # on the site only
    routes = sorted(route.stem for route in course.glob("routes/*.toml"))
    assert [line.split()[0] for line in listed] == [*lessons, *routes]
    python(folder, "-m", "onpath", "experiment", "position", "--set", "duration=0.05")
