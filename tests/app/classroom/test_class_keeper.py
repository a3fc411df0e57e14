"""A class with an address is kept, and goes on in another process as it was."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest

from onpath.app.classroom import class_keeper
from onpath.app.classroom.class_keeper import FRESH, ClassKeeper
from onpath.app.classroom.class_state import SETTLED, from_stored, to_stored
from onpath.app.classroom.classroom import (
    NOTHING_DONE,
    Classroom,
    ClassState,
)
from onpath.app.common.access_codes import shown
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.setups.setup import Setup
from onpath.app.storage.leases import LEASE, RENEWAL
from onpath.app.storage.records import NotKept, Records, file_url
from onpath.app.storage.schema import classes
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Progress

KEY, OTHER_KEY = "k7mf2xqa9tzr", "k7mf2xqa9tzs"
ADA, BOB = "a" * 12, "b" * 12


class Process:
    """A class in one process, under a clock of its own.

    Args:
        wall: the time that all processes share.
    """

    def __init__(
        self, file: Path, now: float, key: str = KEY, wall: Callable[[], float] = time.time
    ) -> None:
        self.now, self.given_up = now, 0
        self.records = Records(file_url(file), wall)
        self.room: Classroom = Classroom(lambda: self.now, key)
        self.keeper = ClassKeeper(self.room, self.records, self._give_up)

    def _give_up(self) -> None:
        self.given_up += 1

    def leave(self) -> None:
        """Nobody has the class open here any more."""
        self.records.give_up()

    def settle(self) -> None:
        """Some time passes, and the class is stored."""
        self.now += SETTLED + 1
        self.keeper.check()


@pytest.fixture
def two(tmp_path: Path) -> Iterator[list[Process]]:
    made = [Process(tmp_path / "labs.db", 1000.0), Process(tmp_path / "labs.db", 77.0)]
    yield made
    for process in made:
        process.records.close()


def moved(two: list[Process]) -> list[Process]:
    """The processes after a class with Ada has gone over to the second one, where Bob joins it."""
    one, other = two
    one.keeper.open()
    one.room.join(ADA, one.room.code, "Ada")
    one.keeper.check()
    one.leave()
    other.keeper.open()
    other.room.join(BOB, other.room.code, "Bob")
    other.keeper.check()
    return two


def names(process: Process) -> list[str]:
    return [member.name for member in process.room.members().values()]


def test_every_process_with_the_key_has_the_same_class(two: list[Process], tmp_path: Path) -> None:
    one, other = two
    stranger = Process(tmp_path / "labs.db", 0.0, OTHER_KEY)
    assert one.room.code == other.room.code != stranger.room.code
    one.keeper.open()
    one.room.join(ADA, one.room.code, "Ada")
    one.keeper.check()
    stranger.keeper.open()
    assert names(stranger) == []
    stranger.records.close()
    for row in rows(one.records):
        assert KEY not in str(tuple(row)) and one.room.code not in str(tuple(row))


def rows(records: Records) -> list[Any]:
    with records.transaction() as connection:
        return list(connection.execute(classes.select()))


@pytest.mark.parametrize(
    "push", [TakeStep("01-a", 2, "short"), TakeSetup(Setup(settings={"rate": 0.5}))]
)
def test_a_class_goes_on_in_another_process(two: list[Process], push: TakeStep | TakeSetup) -> None:
    one, other = two
    one.keeper.open()
    room = one.room
    teacher = room.admit(shown(KEY), "desk")
    for lab, name in ((ADA, "Ada"), (BOB, "Bob <b>")):
        room.join(lab, room.code, name)
    one.records.save(ADA, {"lessons": {"lesson": "01-a"}})
    room.leave(BOB)
    room.join("c" * 12, room.code, "Cid")
    room.push(push)
    room.freeze(True)
    room.keep_within(Pace("01-a", 1, 3))
    room.note(ADA, taken=1)
    one.settle()
    one.leave()
    other.keeper.open()
    assert names(other) == ["Ada", "Cid"]
    ada, cid = other.room.members().values()
    assert (ada.number, ada.taken, ada.progress) == (1, 1, Progress(lesson="01-a"))
    assert (cid.number, cid.taken, cid.progress) == (3, 0, NOTHING_DONE)
    assert not ada.connected and ada.active == other.now
    assert other.room.orders.frozen and other.room.orders.push == push
    assert other.room.orders.pace == Pace("01-a", 1, 3)
    assert other.room.is_pass(teacher) and not other.room.is_pass("x")
    assert other.room.join("d" * 12, room.code, "ada").number == 4
    assert [each for each in names(other) if each.lower().startswith("ada")] == ["Ada", "ada 2"]


def test_who_has_lost_the_class_gives_it_up_and_takes_it_back_as_it_is_then(
    two: list[Process],
) -> None:
    one, other = moved(two)
    one.room.freeze(True)  # its teacher does not know yet
    for _ in range(2):
        one.keeper.check()
    assert one.given_up == 1 and names(one) == [] and not one.room.orders.frozen
    assert other.given_up == 0 and names(other) == ["Ada", "Bob"]
    other.leave()
    one.keeper.open()
    assert names(one) == ["Ada", "Bob"] and not one.room.orders.frozen
    other.keeper.check()
    assert other.given_up == 1


def test_who_comes_while_the_class_is_here_finds_it_as_it_is(two: list[Process]) -> None:
    one, _ = two
    one.keeper.open()
    one.room.join(ADA, one.room.code, "Ada")  # not stored yet
    one.keeper.open()
    assert names(one) == ["Ada"] and one.given_up == 0


def test_a_class_that_moved_away_while_its_process_was_suspended_is_read_again(
    two: list[Process],
) -> None:
    one, other = moved(two)
    one.now += FRESH  # it wakes up, and somebody comes before it has looked
    other.leave()
    assert one.keeper.open()
    assert names(one) == ["Ada", "Bob"]
    one.keeper.check()
    assert one.given_up == 0 and names(one) == ["Ada", "Bob"]
    other.keeper.check()
    assert other.given_up == 1


def test_a_class_is_not_taken_from_a_process_that_has_it_open(tmp_path: Path) -> None:
    wall = [1e9]
    one, other = (Process(tmp_path / "labs.db", 0.0, wall=lambda: wall[0]) for _ in range(2))
    assert one.keeper.open()
    one.room.join(ADA, one.room.code, "Ada")
    one.keeper.check()
    for _ in range(20):
        wall[0] += RENEWAL
        one.records.renew([one.keeper.id])
        assert not other.keeper.open()
    other.keeper.check()
    assert names(one) == ["Ada"] and (one.given_up, other.given_up) == (0, 0)
    wall[0] += LEASE + RENEWAL  # the first one is suspended
    assert other.keeper.open() and names(other) == ["Ada"]
    one.now += FRESH
    assert not one.keeper.open() and one.given_up == 1 and names(one) == []
    for process in (one, other):
        process.records.close()


def test_who_comes_while_the_database_is_away_does_not_ask_it_each_time(
    two: list[Process], monkeypatch: pytest.MonkeyPatch
) -> None:
    one, asked = two[0], list[str]()

    def refuse(what: str, *_: object) -> None:
        asked.append(what)
        raise NotKept("error.database_busy")

    monkeypatch.setattr(one.records, "claim", refuse)
    monkeypatch.setattr(one.records, "is_current", refuse)
    for _ in range(100):
        one.keeper.open()
    assert len(asked) == 1
    one.now += FRESH
    one.keeper.open()
    assert len(asked) == 2


def test_nobody_waits_for_ever_for_a_database_that_hangs_while_another_asks_it(
    two: list[Process], monkeypatch: pytest.MonkeyPatch
) -> None:
    asked, answers = Event(), Event()

    def hang(*_: object) -> None:
        asked.set()
        answers.wait()

    keeper = two[0].keeper
    monkeypatch.setattr(class_keeper, "OPENING_WAIT", 0.01)
    monkeypatch.setattr(two[0].records, "claim", hang)
    first = Thread(target=keeper.open)
    first.start()
    asked.wait()
    keeper.open()  # returns
    assert first.is_alive()
    answers.set()
    first.join()


def test_a_push_that_labs_may_not_have_stored_yet_is_sent_again(two: list[Process]) -> None:
    one, other = two
    one.keeper.open()
    one.room.join(ADA, one.room.code, "Ada")
    one.room.push(TakeStep("01-a", 0))
    one.room.note(ADA, taken=1)
    one.settle()
    one.room.push(TakeStep("01-a", 1))
    one.room.note(ADA, taken=2, given=one.now)
    one.keeper.check()
    one.leave()
    other.keeper.open()
    member = other.room.member(ADA)
    assert member is not None and member.taken == 1 < other.room.orders.pushes == 2


def test_a_push_is_not_sent_again_because_the_class_moves_twice(two: list[Process]) -> None:
    """However quickly: who has gone on since then would be thrown back."""
    one, other = two
    one.keeper.open()
    one.room.join(ADA, one.room.code, "Ada")
    one.room.push(TakeStep("01-a", 0))
    one.room.note(ADA, taken=1, given=one.now)
    one.settle()
    one.leave()
    for process in (other, one, other):
        process.now += FRESH
        process.keeper.open()
        process.room.freeze(not process.room.orders.frozen)
        process.keeper.check()
        member = process.room.member(ADA)
        assert member is not None and member.taken == 1
        process.leave()
    one.keeper.check()


def test_a_database_that_is_away_ends_no_class(
    two: list[Process], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **more: object) -> None:
        raise NotKept("error.database_busy")

    one, other = two
    with monkeypatch.context() as away:
        for name in ("save", "claim", "is_current"):
            away.setattr(one.records, name, refuse)
        one.keeper.open()
        one.room.join(ADA, one.room.code, "Ada")
        one.keeper.check()
        one.now += FRESH
        one.keeper.open()
        assert names(one) == ["Ada"]
    one.keeper.check()
    one.leave()
    other.keeper.open()
    assert names(other) == ["Ada"]


@pytest.mark.parametrize(
    ("field", "broken"),
    [
        ("members", [7, {}, {"session": ADA, "number": -1, "name": "x", "taken": 0}]),
        ("members", [{"session": "", "number": 1, "name": "x", "taken": 0}]),
        ("members", [{"session": BOB, "number": 1, "name": "\u200b", "taken": 0}]),
        ("push", {"setup": {"rate": "fast"}}),
        ("push", {"lesson": 3}),
        ("step", {"lesson": 3}),
        ("step", {"setup": {}}),
    ],
)
def test_what_is_broken_is_left_out_and_the_class_goes_on(field: str, broken: Any) -> None:
    room = Classroom(key=KEY)
    room.join(ADA, room.code, "Ada")
    stored = to_stored(room.state, room.clock())
    if field == "members":
        broken = [*stored["members"], *broken]
    read = from_stored({**stored, field: broken}, lambda _: NOTHING_DONE, 0.0)
    assert [member.name for member in read.members.values()] == ["Ada"]
    assert read.orders.push is None and read.orders.step is None


def test_a_class_of_before_goes_on_from_the_step_that_was_sent() -> None:
    room = Classroom(key=KEY)
    room.push(TakeStep("01-path-or-timetable", 2, "1-lab"))
    stored = to_stored(room.state, room.clock())
    del stored["step"]
    assert from_stored(stored, lambda _: NOTHING_DONE, 0.0).orders == room.orders


@pytest.mark.parametrize("broken", [{}, {"members": 1}, {"passes": [1]}])
def test_a_class_that_cannot_be_read_is_begun_anew(broken: dict[str, Any]) -> None:
    assert from_stored(broken, lambda _: NOTHING_DONE, 0.0) == ClassState()


def test_a_class_that_ends_keeps_its_code() -> None:
    room = Classroom()
    code = room.code
    room.join(ADA, code, "Ada")
    assert room.end() == 1 and room.code == code and room.members() == {}
