"""What a README points to is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support.checkout import ROOT

READMES = [
    file
    for file in sorted(ROOT.rglob("*.md"))
    if not {".venv", "course", "onpath", ".git", "node_modules"} & set(file.relative_to(ROOT).parts)
]


@pytest.mark.parametrize("file", READMES, ids=lambda file: str(file.relative_to(ROOT)))
def test_files_and_pictures_that_are_linked_exist(file: Path) -> None:
    text = re.sub(r"```.*?```|`[^`]*`", "", file.read_text("utf-8"), flags=re.DOTALL)
    links = re.findall(r"\]\(([^)#\s]+)", text)
    assert not [link for link in links if "://" not in link and not (file.parent / link).exists()]
