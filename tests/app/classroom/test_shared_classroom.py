"""One class in several processes: each has a SharedClassroom on the same database."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
import sqlalchemy as sa

from onpath.app.classroom.class_ledger import FORGOTTEN
from onpath.app.classroom.class_opening import KEY, class_of_workers, given_key, open_class
from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import MOST_MEMBERS, Orders
from onpath.app.classroom.local_classroom import LocalClassroom
from onpath.app.classroom.mirror import Mirror
from onpath.app.classroom.relay import Relay
from onpath.app.classroom.shared_classroom import LIVELY, SharedClassroom
from onpath.app.classroom.watches import GONE, LASTS, NONSENSE, Watches
from onpath.app.common.access_codes import new_code, shown
from onpath.app.common.throttle import TRIES
from onpath.app.lab import commands as c
from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.commands import TakeSetup, TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.page.teacher_context import TeacherChoices
from onpath.app.server.followed_lab import FollowedLab
from onpath.app.simulation.simulation_thread import ScheduledLab, SimulationThread
from onpath.app.storage.forget import forget
from onpath.app.storage.leases import TERM, Leases
from onpath.app.storage.records import NotKept, Records, file_url
from onpath.app.storage.schema import OF_A_CLASS, classes
from onpath.lessons.progress import Answer, Notes, Progress
from onpath.lessons.words import ENGLISH
from tests.support.lab import FOLLOWER, FRAME, do, new_lab, run, store, y
from tests.support.waiting import wait_for

CODE = "k7mf2xqa9tzr"
WAY = Progress(lesson="one", notes={"one": Notes(answers={"1": Answer(option=1)})})


class Clock:
    """Of the wall; each process has a monotonic one of its own."""

    def __init__(self) -> None:
        self.now = 1.8e9


@dataclass
class Process:
    """A worker: its view of the class, and the labs that it has, as by app.server.lab_registry."""

    file: Path
    key: str
    clock: Clock
    begun: float = 0.0
    labs: dict[str, ScheduledLab] = field(default_factory=dict)
    clients: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.records = Records(file_url(self.file), self.wall)
        mine = lambda: self.clock.now - self.begun  # noqa: E731
        self.room = SharedClassroom(self.records, self.key, mine, self.wall)
        self.leases = Leases(self.records, clock=self.wall)
        self.attendance = ClassSync(self.room, self._find)
        self.watches = Watches(self.records, self.room.id, self.wall)

    def wall(self) -> float:
        return self.clock.now

    def lab(self, code: str, lab: Lab | None = None) -> Lab:
        """A student is here now."""
        self.labs[code] = ScheduledLab(lab or Lab(store()))
        self.clients.add(code)
        self.leases.claim(code)
        return self.labs[code].lab

    def student(self, code: str, name: str) -> Lab:
        lab = self.lab(code)
        self.room.join(code, self.room.code, name)
        return lab

    def look(self) -> None:
        """As the threads of a worker do, and a frame of each lab."""
        self.leases.renew(self.clients)
        self.attendance.look()
        for lab in self.labs.values():
            lab.lab.drain()

    def here(self, code: str) -> ScheduledLab | None:
        return None if self.room.is_elsewhere(code) else self.labs.get(code)

    def kill(self) -> None:
        """Nothing is let go of."""
        self.records.close()

    def _find(self, code: str) -> tuple[Lab, bool] | None:
        lab = self.labs.get(code)
        return None if lab is None else (lab.lab, code in self.clients)


@dataclass
class Two:
    file: Path
    clock: Clock
    both: tuple[Process, Process]

    def look(self) -> None:
        """Twice: what one writes, the other reads at the latest then."""
        for process in self.both * 2:
            process.look()


@pytest.fixture
def two(tmp_path: Path) -> Iterator[Two]:
    file, key, clock = tmp_path / "labs.db", new_code(), Clock()
    both = Process(file, key, clock), Process(file, key, clock, begun=1e6)
    yield Two(file, clock, both)
    for process in both:
        process.records.close()


# Who is in it.


def test_all_processes_have_the_same_class(two: Two) -> None:
    one, other = two.both
    assert one.room.code == other.room.code and one.room.id == other.room.id
    first, second = one.student("a", "Ada"), other.student("b", "Bob")
    first.lessons.progress = WAY
    two.look()
    for process in two.both:
        assert [member.name for member in process.room.members().values()] == ["Ada", "Bob"]
    seen = other.room.member("a")
    assert seen is not None and seen.progress == WAY and seen.connected
    assert not one.room.is_elsewhere("a") and other.room.is_elsewhere("a")
    one.room.leave("a")
    two.look()
    assert list(other.room.members()) == ["b"] and second.lessons.progress == Progress()


def test_another_key_is_another_class(two: Two) -> None:
    one, _ = two.both
    one.student("a", "Ada")
    room = SharedClassroom(one.records, new_code())
    assert room.members() == {} and room.id != one.room.id
    room.end()
    one.room.look()
    assert list(one.room.members()) == ["a"]


def test_names_are_unique_and_numbers_too_however_many_join_at_once(two: Two) -> None:
    def join(process: Process, number: int) -> None:
        process.room.join(f"lab {number}", process.room.code, "Ada")

    threads = [threading.Thread(target=join, args=(two.both[i % 2], i)) for i in range(16)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for process in two.both:
        process.room.look()
        there = process.room.members().values()
        assert len({m.name for m in there}) == 16
        assert [m.number for m in there] == [*range(1, 17)]


def test_a_class_is_full_for_all(two: Two, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("onpath.app.classroom.classroom.MOST_MEMBERS", 2)
    assert MOST_MEMBERS > 2
    one, other = two.both
    one.student("a", "Ada")
    other.student("b", "Bob")
    for process in two.both:
        with pytest.raises(ValueError, match="full"):
            process.student("c", "Cid")
    assert one.student("a", "Eve") and one.room.members()["a"].name == "Eve"


def test_a_pass_opens_the_page_in_every_process_and_is_not_kept_as_it_is(two: Two) -> None:
    one, other = two.both
    shown_pass = one.room.admit(shown(one.key), "teacher")
    assert other.room.is_pass(shown_pass) and not other.room.is_pass(shown_pass + "x")
    for part in two.file.parent.iterdir():
        kept = part.read_bytes()
        assert shown_pass.encode() not in kept and one.key.encode() not in kept
    other.room.revoke(shown_pass)
    assert not one.room.is_pass(shown_pass)
    for _ in range(TRIES):
        with pytest.raises(ValueError, match="key"):
            one.room.admit(new_code(), "thief")
    with pytest.raises(ValueError, match="too many"):
        one.room.admit(shown(one.key), "thief")


# What reaches the labs.


def test_orders_reach_the_labs_of_all_processes(two: Two) -> None:
    one, other = two.both
    labs = [one.student("a", "Ada"), other.student("b", "Bob")]
    one.room.freeze(True)
    assert one.room.orders.frozen
    two.look()
    assert [lab.frozen for lab in labs] == [True, True]
    own = new_lab()
    do(own, c.SetParameter("K2", 33.0))
    other.room.push(TakeSetup(capture(own.session)))
    other.room.freeze(False)
    two.look()
    assert [lab.frozen for lab in labs] == [False, False]
    assert [capture(lab.session) for lab in labs] == [capture(own.session)] * 2
    do(labs[0], c.SetParameter("K2", 44.0))
    two.look()
    assert labs[0].session.parameters.K2 == 44.0  # once, not again and again
    assert one.room.end() == 2
    two.look()
    assert other.room.code == one.room.code and other.room.members() == {}


def test_who_joins_later_gets_what_was_sent_whichever_the_process(two: Two) -> None:
    one, other = two.both
    own = new_lab()
    do(own, c.SetParameter("K2", 33.0))
    one.room.push(TakeSetup(capture(own.session)))
    one.look()
    labs = [one.student("a", "Ada"), other.student("b", "Bob")]
    two.look()
    assert [capture(lab.session) for lab in labs] == [capture(own.session)] * 2
    do(labs[1], c.SetParameter("K2", 44.0))
    two.look()
    assert labs[1].session.parameters.K2 == 44.0  # once
    other.room.push(None)
    two.look()
    late = one.student("c", "Cid")
    two.look()
    assert one.room.orders.push is None and capture(late.session) != capture(own.session)


def test_a_student_who_changes_the_process_is_the_same(two: Two) -> None:
    one, other = two.both
    lab = one.student("a", "Ada")
    lab.lessons.progress = WAY
    one.room.push(TakeStep("none", 0))
    one.room.freeze(True)
    two.look()
    one.kill()  # no word to anybody
    assert other.room.members()["a"].connected
    two.clock.now += TERM + 0.1
    other.look()
    assert not other.room.members()["a"].connected
    again = other.lab("a")
    again.lessons.progress = WAY
    other.look()
    other.look()
    member = other.room.members()["a"]
    assert (member.number, member.name, member.progress) == (1, "Ada", WAY) and member.connected
    assert again.frozen and not again.message.startswith("no ")  # the push is not repeated


def test_what_was_left_behind_does_not_speak_for_a_student(two: Two) -> None:
    one, other = two.both
    old = one.student("a", "Ada")
    two.look()
    one.clients.discard("a")
    one.leases.release("a")
    new = other.lab("a")
    new.lessons.progress = WAY
    two.look()
    old.lessons.progress = Progress(lesson="old")
    other.room.freeze(True)
    two.look()
    for process in two.both:
        member = process.room.members()["a"]
        assert member.progress == WAY and member.connected
    assert new.frozen and not old.frozen


def test_nothing_is_written_while_nothing_happens(two: Two) -> None:
    one, other = two.both
    lab = one.student("a", "Ada")
    lab.lessons.progress = WAY
    two.look()

    def changes() -> int:
        with one.records.transaction() as connection:
            return connection.execute(sa.select(classes.c.changes)).scalar_one()

    before, way = changes(), other.room.members()["a"].progress
    for _ in range(5):
        two.look()
    for _ in range(10):  # hands that move all the time are noted now and then
        two.clock.now += LIVELY / 12
        do(lab, c.MoveHand(0.0, 0.001))
        two.look()
    assert changes() <= before + 1
    assert other.room.members()["a"].progress is way


def test_a_clock_that_jumps_makes_nobody_idle_for_long(two: Two) -> None:
    one, other = two.both
    lab = one.student("a", "Ada")
    two.look()
    for jump in (86400.0, -2 * 86400.0):
        one.begun += jump  # the processes' own clocks go on
        other.begun += jump
        two.clock.now += jump
        do(lab, c.SetRate(1.0))
        two.look()
        two.clock.now += LIVELY
        do(lab, c.SetRate(1.0))
        two.look()
        for process in two.both:
            idle = process.room.clock() - process.room.members()["a"].active
            assert 0 <= idle <= LIVELY + 1
            assert process.room.members()["a"].connected


# What is in the database.


@pytest.mark.parametrize(
    "broken",
    [
        {"progress": "{"},
        {"progress": '{"notes": 3}'},
        {"name": ""},
        {"name": "\u200b"},
        {"number": "x"},
        {"active": "never"},
        {"taken": -1},
        {"changed": "x"},
    ],
    ids=str,
)
def test_a_broken_row_does_not_stop_the_class(two: Two, broken: dict[str, Any]) -> None:
    one, other = two.both
    one.student("a", "Ada")
    two.look()
    with one.records.transaction() as connection:
        for name, value in {"changed": 99, **broken}.items():
            connection.exec_driver_sql(f"UPDATE members SET {name} = ?", (value,))
        connection.execute(sa.update(classes).values(changes=99))
    bob = other.student("b", "Bob")
    one.room.freeze(True)
    two.look()
    assert bob.frozen and "b" in one.room.members()
    fresh = SharedClassroom(one.records, one.key)
    assert "b" in fresh.members()
    one.room.join("a", one.room.code, "Ada")
    two.look()
    assert other.room.members()["a"].name == "Ada"


@pytest.mark.parametrize("broken", [{"push": "{"}, {"push": '{"setup": 1}'}, {"pushes": "x"}])
def test_a_broken_order_does_not_stop_the_class(two: Two, broken: dict[str, Any]) -> None:
    one, other = two.both
    one.student("a", "Ada")
    with one.records.transaction() as connection:
        connection.execute(sa.update(classes).values(changes=99, **broken))
    two.look()
    assert other.room.orders.push is None
    bob = other.student("b", "Bob")
    one.room.freeze(True)
    two.look()
    assert bob.frozen


def test_when_the_database_is_away_labs_stay_as_they_are(
    two: Two, monkeypatch: pytest.MonkeyPatch
) -> None:
    one, _ = two.both
    lab = one.student("a", "Ada")
    one.room.freeze(True)
    two.look()
    with monkeypatch.context() as patch:
        patch.setattr(
            one.room, "_written", lambda *_: _raise(NotKept("error.database", reason="away"))
        )
        one.room.freeze(False)
        lab.lessons.progress = WAY
        one.attendance.look()
        with pytest.raises(OSError, match="away"):
            one.room.join("b", one.room.code, "Bob")
    two.look()
    assert not lab.frozen and two.both[1].room.members()["a"].progress == WAY


def _raise(error: Exception) -> Any:
    raise error


def test_everything_is_forgotten(two: Two) -> None:
    one, other = two.both
    one.student("a", "Adalbert")
    one.room.admit(shown(one.key), "a")
    one.watches.ask(["a"])
    before = one.room.code
    forget(f"sqlite:///{two.file}")
    with one.records.transaction() as connection:
        for table in (*OF_A_CLASS, classes):
            assert connection.execute(sa.select(table)).first() is None
    one.attendance.look()
    other.attendance.look()
    assert one.room.members() == other.room.members() == {}
    assert one.room.code == other.room.code != before
    one.records.close()
    other.records.close()
    assert not any(b"Adalbert" in part.read_bytes() for part in two.file.parent.iterdir())


def test_classes_that_nobody_ended_are_forgotten_after_a_while(two: Two) -> None:
    one, _ = two.both
    one.student("a", "Ada")
    two.clock.now += FORGOTTEN + 1
    SharedClassroom(one.records, new_code(), wall=one.wall)
    one.room.look()
    assert one.room.members() == {} and one.room.orders == Orders()


def test_which_class_a_server_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, two: Two
) -> None:
    monkeypatch.setenv(KEY, shown(CODE).upper())
    assert given_key() == CODE and given_key() is None  # not for the processes that it starts
    monkeypatch.setenv(KEY, "nonsense")
    with pytest.raises(ValueError, match=KEY):
        given_key()
    records = two.both[0].records
    assert isinstance(open_class(records, None), LocalClassroom)
    assert isinstance(open_class(records, CODE), SharedClassroom)
    alone = Records("sqlite://")
    with pytest.raises(ValueError, match="share"):
        open_class(alone, CODE)
    url = f"sqlite:///{tmp_path / 'class.db'}"
    with class_of_workers(url) as (room, is_new):
        assert is_new and room.join("a", room.code, "Ada")
    again = Records(url)
    assert SharedClassroom(again, room.key).members() == {}
    monkeypatch.setenv(KEY, CODE)
    with class_of_workers(url) as (room, is_new):
        assert not is_new and room.join("a", room.code, "Ada")
    assert list(SharedClassroom(again, CODE).members()) == ["a"]
    again.close()


# A student's lab in another process.


def test_what_is_asked_for_is_told_for_a_while(two: Two) -> None:
    one, other = (process.watches for process in two.both)
    assert one.asked() == set() and one.published(["a"]) == {}
    other.ask(["a", "b"])
    other.ask(["a", "b"])
    assert one.asked() == {"a", "b"} and one.published(["a"]) == {}
    one.tell({"a": "moment", "c": "nobody asked"})
    assert other.published(["a", "b", "c"]) == {"a": "moment"}
    two.clock.now += LASTS + 0.1
    assert one.asked() == set()
    two.clock.now += GONE
    other.ask(["b"])
    assert other.published(["a", "b"]) == {} and one.asked() == {"b"}
    two.clock.now -= NONSENSE
    assert one.asked() == set()


def test_a_lab_elsewhere_is_mirrored_as_long_as_a_teacher_looks(two: Two) -> None:
    one, other = two.both
    student = one.student("a", "Ada")
    wanted: dict[int, str] = {}
    simulation, elsewhere = SimulationThread(), SimulationThread()
    there = Relay(one.watches, one.here, dict, lambda: Lab(store()), elsewhere)
    here = Relay(other.watches, other.here, lambda: wanted, lambda: Lab(store()), simulation)

    def pass_time(looks: int) -> Mirror | None:
        for _ in range(looks):
            for relay in (here, there):
                relay.look()
            run(student, 0.125)
            mirror = here.mirror(7, "a")
            if mirror is not None:
                for _ in range(8):
                    advance_together([mirror.frame(FRAME)])
            two.clock.now += 0.125
        return here.mirror(7, "a")

    two.look()
    assert pass_time(8) is None
    wanted[7] = "a"
    mirror = pass_time(24)
    assert simulation.labs == [mirror] and elsewhere.labs == []
    assert mirror is not None and here.mirror(8, "a") is None and here.mirror(7, "b") is None
    behind = student.session.time - mirror.session.time
    assert 0 < behind < 1.5
    tip = y(mirror.lab.session, FOLLOWER)
    assert abs(float(tip @ tip) ** 0.5 - 0.05) < 1e-3  # on the circle
    assert not mirror.is_seen
    one.labs["a"].view = object()  # type: ignore[assignment]
    pass_time(8)
    assert mirror.is_seen
    wanted[7] = "b"
    assert pass_time(1) is None and here._mirrors == {} and simulation.labs == []
    wanted.clear()
    pass_time(int(LASTS / 0.125) + 8)
    assert there._asked == set() and there._told == {}
    posted = len(student._inbox)
    pass_time(8)
    assert len(student._inbox) == posted == 0


def test_the_teacher_reads_why_a_lab_stands_still(two: Two) -> None:
    one, other = two.both
    one.student("a", "Ada")
    other.student("b", "Bob")
    two.look()
    lab = ScheduledLab(new_lab())
    shown_lab: list[ScheduledLab | None] = [lab]
    teaching = FollowedLab(one.room, TeacherChoices(), lambda _: shown_lab[0])
    assert teaching.why_still(ENGLISH) == ""
    for code in ("a", "b"):
        teaching.chosen.followed = code
        lab.view = None
        assert teaching.why_still(ENGLISH) == ENGLISH("class.hidden")
        lab.view = object()  # type: ignore[assignment]
        assert teaching.why_still(ENGLISH) == ""
        assert teaching.find() == (lab, one.room.members()[code].number)
    shown_lab[0] = None
    assert teaching.why_still(ENGLISH) == ENGLISH("class.fetching")
    other.clients.clear()
    other.leases.release("b")
    two.look()
    assert teaching.why_still(ENGLISH) == ENGLISH("class.absent")
    other.room.leave("b")
    two.look()
    assert teaching.why_still(ENGLISH) == "" and teaching.find() is None


def test_a_relay_that_is_told_nonsense_shows_nothing(two: Two) -> None:
    one, other = two.both
    simulation = SimulationThread()
    here = Relay(other.watches, other.here, lambda: {7: "a"}, lambda: Lab(store()), simulation)
    here.look()
    one.watches.tell({"a": "nonsense"})
    here.look()
    assert here.mirror(7, "a") is None
    here.rounds.start()
    wait_for(lambda: here._looks > 4, 5.0)
    here.rounds.stop()
