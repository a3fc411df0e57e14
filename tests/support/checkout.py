"""Path of the checkout under test, and the modules in it."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("app", "assets", "lessons", "models")
"""Top folders of which the package `onpath` is made."""


def modules() -> list[str]:
    """Names of all modules of the package, such as "onpath.models.paths.curves"."""
    files = [file for folder in FOLDERS for file in (ROOT / folder).rglob("*.py")]
    parts = [file.relative_to(ROOT).with_suffix("").parts for file in sorted(files)]
    names = [".".join(("onpath", *each)).removesuffix(".__init__") for each in parts]
    scripts = (
        *("onpath.app.storage.migrations.versions.", "onpath.app.storage.migrations.env"),
        "onpath.assets.examples.",
    )
    return [name for name in names if not name.startswith(scripts)]  # which are run by their paths
