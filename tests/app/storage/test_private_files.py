"""Other users of the machine cannot read the database, whose codes open labs."""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from onpath.app.storage import records as database
from onpath.app.storage.records import Records, default_file, file_url

pytestmark = pytest.mark.skipif(os.name != "posix", reason="permissions of a POSIX system")


@pytest.fixture(autouse=True)
def generous_umask() -> Iterator[None]:
    before = os.umask(0)
    yield
    os.umask(before)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "data" / "labs.db"


def mode(path: Path) -> int:
    return path.stat().st_mode & 0o777


def modes(file: Path) -> dict[str, int]:
    """Of the database and its journals, while it is open."""
    records = Records(file_url(file))
    records.claim("a")
    records.save("a", {})
    found = {part.name: mode(part) for part in file.parent.iterdir()}
    records.close()
    return found


def test_a_new_file_its_journals_and_its_folder_are_their_owner_s(file: Path) -> None:
    assert modes(file) == dict.fromkeys(("labs.db", "labs.db-wal", "labs.db-shm"), 0o600)
    assert mode(file.parent) == 0o700


def test_an_existing_file_is_made_private_and_its_folder_left_alone(file: Path) -> None:
    file.parent.mkdir(mode=0o755)
    with closing(sqlite3.connect(file)) as earlier:
        earlier.execute("PRAGMA journal_mode = WAL")
        earlier.execute("CREATE TABLE IF NOT EXISTS other (n INTEGER)")
        earlier.execute("DROP TABLE other")
        earlier.commit()
        for part in file.parent.iterdir():
            part.chmod(0o644)
        assert len(list(file.parent.iterdir())) == 3
        assert set(modes(file).values()) == {0o600}
    assert mode(file.parent) == 0o755


def test_the_default_folder_is_made_private(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(database.platformdirs, "user_data_dir", lambda name: str(file.parent))
    file.parent.mkdir(mode=0o755)
    Records().close()
    assert mode(file.parent) == 0o700 and mode(default_file()) == 0o600


def test_a_warning_is_logged_if_permissions_cannot_be_restricted(
    file: Path, monkeypatch: pytest.MonkeyPatch, caplog: Any
) -> None:
    def refuse(path: Path, mode: int) -> None:
        raise PermissionError(1, "Operation not permitted")

    modes(file)
    file.chmod(0o644)
    monkeypatch.setattr(Path, "chmod", refuse)
    modes(file)
    assert f"may read {file}" in caplog.text
