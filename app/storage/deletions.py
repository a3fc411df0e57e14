"""A journal of deletions, in a file apart from the database: a restored backup applies it again.

A line is the time of a deletion, seconds since 1970, and the SHA-256 of a name: of the code of a
lab, of a class, or of a student's seat in a class. Whoever reads it cannot tell which they were,
and it opens nothing. What was used after its deletion is another one, and stays.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from typing import Any

import msgspec
import sqlalchemy as sa

from onpath.app.storage.private_files import OWNER_FILE, make_private_folder
from onpath.app.storage.schema import classes, labs

BATCH = 500  # rows deleted by one statement; databases limit its parameters


def seat_name(room: str, lab: str) -> str:
    """The name in the journal of a student's seat in a class.

    Args:
        room: identifies the class in the database.
        lab: code of the student's lab.
    """
    return f"{room} {lab}"


class Deletions:
    """The journal.

    Args:
        file: created with the first deletion; None: nothing is noted, as nothing can be restored.
    """

    def __init__(self, file: Path | None) -> None:
        self._file = file

    def note(self, names: Iterable[str], now: float) -> None:
        """Note that these are being deleted.

        Call it in the transaction that deletes them, so that it is done if they are noted, and not
        done if they cannot be.

        Args:
            now: seconds since 1970.

        Raises:
            OSError: they cannot be noted.
        """
        lines = "".join(f"\n{now!r} {_hash(name)}" for name in names)  # ends half a line, if any
        if self._file is None or not lines:
            return
        if not self._file.parent.exists():
            self._file.parent.mkdir(parents=True)
            make_private_folder(self._file.parent)
        opened = os.open(self._file, os.O_APPEND | os.O_CREAT | os.O_WRONLY, OWNER_FILE)
        with open(opened, "a", encoding="ascii") as to:
            to.write(lines)
            to.flush()
            os.fsync(to.fileno())

    def apply(self, connection: sa.Connection) -> int:
        """Delete again what a database still has that was used last before its deletion.

        Returns:
            The number of labs, classes and seats that were deleted.

        Raises:
            OSError: the journal cannot be read.
        """
        known = self._known()
        if not known:
            return 0

        def is_gone(name: str, updated: float) -> bool:
            return updated <= known.get(_hash(name), 0.0)

        rows = connection.execute(sa.select(labs.c.code, labs.c.updated)).all()
        gone = [code for code, updated in rows if is_gone(code, updated)]
        _delete(connection, labs, gone)
        count = len(gone)
        columns = classes.c.code, classes.c.updated, classes.c.state
        for code, updated, state in connection.execute(sa.select(*columns)).all():
            if is_gone(code, updated):
                _delete(connection, classes, [code])
                count += 1
                continue
            stored, seats = _seats(state)
            kept = [each for each in seats if not is_gone(seat_name(code, _lab(each)), updated)]
            if len(kept) < len(seats):
                text = msgspec.json.encode({**stored, "members": kept}).decode()
                this = (classes.c.code == code) & (classes.c.updated == updated)
                connection.execute(sa.update(classes).where(this).values(state=text))
                count += len(seats) - len(kept)
        return count

    def _known(self) -> dict[str, float]:
        """The last deletion of each name, by its hash."""
        known = dict[str, float]()
        if self._file is None or not self._file.exists():
            return known
        for line in self._file.read_text("ascii", errors="replace").splitlines():
            time, _, name = line.partition(" ")
            try:
                known[name] = max(known.get(name, 0.0), float(time))
            except ValueError:
                continue  # half a line, of a process that was killed
        return known


def _hash(name: str) -> str:
    return sha256(name.encode(errors="replace")).hexdigest()


def _delete(connection: sa.Connection, table: sa.Table, codes: list[str]) -> None:
    for at in range(0, len(codes), BATCH):
        connection.execute(sa.delete(table).where(table.c.code.in_(codes[at : at + BATCH])))


def _seats(state: str) -> tuple[dict[str, Any], list[Any]]:
    """A stored class, and its students; empty if it cannot be read."""
    try:
        stored = msgspec.json.decode(state, type=dict[str, Any])
    except (ValueError, RecursionError):
        return {}, []
    seats = stored.get("members")
    return (stored, seats) if isinstance(seats, list) else (stored, [])


def _lab(seat: Any) -> str:
    return str(seat.get("session", "")) if isinstance(seat, dict) else ""
