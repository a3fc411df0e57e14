"""A database that is locked, full, deleted or replaced: who waits is told soon, nothing is lost."""

from __future__ import annotations

import os
import shutil
import sqlite3
import threading
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import event, exc

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.stored import from_data
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.app.server.lab_registry import LabRegistry
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.simulation.simulation_thread import SimulationThread
from onpath.app.storage import records as database
from onpath.app.storage.engine import TRANSACTION_WAIT
from onpath.app.storage.records import NotKept, Records, file_url
from onpath.app.storage.write_behind import WriteBehind
from onpath.lessons.words import ENGLISH, Words
from tests.support import waiting
from tests.support.lab import do, new_lab, run
from tests.support.student import Student, remembered

BRIEF = 0.01  # [s], for what waits in vain in these tests
until = partial(waiting.wait_for, seconds=60.0)


class Server:
    """Labs with a database, without a network."""

    def __init__(self, file: Path) -> None:
        self.file, self.records = file, Records(file_url(file))
        self.keeper = WriteBehind(self.records, interval=0.0)
        self.registry = LabRegistry(
            SimulationThread(),
            new_lab,
            load=self.records.claim,
            is_current=self.records.is_current,
            keeper=self.keeper,
        )

    def stop(self) -> None:
        self.keeper.close()
        self.records.close()

    def kept(self, code: str) -> bool:
        """Whether another process finds the lab in the file."""
        with closing(sqlite3.connect(self.file)) as raw:
            found = raw.execute("SELECT count(*) FROM labs WHERE code = ?", (code,)).fetchone()
        return found == (1,)


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    made = Server(tmp_path / "data" / "labs.db")
    yield made
    made.stop()


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(database, "TRANSACTION_WAIT", BRIEF)


@contextmanager
def locked(file: Path) -> Iterator[None]:
    """Another process is writing, and does not end."""
    with closing(sqlite3.connect(file, isolation_level=None)) as other:
        other.execute("BEGIN IMMEDIATE")
        yield


@contextmanager
def full(server: Server) -> Iterator[None]:
    """No room for a lab; `test_database` fills a real file."""

    def refuse(_: Any, __: Any, statement: str, *___: Any) -> None:
        if not statement.startswith("SELECT") and " labs " in statement:
            full = sqlite3.OperationalError("database or disk is full")
            raise exc.OperationalError(statement, None, full)

    event.listen(server.records._engine, "before_cursor_execute", refuse)
    yield
    event.remove(server.records._engine, "before_cursor_execute", refuse)


@contextmanager
def no_folder(server: Server) -> Iterator[None]:
    """Neither the file nor a place for it."""
    delete_folder(server.file)
    server.file.parent.write_text("a file where the folder was")
    yield
    server.file.parent.unlink()


def page(lab: Lab) -> str:
    """What the page says, a second later."""
    run(lab, 1.0)
    return take_snapshot(lab, 1.0).message


def is_kept(server: Server, code: str, lab: Lab) -> bool:
    """Whether the database has a lab's set-up, a second later."""
    run(lab, 1.0)
    state = server.records.load(code)
    return state is not None and from_data(state["setup"]) == capture(lab.simulation)


# The student is told


@pytest.mark.thorough
@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize("fault", [lambda server: locked(server.file), full, no_folder])
def test_the_page_says_that_a_lab_is_not_kept_and_when_it_is_again(
    server: Server, impatient: None, language: str, fault: Callable[[Server], Any]
) -> None:
    words = Words(language)
    entry = server.registry.join(1, None)
    lab = entry.scheduled.lab
    do(lab, c.SetLanguage(language), c.Set("K2", 33))
    assert words("keep.failed") not in page(lab)
    with fault(server):
        do(
            lab,
            c.ChoosePath("clover"),
            c.Set("K1", 444),
            c.Set("output", "nonsense"),
        )
        refusal = lab.message
        until(lambda: words("keep.failed") in page(lab))
        snapshot = take_snapshot(lab, 1.0)
        assert snapshot.message_level == "warning" and refusal in snapshot.message
        do(lab, c.Set("K1", 445))  # does not hide it
        assert words("keep.failed") in page(lab)
    until(lambda: words("keep.failed") not in page(lab))
    assert words("keep.again") in page(lab) or words("keep.anew") in page(lab)
    until(lambda: is_kept(server, entry.code, lab))


def test_a_lab_that_is_too_large_is_said_once_and_what_was_stored_last_stays(
    server: Server, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    entry, words = server.registry.join(1, None), ENGLISH
    lab = entry.scheduled.lab
    do(lab, c.Set("K1", 444))
    until(lambda: is_kept(server, entry.code, lab))
    stored = server.records.load(entry.code)
    monkeypatch.setattr(database, "LARGEST", 20)
    for k in range(5):
        do(lab, c.Set("K2", 50 + k), c.ChoosePath(("clover", "circle")[k % 2]))
        until(lambda: words("keep.too_large") in page(lab))
    do(lab, c.Set("K1", 445))
    assert page(lab).count(words("keep.too_large")) == 1
    assert not server.keeper.unsaved("other")
    assert server.records.load(entry.code) == stored
    assert caplog.text.count("cannot be stored") == 1 and "Traceback" not in caplog.text
    monkeypatch.undo()
    do(lab, c.Set("K1", 446))
    until(lambda: words("keep.too_large") not in page(lab))
    assert words("keep.again") in page(lab) and is_kept(server, entry.code, lab)


def test_while_one_lab_waits_for_the_database_those_behind_it_are_not_kept_either() -> None:
    tries, gate = list[str](), threading.Event()

    class Locked:
        warning, generation = "", 0

        def save(self, code: str, state: dict[str, Any]) -> None:
            tries.append(code)
            if len(tries) == 1:
                held.wait(60.0)
                raise NotKept("error.database", reason="database is locked")
            gate.wait(60.0)

    held = threading.Event()
    keeper, codes = WriteBehind(Locked(), interval=0.0), ["a", "b", "c"]
    for code in codes:
        keeper.submit(code, dict)
    held.set()
    until(lambda: len(tries) == 2)  # the third's turn has not come
    assert keeper.unsaved("c") and all(map(keeper.unsaved, codes))
    gate.set()
    until(lambda: not any(map(keeper.unsaved, codes)))
    keeper.close()


def test_a_server_that_could_not_open_its_file_says_so_on_every_page(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    server = Server(tmp_path / "plain" / "labs.db")
    try:
        assert ENGLISH("keep.failed") in page(server.registry.join(1, None).scheduled.lab)
    finally:
        server.stop()


@pytest.mark.thorough
def test_a_browser_shows_it(tmp_path: Path, impatient: None) -> None:
    file = tmp_path / "labs.db"
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(records=Records(file_url(file))))
    try:
        with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
            student.open()
            student.value("K2")
            with locked(file):
                student.set("K2", 44.0)
                student.read(lambda: student.sees(ENGLISH("keep.failed")))
            student.read(lambda: student.sees(ENGLISH("keep.again")))
            assert not student.sees(ENGLISH("keep.failed"))
    finally:
        server.stop()


# The file is another


def delete(file: Path) -> None:
    file.unlink()


def delete_folder(file: Path) -> None:
    """Delete it at once: file by file, the writer could put another one there meanwhile."""
    shutil.rmtree(file.parent.rename(file.parent.with_name("deleted")))


def put_another(file: Path) -> None:
    backup = file.with_name("backup.db")
    other = Records(file_url(backup))
    for i in range(40):
        other.save(f"code{i}", {"text": "x" * 500})
    other.close()
    os.replace(backup, file)


def put_rubbish(file: Path) -> None:
    rubbish = file.with_name("rubbish")
    rubbish.write_bytes(b"rubbish" * 1000)
    os.replace(rubbish, file)


@pytest.mark.thorough
@pytest.mark.parametrize("lose", [delete, delete_folder, put_another, put_rubbish])
def test_a_file_that_is_deleted_or_replaced_is_noticed_and_labs_in_use_are_kept_anew(
    server: Server, lose: Callable[[Path], None], caplog: Any
) -> None:
    entries = [server.registry.join(client, None) for client in (1, 2)]
    for entry in entries:
        do(entry.scheduled.lab, c.Set("K2", 33))
        run(entry.scheduled.lab, 1.0)
        until(lambda code=entry.code: server.kept(code))
    lose(server.file)
    do(entries[0].scheduled.lab, c.Set("K2", 34))  # the other does nothing
    for entry in entries:
        until(lambda entry=entry: ENGLISH("keep.anew") in page(entry.scheduled.lab))
        until(lambda code=entry.code: server.kept(code))
    if lose is put_another:  # the old file's journal has not been applied to it
        assert all(server.kept(f"code{i}") for i in range(40))
    assert "deleted or replaced" in caplog.text and server.records.generation == 1
    assert not server.records.warning


def test_two_processes_whose_file_is_replaced_go_on_in_the_new_one(tmp_path: Path) -> None:
    file = tmp_path / "labs.db"
    one, two = Records(file_url(file)), Records(file_url(file))
    one.save("before", {})
    put_another(file)
    one.save("one", {"n": 1})
    two.save("two", {"n": 2})
    for records in (one, two):
        assert records.load("one") == {"n": 1} and records.load("two") == {"n": 2}
        assert records.load("before") is None and records.load("code39")
        records.close()


# Nobody waits long


@pytest.fixture
def granted(server: Server) -> list[float]:
    """How long each transaction was allowed to wait for other processes, [s]."""
    waits: list[float] = []

    def note(_: Any, __: Any, statement: str, *___: Any) -> None:
        name, _, value = statement.partition(" = ")
        if name == "PRAGMA busy_timeout":
            waits.append(float(value) / 1000)

    event.listen(server.records._engine, "before_cursor_execute", note)
    return waits


@pytest.mark.thorough
def test_a_returning_user_waits_for_four_seconds_at_most_is_told_and_finds_the_lab_later(
    server: Server, granted: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    assert TRANSACTION_WAIT <= 2.0
    server.records.save("a" * 12, {"setup": {}, "lessons": {}})
    monkeypatch.setattr(database, "TRANSACTION_WAIT", 0.2)
    granted.clear()
    with locked(server.file):
        entry = server.registry.join(1, "a" * 12)
        assert 0 < len(granted) <= 2 and sum(granted) <= 2 * 0.2
        assert entry.code != "a" * 12 and "cannot be opened now" in page(entry.scheduled.lab)
    known = remembered(entry.code, "a" * 12)
    server.registry.leave(1)
    assert server.registry.join(2, known).code == "a" * 12  # a reload
    assert server.registry.join(3, known).code == entry.code


def test_a_transaction_that_does_not_end_holds_up_nobody_for_long(
    server: Server, impatient: None
) -> None:
    said: list[NotKept] = []

    def load() -> None:
        try:
            server.records.load("a")
        except NotKept as error:
            said.append(error)

    thread = threading.Thread(target=load, daemon=True)
    with server.records.transaction():
        thread.start()
        thread.join(10.0)
        assert len(said) == 1 and "busy" in str(said[0])
    assert server.records.load("a") is None
