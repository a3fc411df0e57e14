"""Opens the database: an SQLite file, or a server by its URL.

A broken file is moved aside, not deleted, and a fresh one is begun.
"""

from __future__ import annotations

import logging
import sqlite3
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import sqlalchemy as sa
from sqlalchemy import event, exc, pool

from onpath.app.storage.migrations import HEAD, known_revisions, revision_of, upgrade
from onpath.app.storage.migrations.first_tables import strange_table
from onpath.app.storage.schema import meta

log = logging.getLogger(__name__)

VERSION = 1  # of the tables and of what `state` holds
PATIENCE = 10.0  # [s] to wait for another process that writes
_BROKEN = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


class NotKept(OSError):
    """The database does not work now; the message says why, in words."""


class _Broken(Exception):
    """A file that is no database, or no longer."""


def parsed(url: str | sa.URL) -> sa.URL:
    """A database's URL.

    Raises:
        ValueError: it makes no sense.
    """
    try:
        return sa.make_url(url)
    except exc.ArgumentError:
        raise ValueError("no URL of a database, like postgresql+psycopg://user@host/name") from None


def opened_server(url: sa.URL) -> sa.Engine:
    """A database by its URL, with the tables in it.

    Raises:
        ValueError: its driver is not installed.
        NotKept: it cannot be used.
    """
    for last in (False, True):
        try:
            return _prepared(url)
        except exc.SQLAlchemyError as error:  # perhaps another process made the tables
            if last:
                raise NotKept(f"cannot use {url!r}: {words(error)}") from error
    raise AssertionError


def opened_memory() -> sa.Engine:
    """A database that lives as long as the process."""
    return _prepared(parsed("sqlite://"))


def opened_file(url: sa.URL, clock: Callable[[], float]) -> sa.Engine:
    """An SQLite file, with the tables in it.

    Args:
        clock: seconds since 1970; a broken file gets it in its name.

    Raises:
        OSError: it cannot be used.
    """
    file = Path(url.database) if url.database else None
    if file is not None:
        file.parent.mkdir(parents=True, exist_ok=True)
    for _ in range(3):
        before = _identity(file)
        try:
            return _prepared(url)
        except _Broken as error:
            if file is not None:
                _move_aside(file, before, str(error), clock)
        except exc.SQLAlchemyError as error:
            raise NotKept(words(error)) from error
    raise NotKept("it breaks again and again")


def words(error: Exception) -> str:
    """What the driver said, without the statement and what was in it."""
    return str(getattr(error, "orig", None) or type(error).__name__).strip().splitlines()[0]


def _move_aside(
    file: Path, broken: tuple[int, int] | None, why: str, clock: Callable[[], float]
) -> None:
    with _locked(file.with_name(f"{file.name}.lock")):
        if _identity(file) == broken:  # nobody was quicker
            _rename(file, why, clock)


@contextmanager
def _locked(beside: Path) -> Iterator[None]:
    """Alone among processes, until it ends or is killed: SQLite's own lock, of an empty file."""
    try:
        with closing(sqlite3.connect(beside, timeout=PATIENCE, isolation_level=None)) as lock:
            lock.execute("BEGIN EXCLUSIVE")
            yield
    except sqlite3.Error as error:
        raise NotKept(f"{beside.name}: {error}") from error


def _rename(file: Path, why: str, clock: Callable[[], float]) -> None:
    stamp = time.strftime("%Y%m%d-%H%M%S", time.gmtime(clock()))
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


def _identity(file: Path | None) -> tuple[int, int] | None:
    if file is None or not file.exists():
        return None
    found = file.stat()
    return found.st_dev, found.st_ino


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
            _migrate(connection)
    except Exception as error:
        engine.dispose()
        code = getattr(getattr(error, "orig", None), "sqlite_errorcode", 0)
        if code & 0xFF in _BROKEN:
            raise _Broken(words(error)) from error
        if isinstance(error, UnicodeDecodeError):  # SQLite's complaint quotes what it found
            raise _Broken("it is full of strange letters") from error
        raise
    return engine


def _migrate(connection: sa.Connection) -> None:
    """Bring the tables up to date.

    Raises:
        NotKept: they are somebody else's, or a newer version's.
    """
    revision = revision_of(connection)
    if revision is None and (strange := strange_table(connection)):
        raise NotKept(f"its table {strange} is not OnPath's")
    if revision != HEAD:
        if revision is not None and revision not in known_revisions():
            raise NotKept(f"its tables ({revision}) are of a newer OnPath, which is needed here")
        upgrade(connection)
    version = connection.execute(sa.select(meta.c.number).where(meta.c.name == "version")).scalar()
    if version is None:
        connection.execute(sa.insert(meta).values(name="version", number=VERSION))
    elif version > VERSION:
        raise NotKept(f"it is of version {version}, made by a newer OnPath, which is needed here")
