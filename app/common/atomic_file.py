"""Output files that are written completely or not at all, and early checks of their paths."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

PICTURES = ".png", ".svg", ".pdf"


def check_plot(path: Path | None, asked_by: str = "--plot") -> None:
    """Check that a picture can be written.

    Args:
        asked_by: the option or function that the picture is for.

    Raises:
        ValueError: an unknown kind of file, or the file cannot be written.
    """
    check_file(path, PICTURES, asked_by)


def check_file(path: Path | None, endings: Sequence[str], asked_by: str) -> None:
    """Check that a file can be written, if there is one, and that its name has a right ending.

    Raises:
        ValueError: another ending, or the file cannot be written.
    """
    if path is None:
        return
    if path.suffix.lower() not in endings:
        *most, last = endings
        wanted = f"{', '.join(most)} or {last}" if most else last
        raise ValueError(f"{asked_by} {path}: expected a name ending in {wanted}")
    check_writable(path)


def check_writable(path: Path) -> None:
    """Check that a file can be written.

    Raises:
        ValueError: the file cannot be written.
    """
    if path.is_dir():
        raise ValueError(f"{path}: that is a folder")
    if not path.parent.is_dir():
        raise ValueError(f"{path}: no folder {path.parent}")
    if not os.access(path.parent, os.W_OK):
        raise ValueError(f"{path}: nothing can be written to {path.parent}")


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Open a temporary file that is renamed to `path` once it is complete.

    Raises:
        OSError: it cannot be written; the error names `path`.
    """
    scratch = ""
    try:
        handle, scratch = tempfile.mkstemp(dir=path.parent, suffix=path.suffix)
        os.close(handle)
        yield Path(scratch)
        os.chmod(scratch, 0o644)
        os.replace(scratch, path)
    except OSError as error:
        if error.errno is None or (scratch and error.filename not in (None, scratch)):
            raise  # the error concerns another file
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        if scratch:
            Path(scratch).unlink(missing_ok=True)
