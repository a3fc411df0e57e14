"""Data files of the project: robot parameters, pictures."""

from __future__ import annotations

from pathlib import Path


def asset_path(name: str) -> Path:
    """Path of a data file or folder in this folder.

    Raises:
        FileNotFoundError: no such file; the message lists the existing ones.
    """
    folder = Path(__file__).parent
    path = folder / name
    if not path.exists():
        known = ", ".join(sorted(p.name for p in folder.iterdir() if p.is_file()))
        raise FileNotFoundError(f"no asset {name!r}; there are: {known}")
    return path
