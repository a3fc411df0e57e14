"""Labs have the process that opened them last; a class is one row, like a lab.

The tables with which several processes served one class are dropped: classes that were open end,
labs stay.
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Add the owner of labs, drop the tables of classes, and create the new one."""
    for name in ("leases", "watches", "passes", "members", "classes"):
        op.drop_table(name)
    op.add_column("labs", sa.Column("owner", sa.String(40), nullable=False, server_default=""))
    op.create_table(
        "classes",
        sa.Column("code", sa.String(64), primary_key=True, nullable=False),
        sa.Column("owner", sa.String(40), nullable=False),
        sa.Column("version", sa.Integer, nullable=False),
        sa.Column("updated", sa.Double, nullable=False),
        sa.Column("state", sa.Text, nullable=False),
    )
