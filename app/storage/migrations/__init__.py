"""How the database's tables came about: one revision a change, applied by Alembic at opening."""

from __future__ import annotations

import logging
import threading
from pathlib import Path

import sqlalchemy as sa

HEAD = "0001"
"""The revision of `app.storage.schema`; a test holds it to be the newest file in versions/."""
REVISIONS = sa.Table(
    "alembic_version", sa.MetaData(), sa.Column("version_num", sa.String(32), primary_key=True)
)
logging.getLogger("alembic").setLevel(logging.WARNING)  # it tells of each of its plugins
_alone = threading.Lock()  # Alembic keeps the migration under way in a global


def revision_of(connection: sa.Connection) -> str | None:
    """The revision that a database is at; None before the first."""
    if not sa.inspect(connection).has_table(REVISIONS.name):
        return None
    return connection.execute(sa.select(REVISIONS.c.version_num)).scalar()


def known_revisions() -> set[str]:
    """All that this version of the program can start from."""
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
