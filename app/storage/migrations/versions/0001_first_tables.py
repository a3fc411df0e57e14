"""Create the tables of version 0.1 where they are missing; older databases have them already.

What a teacher had sent is cleared, because it would now apply to all students who join later.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from onpath.app.storage.migrations.first_tables import TABLES

revision = "0001"
down_revision = None


def upgrade() -> None:
    """Create the missing tables."""
    there = set(sa.inspect(op.get_bind()).get_table_names())
    for name, columns in TABLES.items():
        if name not in there:
            op.create_table(
                name,
                *(sa.Column(c, kind, primary_key=key, nullable=False) for c, kind, key in columns),
            )
    if "classes" in there:
        op.execute("UPDATE classes SET push = ''")
