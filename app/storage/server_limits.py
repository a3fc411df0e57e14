"""Limits on waiting for a PostgreSQL server, and for other processes that use it.

Without them, a process suspended within a transaction would keep its rows locked, and others would
wait as long. The server enforces most limits, so they do not hold while it is frozen itself.
"""

from __future__ import annotations

from typing import Any

import sqlalchemy as sa

CONNECT_WAIT = 5  # [s] for a new connection, a whole number
STATEMENT_WAIT = 30.0  # [s] for a statement; to delete 100,000 labs takes a few
IDLE_WAIT = 10.0  # [s] between statements of a transaction; then the server ends the connection
PROBE_INTERVAL = 5  # [s] between probes of a silent connection, a whole number
GONE = 15  # [s] without a sign of the server's host after which a connection is given up

_SET = sa.select(
    sa.func.set_config("lock_timeout", sa.bindparam("lock", type_=sa.String), True),
    sa.func.set_config("statement_timeout", sa.bindparam("statement", type_=sa.String), True),
    sa.func.set_config(
        "idle_in_transaction_session_timeout", sa.bindparam("idle", type_=sa.String), True
    ),
)


def connection_limits(url: sa.URL) -> dict[str, Any]:
    """The driver's options for connections; options that the URL sets itself are left out."""
    if url.drivername != "postgresql+psycopg":  # other drivers may not know these names
        return {}
    limits = {
        "connect_timeout": CONNECT_WAIT,
        "keepalives_idle": PROBE_INTERVAL,
        "keepalives_interval": PROBE_INTERVAL,
        "keepalives_count": GONE // PROBE_INTERVAL,
        "tcp_user_timeout": 1000 * GONE,
    }
    return {name: value for name, value in limits.items() if name not in url.query}


def limit_transaction(connection: sa.Connection) -> None:
    """Limit the waits of the transaction that begins; for SQLAlchemy's event.

    They are set for each transaction, not in the connection's options: those would replace the
    URL's, and poolers in front of a server refuse them.
    """
    patience = connection.get_execution_options()["patience"]
    limits = {"lock": patience, "statement": STATEMENT_WAIT, "idle": IDLE_WAIT}
    connection.execute(_SET, {name: _milliseconds(wait) for name, wait in limits.items()})


def lift_statement_limit(connection: sa.Connection) -> None:
    """Let the statements of a transaction take as long as they need."""
    connection.exec_driver_sql("SET LOCAL statement_timeout = 0")


def _milliseconds(wait: float) -> str:
    return str(max(round(1000 * wait), 1))  # 0 would be no limit
