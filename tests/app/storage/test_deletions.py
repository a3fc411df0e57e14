"""A backup that is restored, as the recipe in assets/deploy says, brings nothing deleted back."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import sqlalchemy as sa
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from onpath.app.classroom.class_keeper import ClassKeeper
from onpath.app.classroom.classroom import Classroom
from onpath.app.storage.expiry import DAY, Expiry, Retention
from onpath.app.storage.forget import forget
from onpath.app.storage.records import Records, file_url, journal_file
from tests.support.checkout import ROOT
from tests.support.site import needs_postgres, postgres, postgres_programs

KEY = "k7mf2xqa9tzr"
LABS = "abcd"
MOVES = st.lists(
    st.tuples(
        st.sampled_from(["use", "delete", "join", "leave", "end", "back up", "restore"]),
        st.sampled_from(LABS),
    ),
    min_size=8,
    max_size=16,
)


class World:
    """A database file under a clock, one process, and a backup.

    Attributes:
        labs, seats: what there is.
    """

    def __init__(self, folder: Path) -> None:
        self.now, self.file, self.copy = 1.7e9, folder / "labs.db", folder / "copy.db"
        self.labs, self.seats = set[str](), set[str]()
        self.copied: tuple[set[str], set[str]] | None = None
        self.gone = set[str](), set[str]()  # since the backup
        self.start()

    def start(self) -> None:
        self.records = Records(file_url(self.file), clock=lambda: self.now)
        self.room = Classroom(key=KEY)
        self.keeper = ClassKeeper(self.room, self.records, lost=lambda: None)
        assert self.keeper.open()

    def stop(self) -> None:
        self.keeper.stop()
        self.records.give_up()
        self.records.close()

    def do(self, move: str, lab: str) -> None:
        self.now += 10.0
        if move == "use":
            self.records.claim(lab)
            self.records.save(lab, {"lessons": {}})
            self.labs.add(lab)
        elif move == "delete":
            self.records.delete(lab)
            self.labs.discard(lab)
            self.gone[0].add(lab)
        elif move == "join":
            self.room.join(lab, self.room.code, lab)
            self.seats.add(lab)
        elif move in ("leave", "end"):
            self.room.leave(lab) if move == "leave" else self.room.end()
            left = {lab} if move == "leave" else set(self.seats)
            self.gone[1].update(left & self.seats)
            self.seats -= left
        elif move == "back up":
            self.stop()
            shutil.copy(self.file, self.copy)
            self.copied, self.gone = (set(self.labs), set(self.seats)), (set(), set())
            self.start()
        elif move == "restore" and self.copied is not None:
            self.stop()
            shutil.copy(self.copy, self.file)
            self.labs, self.seats = (a - b for a, b in zip(self.copied, self.gone, strict=True))
            self.start()
        self.keeper.check()

    def check(self) -> None:
        assert {lab for lab in LABS if self.records.load(lab) is not None} == self.labs
        assert set(self.room.members()) == self.seats


@settings(max_examples=6, deadline=None, phases=[Phase.generate])
@given(MOVES)
def test_what_was_deleted_after_the_backup_stays_deleted_and_nothing_else(
    tmp_path_factory: pytest.TempPathFactory, moves: list[tuple[str, str]]
) -> None:
    world = World(tmp_path_factory.mktemp("labs"))
    for move, lab in moves:
        world.do(move, lab)
        world.check()
    world.stop()


def commands(program: str) -> list[str]:
    """The lines of the recipe that begin with a program."""
    text = (ROOT / "assets/deploy/README.md").read_text("utf-8")
    recipe = text[text.index("**Backup:**") : text.index("**Upgrade:**")]
    return re.findall(rf"(?m)^{program} .*$", recipe)


def follow(command: str, folder: Path, url: str = "") -> None:
    programs = f"{postgres_programs()}:{os.environ['PATH']}"
    known = {**os.environ, "PATH": programs, "DATABASE": url.replace("+psycopg", "")}
    subprocess.run(["sh", "-ec", command], cwd=folder, env=known, check=True)


@pytest.fixture(autouse=True)
def data_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    return tmp_path


def days_of_a_server(url: str | sa.URL, back_up: str, restore: str, folder: Path) -> None:
    """Five labs, two seats and two classes, of which some are deleted after a copy was made."""
    now = 1.8e9
    plain = "" if isinstance(url, sa.URL) else url
    records = Records(url, clock=lambda: now)
    for lab in "abcde":
        records.save(lab, {"lessons": {}})
    rooms = [Classroom(key=key) for key in (KEY, "bn4ws8cd3vyp")]
    keepers = [ClassKeeper(room, records, lost=lambda: None) for room in rooms]
    for room, keeper, seats in zip(rooms, keepers, ("ab", "c"), strict=True):
        assert keeper.open()
        for lab in seats:
            room.join(lab, room.code, f"Lise {lab}")
        keeper.check()
    records.give_up()  # a copy with leases can be opened when they have ended
    follow(back_up, folder, plain)
    now += 10.0
    records.delete("a")
    rooms[0].leave("a")
    keepers[0].check()
    now += 3 * DAY
    assert Expiry(records, Retention(class_days=2), clock=lambda: now).delete() == 0
    records.give_up()
    records.close()

    follow(restore, folder, plain)
    records = Records(url, clock=lambda: now)
    assert [lab for lab in "abcde" if records.load(lab) is not None] == list("bcde")
    rooms = [Classroom(key=room.key) for room in rooms]
    for room in rooms:
        assert ClassKeeper(room, records, lost=lambda: None).open()
    assert [list(room.members()) for room in rooms] == [[], []]
    records.give_up()
    records.close()
    text = journal_file(records._url).read_text("ascii")
    assert KEY not in text and not re.search("Lise|[g-z]", text)


def test_the_recipe_for_a_file(data_folder: Path) -> None:
    file = data_folder / "onpath.db"
    (back_up,), (restore,) = commands("sqlite3"), commands("rm")
    days_of_a_server(file_url(file), back_up, restore, data_folder)
    assert os.stat(journal_file(file_url(file))).st_mode & 0o777 == 0o600


@needs_postgres
def test_the_recipe_for_a_database_server(data_folder: Path) -> None:
    (back_up,), (restore,) = commands("pg_dump"), commands("psql")
    with postgres() as url:
        days_of_a_server(url, back_up, restore, data_folder)


def test_onpath_forget_is_not_undone_by_a_copy(data_folder: Path) -> None:
    world = World(data_folder)
    for move, lab in (("use", "a"), ("join", "b"), ("back up", "a")):
        world.do(move, lab)
    world.stop()
    forget(str(world.records._url))
    shutil.copy(world.copy, world.file)
    world.labs.clear()
    world.seats.clear()
    world.start()
    world.check()
    world.stop()
