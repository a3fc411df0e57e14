"""A foreign folder whose files have the same names as OnPath's."""

from __future__ import annotations

import os
from pathlib import Path

from tests.support.checkout import ROOT

MARK = "a-stranger-s-code-has-run"
CODE = f"""
from pathlib import Path
(Path(__file__).parent / "{MARK}").touch()
raise SystemExit("a stranger's code has run")
"""
FILES = ("app.py", "experiments.py", "models/__init__.py", "models/robots.py", "lessons/words.py")


def fill(folder: Path) -> None:
    """Write the `FILES`, of which models/ is a package; importing any of them leaves a mark."""
    for name in FILES:
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(CODE, "utf-8")
    (folder / "assets").mkdir()


def marks(folder: Path) -> list[Path]:
    """Marks left by the foreign code."""
    return list(folder.rglob(MARK))


def environment(**more: str) -> dict[str, str]:
    """Environment of a process outside the checkout that imports the package under test."""
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")]))
    return {**os.environ, "PYTHONPATH": path, **more}
