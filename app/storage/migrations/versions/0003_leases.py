"""A process that has a lab or class open holds a lease of it, which it renews."""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    """Create the table of leases."""
    op.create_table(
        "leases",
        sa.Column("code", sa.String(64), primary_key=True, nullable=False),
        sa.Column("owner", sa.String(40), nullable=False),
        sa.Column("until", sa.Double, nullable=False),
    )
