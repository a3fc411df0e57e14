"""The tables of 0.1, made where they are missing: databases from before Alembic have them.

Columns are written out: this is what the tables were then, whatever they become.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None

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


def upgrade() -> None:
    """Create what is missing."""
    there = set(sa.inspect(op.get_bind()).get_table_names())
    for name, columns in TABLES.items():
        if name not in there:
            op.create_table(
                name,
                *(sa.Column(c, kind, primary_key=key, nullable=False) for c, kind, key in columns),
            )
