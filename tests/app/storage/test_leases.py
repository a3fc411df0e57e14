"""Nobody takes a lab or class from a process that renews its lease; one that is gone loses it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, suppress
from functools import cache
from math import inf
from pathlib import Path

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule

from onpath.app.storage.lease_keeper import LeaseKeeper
from onpath.app.storage.leases import LEASE, RENEWAL
from onpath.app.storage.records import HeldElsewhere, NotKept, Records, file_url
from onpath.app.storage.schema import classes, labs
from tests.support.site import needs_postgres, postgres
from tests.support.waiting import wait_for

CLASS, LAB = "f" * 40, "a" * 12
GIVEN_UP = -inf


def opened(records: Records) -> dict[str, int]:
    """What is stored of the class, which is its process's from the beginning."""
    if (state := records.claim(CLASS, classes)) is None:
        records.save(CLASS, {"n": 0}, classes)
        state = records.claim(CLASS, classes)
    assert state is not None
    return state


class Owner:
    """A process that has a class open or not, and counts on from what it read last."""

    def __init__(self, records: Records, name: str) -> None:
        self._records, self.name = records, name
        self.is_open, self.known, self.stalled = False, 0, False
        self.renewed = GIVEN_UP  # when it last made sure of its lease; GIVEN_UP: it has no lease
        self.keeper = LeaseKeeper(records, self._held, [CLASS], lambda _: self._lose())

    def _held(self) -> list[str]:
        return [CLASS] if self.is_open else []

    def _lose(self) -> None:
        self.is_open = False

    def claim(self) -> bool:
        self._records.owner = self.name
        try:
            self.known = opened(self._records)["n"]
        except HeldElsewhere:
            return False
        self.is_open = True
        return True

    def renew(self) -> bool:
        """Renew, and say whether the class is still here."""
        self._records.owner = self.name
        self.keeper.check()
        return self.is_open

    def give_up(self) -> None:
        self._records.owner = self.name
        self._records.give_up()
        self.is_open, self.renewed = False, GIVEN_UP

    def save(self) -> bool:
        self._records.owner = self.name
        try:
            self._records.save(CLASS, {"n": self.known + 1}, classes)
        except HeldElsewhere:
            return False
        self.known += 1
        return True


who = st.integers(0, 1)


@cache
def opened_once() -> Records:
    return Records("sqlite://")


def memory() -> Records:
    """An empty database."""
    records = opened_once()
    records.delete_all()
    return records


class TwoOwners(RuleBasedStateMachine):
    """Two processes that want one class. Time passes in rounds of renewal.

    There are never two who may write, nothing is written from an outdated copy, nobody takes the
    class from who has renewed within the last `LEASE` seconds, and there is an owner in the end.
    """

    def __init__(self) -> None:
        super().__init__()
        self.now, self.stored = 1e9, 0
        self.records = memory()
        self.records._clock = lambda: self.now
        self.owners = [Owner(self.records, "one"), Owner(self.records, "two")]

    @rule(seconds=st.floats(0.0, 2 * LEASE))
    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds / RENEWAL)):
            self.now += RENEWAL
            for each in self.owners:
                if not each.stalled and each.renew():
                    each.renewed = self.now

    @rule(who=who)
    def claim(self, who: int) -> None:
        owner, other = self.owners[who], self.owners[1 - who]
        if owner.stalled:
            return
        safe = self.now - other.renewed < LEASE
        assert owner.claim() != safe
        if not safe:
            owner.renewed, other.renewed = self.now, GIVEN_UP

    @rule(who=who)
    def save(self, who: int) -> None:
        owner = self.owners[who]
        if owner.is_open and owner.save():
            assert owner.known == self.stored + 1
            self.stored = owner.known

    @rule(who=who, stalled=st.booleans())
    def stall(self, who: int, stalled: bool) -> None:
        """The process is suspended, or goes on where it was."""
        self.owners[who].stalled = stalled

    @rule(who=who)
    def give_up(self, who: int) -> None:
        if not self.owners[who].stalled:
            self.owners[who].give_up()

    @rule(who=who)
    def kill(self, who: int) -> None:
        """The process is killed; another one starts while its lease lasts."""
        killed, new = self.owners[who], Owner(self.records, f"{self.owners[who].name}'")
        self.owners[who] = new
        lasts = killed.renewed + LEASE - self.now
        if lasts > 0:
            assert not self.owners[1 - who].claim() and not new.claim()
            self.wait(lasts + RENEWAL)

    @rule()
    def put_the_clock_back(self) -> None:
        self.now -= 86_400.0
        for each in self.owners:
            each.renewed = GIVEN_UP

    def teardown(self) -> None:
        for each in self.owners:
            each.stalled = False
        self.wait(2 * LEASE)
        if not any(each.is_open for each in self.owners):
            assert self.owners[0].claim()
        assert sum(each.is_open for each in self.owners) == 1
        assert [each.save() for each in self.owners if each.is_open] == [True]
        assert [each.save() for each in self.owners if not each.is_open] == [False]


TestTwoOwners = pytest.mark.thorough(TwoOwners.TestCase)
TestTwoOwners.settings = settings(max_examples=50, stateful_step_count=25, deadline=None)


@pytest.fixture(params=["sqlite", pytest.param("postgres", marks=needs_postgres)])
def two(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[list[Records]]:
    with ExitStack() as stack:
        url = file_url(tmp_path / "labs.db")
        found = stack.enter_context(postgres()) if request.param == "postgres" else url
        made = [Records(found) for _ in range(2)]
        yield made
        for each in made:
            each.close()


def test_what_is_open_in_one_process_is_not_taken_by_another(two: list[Records]) -> None:
    one, other = two
    assert opened(one) == {"n": 0}
    one.save(LAB, {"n": 1})
    assert one.renew([LAB, CLASS]).lost == frozenset()
    for code, table in ((CLASS, classes), (LAB, labs)):
        one.renew([LAB, CLASS])
        with pytest.raises(HeldElsewhere):
            other.claim(code, table)
    one.renew([LAB, CLASS])
    seen = other.renew([], [CLASS, LAB]).elsewhere
    assert seen.keys() == {CLASS, LAB} and all(0 < left <= LEASE for left in seen.values())
    one.renew([LAB, CLASS])
    with pytest.raises(HeldElsewhere):
        other.delete(LAB)
    one.give_up(LAB)
    assert other.claim(LAB) == {"n": 1}
    found = one.renew([LAB, CLASS])
    assert found.lost == {LAB} and found.missing == frozenset()
    one.give_up()
    assert opened(other) == {"n": 0}
    assert other.delete(LAB) == 1 and other.delete(LAB) == 0 and other.load(LAB) is None


@pytest.mark.thorough
def test_a_lease_ends_when_its_owner_is_gone(two: list[Records]) -> None:
    """The fixture's databases reckon by their own clocks, so this waits for the lease's end."""
    one, other = two
    opened(one)
    keeper = LeaseKeeper(other, list, [CLASS], lambda _: None)

    def seen() -> bool:
        one.renew([CLASS])
        keeper.check()
        return keeper.is_elsewhere(CLASS)

    wait_for(seen, 60.0)
    assert not keeper.is_elsewhere(LAB)
    wait_for(lambda: not keeper.is_elsewhere(CLASS), 60.0)

    def taken() -> bool:
        with suppress(HeldElsewhere):  # it is known to end by a clock of its own
            return opened(other) == {"n": 0}
        return False

    wait_for(taken, 60.0)


def test_a_database_that_is_away_moves_nothing(
    two: list[Records], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, lost = two[0], list[str]()
    opened(one)
    keeper = LeaseKeeper(one, lambda: [CLASS], [CLASS], lost.append)

    def refuse(*_: object) -> None:
        raise NotKept("error.database_busy")

    with monkeypatch.context() as away:
        for name in ("renew", "give_up"):
            away.setattr(one, name, refuse)
        keeper.check()
        keeper.stop()
    keeper.check()
    assert not lost
