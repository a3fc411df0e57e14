"""Labs that nobody uses are deleted in the end, and those that somebody uses never."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from onpath.app.storage.expiry import DAY, Expiry, Retention
from onpath.app.storage.leases import Leases
from onpath.app.storage.records import Records, file_url


class World:
    """A database under a clock."""

    def __init__(self, file: Path) -> None:
        self.now = 1.8e9
        self.records = Records(file_url(file), clock=lambda: self.now)
        self.leases = Leases(self.records, clock=lambda: self.now)

    def save(self, *codes: str) -> None:
        """Store labs one after the other."""
        for code in codes:
            self.records.save(code, {})
            self.now += 1.0

    def expiry(self, days: int = 365, most: int = 1000) -> Expiry:
        return Expiry(self.records, Retention(days, most), lambda: self.now)

    def there(self) -> str:
        return "".join(code for code in "abcdef" if self.records.load(code) is not None)


@pytest.fixture
def world(tmp_path: Path) -> Iterator[World]:
    made = World(tmp_path / "labs.db")
    yield made
    made.records.close()


def test_a_lab_is_deleted_a_year_after_its_last_use(world: World) -> None:
    world.save("a", "b", "c", "d")
    world.now += 200 * DAY
    world.save("b")  # changed
    world.leases.claim("c")  # opened
    world.leases.release("c")
    assert world.expiry().delete() == 0
    world.now += 165 * DAY
    world.leases.claim("d")  # opened, and open
    assert world.expiry().delete() == 1 and world.there() == "bcd"
    world.now += 300 * DAY
    world.leases.renew(["d"])
    assert world.expiry().delete() == 2 and world.there() == "d"


def test_beyond_the_limit_the_least_recently_used_labs_are_deleted_but_none_in_use(
    world: World,
) -> None:
    world.save(*"abcdef")
    world.leases.renew(["a"])  # has been open for long
    world.save("b")
    assert world.expiry(most=3).delete() == 2 and world.there() == "abef"
    assert world.expiry(most=3).delete() == 0


def test_it_is_done_at_the_start_and_a_database_that_is_away_does_not_matter(world: World) -> None:
    world.save(*"abc")
    expiry = world.expiry(most=1)
    expiry.start()
    expiry.stop()
    assert world.there() == "c"
    with world.records.transaction() as connection:
        connection.exec_driver_sql("DROP TABLE leases")
    again = world.expiry(most=1)
    again.start()
    again.stop()


@pytest.mark.parametrize(("days", "most"), [(0, 1), (1, 0), (-1, 1)])
def test_a_retention_is_positive(days: int, most: int) -> None:
    with pytest.raises(ValueError, match="expected 1 or more"):
        Retention(days, most)
