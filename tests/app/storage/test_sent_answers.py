"""An answer counts as sent when it is in the database, not before, and is there at once."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from typing_extensions import override

from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.storage.engine import NotKept
from onpath.app.storage.lab_state import StateObserver, put_back
from onpath.app.storage.records import Records, file_url
from onpath.app.storage.schema import labs
from onpath.app.storage.write_behind import WriteBehind
from onpath.lessons.course import Course, read_course
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import write_lesson
from tests.support.site import needs_postgres, postgres

LESSON, CHOICE, CODE = "01-a", 3, "a" * 12
LONG = 3600.0  # [s] between writes: what is stored was not waited for
ANSWER = c.Predict(option=1, lesson=LESSON, step=CHOICE, key="k1")


class Slow(Records):
    """A database that lets a write go on when it is told to.

    Attributes:
        away: how many writes fail before one succeeds.
    """

    def __init__(self, url: Any) -> None:
        super().__init__(url)
        self.goes_on, self.away, self.saved = threading.Event(), 0, threading.Event()

    @override
    def save(
        self, code: str, state: dict[str, Any], table: Any = labs, gone: Iterable[str] = ()
    ) -> None:
        self.goes_on.wait(30.0)
        if self.away:
            self.away -= 1
            raise NotKept("error.database", reason="away")
        super().save(code, state, table, gone)


@pytest.fixture(params=["sqlite", pytest.param("postgres", marks=needs_postgres)])
def records(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Slow]:
    with ExitStack() as stack:
        url: Any = file_url(tmp_path / "labs.db")
        if request.param == "postgres":
            url = stack.enter_context(postgres())
        made = Slow(url)
        yield made
        made.close()


@pytest.fixture
def course(tmp_path: Path) -> Course:
    write_lesson(tmp_path)
    return read_course([tmp_path])[0]


def until_sent(lab: Lab, keeper: WriteBehind) -> None:
    """Let frames pass until the page is told; the write is awaited, not the time."""
    while "k1" not in lab.lessons.sent:
        keeper._hurry.wait(0.01)
        do(lab)


@pytest.mark.parametrize("failures", [0, 2])
def test_an_answer_is_sent_when_it_is_stored_and_not_before(
    records: Slow, course: Course, failures: int
) -> None:
    keeper = WriteBehind(records, interval=LONG if not failures else 0.0)
    lab = Lab(loop_cache(), FIVE_BAR, course)
    lab.watch = StateObserver(CODE, keeper, lab)
    records.away = failures
    do(lab, TakeStep(LESSON, CHOICE), ANSWER)
    for _ in range(3):
        do(lab)
        assert not lab.lessons.waits and lab.lessons.sent == ()  # taken, but not stored
    assert records.load(CODE) is None
    records.goes_on.set()
    until_sent(lab, keeper)
    stored = records.load(CODE)
    assert stored is not None
    again = Lab(loop_cache(), FIVE_BAR, course)  # as after kill -9: nothing else is left
    put_back(again, stored)
    again.watch = StateObserver(CODE, keeper, again)
    assert again.lessons.sent == ("k1",)
    do(again, ANSWER)  # the browser did not hear of it
    assert again.lessons.progress == lab.lessons.progress
    keeper.close()


@pytest.mark.parametrize("killed", ["on the way", "taken", "stored", "told"])
def test_wherever_the_process_is_killed_a_vote_counts_once(
    tmp_path: Path, course: Course, killed: str
) -> None:
    records, after = (Slow(file_url(tmp_path / "labs.db")) for _ in range(2))
    after.goes_on.set()
    lab, again = (Lab(loop_cache(), FIVE_BAR, course) for _ in range(2))
    keeper, other = WriteBehind(records, interval=LONG), WriteBehind(after, interval=LONG)
    lab.watch = StateObserver(CODE, keeper, lab)
    do(lab, TakeStep(LESSON, CHOICE))
    if killed != "on the way":
        do(lab, ANSWER)
    if killed in ("stored", "told"):
        records.goes_on.set()
        until_sent(lab, keeper)
    stored = after.load(CODE)  # all that is left
    assert (stored is None) == (killed in ("on the way", "taken"))
    if stored is not None:
        put_back(again, stored)
    again.watch = StateObserver(CODE, other, again)
    do(again, TakeStep(LESSON, CHOICE))
    if killed != "told":
        do(again, ANSWER)  # its browser has kept it
    until_sent(again, other)
    left = after.load(CODE)
    assert left is not None
    assert [each["key"] for each in left["lessons"]["notes"][LESSON]["given"]] == ["k1"]
    records.away = 9  # nothing comes of the process that was killed
    records.goes_on.set()
    for each in (keeper, other, records, after):
        each.close()
