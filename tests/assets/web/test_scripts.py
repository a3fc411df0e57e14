"""The tests of the pages' scripts, which run in Node: the files `*.test.ts` here."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.support.node_page import NODE, TESTS, built, needs_node

FILES = sorted(TESTS.rglob("*.test.ts"))
pytestmark = needs_node


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(TESTS)))
def test_script(file: Path) -> None:
    script = built(*FILES) / file.relative_to(TESTS).with_suffix(".mjs")
    command = [
        NODE or "",
        "--enable-source-maps",
        "--test",
        "--test-reporter=spec",
        "--test-force-exit",
        script,
    ]
    run = subprocess.run(command, check=False, capture_output=True, text=True, encoding="utf-8")
    assert run.returncode == 0, run.stdout + run.stderr
    assert "tests 0" not in run.stdout
