"""Stored data persists, and storage failures never stop the lab."""

from __future__ import annotations

import logging
import os
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from types import NoneType
from typing import Any

import pytest
import sqlalchemy as sa
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.stored import from_data, to_data
from onpath.app.storage import records as database
from onpath.app.storage import write_behind
from onpath.app.storage.engine import opened_file, parsed
from onpath.app.storage.records import LARGEST, NotKept, Records, default_file, file_url
from onpath.app.storage.schema import labs, metadata
from onpath.app.storage.write_behind import BREATH, WriteBehind
from tests.support import waiting
from tests.support.checkout import ROOT
from tests.support.lab import new_lab

NOON = 1_800_000_000.0


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "data" / "onpath.db"


@contextmanager
def opened(file: Path) -> Iterator[Records]:
    records = Records(file_url(file), clock=lambda: NOON)
    try:
        yield records
    finally:
        records.close()


def filled(file: Path, count: int = 40) -> bytes:
    """A database with something in it, at rest, as bytes."""
    with opened(file) as records:
        for i in range(count):
            records.save(f"code{i}", {"number": i, "text": "x" * 500})
    assert {part.name for part in file.parent.iterdir()} == {file.name}
    return file.read_bytes()


def works(records: Records) -> None:
    records.claim("new")
    records.save("new", {"a": 1})
    assert records.load("new") == {"a": 1}
    records.give_up("new")


def found_in(records: Records, i: int) -> str | None:
    """Whether what `filled` wrote is there as it was."""
    try:
        state = records.load(f"code{i}")
    except NotKept:
        return "unreadable"
    assert state is None or state == {"number": i, "text": "x" * 500}
    return "there" if state else None


def broken_files(file: Path) -> list[Path]:
    return sorted(file.parent.glob(f"{file.name}.broken-*"))


# What is kept


def test_what_is_saved_is_loaded_by_another_process(file: Path) -> None:
    with opened(file) as records:
        assert records.load("a") is None
        records.save("a", {"n": 1})
        records.save("a", {"n": 2, "words": "Größe ∂ \0 '; DROP TABLE labs"})
        records.save("b", {})
        assert records.warning == ""
    with opened(file) as records:
        assert records.load("a") == {"n": 2, "words": "Größe ∂ \0 '; DROP TABLE labs"}
        assert records.load("b") == {}
        assert records.load("' OR 1=1") is None
        assert records.delete_all() == 2
        assert records.load("a") is None
    assert b"DROP TABLE" not in file.read_bytes()


JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**60), 2**60) | st.floats(-1e9, 1e9) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=10,
)


@pytest.mark.thorough
@settings(max_examples=25, deadline=None)
@given(st.dictionaries(st.text(min_size=1, max_size=64), st.dictionaries(st.text(), JSON)))
def test_any_states_under_any_codes(labs: dict[str, dict[str, Any]]) -> None:
    records = Records("sqlite://")
    for code, state in labs.items():
        records.save(code, state)
    assert {code: records.load(code) for code in labs} == labs
    assert records.delete_all() == len(labs)
    records.close()


def test_a_lab_comes_back(file: Path) -> None:
    simulation, other = new_lab().simulation, new_lab().simulation
    simulation.editor.commit(simulation.presets["clover"])
    with opened(file) as records:
        records.save("a", {"setup": to_data(capture(simulation))})
    with opened(file) as records:
        state = records.load("a")
    assert state is not None
    restore(other, from_data(state["setup"]))
    assert capture(other) == capture(simulation)


def test_the_time_of_storing_is_that_of_the_clock(file: Path) -> None:
    filled(file, 1)
    with sqlite3.connect(file) as raw:
        assert raw.execute("SELECT updated, version FROM labs").fetchall() == [(NOON, 1)]
        assert raw.execute("PRAGMA journal_mode").fetchone() == ("wal",)


def test_little_of_the_file_is_in_memory(file: Path) -> None:
    file.parent.mkdir()
    engine, _ = opened_file(parsed(file_url(file)), lambda: NOON)
    for _ in range(2):
        with engine.begin() as connection:
            size = connection.exec_driver_sql("PRAGMA cache_size").scalar()
            assert size == -256  # KiB; SQLite's default is 2000
    engine.dispose()


@pytest.mark.parametrize(
    ("code", "state", "words"),
    [
        ("a", {"text": "x" * LARGEST}, "too much"),
        ("a", {"list": list(range(LARGEST))}, "too much"),
        ("a", {"object": object()}, "cannot be stored"),
        ("", {}, "lab code"),
        ("x" * 65, {}, "lab code"),
    ],
)
def test_a_state_that_is_too_large_or_invalid_is_refused(
    file: Path, code: str, state: dict[str, Any], words: str
) -> None:
    with opened(file) as records:
        records.save("a", {"before": 1})
        with pytest.raises(ValueError, match=words):
            records.save(code, state)
        assert records.load("a") == {"before": 1}


def test_the_default_is_in_the_user_s_folder(monkeypatch: pytest.MonkeyPatch, file: Path) -> None:
    monkeypatch.setattr(database.platformdirs, "user_data_dir", lambda name: str(file.parent))
    assert default_file() == file
    records = Records()
    works(records)
    records.close()
    assert file.exists()


@pytest.mark.parametrize("name", ["a b", "100%", "q?x=1#y", "ß", "%2e"])
def test_any_folder_will_do(tmp_path: Path, name: str) -> None:
    with opened(tmp_path / name / "onpath.db") as records:
        works(records)
        assert records.warning == ""
    assert (tmp_path / name / "onpath.db").exists()


# Broken files


@pytest.mark.parametrize(
    "length",
    [0, 1, 15, 16, 50, 99, 100, 101, 511, 512, 1024, 4095, 4096, 4097, 8192, 20_000, -4096, -1],
)
def test_a_truncated_file_is_moved_aside(file: Path, length: int, caplog: Any) -> None:
    rest = filled(file)[:length]
    file.write_bytes(rest)
    with opened(file) as records:
        found = [found_in(records, i) for i in range(40)]
        works(records)
        assert records.warning == ""
    if broken_files(file):
        (aside,) = broken_files(file)
        assert aside.read_bytes() == rest and found == 40 * [None]
        assert aside.name in caplog.text and "fresh one" in caplog.text
    elif len(rest) > 1:  # one byte is as empty a file as none, for SQLite
        assert None not in found and found.count("unreadable") <= 1
    with opened(file) as records:
        assert records.load("new") == {"a": 1}


@pytest.mark.parametrize("size", [3, 100, 5000, 10_000_000])
def test_a_file_of_something_else_is_moved_aside(file: Path, size: int) -> None:
    file.parent.mkdir()
    data = random.Random(size).randbytes(size)
    for _ in range(2):  # in the same second, too
        file.write_bytes(data)
        with opened(file) as records:
            works(records)
    assert [aside.read_bytes() for aside in broken_files(file)] == [data, data]
    assert len({aside.name for aside in broken_files(file)}) == 2


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(20))
def test_a_file_with_wrong_bytes_opens_and_nothing_is_deleted(file: Path, seed: int) -> None:
    chance = random.Random(seed)
    good = bytearray(filled(file))
    where = (120, 4200, len(good))[seed % 3]  # the header, the schema, anywhere
    for _ in range(chance.choice([1, 3, 30])):
        good[chance.randrange(where)] = chance.randrange(256)
    file.write_bytes(good)
    with opened(file) as records:
        try:
            works(records)
        except NotKept:  # what is wrong shows only now: the file must still be there
            assert file.exists()
        for i in range(40):
            with suppress(NotKept):
                assert isinstance(records.load(f"code{i}"), dict | NoneType)
    if broken_files(file):
        assert broken_files(file)[0].read_bytes() == bytes(good)


def test_an_invalid_state_is_distinguished_from_a_missing_one(file: Path) -> None:
    filled(file, 3)
    with sqlite3.connect(file) as raw:
        raw.execute("UPDATE labs SET state = '[1,' WHERE code = 'code0'")
        raw.execute("UPDATE labs SET state = ? WHERE code = 'code1'", ("[" * 100_000,))
        raw.execute("UPDATE labs SET version = 2 WHERE code = 'code2'")
    raw.close()
    with opened(file) as records:
        for code, words in (("code0", "read"), ("code1", "read"), ("code2", "newer")):
            with pytest.raises(NotKept, match=words):
                records.load(code)
        with pytest.raises(NotKept, match="newer"):
            records.save("code2", {})


def test_a_newer_database_is_left_alone(file: Path) -> None:
    filled(file, 3)
    with sqlite3.connect(file) as raw:
        raw.execute("UPDATE meta SET number = 2")
    raw.close()
    before = file.read_bytes()
    with opened(file) as records:
        assert "newer OnPath" in records.warning and str(file) in records.warning
        assert records.load("code1") is None
        works(records)
    assert file.read_bytes() == before and not broken_files(file)


def test_another_program_s_database_is_left_alone(file: Path) -> None:
    file.parent.mkdir()
    with sqlite3.connect(file) as raw:
        raw.execute("CREATE TABLE labs (name TEXT, price REAL)")
    raw.close()
    with opened(file) as records:
        assert "not OnPath's" in records.warning
        works(records)
    with sqlite3.connect(file) as raw:
        assert raw.execute("SELECT name FROM sqlite_master").fetchall() == [("labs",)]
    raw.close()


# Where nothing can be written


@contextmanager
def unprivileged() -> Iterator[None]:
    """As a user for whom permissions count."""
    root = os.geteuid() == 0
    if root:
        os.seteuid(65534)
    try:
        yield
    finally:
        if root:
            os.seteuid(0)


@pytest.mark.skipif(os.name != "posix", reason="permissions of a POSIX system")
@pytest.mark.parametrize("there", [True, False])
def test_a_folder_that_cannot_be_written(there: bool) -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "onpath.db"
        if there:
            filled(file, 3)
        before = file.read_bytes() if there else b""
        os.chmod(folder, 0o555)
        try:
            with unprivileged(), opened(file) as records:
                assert "Nothing outlives the server" in records.warning
                works(records)
        finally:
            os.chmod(folder, 0o755)
        assert [p.name for p in Path(folder).iterdir()] == (["onpath.db"] if there else [])
        assert not there or file.read_bytes() == before


def test_a_folder_where_the_file_should_be_and_a_file_where_the_folder_should(
    file: Path, tmp_path: Path
) -> None:
    file.mkdir(parents=True)
    (tmp_path / "plain").write_text("")
    for place in (file, tmp_path / "plain" / "onpath.db"):
        with opened(place) as records:
            assert str(place) in records.warning
            works(records)


@contextmanager
def full_disk(records: Records) -> Iterator[None]:
    """SQLite's own way to have no room left."""

    def set_most(pages: int) -> None:
        with records._engine.connect() as connection:
            connection.exec_driver_sql(f"PRAGMA max_page_count = {pages}")

    set_most(1)
    yield
    set_most(2**30)


def test_a_full_disk_keeps_what_was_there(file: Path) -> None:
    with opened(file) as records:
        records.save("a", {"n": 1})
        with full_disk(records):
            for code in ("a", "b"):
                with pytest.raises(NotKept, match="full"):
                    records.save(code, {"text": "x" * 100_000})
            assert records.load("a") == {"n": 1}
        records.save("a", {"text": "x" * 100_000})
    with opened(file) as records:
        assert len((records.load("a") or {})["text"]) == 100_000


LIMITED = """
import resource, signal, sys
from onpath.app.storage.records import NotKept, Records, file_url
from pathlib import Path
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
records = Records(file_url(Path(sys.argv[1])))
resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000))
kept = 0
for i in range(100):
    try:
        records.save(f"code{i}", {"text": "x" * 20_000})
        kept += 1
    except NotKept as error:
        print(kept, error)
        break
assert all(records.load(f"code{i}") for i in range(kept))
"""


def child(script: str, *arguments: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", script, *arguments]
    pipe = subprocess.PIPE
    return subprocess.Popen(command, cwd=ROOT, stdout=pipe, stderr=pipe, text=True)


@pytest.mark.thorough
@pytest.mark.skipif(os.name != "posix", reason="limits of a POSIX system")
def test_writes_that_the_system_refuses_lose_nothing_that_was_kept(file: Path) -> None:
    process = child(LIMITED, str(file))
    told, errors = process.communicate(timeout=60)
    assert process.returncode == 0 and "Traceback" not in errors, errors
    kept = int(told.split()[0])
    assert 0 < kept < 100
    with opened(file) as records:
        assert all(records.load(f"code{i}") for i in range(kept))
        works(records)
    assert not broken_files(file)


# Several processes, and one that is killed

WRITER = """
import sys
from pathlib import Path
from onpath.app.storage.records import HeldElsewhere, Records, file_url
records = Records(file_url(Path(sys.argv[1])))
assert not records.warning
while True:
    try:
        records.claim(sys.argv[2])
        break
    except HeldElsewhere:  # the lease of a process that was killed has not ended
        pass
print("open", flush=True)
for i in range(int(sys.argv[3])):
    records.save(sys.argv[2], {"n": i, "text": "x" * (i % 7) * 3000})
    print(i, flush=True)
"""


@pytest.mark.thorough
@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no kill -9 here")
def test_kill_9_in_the_middle_of_writes(file: Path) -> None:
    for attempt in range(4):
        process = child(WRITER, str(file), "a", "1000000")
        assert process.stdout is not None and process.stdout.readline() == "open\n"
        told = [process.stdout.readline() for _ in range(4 + 20 * attempt)]
        process.kill()
        told += process.communicate(timeout=30)[0].split()
        with opened(file) as records:
            state = records.load("a")
            assert state is not None and records.warning == ""
            assert state["n"] >= int(told[-2])  # the last line may be cut
            works(records)
        assert not broken_files(file)


@pytest.mark.thorough
def test_processes_that_open_and_write_at_once(file: Path) -> None:
    names = [f"w{i}" for i in range(4)]
    processes = [child(WRITER, str(file), name, "30") for name in names]
    for process in processes:
        told, errors = process.communicate(timeout=60)
        assert process.returncode == 0 and told.endswith("29\n"), errors
    with opened(file) as records:
        assert [(records.load(name) or {})["n"] for name in names] == [29] * 4


@pytest.mark.thorough
def test_processes_that_find_a_broken_file_at_once(file: Path) -> None:
    file.parent.mkdir()
    file.write_bytes(b"broken" * 1000)
    processes = [child(WRITER, str(file), f"w{i}", "5") for i in range(3)]
    for process in processes:
        told, errors = process.communicate(timeout=60)
        assert process.returncode == 0 and told.endswith("4\n"), errors
    assert [aside.read_bytes() for aside in broken_files(file)] == [b"broken" * 1000]
    with opened(file) as records:
        assert all(records.load(f"w{i}") for i in range(3))


@pytest.mark.thorough
def test_a_process_that_finds_a_broken_file_waits_while_another_moves_it_aside(file: Path) -> None:
    file.parent.mkdir()
    file.write_bytes(b"broken" * 1000)
    others: list[Records] = []
    other = threading.Thread(target=lambda: others.append(Records(file_url(file))))

    def clock() -> float:  # asked for the name, when nothing is moved yet
        if not other.ident:
            other.start()
            other.join(timeout=1.0)
        return NOON

    records = Records(file_url(file), clock=clock)
    other.join(timeout=30.0)
    assert [aside.read_bytes() for aside in broken_files(file)] == [b"broken" * 1000]
    records.save("mine", {"n": 1})
    assert others[0].load("mine") == {"n": 1} and not others[0].warning
    for each in (records, *others):
        each.close()


# Other databases


def test_a_database_elsewhere_must_work_from_the_start() -> None:
    with pytest.raises(ValueError, match="no driver"):
        Records("martian://user:secret@host/onpath")
    with pytest.raises(ValueError, match="not a database URL"):
        Records("not a URL: secret")


def test_statements_are_everybody_s_sql() -> None:
    from sqlalchemy.dialects import postgresql
    from sqlalchemy.schema import CreateTable

    for table in metadata.sorted_tables:
        made = str(CreateTable(table).compile(dialect=postgresql.dialect()))
        assert "CREATE TABLE" in made
    assert "DOUBLE PRECISION" in str(CreateTable(labs).compile(dialect=postgresql.dialect()))


# The keeper


class Memory:
    """A store that notes what comes, and fails when told to."""

    warning, generation = "", 0

    def __init__(self) -> None:
        self.saved: list[tuple[str, Any]] = []
        self.fault: Exception | None = None
        self.tries = 0
        self.gate = threading.Event()
        self.gate.set()

    def save(self, code: str, state: dict[str, Any]) -> None:
        self.gate.wait(60.0)
        self.tries += 1
        if self.fault is not None:
            raise self.fault
        self.saved.append((code, state["n"]))


until = partial(waiting.wait_for, seconds=60.0)


def number(n: int) -> Callable[[], dict[str, Any]]:
    return lambda: {"n": n}


def test_only_the_latest_state_is_written_and_the_rest_on_close() -> None:
    store = Memory()
    keeper = WriteBehind(store, interval=60.0)
    keeper.submit("a", number(0))
    until(lambda: store.saved)
    for n in range(1, 1000):
        keeper.submit("a", number(n))
        keeper.submit("b", number(-n))
    assert store.saved == [("a", 0)]
    keeper.close()
    assert sorted(store.saved[1:]) == [("a", 999), ("b", -999)]


class Pauses(threading.Event):
    """Time that a keeper lets pass before each save, [s], without letting it pass.

    Attributes:
        before_save: by the number of the save.
    """

    def __init__(self, store: Memory) -> None:
        super().__init__()
        self.before_save: defaultdict[int, float] = defaultdict(float)
        self._store = store

    def wait(self, timeout: float | None = None) -> bool:
        self.before_save[len(self._store.saved)] += timeout or 0.0
        return self.is_set()


def test_states_are_written_every_few_seconds() -> None:
    store, n = Memory(), 0
    keeper = WriteBehind(store, interval=2.0)
    pauses = keeper._closing = Pauses(store)
    keeper._hurry = Pauses(store)
    keeper._hurry.before_save = pauses.before_save
    while len(store.saved) < 5:
        keeper.submit("a", number(n))
        n += 1
    keeper.close()
    assert [pauses.before_save[k] for k in range(1, 5)] == pytest.approx([2.0 + BREATH] * 4)
    assert store.saved[-1] == ("a", n - 1)
    assert [value for _, value in store.saved] == sorted({value for _, value in store.saved})


def test_a_database_that_hangs_keeps_nobody_waiting() -> None:
    store = Memory()
    store.gate.clear()
    keeper = WriteBehind(store, interval=0.0)
    for n in range(2000):
        keeper.submit(f"code{n % 60}", number(n))
    assert not store.saved  # the store still hangs
    store.gate.set()
    keeper.close()
    assert {code for code, _ in store.saved} == {f"code{i}" for i in range(60)}


def test_a_lab_is_kept_when_it_is_let_go_though_its_turn_was_under_way() -> None:
    store = Memory()
    store.gate.clear()
    keeper = WriteBehind(store, interval=0.0)
    keeper.submit("a", number(1))
    until(lambda: not keeper._pending)  # it is being written
    kept: list[list[Any]] = []
    flushing = threading.Thread(target=lambda: (keeper.flush("a"), kept.append(store.saved[:])))
    flushing.start()
    flushing.join(0.1)
    assert flushing.is_alive() and not kept
    store.gate.set()
    flushing.join(5.0)
    assert kept == [[("a", 1)]]
    keeper.close()


@pytest.fixture
def hanging(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Memory, WriteBehind]]:
    """A store that hangs with the first state of a lab, and its keeper; newer ones are pending."""
    monkeypatch.setattr(write_behind, "TURN_WAIT", 0.01)
    store = Memory()
    store.gate.clear()
    keeper = WriteBehind(store, interval=0.0)
    keeper.submit("a", number(1))
    until(lambda: not keeper._pending)  # it is being written
    keeper.submit("a", number(2))
    keeper.submit("b", number(3))
    yield store, keeper
    store.gate.set()
    keeper.close()


def test_nobody_waits_long_for_a_write_that_hangs_and_all_is_kept_when_it_goes_on(
    hanging: tuple[Memory, WriteBehind],
) -> None:
    store, keeper = hanging
    assert not keeper.flush("a") and not keeper.flush("b") and not store.saved
    store.gate.set()
    keeper.close()
    assert store.saved == [("a", 1), ("a", 2), ("b", 3)]
    assert keeper.flush("a") and len(store.saved) == 3


def test_nothing_is_discarded_while_a_write_hangs(
    hanging: tuple[Memory, WriteBehind],
) -> None:
    """The write would store again what was deleted, or overwrite what is read next."""
    store, keeper = hanging
    with pytest.raises(NotKept, match="busy"):
        keeper.discard("a")
    assert not store.saved
    store.gate.set()
    keeper.close()
    assert store.saved == [("a", 1), ("a", 2), ("b", 3)]


def test_while_a_write_hangs_its_lab_and_those_behind_it_count_as_not_kept(
    hanging: tuple[Memory, WriteBehind], monkeypatch: pytest.MonkeyPatch
) -> None:
    store, keeper = hanging
    assert not keeper.unsaved("a")  # it may just be slow
    monkeypatch.setattr(write_behind, "HANGING", 0.0)
    until(lambda: keeper.unsaved("a") and keeper.unsaved("b"))
    assert not keeper.unsaved("other")
    monkeypatch.undo()
    store.gate.set()
    until(lambda: len(store.saved) == 3)
    until(lambda: not keeper.unsaved("a") and not keeper.unsaved("b"))


def test_a_failed_write_is_repeated_and_reported_once(caplog: Any) -> None:
    caplog.set_level(logging.WARNING)
    store = Memory()
    store.fault = NotKept("error.database", reason="the disk is full")
    keeper = WriteBehind(store, interval=0.002)
    keeper.submit("a", number(1))
    until(lambda: keeper.warning)
    assert keeper.warning.endswith("the disk is full")
    for n in range(2, 20):
        tries = store.tries
        keeper.submit("b", number(n))
        until(lambda tries=tries: store.tries > tries)
    store.fault = None
    until(lambda: len(store.saved) == 2)
    until(lambda: not keeper.warning)
    keeper.close()
    assert sorted(store.saved) == [("a", 1), ("b", 19)]
    assert caplog.text.count("the disk is full") == 1 and "kept again" in caplog.text


def test_an_older_state_never_overwrites_a_newer_one() -> None:
    """A write that fails while a newer state arrives is not tried again with the older one."""
    store = Memory()
    store.gate.clear()
    store.fault = NotKept("error.database", reason="the disk is full")
    keeper = WriteBehind(store, interval=0.0)
    keeper.submit("a", number(1))
    until(lambda: not keeper._pending)  # 1 is being written
    keeper.submit("a", number(2))
    store.gate.set()  # and fails
    until(lambda: keeper.warning)
    store.fault = None
    until(lambda: store.saved)
    keeper.close()
    assert store.saved == [("a", 2)]


def test_a_mistake_of_one_lab_does_not_affect_others(caplog: Any) -> None:
    store = Memory()
    keeper = WriteBehind(store, interval=0.002)

    def fails() -> dict[str, Any]:
        raise KeyError("lost")

    for _ in range(5):
        keeper.submit("bad", fails)
        keeper.submit("good", number(1))
        until(lambda: ("good", 1) in store.saved)
        store.saved.clear()
    keeper.close()
    assert caplog.text.count("Traceback") == 1


def test_the_keeper_writes_a_real_database(file: Path) -> None:
    with opened(file) as records:
        keeper = WriteBehind(records, interval=0.01)
        for n in range(200):
            keeper.submit(f"code{n % 60}", number(n))
        keeper.submit("huge", lambda: {"text": "x" * LARGEST})
        keeper.close()
        assert all((records.load(f"code{n % 60}") or {})["n"] == n for n in range(140, 200))
        assert records.load("huge") is None
        assert isinstance(records._engine, sa.Engine) and keeper.warning == ""
