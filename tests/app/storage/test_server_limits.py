"""A PostgreSQL server keeps nobody waiting for long, and nothing is lost meanwhile."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from functools import partial

import pytest
import sqlalchemy as sa

from onpath.app.storage import engine, server_limits
from onpath.app.storage import records as database
from onpath.app.storage.engine import opened_server, parsed
from onpath.app.storage.records import NotKept, Records
from onpath.app.storage.schema import labs
from onpath.app.storage.server_limits import CONNECT_WAIT, connection_limits
from tests.support import waiting
from tests.support.site import needs_postgres, postgres

BRIEF = 0.01  # [s], for what waits in vain in these tests
CODE = "a" * 12
until = partial(waiting.wait_for, seconds=60.0)


@pytest.fixture(scope="module")
def url() -> Iterator[str]:
    with postgres() as found:
        Records(found).close()  # creates the tables
        yield found


@pytest.fixture
def records(url: str) -> Iterator[Records]:
    made = Records(url)
    made.delete_all()
    yield made
    made.close()


@contextmanager
def another(url: str) -> Iterator[sa.Connection]:
    """A transaction of another process, without limits; it is rolled back."""
    other = sa.create_engine(url)
    with other.connect() as connection:
        yield connection
    other.dispose()


def refusal(act: Callable[[], object]) -> str:
    """Why the database refuses something; "" if it does not, or if that takes for ever."""
    said: list[str] = []

    def try_it() -> None:
        try:
            act()
        except NotKept as error:
            said.append(str(error))

    thread = threading.Thread(target=try_it, daemon=True)
    thread.start()
    thread.join(20.0)
    return "".join(said)


@pytest.mark.thorough
@needs_postgres
def test_a_row_that_another_process_holds_is_not_waited_for_long(
    url: str, records: Records, monkeypatch: pytest.MonkeyPatch
) -> None:
    records.save(CODE, {"n": 1})
    monkeypatch.setattr(database, "TRANSACTION_WAIT", BRIEF)
    with another(url) as other:
        other.execute(sa.select(labs).where(labs.c.code == CODE).with_for_update())
        assert "lock timeout" in refusal(lambda: records.save(CODE, {"n": 2}))
        assert records.load(CODE) == {"n": 1}
    monkeypatch.undo()
    records.save(CODE, {"n": 3})
    assert records.load(CODE) == {"n": 3}


@needs_postgres
def test_the_server_ends_a_process_that_is_suspended_within_a_transaction(
    url: str, records: Records, monkeypatch: pytest.MonkeyPatch
) -> None:
    records.save(CODE, {"n": 1})
    monkeypatch.setattr(server_limits, "IDLE_WAIT", 0.1)
    held = sa.select(labs).where(labs.c.code == CODE).with_for_update()
    with closing(Records(url)) as suspended:
        with pytest.raises(NotKept), suspended.transaction() as connection:
            connection.execute(held)
            until(lambda: not refusal(lambda: records.save(CODE, {"n": 2})))
            connection.execute(held)
        assert records.load(CODE) == {"n": 2}
        assert suspended.claim(CODE) == {"n": 2}  # with another connection


@needs_postgres
def test_a_statement_that_takes_too_long_is_ended_but_not_while_the_tables_are_migrated(
    url: str, records: Records, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(server_limits, "STATEMENT_WAIT", 0.1)
    long = sa.select(sa.func.pg_sleep(0.5))
    with pytest.raises(NotKept, match="statement timeout"), records.transaction() as connection:
        connection.execute(long)
    migrated: list[sa.Connection] = []
    monkeypatch.setattr(engine, "_migrate", lambda c: (c.execute(long), migrated.append(c)))
    Records(url).close()
    assert len(migrated) == 1


@needs_postgres
def test_a_server_whose_tables_another_process_locks_is_not_waited_for_when_it_is_opened(
    url: str, records: Records, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(engine._prepared, "__defaults__", (BRIEF,))
    with another(url) as other:
        other.execute(sa.text("LOCK TABLE meta"))
        assert "lock timeout" in refusal(lambda: opened_server(parsed(url)).dispose())
    opened_server(parsed(url)).dispose()


@needs_postgres
def test_the_url_s_own_options_hold(url: str) -> None:
    own = f"{url}?connect_timeout=7&options=-csearch_path%3Dpublic,pg_temp"
    with closing(Records(own)) as records, records.transaction() as connection:
        assert connection.execute(sa.text("SHOW search_path")).scalar() == "public,pg_temp"


def test_only_what_the_url_does_not_say_is_added_and_only_for_a_driver_that_knows_it() -> None:
    plain = parsed("postgresql+psycopg://user@host/name")
    assert connection_limits(plain)["connect_timeout"] == CONNECT_WAIT
    own = plain.update_query_dict({"connect_timeout": "7"})
    assert set(connection_limits(plain)) - set(connection_limits(own)) == {"connect_timeout"}
    assert not connection_limits(plain.set(drivername="postgresql+pg8000"))
