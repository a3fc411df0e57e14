"""The stored states of labs, by session code: in an SQLite file of the user, or a database by URL.

An SQLite file that cannot be used never stops the lab: `Records.warning` then says why, and the
records are in memory. engine.py opens the database.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from uuid import uuid4

import msgspec
import platformdirs
import sqlalchemy as sa
from sqlalchemy import exc

from onpath.app.storage.engine import (
    TRANSACTION_WAIT,
    VERSION,
    Identity,
    NotKept,
    discard_journals,
    file_of,
    identity,
    journals_of,
    opened_file,
    opened_memory,
    opened_server,
    parsed,
    words,
)
from onpath.app.storage.private_files import make_private_folder
from onpath.app.storage.schema import LONGEST_CODE, labs, leases, meta, metadata

log = logging.getLogger(__name__)

LARGEST = 1_000_000  # [B], of one state

_of = sa.bindparam("of")  # a code. Prebuilt statements take half the time
# The last owner of a lab. The row is locked until the transaction ends
_OWNER = sa.select(leases.c.owner).where(leases.c.code == _of).with_for_update()
_CHANGE = (
    sa.update(labs)
    .where(labs.c.code == _of, labs.c.version <= VERSION)
    .values({name: sa.bindparam(name) for name in ("version", "updated", "state")})
)


class HeldElsewhere(Exception):
    """Another process has the lab now; the state in this process is stale."""


def default_file() -> Path:
    """The SQLite file that is used without a URL."""
    return Path(platformdirs.user_data_dir("onpath")) / "onpath.db"


def file_url(file: Path) -> sa.URL:
    """The URL of an SQLite file."""
    return sa.URL.create("sqlite", database=str(file))


class Records:
    """States by session code. Thread-safe.

    Args:
        url: of the database as SQLAlchemy takes it, "postgresql+psycopg://user@host/onpath"; None
            for `default_file`.
        clock: seconds since 1970.

    Attributes:
        owner: unique name of this process among those that share the database.
        warning: why states are lost when the process ends, in words; empty if they are not.
        generation: how often the file was found deleted or replaced; what was saved before may be
            gone.

    Raises:
        ValueError: the URL is malformed, or its driver is not installed.
        NotKept: a database server cannot be used. There is no fallback to memory, because other
            processes would not see those records.
    """

    def __init__(
        self, url: str | sa.URL | None = None, clock: Callable[[], float] = time.time
    ) -> None:
        self._clock, self.owner = clock, uuid4().hex
        self._lock = threading.Lock()
        self._url = parsed(url) if url else file_url(default_file())
        if not url:
            make_private_folder(default_file().parent)
        self.warning, self.generation = "", 0
        self._file = file_of(self._url)
        self._identity: Identity | None = None
        self._engine = self._opened()
        self._journals = journals_of(self._file, self._identity)

    def load(self, code: str) -> dict[str, Any] | None:
        """The state of a lab; None if there is none.

        Raises:
            NotKept: the database cannot be used, or the state cannot be read; the caller must then
                not save under this code.
        """
        wanted = sa.select(labs.c.state, labs.c.version).where(labs.c.code == code)
        with self.transaction() as connection:
            row = connection.execute(wanted).first()
        if row is None:
            return None
        if row.version > VERSION:
            raise NotKept("error.lab_newer")
        try:
            return msgspec.json.decode(row.state, type=dict[str, Any])
        except (ValueError, RecursionError):
            raise NotKept("error.lab_unreadable") from None

    def save(self, code: str, state: dict[str, Any], owner: str | None = None) -> None:
        """Replace the state of a lab.

        Args:
            owner: who saves. Nothing is saved if another owner has leased the lab.

        Raises:
            ValueError: the state is too large or not JSON, or the code is invalid.
            NotKept: the database cannot be used (disk full, server away); the previous state
                remains.
            HeldElsewhere: another owner has the lab.
        """
        text = _text(code, state)
        values = {"version": VERSION, "updated": self._clock(), "state": text}
        for last in (False, True):
            try:
                with self.transaction() as connection:
                    if owner is not None:
                        leased = connection.execute(_OWNER, {"of": code}).scalar()
                        if leased not in (None, owner):
                            raise HeldElsewhere
                    changed = connection.execute(_CHANGE, {"of": code, **values})
                    if not changed.rowcount:
                        connection.execute(sa.insert(labs).values(code=code, **values))
                return
            except exc.IntegrityError:  # another process inserted it first, or is a newer version
                if last:
                    raise NotKept("error.lab_newer") from None

    def delete_all(self) -> int:
        """Delete all labs and classes. Returns the number of labs.

        Raises:
            NotKept: they could not be deleted.
        """
        with self.transaction() as connection:
            for table in metadata.tables.values():
                if table not in (meta, labs):
                    connection.execute(sa.delete(table))
            return connection.execute(sa.delete(labs)).rowcount

    @property
    def is_shared(self) -> bool:
        """Whether other processes with the same URL see the same records."""
        return not self.warning and self._url.database not in (None, "", ":memory:")

    def close(self) -> None:
        """Close the database."""
        self._engine.dispose()

    def _reopen_if_replaced(self, until: float) -> None:
        """Open the file again if it has been deleted or replaced under its name.

        Raises:
            NotKept: it cannot be opened or created.
        """
        if self._file is None or self.warning or identity(self._file) == self._identity:
            return
        try:
            if self._file.parent.exists():
                discard_journals(self._file, self._journals, _left(until))
            self._engine.dispose()
            self._engine, self._identity = opened_file(self._url, self._clock, _left(until))
        except NotKept:
            raise
        except OSError as error:
            raise NotKept("error.database", reason=error.strerror or str(error)) from error
        self._journals = journals_of(self._file, self._identity)
        self.generation += 1
        log.warning("%s was deleted or replaced: labs in use are kept anew in it", self._file)

    @contextmanager
    def transaction(self) -> Iterator[sa.Connection]:
        """A transaction; serialised with all others in SQLite.

        Whoever waits for others, in this process or another, waits `TRANSACTION_WAIT` at most.

        Raises:
            NotKept: the database cannot be used; nothing was changed.
            sqlalchemy.exc.IntegrityError: another process inserted the row first; nothing was
                changed.
        """
        until = time.monotonic() + TRANSACTION_WAIT
        if not self._lock.acquire(timeout=TRANSACTION_WAIT):
            raise NotKept("error.database_busy")
        try:
            self._reopen_if_replaced(until)
            connection = self._engine.connect().execution_options(patience=_left(until))
            with connection, connection.begin():
                yield connection
        except exc.IntegrityError:
            raise
        except (exc.SQLAlchemyError, UnicodeDecodeError) as error:
            raise NotKept("error.database", reason=words(error)) from error
        finally:
            self._lock.release()

    def _opened(self) -> sa.Engine:
        if self._url.get_backend_name() != "sqlite":
            return opened_server(self._url)
        try:
            engine, self._identity = opened_file(self._url, self._clock)
            return engine
        except OSError as error:
            reason = error.strerror or error
            self.warning = f"Nothing outlives the server: {self._url.database}: {reason}."
            log.warning("%s", self.warning)
        return opened_memory()


def _text(code: str, state: dict[str, Any]) -> str:
    if not 0 < len(code) <= LONGEST_CODE:
        raise ValueError(f"a session code has up to {LONGEST_CODE} characters, not {len(code)}")
    try:
        text = msgspec.json.encode(state).decode()
    except (TypeError, ValueError, RecursionError) as error:
        raise ValueError(f"this cannot be kept: {error}") from error
    if len(text) > LARGEST:
        size = f"{len(text) / 1e6:.1f} MB, at most {LARGEST / 1e6:g} MB"
        raise ValueError(f"there is too much in this lab to be kept: {size}")
    return text


def _left(until: float) -> float:
    """Time that is left until a deadline by `time.monotonic`, [s]."""
    return max(until - time.monotonic(), 0.0)
