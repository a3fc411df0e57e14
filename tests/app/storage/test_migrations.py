"""A database of any earlier version opens with everything that was in it."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest
import sqlalchemy as sa
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory

from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.stored import from_data
from onpath.app.storage import migrations
from onpath.app.storage.migrations import HEAD
from onpath.app.storage.records import Records, file_url
from onpath.app.storage.schema import metadata
from tests.support.checkout import ROOT
from tests.support.lab import new_lab

BEFORE_MIGRATIONS = ROOT / "tests" / "data" / "database_0_1.sql"


@pytest.fixture
def old(tmp_path: Path) -> Path:
    """Written by 0.1: three labs, one with a clover and K1 = 900, and a class of two."""
    file = tmp_path / "onpath.db"
    with closing(sqlite3.connect(file)) as raw:
        raw.executescript(BEFORE_MIGRATIONS.read_text("utf-8"))
    return file


def rows(file: Path) -> dict[str, list[tuple[Any, ...]]]:
    """Everything, by table."""
    with closing(sqlite3.connect(file)) as raw:
        tables = raw.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
        return {name: sorted(raw.execute(f"SELECT * FROM {name}")) for (name,) in tables}


def test_no_lab_of_an_old_database_is_lost_and_nothing_of_its_classes_stays(old: Path) -> None:
    before = rows(old)
    assert len(before["members"]) == 2 and b"Bob <b>" in old.read_bytes()
    records = Records(file_url(old))
    assert records.warning == ""
    state, simulation = records.load("c0de01"), new_lab().simulation
    assert state is not None
    restore(simulation, from_data(state["setup"]))
    assert (simulation.parameters.K1, simulation.editor.design.name) == (900.0, "clover")
    assert simulation.parameters.K3 == 0.0  # as by default then
    assert records.claim("c0de01") == state and records.is_current("c0de01")
    records.close()
    after = rows(old)
    assert after.keys() == {"alembic_version", "meta", "labs", "classes", "leases"}
    assert after["alembic_version"] == [(HEAD,)] and after["meta"] == before["meta"]
    assert after["classes"] == [] and b"Bob <b>" not in old.read_bytes()
    with closing(sqlite3.connect(old)) as raw:
        labs = raw.execute("SELECT code, version, state FROM labs ORDER BY code").fetchall()
    assert labs == [(code, version, state) for code, version, _, state in before["labs"]]
    assert len(labs) == 3


def test_a_table_that_an_older_one_lacks_is_made(old: Path) -> None:
    with closing(sqlite3.connect(old)) as raw:
        raw.execute("DROP TABLE watches")
        raw.commit()
    records = Records(file_url(old))
    assert records.warning == "" and records.load("c0de02") is not None
    records.close()


def test_a_database_of_a_newer_version_is_left_alone(old: Path) -> None:
    Records(file_url(old)).close()
    with closing(sqlite3.connect(old)) as raw:
        raw.execute("UPDATE alembic_version SET version_num = '9999'")
        raw.commit()
    before = old.read_bytes()
    records = Records(file_url(old))
    assert "newer OnPath" in records.warning and str(old) in records.warning
    records.close()
    assert old.read_bytes() == before


def test_migrations_lead_to_the_tables_that_the_program_uses() -> None:
    scripts = ScriptDirectory(str(Path(migrations.__file__).parent))
    assert scripts.get_current_head() == HEAD and HEAD in migrations.known_revisions()
    engine = sa.create_engine("sqlite://")
    with engine.begin() as connection:
        migrations.upgrade(connection)
        assert migrations.revision_of(connection) == HEAD
        assert compare_metadata(MigrationContext.configure(connection), metadata) == []
    engine.dispose()
