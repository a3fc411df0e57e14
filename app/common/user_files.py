"""Files that users name, in Python and on the command line."""

from __future__ import annotations

from pathlib import Path


def user_file(file: str | Path) -> Path:
    """A file to read, with ~ expanded.

    Raises:
        FileNotFoundError: there is no such file.
        IsADirectoryError: it is a folder.
    """
    path = Path(file).expanduser()
    if not path.exists():
        raise FileNotFoundError(f"{path}: there is no such file")
    if path.is_dir():
        raise IsADirectoryError(f"{path}: that is a folder")
    return path
