"""Labs that nobody uses are deleted in the end, and those that somebody uses never."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from onpath.app.storage.expiry import CLASS_DAYS, DAY, IN_USE, Expiry, Retention
from onpath.app.storage.records import Records, file_url
from onpath.app.storage.schema import classes


class World:
    """A database under a clock, and the labs that are open."""

    def __init__(self, file: Path) -> None:
        self.now, self.open = 1.8e9, list[str]()
        self.records = Records(file_url(file), clock=lambda: self.now)

    def save(self, *codes: str) -> None:
        """Store labs one after the other."""
        for code in codes:
            self.records.save(code, {})
            self.now += 1.0

    def expiry(self, days: int = 365, most: int = 1000) -> Expiry:
        return Expiry(self.records, Retention(days, most), lambda: self.open, lambda: self.now)

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
    world.records.claim("c")  # opened
    assert world.expiry().delete() == 0
    world.now += 165 * DAY
    world.open = ["d"]
    assert world.expiry().delete() == 1 and world.there() == "bcd"
    world.now += 300 * DAY
    assert world.expiry().delete() == 2 and world.there() == "d"


def test_beyond_the_limit_the_least_recently_used_labs_are_deleted_but_none_in_use(
    world: World,
) -> None:
    world.save(*"abcdef")
    world.save("b")
    world.open = ["a"]  # has been open for long
    assert world.expiry(most=3).delete() == 0  # any may be open in another process
    world.now += IN_USE
    assert world.expiry(most=3).delete() == 3 and world.there() == "abf"
    assert world.expiry(most=3).delete() == 0


def test_a_lab_that_another_process_has_open_is_not_deleted(world: World) -> None:
    world.save(*"ab")
    world.now += 2 * DAY
    other = Records(world.records._url, clock=lambda: world.now)
    assert other.claim("a") is not None
    world.now += IN_USE / 2
    other.touch(["a", "b"])  # b is not its own
    world.now += IN_USE / 2 + 1
    assert world.expiry(days=1, most=1).delete() == 1 and world.there() == "a"
    other.close()


def test_a_class_is_deleted_a_week_after_its_last_change(world: World) -> None:
    world.records.save("x", {}, classes)
    world.now += CLASS_DAYS * DAY - 1
    world.expiry().delete()
    assert world.records.load("x", classes) == {}
    world.now += 2
    world.expiry().delete()
    assert world.records.load("x", classes) is None


@pytest.mark.parametrize(
    ("state", "most", "kept"),
    [
        ({}, 30, 30),
        ({"days": 2}, 30, 2),
        ({"days": 60}, 30, 30),  # not longer than the server allows
        ({"days": 0}, 5, 5),
        ({"days": "x"}, 5, 5),
    ],
)
def test_a_class_is_kept_as_long_as_its_teacher_wants_and_the_server_allows(
    world: World, state: dict[str, Any], most: int, kept: int
) -> None:
    world.records.save("x", state, classes)
    world.records.save("y", {}, classes)
    retention = Retention(class_days=most)
    expiry = Expiry(world.records, retention, tuple, lambda: world.now)
    world.now += kept * DAY - 1
    expiry.delete()
    assert world.records.load("x", classes) == state
    world.now += 2
    expiry.delete()
    assert world.records.load("x", classes) is None
    assert (world.records.load("y", classes) is None) == (kept == most)


def test_it_is_done_at_the_start_and_a_database_that_is_away_does_not_matter(world: World) -> None:
    world.save(*"abc")
    world.now += IN_USE
    expiry = world.expiry(most=1)
    expiry.start()
    expiry.stop()
    assert world.there() == "c"
    with world.records.transaction() as connection:
        connection.exec_driver_sql("DROP TABLE classes")
    again = world.expiry(most=1)
    again.start()
    again.stop()


@pytest.mark.parametrize("numbers", [(0, 1, 1), (1, 0, 1), (-1, 1, 1), (1, 1, 0)])
def test_a_retention_is_positive(numbers: tuple[int, int, int]) -> None:
    with pytest.raises(ValueError, match="expected 1 or more"):
        Retention(*numbers)
