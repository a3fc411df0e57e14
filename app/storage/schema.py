"""The tables of the database. A change here needs a revision in `migrations/versions`.

meta: engine.py. labs: records.py. leases: leases.py. watches: classroom/watches.py. classes,
members, passes: classroom/shared_classroom.py.
"""

from __future__ import annotations

import sqlalchemy as sa

LONGEST_CODE = 64  # [characters]

metadata = sa.MetaData()
meta = sa.Table(
    "meta",
    metadata,
    sa.Column("name", sa.String(40), primary_key=True),
    sa.Column("number", sa.Integer, nullable=False),
)
labs = sa.Table(
    "labs",
    metadata,
    sa.Column("code", sa.String(LONGEST_CODE), primary_key=True),
    sa.Column("version", sa.Integer, nullable=False),
    sa.Column("updated", sa.Double, nullable=False),
    sa.Column("state", sa.Text, nullable=False),
)
leases = sa.Table(
    "leases",
    metadata,
    sa.Column("code", sa.String(LONGEST_CODE), primary_key=True),
    sa.Column("owner", sa.String(40), nullable=False),
    sa.Column("expires", sa.Double, nullable=False),
)
classes = sa.Table(
    "classes",
    metadata,
    sa.Column("id", sa.String(40), primary_key=True),
    sa.Column("code", sa.String(8), nullable=False),
    sa.Column("touched", sa.Double, nullable=False),
    sa.Column("changes", sa.Integer, nullable=False),
    sa.Column("joined", sa.Integer, nullable=False),
    sa.Column("frozen", sa.Integer, nullable=False),
    sa.Column("pushes", sa.Integer, nullable=False),
    sa.Column("push", sa.Text, nullable=False),
)
members = sa.Table(
    "members",
    metadata,
    sa.Column("class_id", sa.String(40), primary_key=True),
    sa.Column("session", sa.String(LONGEST_CODE), primary_key=True),
    sa.Column("changed", sa.Integer, nullable=False),
    sa.Column("number", sa.Integer, nullable=False),
    sa.Column("name", sa.String(100), nullable=False),
    sa.Column("active", sa.Double, nullable=False),
    sa.Column("taken", sa.Integer, nullable=False),
    sa.Column("progress", sa.Text, nullable=False),
)
passes = sa.Table(
    "passes",
    metadata,
    sa.Column("class_id", sa.String(40), primary_key=True),
    sa.Column("hash", sa.String(64), primary_key=True),
)
watches = sa.Table(
    "watches",
    metadata,
    sa.Column("class_id", sa.String(40), primary_key=True),
    sa.Column("session", sa.String(LONGEST_CODE), primary_key=True),
    sa.Column("until", sa.Double, nullable=False),
    sa.Column("moment", sa.Text, nullable=False),
)
OF_A_CLASS = (members, passes, watches)
