"""A state belongs to the process that opened it last; one whose copy is outdated notices it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.server import lab_registry
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage import records as database
from onpath.app.storage.leases import LEASE
from onpath.app.storage.records import HeldElsewhere, NotKept, Records, file_url
from onpath.app.storage.schema import classes, labs
from onpath.app.storage.write_behind import WriteBehind
from tests.support.lab import do, loop_cache, run
from tests.support.waiting import wait_for

CODE = "a" * 12


class Process:
    """Labs of one process, without a network."""

    def __init__(self, file: Path) -> None:
        self.records = Records(file_url(file))
        self.lost: list[str] = []
        self.keeper = WriteBehind(self.records, interval=60.0, lost=self._lose)
        begun = f"{id(self):x}"[-12:]
        self.keeper.submit(begun, dict)
        wait_for(lambda: self.keeper.written(begun), 10.0)  # its thread now waits for an interval
        self.registry = LabRegistry(
            SimulationThread(),
            lambda: Lab(loop_cache()),
            load=self.records.claim,
            give_up=self.records.give_up,
            is_current=self.records.is_current,
            keeper=self.keeper,
        )

    def leave(self, client: int) -> None:
        """Have a client leave, as it is when its page has been closed."""
        entry = self.registry.leave(client)
        if entry is not None:
            self.registry.give_back(entry.code)

    def _lose(self, code: str) -> None:
        self.lost.append(code)
        self.registry.lose(code)

    def gain(self, code: str) -> float:
        entry = self.registry.find(code)
        assert entry is not None
        return entry.scheduled.simulation.parameters.K2

    def set(self, code: str, gain: float) -> None:
        """Change a lab, and wait until it asks to be stored."""
        entry = self.registry.find(code)
        assert entry is not None
        do(entry.scheduled.lab, c.Set("K2", gain))
        run(entry.scheduled.lab, 1.1)


@pytest.fixture
def two(tmp_path: Path) -> Iterator[list[Process]]:
    made = [Process(tmp_path / "labs.db") for _ in range(2)]
    yield made
    for process in made:
        process.keeper.close()
        process.records.close()


@pytest.mark.parametrize("table", [labs, classes], ids=str)
def test_only_who_opened_a_state_last_can_save_it(two: list[Process], table: object) -> None:
    one, other = (process.records for process in two)
    one.save(CODE, {"n": 1}, table)  # type: ignore[arg-type]
    one.save(CODE, {"n": 2}, table)  # type: ignore[arg-type]
    assert one.is_current(CODE, table) and not other.is_current(CODE, table)  # type: ignore[arg-type]
    with pytest.raises(HeldElsewhere):
        other.save(CODE, {"n": 3}, table)  # type: ignore[arg-type]
    assert other.claim(CODE, table) == {"n": 2}  # type: ignore[arg-type]
    with pytest.raises(HeldElsewhere):
        one.claim(CODE, table)  # type: ignore[arg-type]
    with pytest.raises(HeldElsewhere):
        one.save(CODE, {"n": 4}, table)  # type: ignore[arg-type]
    other.save(CODE, {"n": 5}, table)  # type: ignore[arg-type]
    assert one.load(CODE, table) == {"n": 5}  # type: ignore[arg-type]
    assert other.is_current(CODE, table) and not one.is_current(CODE, table)  # type: ignore[arg-type]
    other.give_up(CODE)
    assert one.claim(CODE, table) == {"n": 5}  # type: ignore[arg-type]
    assert one.claim("nobody", table) is None and one.is_current("nobody", table)  # type: ignore[arg-type]


def test_a_state_that_cannot_be_read_is_not_taken_over(
    two: list[Process], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = (process.records for process in two)
    monkeypatch.setattr(database, "VERSION", 2)
    with one.transaction() as connection:
        values = {"owner": "newer", "version": 2, "updated": 0.0}
        connection.execute(labs.insert().values(code=CODE, state="{}", **values))
    monkeypatch.undo()
    for act in (lambda: other.claim(CODE), lambda: other.save(CODE, {})):
        with pytest.raises(NotKept, match="newer"):
            act()
    assert not other.is_current(CODE)


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.sampled_from(["claim", "save", "wait"]), st.integers(0, 2)), max_size=20)
)
def test_nothing_that_was_saved_is_ever_overwritten_from_an_older_copy(
    steps: list[tuple[str, int]],
) -> None:
    """Each process counts on from what it read last, as a lab does that is worked in."""
    now = [1e9]
    shared = Records("sqlite://", clock=lambda: now[0])
    owners, known, stored = ["one", "two", "three"], [0, 0, 0], 0
    for what, who in steps:
        shared.owner = owners[who]
        if what == "claim":
            with suppress(HeldElsewhere):
                known[who] = (shared.claim(CODE) or {"n": known[who]})["n"]
            continue
        if what == "wait":
            now[0] += LEASE
            continue
        try:
            shared.save(CODE, {"n": known[who] + 1})
        except HeldElsewhere:
            assert not shared.is_current(CODE)
            continue
        known[who] += 1
        assert known[who] == stored + 1
        stored = known[who]
    shared.close()


def test_a_lab_moves_to_and_fro_between_processes_as_it_was_left(two: list[Process]) -> None:
    here, there = two
    code = here.registry.join(1, None).code
    for gain in (41, 42, 43):
        here.set(code, gain)
        here.leave(1)
        assert there.registry.join(1, code).code == code and there.gain(code) == gain
        here, there = there, here
    assert not two[0].lost and not two[1].lost


def test_a_lab_that_moved_away_while_its_process_was_suspended_is_given_up(
    two: list[Process],
) -> None:
    one, other = two
    code = one.registry.join(1, None).code
    one.set(code, 41)
    one.keeper.flush(code)
    one.set(code, 42)  # not stored yet
    assert other.registry.join(1, code).code == code and other.gain(code) == 41
    other.set(code, 43)
    other.leave(1)
    one.keeper.flush(code)
    assert one.lost == [code] and one.registry.find(code) is None
    assert one.registry.join(2, code).code == code and one.gain(code) == 43


@pytest.mark.thorough
def test_a_lab_that_waited_here_meanwhile_is_read_again_and_its_late_changes_are_dropped(
    two: list[Process], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, other = two
    code = one.registry.join(1, None).code
    one.set(code, 41)
    one.keeper.flush(code)
    one.set(code, 42)
    with monkeypatch.context() as away:  # the database, when the client leaves
        away.setattr(one.records, "save", _refuse)
        one.leave(1)
    assert other.registry.join(1, code).code == code
    other.set(code, 43)
    other.leave(1)
    assert one.registry.join(1, code).code == code and one.gain(code) == 43
    one.keeper.flush(code)
    assert other.registry.join(1, code).code == code and other.gain(code) == 43


def test_a_lab_that_is_dropped_before_it_could_be_stored_is_opened_as_it_was_left(
    two: list[Process], monkeypatch: pytest.MonkeyPatch
) -> None:
    here = two[0]
    code = here.registry.join(1, None).code
    here.set(code, 41)
    here.keeper.flush(code)
    here.set(code, 42)
    with monkeypatch.context() as away:  # the database
        away.setattr(here.records, "save", _refuse)
        here.leave(1)
        here.registry.lose(code)
        assert here.registry.join(1, code).stands_in  # not as it was stored before
    assert here.registry.join(2, code).code == code and here.gain(code) == 42


def test_a_lab_that_is_open_in_one_process_stays_there(
    two: list[Process], monkeypatch: pytest.MonkeyPatch
) -> None:
    here, there = two
    monkeypatch.setattr(lab_registry, "LEASE_WAIT", 0.0)
    code = here.registry.join(1, None).code
    here.set(code, 41)
    here.keeper.flush(code)
    here.records.renew(here.registry.held())
    assert there.registry.join(1, code).code != code  # a new one, as in a second tab
    with pytest.raises(ValueError, match="open"):
        there.registry.enter(2, code)
    here.set(code, 42)
    here.leave(1)
    assert there.registry.join(3, code).code == code and there.gain(code) == 42


@pytest.mark.thorough
def test_the_lab_of_a_process_that_was_killed_is_waited_for(two: list[Process]) -> None:
    here, there = two
    code = here.registry.join(1, None).code
    here.set(code, 41)
    here.keeper.flush(code)
    here.records.renew(here.registry.held())  # for the last time
    assert there.registry.join(1, code).code == code and there.gain(code) == 41


def test_an_error_while_a_lab_is_given_up_does_not_end_the_writes(two: list[Process]) -> None:
    one, other = (process.records for process in two)
    other.save(CODE, {})

    def fail(code: str) -> None:
        raise RuntimeError(code)

    keeper = WriteBehind(one, interval=0.0, lost=fail)
    keeper.submit(CODE, lambda: {"n": 1})
    keeper.submit("b" * 12, lambda: {"n": 2})
    wait_for(lambda: one.load("b" * 12), 60.0)
    keeper.submit("c" * 12, lambda: {"n": 3})
    wait_for(lambda: one.load("c" * 12), 60.0)
    keeper.close()
    assert one.load(CODE) == {}


def _refuse(*_: object) -> None:
    raise NotKept("error.database_busy")
