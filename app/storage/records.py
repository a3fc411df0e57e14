"""The stored states of labs and classes, in the user's SQLite file or a database given by URL.

Several processes may share a database. A state belongs to the process that claimed it last, and no
other can save it, so a process notices when its copy in memory is outdated. A state that another
process has open cannot be claimed: that process holds a lease, see leases.py.

An SQLite file that cannot be used does not stop a lab on a laptop: `Records.warning` then says why,
and the records are in memory. engine.py opens the database.
"""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from uuid import uuid4

import msgspec
import platformdirs
import sqlalchemy as sa
from sqlalchemy import exc

from onpath.app.storage.deletions import Deletions
from onpath.app.storage.engine import (
    TRANSACTION_WAIT,
    VERSION,
    Identity,
    NotKept,
    discard_journals,
    file_of,
    held,
    identity,
    journals_of,
    opened_file,
    opened_memory,
    opened_server,
    parsed,
    words,
)
from onpath.app.storage.leases import Renewal, give_up, renew, take
from onpath.app.storage.private_files import make_private_folder
from onpath.app.storage.schema import LONGEST_CODE, classes, labs, leases
from onpath.models.errors import CodedError

log = logging.getLogger(__name__)

LARGEST = 1_500_000  # [B], of one state


@dataclass(frozen=True, slots=True)
class _Statements:
    """The statements for one table; prebuilt, they take half the time."""

    read: sa.Executable
    lock: sa.Executable
    claim: sa.Executable
    change: sa.Update
    insert: sa.Executable


def _statements(table: sa.Table) -> _Statements:
    this = table.c.code == sa.bindparam("of")
    read = sa.select(table.c.state, table.c.version, table.c.owner).where(this)
    used = {"owner": sa.bindparam("own"), "updated": sa.bindparam("updated")}
    state = {"version": VERSION, "state": sa.bindparam("state"), "updated": used["updated"]}
    mine = (table.c.owner == used["owner"]) & (table.c.version <= VERSION)
    return _Statements(
        read=read,
        lock=read.with_for_update(),
        claim=sa.update(table).where(this).values(used),
        change=sa.update(table).where(this, mine).values(state),
        insert=sa.insert(table).values({"code": sa.bindparam("of"), **used, **state}),
    )


_SERVER_TIME = sa.select(sa.cast(sa.extract("epoch", sa.func.clock_timestamp()), sa.Double))
_STATEMENTS = {table: _statements(table) for table in (labs, classes)}


class NotStorable(CodedError):
    """A state cannot be stored, whatever the database does; the previous one remains."""


class HeldElsewhere(Exception):
    """Another process has claimed the state, or has it open."""


def default_file() -> Path:
    """The SQLite file that is used without a URL."""
    return Path(platformdirs.user_data_dir("onpath")) / "onpath.db"


def file_url(file: Path) -> sa.URL:
    """The URL of an SQLite file."""
    return sa.URL.create("sqlite", database=str(file))


def journal_file(url: sa.URL) -> Path:
    """The file in which deletions are noted: beside an SQLite file, else in the data folder."""
    file = file_of(url)
    file = default_file().with_suffix("") if file is None else file
    return file.with_name(f"{file.name}.deleted")


class Records:
    """States of labs by code, and of classes. Thread-safe.

    What is deleted by hand is noted in a file of its own, and deleted again from a backup that is
    restored; see `Deletions`.

    Args:
        url: of the database, as for SQLAlchemy, such as "postgresql+psycopg://user@host/onpath";
            None for `default_file`.
        clock: seconds since 1970.
        needed: whether an SQLite file that cannot be used is an error.

    Attributes:
        owner: unique name of this process among those that share the database.
        warning: why states will be lost when the process ends; empty if they will not.
        generation: how often the file was found deleted or replaced; earlier states may be gone.

    Raises:
        ValueError: the URL is malformed, or its driver is not installed.
        NotKept: a database server, or a file that is needed, cannot be used. Other processes
            would not see records in memory.
    """

    def __init__(
        self,
        url: str | sa.URL | None = None,
        clock: Callable[[], float] = time.time,
        needed: bool = False,
    ) -> None:
        self._clock, self.owner, self._needed = clock, uuid4().hex, needed
        self._lock = threading.Lock()
        self._url = parsed(url) if url else file_url(default_file())
        if not url:
            make_private_folder(default_file().parent)
        self.warning, self.generation = "", 0
        self._file = file_of(self._url)
        self._identity: Identity | None = None
        self._engine = self._opened()
        self._journals = journals_of(self._file, self._identity)
        is_kept = not self.warning and (self._file is not None or not self._is_sqlite)
        self._deletions = Deletions(journal_file(self._url) if is_kept else None)
        self._delete_again(TRANSACTION_WAIT)

    def load(self, code: str, table: sa.Table = labs) -> dict[str, Any] | None:
        """A state; None if there is none.

        Raises:
            NotKept: the database cannot be used, or the state cannot be read; the caller must then
                not save under this code.
        """
        with self.transaction() as connection:
            row = connection.execute(_STATEMENTS[table].read, {"of": code}).first()
        return None if row is None else _state(row)

    def claim(self, code: str, table: sa.Table = labs) -> dict[str, Any] | None:
        """Take over a state and its lease, which counts as using it; see `load`.

        Raises:
            HeldElsewhere: another process has it open.
        """
        values = {"of": code, "own": self.owner, "updated": self._clock()}
        try:
            with self.transaction() as connection:
                row = connection.execute(_STATEMENTS[table].lock, {"of": code}).first()
                if row is None:
                    return None
                state = _state(row)
                take(connection, code, self.owner, self._now(connection))
                connection.execute(_STATEMENTS[table].claim, values)
                return state
        except exc.IntegrityError:
            raise HeldElsewhere from None

    def renew(self, codes: Iterable[str], watched: Iterable[str] = ()) -> Renewal:
        """Renew the leases of what this process has open; see `app.storage.leases.renew`.

        Raises:
            NotKept: the database cannot be used.
        """
        with self.transaction() as connection:
            renewal = renew(connection, codes, watched, self.owner, self._now(connection))
        for code in renewal.missing:
            with suppress(exc.IntegrityError), self.transaction() as connection:
                take(connection, code, self.owner, self._now(connection))
        return renewal

    def give_up(self, code: str | None = None) -> None:
        """Give up the lease of a state, or all leases of this process.

        Raises:
            NotKept: the database cannot be used; the leases end by themselves.
        """
        with self.transaction() as connection:
            give_up(connection, self.owner, code)

    def is_current(self, code: str, table: sa.Table = labs) -> bool:
        """Whether no other process has claimed or saved a state since this one did.

        Raises:
            NotKept: the database cannot be used.
        """
        with self.transaction() as connection:
            row = connection.execute(_STATEMENTS[table].read, {"of": code}).first()
        return row is None or row.owner == self.owner

    def save(
        self,
        code: str,
        state: dict[str, Any],
        table: sa.Table = labs,
        gone: Iterable[str] = (),
    ) -> None:
        """Replace a state that belongs to this process, or save one under a new code.

        Args:
            gone: names of what has been deleted from the state; see `Deletions`.

        Raises:
            NotStorable: the state is too large or not JSON; the previous one remains.
            ValueError: the code is invalid.
            NotKept: the database cannot be used (disk full, server away); the previous state
                remains.
            HeldElsewhere: the state belongs to another process.
        """
        statements, text = _STATEMENTS[table], _text(code, state)
        values = {"of": code, "own": self.owner, "updated": self._clock(), "state": text}
        try:
            with self.transaction() as connection:
                if not connection.execute(statements.change, values).rowcount:
                    connection.execute(statements.insert, values)
                self._note(gone)
        except exc.IntegrityError:  # the row exists: another process's, or of a newer version
            with self.transaction() as connection:
                row = connection.execute(statements.read, {"of": code}).first()
            if row is not None and row.version > VERSION:
                raise NotKept("error.lab_newer") from None
            raise HeldElsewhere from None

    def touch(self, codes: Iterable[str]) -> None:
        """Count labs of this process as used now.

        Raises:
            NotKept: the database cannot be used.
        """
        ours = labs.c.code.in_(list(codes)) & (labs.c.owner == self.owner)
        with self.transaction() as connection:
            connection.execute(sa.update(labs).where(ours).values(updated=self._clock()))

    def delete(self, code: str) -> int:
        """Delete a lab. Returns the number of labs deleted, 1 or 0.

        Raises:
            NotKept: it could not be deleted.
            HeldElsewhere: another process has it open.
        """
        try:
            with self.transaction() as connection:
                take(connection, code, self.owner, self._now(connection))
                count = connection.execute(sa.delete(labs).where(labs.c.code == code)).rowcount
                give_up(connection, self.owner, code)
                self._note([code])
                return count
        except exc.IntegrityError:
            raise HeldElsewhere from None

    def delete_all(self) -> int:
        """Delete all labs and classes. Returns the number of labs.

        Raises:
            NotKept: they could not be deleted.
        """
        with self.transaction() as connection:
            for table in (classes, labs):
                self._note(connection.scalars(sa.select(table.c.code)))
                count = connection.execute(sa.delete(table)).rowcount
            connection.execute(sa.delete(leases))
            return count

    def end_classes(self, ended: Mapping[str, float]) -> None:
        """Delete classes whose time is over, unless they have been changed meanwhile.

        Args:
            ended: codes of the classes, and when each was changed last.

        Raises:
            NotKept: they could not be deleted.
        """
        with self.transaction() as connection:
            for code, updated in ended.items():
                same = (classes.c.code == code) & (classes.c.updated == updated)
                if connection.execute(sa.delete(classes).where(same)).rowcount:
                    self._note([code])

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
        self._delete_again(_left(until))
        self.generation += 1
        log.warning("%s was deleted or replaced: labs in use are saved to it again", self._file)

    @contextmanager
    def transaction(self) -> Iterator[sa.Connection]:
        """A transaction; serialised with all others in SQLite.

        It waits for others, in this process or another, for at most `TRANSACTION_WAIT`.

        Raises:
            NotKept: the database cannot be used; nothing was changed.
            sqlalchemy.exc.IntegrityError: another process inserted the row first; nothing was
                changed.
        """
        until = time.monotonic() + TRANSACTION_WAIT
        with held(self._lock, TRANSACTION_WAIT):
            try:
                self._reopen_if_replaced(until)
                connection = self._engine.connect().execution_options(patience=_left(until))
                with connection, connection.begin():
                    yield connection
            except exc.IntegrityError:
                raise
            except (exc.SQLAlchemyError, UnicodeDecodeError) as error:
                raise NotKept("error.database", reason=words(error)) from error

    def _note(self, names: Iterable[str]) -> None:
        """Note deletions, within their transaction.

        Raises:
            NotKept: they cannot be noted.
        """
        try:
            self._deletions.note(names, self._clock())
        except OSError as error:
            raise NotKept("error.database", reason=error.strerror or str(error)) from error

    def _delete_again(self, patience: float) -> None:
        """Delete what had been deleted before a backup was restored."""
        try:
            connection = self._engine.connect().execution_options(patience=patience)
            with connection, connection.begin():
                count = self._deletions.apply(connection)
        except (exc.SQLAlchemyError, UnicodeDecodeError) as error:
            raise NotKept("error.database", reason=words(error)) from error
        if count:
            log.warning("%d labs, classes and seats of an old backup are deleted again", count)

    def _now(self, connection: sa.Connection) -> float:
        """The time that leases refer to, the same for all processes, [s]."""
        if connection.dialect.name == "postgresql":
            return connection.execute(_SERVER_TIME).scalar_one()
        return self._clock()

    @property
    def _is_sqlite(self) -> bool:
        return self._url.get_backend_name() == "sqlite"

    def _opened(self) -> sa.Engine:
        if not self._is_sqlite:
            return opened_server(self._url)
        try:
            engine, self._identity = opened_file(self._url, self._clock)
            return engine
        except OSError as error:
            reason = error.strerror or error
            if self._needed:
                place = str(self._url.database)
                raise NotKept("error.database_at", place=place, reason=str(reason)) from error
            self.warning = f"Nothing outlives the server: {self._url.database}: {reason}."
            log.warning("%s", self.warning)
        return opened_memory()


def _state(row: sa.Row[Any]) -> dict[str, Any]:
    if row.version > VERSION:
        raise NotKept("error.lab_newer")
    try:
        return msgspec.json.decode(row.state, type=dict[str, Any])
    except (ValueError, RecursionError):
        raise NotKept("error.lab_unreadable") from None


def _text(code: str, state: dict[str, Any]) -> str:
    if not 0 < len(code) <= LONGEST_CODE:
        raise ValueError(f"a lab code has up to {LONGEST_CODE} characters, not {len(code)}")
    try:
        text = msgspec.json.encode(state).decode()
    except (TypeError, ValueError, RecursionError) as error:
        raise NotStorable("error.not_storable", reason=str(error)) from error
    if len(text) > LARGEST:
        size, most = f"{len(text) / 1e6:.1f}", f"{LARGEST / 1e6:g}"
        raise NotStorable("error.too_much_to_store", size=size, most=most)
    return text


def _left(until: float) -> float:
    """Time left until a deadline of `time.monotonic`, [s]."""
    return max(until - time.monotonic(), 0.0)
