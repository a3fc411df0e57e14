"""Deletes all stored labs."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import sqlalchemy as sa

from onpath.app.storage.records import Records, default_file


@dataclass(frozen=True, slots=True)
class ForgetCounts:
    """What was deleted.

    Attributes:
        labs: number of labs.
        files: corrupt databases that had been moved aside, also deleted.
    """

    labs: int
    files: tuple[Path, ...]


def forget(url: str | None = None) -> ForgetCounts:
    """Delete all labs of a database; without a URL, of the user's own file.

    Raises:
        ValueError: the URL is malformed.
        OSError: something could not be deleted.
    """
    records = Records(url)
    try:
        if records.warning:
            raise OSError(records.warning)
        labs = records.delete_all()
    finally:
        records.close()
    files = tuple(sorted(_broken(url)))
    for file in files:
        file.unlink()
    return ForgetCounts(labs, files)


def _broken(url: str | None) -> list[Path]:
    """The corrupt files that were moved aside; they contain labs as well."""
    parsed = sa.make_url(url) if url else None
    if parsed is not None and (parsed.get_backend_name() != "sqlite" or not parsed.database):
        return []
    file = default_file() if parsed is None else Path(parsed.database or "")
    return [part for part in file.parent.iterdir() if part.name.startswith(f"{file.name}.broken-")]
