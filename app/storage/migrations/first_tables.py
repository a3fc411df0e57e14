"""The tables of version 0.1, which did not use Alembic; they stay as they were then.

A table's columns are (name, type, whether it is part of the primary key); none may be null.
"""

from __future__ import annotations

import sqlalchemy as sa

CODE, TEXT, WHOLE, REAL = sa.String(64), sa.Text, sa.Integer, sa.Double
TABLES = {
    "meta": [("name", sa.String(40), True), ("number", WHOLE, False)],
    "labs": [("code", CODE, True), ("version", WHOLE, False), ("updated", REAL, False)]
    + [("state", TEXT, False)],
    "leases": [("code", CODE, True), ("owner", sa.String(40), False), ("expires", REAL, False)],
    "classes": [("id", sa.String(40), True), ("code", sa.String(8), False)]
    + [("touched", REAL, False)]
    + [(name, WHOLE, False) for name in ("changes", "joined", "frozen", "pushes")]
    + [("push", TEXT, False)],
    "members": [("class_id", sa.String(40), True), ("session", CODE, True)]
    + [("changed", WHOLE, False), ("number", WHOLE, False), ("name", sa.String(100), False)]
    + [("active", REAL, False), ("taken", WHOLE, False), ("progress", TEXT, False)],
    "passes": [("class_id", sa.String(40), True), ("hash", sa.String(64), True)],
    "watches": [("class_id", sa.String(40), True), ("session", CODE, True)]
    + [("until", REAL, False), ("moment", TEXT, False)],
}


def strange_table(connection: sa.Connection) -> str | None:
    """The name of a table with other columns, which belongs to another program; None if none."""
    inspector = sa.inspect(connection)
    for name in TABLES.keys() & set(inspector.get_table_names()):
        columns = {column["name"] for column in inspector.get_columns(name)}
        if columns != {column for column, _, _ in TABLES[name]}:
            return name
    return None
