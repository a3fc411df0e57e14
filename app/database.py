"""What is kept of every lab, by session code: SQLite in the user's folder, or a database by URL.

A file that cannot be used never stops the lab: `Records.warning` says in words what is wrong, and
records live as long as the process. A broken file is moved aside, not deleted.
"""

from __future__ import annotations

import logging
import sqlite3
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
from filelock import FileLock
from sqlalchemy import event, exc, pool

from app.tables import LONGEST_CODE, labs, leases, meta, metadata

log = logging.getLogger(__name__)

VERSION = 1  # of the tables and of what `state` holds
LARGEST = 1_000_000  # [B], of one state
PATIENCE = 10.0  # [s] to wait for another process that writes
_BROKEN = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


_of = sa.bindparam("of")  # a code; statements made once take half the time
# who had a lab last; nobody else can take it before the transaction ends
_OWNER = sa.select(leases.c.owner).where(leases.c.code == _of).with_for_update()
_CHANGE = (
    sa.update(labs)
    .where(labs.c.code == _of, labs.c.version <= VERSION)
    .values({name: sa.bindparam(name) for name in ("version", "updated", "state")})
)


class NotKept(OSError):
    """The database does not work now; the message says why, in words."""


class HeldElsewhere(Exception):
    """Another process has the lab now: what is known of it here is old."""


class _Broken(Exception):
    """A file that is no database, or no longer."""


def default_file() -> Path:
    """Where records are kept unless a URL says otherwise."""
    return Path(platformdirs.user_data_dir("onpath")) / "onpath.db"


def file_url(file: Path) -> sa.URL:
    """The URL of an SQLite file."""
    return sa.URL.create("sqlite", database=str(file))


class Records:
    """States by session code; from any thread.

    Args:
        url: of the database as SQLAlchemy takes it, "postgresql+psycopg://user@host/onpath"; None
            for `default_file`.
        clock: seconds since 1970.

    Attributes:
        owner: a name for these records' process among those that share the database.
        warning: why nothing outlives this process, in words; empty when all is well.

    Raises:
        ValueError: the URL makes no sense, or its driver is not installed.
        NotKept: a database that is no SQLite file cannot be used: better not to start at all
            than to keep what others never see.
    """

    def __init__(
        self, url: str | sa.URL | None = None, clock: Callable[[], float] = time.time
    ) -> None:
        self._clock, self.owner = clock, uuid4().hex
        self._lock = threading.Lock()
        self._url = _parsed(url) if url else file_url(default_file())
        self.warning = ""
        self._engine = self._opened()

    def load(self, code: str) -> dict[str, Any] | None:
        """The state of a lab; None if there is none that this version can read.

        Raises:
            NotKept: the database cannot say; whoever gets this must not save under this code.
        """
        wanted = sa.select(labs.c.state, labs.c.version).where(labs.c.code == code)
        with self.transaction() as connection:
            row = connection.execute(wanted).first()
        if row is None:
            return None
        if row.version > VERSION:
            raise NotKept("this lab was kept by a newer OnPath")
        try:
            return msgspec.json.decode(row.state, type=dict[str, Any])
        except (ValueError, RecursionError):
            raise NotKept("what was kept of this lab cannot be read") from None

    def save(self, code: str, state: dict[str, Any], owner: str | None = None) -> None:
        """Keep a state instead of the one before.

        Args:
            owner: who saves; nothing is saved under a code that somebody else has leased.

        Raises:
            ValueError: too large, not what JSON can say, or no code.
            NotKept: it is not kept: the disk is full, the database away; the old one still is.
            HeldElsewhere: another owner has it.
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
            except exc.IntegrityError:  # another process was quicker, or is newer
                if last:
                    raise NotKept("this lab was kept by a newer OnPath") from None

    def delete_all(self) -> int:
        """Forget every lab and every class. Returns how many labs there were.

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
        """Whether other processes with the same URL have the same."""
        return not self.warning and self._url.database not in (None, "", ":memory:")

    def close(self) -> None:
        """Let the database go."""
        self._engine.dispose()

    @contextmanager
    def transaction(self) -> Iterator[sa.Connection]:
        """All or nothing, alone in SQLite.

        Raises:
            NotKept: nothing.
            sqlalchemy.exc.IntegrityError: nothing; another process was quicker.
        """
        try:
            with self._lock, self._engine.begin() as connection:
                yield connection
        except exc.IntegrityError:
            raise
        except (exc.SQLAlchemyError, UnicodeDecodeError) as error:
            raise NotKept(_words(error)) from error

    # Opening

    def _opened(self) -> sa.Engine:
        if self._url.get_backend_name() != "sqlite":
            return self._opened_server()
        try:
            return self._opened_file()
        except OSError as error:
            reason = error.strerror or error
            self.warning = f"Nothing outlives the server: {self._url.database}: {reason}."
            log.warning("%s", self.warning)
        return _prepared(_parsed("sqlite://"))

    def _opened_server(self) -> sa.Engine:
        for last in (False, True):
            try:
                return _prepared(self._url)
            except exc.SQLAlchemyError as error:  # perhaps another process made the tables
                if last:
                    raise NotKept(f"cannot use {self._url!r}: {_words(error)}") from error
        raise AssertionError

    def _opened_file(self) -> sa.Engine:
        file = Path(self._url.database) if self._url.database else None
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
        for _ in range(3):
            before = _identity(file)
            try:
                return _prepared(self._url)
            except _Broken as error:
                if file is not None:
                    self._move_aside(file, before, str(error))
            except exc.SQLAlchemyError as error:
                raise NotKept(_words(error)) from error
        raise NotKept("it breaks again and again")

    def _move_aside(self, file: Path, broken: tuple[int, int] | None, why: str) -> None:
        with FileLock(f"{file}.lock", timeout=PATIENCE):
            if _identity(file) == broken:  # nobody was quicker
                self._rename(file, why)

    def _rename(self, file: Path, why: str) -> None:
        stamp = time.strftime("%Y%m%d-%H%M%S", time.gmtime(self._clock()))
        aside = file.with_name(f"{file.name}.broken-{stamp}")
        count = 1
        while aside.exists():
            count += 1
            aside = file.with_name(f"{file.name}.broken-{stamp}-{count}")
        for tail in ("-wal", "-shm", ""):  # SQLite finds them again by these names
            part = file.with_name(file.name + tail)
            if part.exists():
                part.rename(aside.with_name(aside.name + tail))
        log.warning("%s is broken (%s): moved to %s, a fresh one is begun", file, why, aside.name)


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


def _parsed(url: str | sa.URL) -> sa.URL:
    try:
        return sa.make_url(url)
    except exc.ArgumentError:
        raise ValueError("no URL of a database, like postgresql+psycopg://user@host/name") from None


def _engine(url: sa.URL) -> sa.Engine:
    options: dict[str, Any] = {"pool_pre_ping": True}
    sqlite = url.get_backend_name() == "sqlite"
    if sqlite:
        options = {"connect_args": {"timeout": PATIENCE, "check_same_thread": False}}
        if not url.database:
            options["poolclass"] = pool.StaticPool
    try:
        engine = sa.create_engine(url, **options)
    except (exc.NoSuchModuleError, ImportError) as error:
        raise ValueError(f"no driver for {url.drivername}: {error}") from None
    if sqlite:
        event.listen(engine, "connect", _connected)
        event.listen(engine, "begin", _begun)
    return engine


def _connected(connection: Any, _: Any) -> None:
    connection.isolation_level = None  # transactions are begun below, tables made inside them
    for pragma in (
        "journal_mode = WAL",
        "synchronous = NORMAL",
        "foreign_keys = ON",
        "secure_delete = ON",
    ):
        connection.execute(f"PRAGMA {pragma}")


def _begun(connection: sa.Connection) -> None:
    connection.exec_driver_sql("BEGIN IMMEDIATE")


def _prepared(url: sa.URL) -> sa.Engine:
    """With the tables in it.

    Raises:
        _Broken: it is no database.
        NotKept: it is somebody else's, or a newer version's.
    """
    engine = _engine(url)
    try:
        with engine.begin() as connection:
            if engine.dialect.name == "sqlite":
                found = str(connection.exec_driver_sql("PRAGMA quick_check(1)").scalar())
                if found != "ok":
                    raise _Broken(found)
            _check_tables(connection)
    except Exception as error:
        engine.dispose()
        code = getattr(getattr(error, "orig", None), "sqlite_errorcode", 0)
        if code & 0xFF in _BROKEN:
            raise _Broken(_words(error)) from error
        if isinstance(error, UnicodeDecodeError):  # SQLite's complaint quotes what it found
            raise _Broken("it is full of strange letters") from error
        raise
    return engine


def _check_tables(connection: sa.Connection) -> None:
    inspector = sa.inspect(connection)
    there = set(inspector.get_table_names())
    for table in metadata.tables.values():
        if table.name in there:
            columns = {column["name"] for column in inspector.get_columns(table.name)}
            if columns != set(table.columns.keys()):
                raise NotKept(f"its table {table.name} is not OnPath's")
    metadata.create_all(connection)
    version = connection.execute(sa.select(meta.c.number).where(meta.c.name == "version")).scalar()
    if version is None:
        connection.execute(sa.insert(meta).values(name="version", number=VERSION))
    elif version > VERSION:
        raise NotKept(f"it is of version {version}, made by a newer OnPath, which is needed here")


def _identity(file: Path | None) -> tuple[int, int] | None:
    if file is None or not file.exists():
        return None
    found = file.stat()
    return found.st_dev, found.st_ino


def _words(error: Exception) -> str:
    """What the driver said, without the statement and what was in it."""
    return str(getattr(error, "orig", None) or type(error).__name__).strip().splitlines()[0]
