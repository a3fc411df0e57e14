"""Leases: which process has a lab or a class open now. A lease that is renewed cannot be taken.

A process renews the leases of what it has open every `RENEWAL` seconds. While a lease lasts, no
other process can claim the state (`Records.claim`). It ends when the process gives it up, as it
does at an orderly stop, or `LEASE` seconds after the process has been killed or suspended.

A lease does not decide who may write. The owner named in the state's own row may, and only a claim
replaces it, in the same transaction that takes the lease. So there are never two who may write,
whatever the clocks say. An owner whose lease has lapsed, because it was suspended or the database
was unavailable, renews it if no other process has claimed the state meanwhile. If one has, the
former owner's writes are refused; it drops its copy and disconnects its members, who reconnect to
the new owner.

Times are the database server's, or those of the one machine that has the file. If that clock is set
back, a lease that seems to last longer than is possible counts as ended.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import sqlalchemy as sa

from onpath.app.storage.schema import classes, labs, leases

LEASE = 1.0  # [s] for which a lease holds after its last renewal
RENEWAL = 0.25  # [s] between renewals
CLOCK_BACK = 60.0  # [s] beyond the possible end from which a lease shows a clock set back

_mine = leases.c.owner == sa.bindparam("own")
_now = sa.bindparam("now", type_=sa.Double)
_lasts = leases.c.until.between(_now, _now + (LEASE + CLOCK_BACK))
_this = leases.c.code == sa.bindparam("of")
_these = sa.bindparam("codes", expanding=True)
_until = {"until": _now + LEASE}
_TAKE = sa.update(leases).where(_this, _mine | ~_lasts).values(owner=sa.bindparam("own"), **_until)
_ADD = sa.insert(leases).values(code=sa.bindparam("of"), owner=sa.bindparam("own"), **_until)
_RENEW = sa.update(leases).where(_mine, leases.c.code.in_(_these)).values(_until)
_RENEWED = sa.select(leases.c.code).where(_mine, leases.c.code.in_(_these))
_LOST = sa.union_all(
    *(
        sa.select(table.c.code).where(
            table.c.code.in_(_these), table.c.owner != sa.bindparam("own")
        )
        for table in (labs, classes)
    )
)
_ELSEWHERE = sa.select(leases.c.code, leases.c.until - _now).where(
    leases.c.code.in_(_these), ~_mine, _lasts
)
_GIVE_UP = sa.delete(leases).where(_mine, _this)
_GIVE_UP_ALL = sa.delete(leases).where(_mine)


@dataclass(frozen=True, slots=True)
class Renewal:
    """What a process learns when it renews its leases.

    Attributes:
        lost: codes of its labs and classes that other processes have claimed.
        missing: codes of its labs and classes for which it has no lease.
        elsewhere: how long the leases of other processes still last, by code, [s].
    """

    lost: frozenset[str]
    missing: frozenset[str]
    elsewhere: dict[str, float]


def take(connection: sa.Connection, code: str, owner: str, now: float) -> None:
    """Take a lease that is free, has ended, or is the owner's already.

    Raises:
        sqlalchemy.exc.IntegrityError: another process holds it; the transaction cannot go on.
    """
    values = {"of": code, "own": owner, "now": now}
    if not connection.execute(_TAKE, values).rowcount:
        connection.execute(_ADD, values)


def renew(
    connection: sa.Connection, codes: Iterable[str], watched: Iterable[str], owner: str, now: float
) -> Renewal:
    """Renew leases; see `Renewal`.

    Args:
        codes: what the owner has open.
        watched: codes of which it wants to know whether other processes have them open.
    """
    values = {"own": owner, "now": now}
    held = set(codes)
    lost = set(connection.scalars(_LOST, {**values, "codes": sorted(held)}))
    kept = {**values, "codes": sorted(held - lost)}
    connection.execute(_RENEW, kept)
    renewed = set(connection.scalars(_RENEWED, kept))
    rows = connection.execute(_ELSEWHERE, {**values, "codes": sorted(watched)})
    elsewhere = {code: left for code, left in rows}
    return Renewal(frozenset(lost), frozenset(held - lost - renewed), elsewhere)


def give_up(connection: sa.Connection, owner: str, code: str | None = None) -> None:
    """Give up the owner's lease of a code, or all of the owner's leases."""
    if code is None:
        connection.execute(_GIVE_UP_ALL, {"own": owner})
    else:
        connection.execute(_GIVE_UP, {"own": owner, "of": code})
