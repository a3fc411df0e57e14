"""Opens the database: an SQLite file, or a server by its URL.

A corrupt file is renamed, not deleted, and a new one is created.
"""

from __future__ import annotations

import logging
import sqlite3
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import sqlalchemy as sa
from sqlalchemy import event, exc, pool

from onpath.app.storage.migrations import HEAD, known_revisions, revision_of, upgrade
from onpath.app.storage.migrations.first_tables import strange_table
from onpath.app.storage.private_files import JOURNALS, make_private_file
from onpath.app.storage.schema import meta
from onpath.app.storage.server_limits import (
    connection_limits,
    lift_statement_limit,
    limit_transaction,
)
from onpath.models.errors import Coded

log = logging.getLogger(__name__)

VERSION = 1  # of the tables and of the content of `state`
PATIENCE = 10.0  # [s] to wait, while opening, for a lock that another process holds
TRANSACTION_WAIT = 2.0  # [s], the same for a transaction, for which a user may be waiting
CACHE = 256  # [KiB] of the file that each connection caches; a state takes a few
Identity = tuple[int, int]
"""Device and inode of a file."""
_BROKEN = (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


class NotKept(Coded, OSError):
    """The database cannot be used at present; the message says why."""


@contextmanager
def held(lock: threading.Lock, seconds: float) -> Iterator[None]:
    """Hold a lock, and wait for it for at most `seconds`.

    Raises:
        NotKept: other threads held it for all that time.
    """
    if not lock.acquire(timeout=seconds):
        raise NotKept("error.database_busy")
    try:
        yield
    finally:
        lock.release()


class _Broken(Exception):
    """The file is not a database, or is corrupt."""


def parsed(url: str | sa.URL) -> sa.URL:
    """A database URL.

    Raises:
        ValueError: it is malformed.
    """
    try:
        return sa.make_url(url)
    except exc.ArgumentError:
        raise ValueError("not a database URL such as postgresql+psycopg://user@host/name") from None


def opened_server(url: sa.URL) -> sa.Engine:
    """The engine of a database server, with the tables created or migrated.

    Raises:
        ValueError: its driver is not installed.
        NotKept: it cannot be used.
    """
    for last in (False, True):
        try:
            return _prepared(url)
        except exc.SQLAlchemyError as error:  # another process may have created the tables
            if last:
                raise NotKept("error.database_at", place=repr(url), reason=words(error)) from error
    raise AssertionError


def opened_memory() -> sa.Engine:
    """The engine of a database in memory."""
    return _prepared(parsed("sqlite://"))


def opened_file(
    url: sa.URL, clock: Callable[[], float], patience: float = PATIENCE
) -> tuple[sa.Engine, Identity | None]:
    """The engine of an SQLite file, with the tables created or migrated, and the file's identity.

    Args:
        clock: seconds since 1970; names a corrupt file that is moved aside.
        patience: how long to wait for a lock that another process holds, [s].

    Raises:
        OSError: it cannot be used.
    """
    file = file_of(url)
    for _ in range(5):
        if file is not None:
            make_private_file(file)
        before = identity(file)
        try:
            engine = _prepared(url, patience)
            if identity(file) == before:
                return engine, before
            engine.dispose()  # another process has replaced the file: unclear which one is open
        except _Broken as error:
            if file is not None:
                _move_aside(file, before, str(error), clock, patience)
        except exc.SQLAlchemyError as error:
            raise NotKept("error.database", reason=words(error)) from error
    raise NotKept("error.database_keeps_breaking")


def file_of(url: sa.URL) -> Path | None:
    """The file of a database; None if it is in memory, on a server, or named by a URI."""
    name = url.database or ""
    if url.get_backend_name() != "sqlite" or name in ("", ":memory:") or name.startswith("file:"):
        return None
    return Path(name)


def identity(file: Path | None) -> Identity | None:
    """Identity of the file that now has this name; None if there is none."""
    try:
        status = None if file is None else file.stat()
    except OSError:
        return None
    return None if status is None else (status.st_dev, status.st_ino)


def journals_of(file: Path | None, known: Identity | None) -> dict[Path, Identity | None]:
    """The journals of an open database and their identities; none if it has been replaced."""
    parts = [] if file is None else [file.with_name(file.name + tail) for tail in JOURNALS]
    found = {part: identity(part) for part in parts}
    return found if identity(file) == known else {}


def discard_journals(
    file: Path, journals: dict[Path, Identity | None], patience: float = PATIENCE
) -> None:
    """Delete the journals of a database that has been deleted or replaced.

    SQLite would apply them to the file that now has its name. Journals that another process has
    begun for that file are kept.

    Args:
        journals: as found by `journals_of` while the database was open.
        patience: how long to wait for another process that is moving or opening the file, [s].
    """
    with _locked(file, patience):
        for part, known in journals.items():
            if known is not None and identity(part) == known:
                part.unlink()


def words(error: Exception) -> str:
    """The driver's message, without the statement and its values."""
    return str(getattr(error, "orig", None) or type(error).__name__).strip().splitlines()[0]


def _move_aside(
    file: Path, broken: Identity | None, why: str, clock: Callable[[], float], patience: float
) -> None:
    with _locked(file, patience):
        if identity(file) == broken:  # no other process has replaced it
            _rename(file, why, clock)


@contextmanager
def _locked(file: Path, patience: float) -> Iterator[None]:
    """Mutual exclusion between processes, by SQLite's lock on an empty file beside the database.

    The lock is released when the process ends, however it ends.
    """
    beside = file.with_name(f"{file.name}.lock")
    try:
        with closing(sqlite3.connect(beside, timeout=patience, isolation_level=None)) as lock:
            lock.execute("BEGIN EXCLUSIVE")
            yield
    except sqlite3.Error as error:
        raise NotKept("error.database_at", place=beside.name, reason=str(error)) from error


def _rename(file: Path, why: str, clock: Callable[[], float]) -> None:
    stamp = time.strftime("%Y%m%d-%H%M%S", time.gmtime(clock()))
    aside = file.with_name(f"{file.name}.broken-{stamp}")
    count = 1
    while aside.exists():
        count += 1
        aside = file.with_name(f"{file.name}.broken-{stamp}-{count}")
    for tail in (*JOURNALS, ""):  # SQLite finds the journals by these names
        part = file.with_name(file.name + tail)
        if part.exists():
            part.rename(aside.with_name(aside.name + tail))
    log.warning("%s is broken (%s): moved to %s, a fresh one is created", file, why, aside.name)


def _engine(url: sa.URL, patience: float) -> sa.Engine:
    options: dict[str, Any] = {"execution_options": {"patience": patience}}
    sqlite = url.get_backend_name() == "sqlite"
    if sqlite:
        options["connect_args"] = {"timeout": patience, "check_same_thread": False}
        if not url.database:
            options["poolclass"] = pool.StaticPool
    else:
        options |= {"pool_pre_ping": True, "connect_args": connection_limits(url)}
    try:
        engine = sa.create_engine(url, **options)
    except (exc.NoSuchModuleError, ImportError) as error:
        raise ValueError(f"no driver for {url.drivername}: {error}") from None
    if sqlite:
        event.listen(engine, "connect", _connected)
        event.listen(engine, "begin", _begun)
    elif engine.dialect.name == "postgresql":
        event.listen(engine, "begin", limit_transaction)
    return engine


def _connected(connection: Any, _: Any) -> None:
    connection.isolation_level = None  # `_begun` begins all transactions, including those of DDL
    for pragma in (
        "journal_mode = WAL",
        "synchronous = NORMAL",
        "foreign_keys = ON",
        "secure_delete = ON",
        f"cache_size = -{CACHE}",
    ):
        connection.execute(f"PRAGMA {pragma}")


def _begun(connection: sa.Connection) -> None:
    patience = connection.get_execution_options()["patience"]
    connection.exec_driver_sql(f"PRAGMA busy_timeout = {1000 * patience:.0f}")
    connection.exec_driver_sql("BEGIN IMMEDIATE")


def _prepared(url: sa.URL, patience: float = PATIENCE) -> sa.Engine:
    """The engine of a database, with the tables created or migrated.

    Raises:
        _Broken: it is not a database, or is corrupt.
        NotKept: it belongs to another program or a newer version.
    """
    engine = _engine(url, patience)
    try:
        with engine.begin() as connection:
            if engine.dialect.name == "sqlite":
                report = str(connection.exec_driver_sql("PRAGMA quick_check(1)").scalar())
                if report != "ok":
                    raise _Broken(report)
            elif engine.dialect.name == "postgresql":
                lift_statement_limit(connection)  # a migration of many labs may take minutes
            _migrate(connection)
    except Exception as error:
        engine.dispose()
        code = getattr(getattr(error, "orig", None), "sqlite_errorcode", 0)
        if code & 0xFF in _BROKEN:
            raise _Broken(words(error)) from error
        if isinstance(error, UnicodeDecodeError):  # SQLite's message quotes the corrupt data
            raise _Broken("it contains undecodable text") from error
        raise
    return engine


def _migrate(connection: sa.Connection) -> None:
    """Create the tables, or migrate them to the current revision.

    Raises:
        NotKept: they belong to another program or a newer version.
    """
    revision = revision_of(connection)
    if revision is None and (strange := strange_table(connection)):
        raise NotKept("error.database_table", table=strange)
    if revision != HEAD:
        if revision is not None and revision not in known_revisions():
            raise NotKept("error.database_tables_newer", revision=revision)
        upgrade(connection)
    version = connection.execute(sa.select(meta.c.number).where(meta.c.name == "version")).scalar()
    if version is None:
        connection.execute(sa.insert(meta).values(name="version", number=VERSION))
    elif version > VERSION:
        raise NotKept("error.database_newer", version=str(version))
