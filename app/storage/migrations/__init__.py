"""Migrations of the database's tables: one revision per change, applied by Alembic on opening."""

from __future__ import annotations

import logging
import threading
from pathlib import Path

import sqlalchemy as sa

HEAD = "0003"
"""The revision of `app.storage.schema`; a test checks that it is the newest file in versions/."""
REVISIONS = sa.Table(
    "alembic_version", sa.MetaData(), sa.Column("version_num", sa.String(32), primary_key=True)
)
logging.getLogger("alembic").setLevel(logging.WARNING)  # it logs each of its plugins
_alone = threading.Lock()  # Alembic stores the current migration in a global


def revision_of(connection: sa.Connection) -> str | None:
    """The revision of a database; None before the first one."""
    if not sa.inspect(connection).has_table(REVISIONS.name):
        return None
    return connection.execute(sa.select(REVISIONS.c.version_num)).scalar()


def known_revisions() -> set[str]:
    """The revisions from which this version of the program can upgrade."""
    from alembic.script import ScriptDirectory

    return {script.revision for script in ScriptDirectory(_folder()).walk_revisions()}


def upgrade(connection: sa.Connection) -> None:
    """Bring a database to HEAD, within the transaction of its connection."""
    from alembic.command import upgrade
    from alembic.config import Config

    config = Config()
    config.set_main_option("script_location", _folder().replace("%", "%%"))
    config.attributes["connection"] = connection
    with _alone:
        upgrade(config, "head")


def _folder() -> str:
    return str(Path(__file__).parent)
