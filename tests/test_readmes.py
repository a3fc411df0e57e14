"""What a README points to exists."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from tests.support.checkout import ROOT

READMES = [
    file
    for file in sorted(ROOT.rglob("*.md"))
    if not {".venv", "course", "build", ".git", "node_modules"} & set(file.relative_to(ROOT).parts)
]


@pytest.mark.parametrize("file", READMES, ids=lambda file: str(file.relative_to(ROOT)))
def test_files_and_pictures_that_are_linked_exist(file: Path) -> None:
    text = re.sub(r"```.*?```|`[^`]*`", "", file.read_text("utf-8"), flags=re.DOTALL)
    links = re.findall(r"\]\(([^)#\s]+)", text)
    assert not [link for link in links if "://" not in link and not (file.parent / link).exists()]


@pytest.mark.parametrize("name", ["app/README.md", "models/README.md"])
def test_modules_that_are_named_exist(name: str) -> None:
    """A module is named by its path, or by the end of it."""
    named = set(re.findall(r"`([\w/]+\.(?:py|js|ts))`", (ROOT / name).read_text("utf-8")))
    folders = ("app", "models", "lessons", "assets", "tests")
    files = [str(file) for folder in folders for file in (ROOT / folder).rglob("*.[pjt]*")]
    assert len(named) > 10
    assert [each for each in named if not any(file.endswith(f"/{each}") for file in files)] == []


def test_tests_that_are_named_exist() -> None:
    """A test is named by its file, or by its own name or a part of it."""
    rows = re.findall(r"^\|.*\|(.*)\|$", (ROOT / "SECURITY.md").read_text("utf-8"), re.MULTILINE)
    named = {name for row in rows for name in re.findall(r"`(\w+)`", row)}
    files = list((ROOT / "tests").rglob("test_*.py"))
    text = "\n".join(file.read_text("utf-8") for file in files)
    exist = {file.stem for file in files} | set(re.findall(r"def test_(\w+)", text))
    assert len(named) > 20
    assert [each for each in named if not any(each in name for name in exist)] == []


def test_all_files_have_the_version_of_the_package() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["version"]
    stated = {
        "README.md": r'"OnPath, version ([\d.]+)"|onpath-([\d.]+)(?:\.tar|-py3)',
        "CITATION.cff": r"^version: ([\d.]+)$",
        "CHANGELOG.md": r"\A# Changelog\n\n## ([\d.]+) — [\d-]+$",
        "assets/deploy/onpath.yaml": r"/onpath:([\d.]+)$",
    }
    for name, pattern in stated.items():
        text = (ROOT / name).read_text("utf-8")
        found = ["".join(each.groups(default="")) for each in re.finditer(pattern, text, re.M)]
        assert found and set(found) == {version}, name
