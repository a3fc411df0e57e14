"""The tables of the database. A change here needs a revision in `migrations/versions`.

meta: engine.py. labs, classes: records.py. leases: leases.py.
"""

from __future__ import annotations

import sqlalchemy as sa

LONGEST_CODE = 64  # [characters] of an access code

metadata = sa.MetaData()
meta = sa.Table(
    "meta",
    metadata,
    sa.Column("name", sa.String(40), primary_key=True),
    sa.Column("number", sa.Integer, nullable=False),
)


def _states(name: str) -> sa.Table:
    """A table of states by code.

    Columns:
        owner: the process that opened the state last; only it may write, see leases.py.
        version: of the program's format.
        updated: when the state was last used, seconds since 1970.
    """
    return sa.Table(
        name,
        metadata,
        sa.Column("code", sa.String(LONGEST_CODE), primary_key=True),
        sa.Column("owner", sa.String(40), nullable=False),
        sa.Column("version", sa.Integer, nullable=False),
        sa.Column("updated", sa.Double, nullable=False),
        sa.Column("state", sa.Text, nullable=False),
    )


labs = _states("labs")
classes = _states("classes")
leases = sa.Table(
    "leases",
    metadata,
    sa.Column("code", sa.String(LONGEST_CODE), primary_key=True),
    sa.Column("owner", sa.String(40), nullable=False),
    sa.Column("until", sa.Double, nullable=False),
)
