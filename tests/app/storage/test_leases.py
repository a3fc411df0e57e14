"""No two processes ever have the same lab, and a lab whose process is gone goes to another."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage.leases import FORGOTTEN, NONSENSE, RENEWAL, TERM, Leases
from onpath.app.storage.records import HeldElsewhere, Records, file_url
from onpath.app.storage.write_behind import WriteBehind
from tests.support.lab import do, run, store

CODES = ["a" * 12, "b" * 12, "c" * 12]


class Clock:
    """Time passes only when somebody sleeps, and then others may act."""

    def __init__(self) -> None:
        self.now = 1.8e9
        self.meanwhile: Callable[[], object] = lambda: None

    def sleep(self, seconds: float) -> None:
        self.now += seconds
        self.meanwhile()


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def records(tmp_path: Path) -> Iterator[Records]:
    made = Records(file_url(tmp_path / "labs.db"))
    yield made
    made.close()


@pytest.fixture
def owners(records: Records, clock: Clock) -> list[Leases]:
    return [Leases(records, name, lambda: clock.now, clock.sleep) for name in ("one", "two")]


def test_who_had_a_lab_last_knows_whether_anybody_had_it_meanwhile(owners: list[Leases]) -> None:
    one, two = owners
    code = CODES[0]
    assert one.claim(code) is True and two.claim(code) is None
    one.release(code)
    assert one.claim(code) is True  # a reload
    one.release(code)
    assert two.claim(code) is False and one.claim(code) is None
    two.release()
    assert one.claim(code) is False


def test_a_lease_lasts_as_long_as_it_is_renewed(owners: list[Leases], clock: Clock) -> None:
    one, two = owners
    for _ in range(10):
        assert one.renew(CODES[:1]) == [] and two.claim(CODES[0]) is None
        clock.now += RENEWAL
    clock.now += TERM
    assert two.claim(CODES[0]) is False
    assert one.renew(CODES[:1]) == CODES[:1]
    two.release()
    clock.now += FORGOTTEN + TERM
    one.renew([])
    assert one.claim(CODES[0]) is True  # nobody remembers


def test_who_was_asleep_does_not_write_over_what_came_after(
    owners: list[Leases], records: Records, clock: Clock
) -> None:
    one, two = owners
    one.claim(CODES[0])
    one.save(CODES[0], {"n": 1})
    clock.now += TERM + 1
    one.save(CODES[0], {"n": 2})  # late, but nobody has come
    two.claim(CODES[0])
    with pytest.raises(HeldElsewhere):
        one.save(CODES[0], {"n": 3})
    assert records.load(CODES[0]) == {"n": 2}


def test_a_lab_is_waited_for_until_its_owner_is_known_dead_or_alive(
    owners: list[Leases], clock: Clock
) -> None:
    one, two = owners
    one.renew(CODES[:2])
    begun = clock.now
    assert two.available(CODES) == CODES and TERM <= clock.now - begun < TERM + 1
    one.renew(CODES[:2])
    begun = clock.now
    clock.meanwhile = lambda: clock.now > begun + 1 and one.renew(CODES[:2])
    assert two.available(CODES) == CODES[2:] and clock.now - begun < 1.5
    clock.meanwhile = lambda: one.release(CODES[1])
    one.renew(CODES[1:2])
    begun = clock.now
    assert two.available(CODES[1:2]) == CODES[1:2] and clock.now - begun < 0.5
    assert one.available(CODES) == CODES


def test_a_clock_that_was_wrong_locks_nobody_out(owners: list[Leases], clock: Clock) -> None:
    one, two = owners
    clock.now += 1e6
    one.claim(CODES[0])
    clock.now -= 1e6
    assert two.available(CODES) == CODES and two.claim(CODES[0]) is False
    assert NONSENSE > 2 * TERM


@settings(max_examples=25, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["claim", "renew", "release", "sleep"]),
            st.integers(0, 1),
            st.sampled_from(CODES[:2]),
        ),
        max_size=30,
    )
)
def test_never_two_owners(steps: list[tuple[str, int, str]]) -> None:
    clock, records = Clock(), Records("sqlite://")
    owners = [Leases(records, name, lambda: clock.now, clock.sleep) for name in ("one", "two")]
    until: dict[tuple[str, int], float] = {}
    for what, who, code in steps:
        if what == "sleep":
            clock.now += TERM / 2
        elif what == "release":
            owners[who].release(code)
            until.pop((code, who), None)
        elif (
            owners[who].claim(code) is not None
            if what == "claim"
            else (owners[who].renew([code]) == [])
        ):
            until[code, who] = clock.now + TERM
        for code in CODES[:2]:
            assert sum(until.get((code, who), 0.0) > clock.now for who in (0, 1)) <= 1
    records.close()


class Worker:
    """Sessions of one process, without a network."""

    def __init__(self, records: Records, leases: Leases) -> None:
        self.keeper = WriteBehind(leases, interval=0.0)
        make = lambda: Lab(store())  # noqa: E731
        self.sessions = LabRegistry(
            SimulationThread(), make, load=records.load, keeper=self.keeper, leases=leases
        )


@pytest.fixture
def workers(records: Records, owners: list[Leases]) -> Iterator[list[Worker]]:
    made = [Worker(records, leases) for leases in owners]
    yield made
    for worker in made:
        worker.keeper.close()


def test_a_lab_goes_to_and_fro_between_processes_as_it_was_left(workers: list[Worker]) -> None:
    one, two = (worker.sessions for worker in workers)
    entry = one.join(1, None)
    code = entry.code
    for gain, (here, there) in enumerate([(one, two), (two, one), (one, two)], start=41):
        do(entry.scheduled.lab, c.SetParameter("K2", gain))
        run(entry.scheduled.lab, 1.1)
        here.leave(1)
        entry = there.join(1, code)
        assert (entry.code, entry.scheduled.session.parameters.K2) == (code, gain)
    assert one.held() == [] and two.held() == [code]


def test_a_lab_that_is_open_elsewhere_is_not_opened_again(
    workers: list[Worker], owners: list[Leases], clock: Clock
) -> None:
    one, two = (worker.sessions for worker in workers)
    entry = one.join(1, None)
    do(entry.scheduled.lab, c.SetParameter("K2", 44))
    run(entry.scheduled.lab, 1.1)
    workers[0].keeper.flush(entry.code)
    owners[0].renew(one.held())
    clock.meanwhile = lambda: owners[0].renew(one.held())
    assert two.join(1, entry.code).code != entry.code
    with pytest.raises(ValueError, match="another window"):
        two.enter(1, entry.code)
    clock.meanwhile = lambda: None  # one is dead now
    found = two.join(2, entry.code)
    assert found.code == entry.code and found.scheduled.session.parameters.K2 == 44
    assert owners[0].renew(one.held()) == [entry.code]
    assert one.lose(entry.code) == 1 and one.held() == [] and one.find(entry.code) is None
