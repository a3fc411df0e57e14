"""A process that hangs says so, ends and is started again; a suspended one does not."""

from __future__ import annotations

import os
import signal
import socket
import sys
import time
from collections.abc import Iterator
from functools import partial
from itertools import cycle
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.app.server.watchdog import CHECKS, EXIT_CODE, Sign, Watchdog
from onpath.app.storage.records import Records
from tests.support import waiting
from tests.support.lab_process import LabProcess, free_ports
from tests.support.starved import starved
from tests.support.student import Student

WAIT = 60.0  # [s]; only ends a test that would hang
HANG = 2  # [s]
STARVED = 30.0  # [s]
wait_for = partial(waiting.wait_for, seconds=WAIT)
linux_only = pytest.mark.skipif(sys.platform != "linux", reason="tried on Linux only")

# A lab in which some values of K1 hang whoever applies or handles them.
HANGING = """
import sys, threading, onpath.app.server.page_form as page_form
from onpath.app.cli.main import run_command
from onpath.app.lab.commands import Set

def hang(value):
    if value == 401.0:
        threading.Event().wait()
    while value == 403.0:
        pass
    if value == 402.0:
        10 ** (10**9)  # never lets go of the interpreter

def apply(self, lab):
    hang(self.value if self.name == "K1" else 0.0)
    applied(self, lab)

def made(name, value):
    hang(value - 10.0 if name == "K1" else 0.0)
    return Set(name, value)

applied, Set.apply, page_form.Set = Set.apply, apply, made
sys.exit(run_command(["serve", *sys.argv[1:]]))
"""


class Stepped:
    """A watchdog of two signs of life, which checks when it is told; each check counts 1 s."""

    def __init__(self) -> None:
        self.values, self.ended = {"a": 0, "b": 0}, 0
        self.dog = Watchdog(float(CHECKS), self._end, self)
        threads = {"a": 1, "b": 2}
        self.counts = dict.fromkeys(threads.values(), 1.0)
        self.dog._signs = {
            name: Sign(partial(self.values.__getitem__, name), partial(threads.__getitem__, name))
            for name in threads
        }

    def __enter__(self) -> Stepped:
        return self

    def __exit__(self, *_: object) -> None:
        self.dog.stop()  # it limits the processor time of this process

    def check(self) -> None:
        pass

    def counted(self, thread: int, most: float) -> float:
        return min(self.counts[thread], most)

    def _end(self) -> None:
        self.ended += 1


@given(
    st.lists(
        st.tuples(
            st.sets(st.sampled_from("ab")),
            st.integers(1, 2 * CHECKS),
            st.sampled_from([1.0, 0.125]),
        ),
        max_size=6,
    )
)
@example([(set(), CHECKS - 1, 1.0), ({"a", "b"}, 1, 1.0), ({"a"}, CHECKS - 1, 1.0)])
@example([({"b"}, CHECKS, 1.0), ({"a", "b"}, 1, 1.0), ({"a"}, 2 * CHECKS, 1.0)])
@example([(set(), 2 * CHECKS, 0.125), (set(), 2 * CHECKS, 1.0)])
def test_anything_without_a_sign_of_life_for_long_enough_hangs(
    lives: list[tuple[set[str], int, float]],
) -> None:
    silent = {"a": 0.0, "b": 0.0}
    with Stepped() as tried:
        tried.dog.check()
        for alive, counts in [(alive, counts) for alive, n, counts in lives for _ in range(n)]:
            tried.counts = dict.fromkeys(tried.counts, counts)
            for name in silent:
                silent[name] = 0.0 if name in alive else silent[name] + counts
                tried.values[name] += name in alive
            ended = tried.ended
            tried.dog.check()
            hangs = {name for name in silent if silent[name] >= CHECKS}
            assert bool(hangs) == bool(tried.dog.trouble)
            assert not hangs or tried.dog.trouble in {f"{name} hangs" for name in hangs}
            assert (tried.ended > ended) == (max(silent.values()) >= 2 * CHECKS)


@linux_only
@pytest.mark.parametrize("address", ["{}/notify", "@onpath-test-{}"])
def test_systemd_hears_from_a_process_at_every_check(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, address: str
) -> None:
    address = address.format(tmp_path)[:100]
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as systemd:
        systemd.bind(address.replace("@", "\0", 1))
        systemd.settimeout(WAIT)
        with Stepped() as tried:
            tried.dog.check()  # nobody asks
            monkeypatch.setenv("NOTIFY_SOCKET", address)
            for _ in range(2):
                tried.dog.check()
                assert systemd.recv(100) == b"WATCHDOG=1"
    with Stepped() as tried:
        tried.dog.check()  # it has gone


class Served(LabProcess):
    """The lab of `HANGING`, which keeps its labs in a file."""

    def __init__(self, folder: Path) -> None:
        self._records = Records(database := f"sqlite:///{folder / 'labs.db'}")
        options = ["--hang-seconds", str(HANG), "--database", database]
        path = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        super().__init__(free_ports(1)[0], options, path, ["-c", HANGING], folder / "log")
        self.wait_until_well()

    def has_kept(self, code: str, word: str) -> bool:
        return word in str(self._records.load(code))

    def end(self) -> None:
        self.kill()
        self._records.close()

    def student(self) -> Student:
        return Student(f"ws://127.0.0.1:{self.port}")


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    served = Served(tmp_path)
    yield served
    served.end()


@pytest.mark.thorough
@linux_only
@pytest.mark.parametrize(
    ("value", "where"), [(401.0, "threading.py"), (403.0, "in hang")], ids=["is locked", "spins"]
)
def test_a_simulation_that_hangs_is_replaced_and_its_labs_go_on(
    served: Served, value: float, where: str
) -> None:
    with served.student() as student:
        student.open()
        student.set("K2", 44.0)
        student.read(lambda: served.has_kept(student.code, "'K2': 44.0"))
        student.set("K1", value)
        wait_for(lambda: served.health() == (503, "the simulation thread hangs\n"))
        assert served.exit_code() == EXIT_CODE
        served.start_again()
        code = student.code
        student.reopen()
        assert student.code == code and student.value("K2") == 44.0
    said = served.said
    assert said.count("the simulation thread hangs: no sign of life for 2 s") == 1
    assert where in said


@pytest.mark.thorough
@linux_only
@pytest.mark.parametrize(
    ("value", "code"),
    [(411.0, EXIT_CODE), (402.0, -signal.SIGPROF), (412.0, -signal.SIGPROF)],
    ids=["the event loop", "the interpreter", "both"],
)
def test_whatever_hangs_ends_the_process(served: Served, value: float, code: int) -> None:
    with served.student() as student:
        student.open()
        student.set("K1", value)
        assert served.exit_code() == code
        served.start_again()
    assert "most recent call first" in served.said  # where each thread was


@pytest.mark.thorough
@linux_only
def test_a_suspended_process_does_not_hang(
    served: Served,
) -> None:
    process = served.process
    with served.student() as student:
        student.open()
        student.read(lambda: student.moving > 10)
        process.send_signal(signal.SIGSTOP)
        time.sleep(2.5 * HANG)  # wall time must pass while the process is suspended
        process.send_signal(signal.SIGCONT)
        moving = student.moving
        student.read(lambda: student.moving > moving + 60)
        assert served.health() == (200, "well\n")
    assert process.poll() is None and "hangs" not in served.said


@pytest.mark.thorough
@linux_only
def test_a_process_that_gets_a_tenth_of_the_machine_does_not_hang(served: Served) -> None:
    """Its labs do dear work meanwhile, and go on afterwards."""
    with served.student() as first, served.student() as second:
        for student in (first, second):
            student.open()
            student.read(lambda student=student: student.moving > 10)
        until, gain = time.monotonic() + STARVED, 40.0
        with starved(served.process.pid):
            for robot in cycle(("two_link_arm", "five_bar")):
                first.tell({"do": "ChooseRobot", "name": robot})
                second.set("K2", gain := gain + 1.0)
                for student in (first, second):
                    later = time.monotonic() + 1.0
                    student.read(lambda later=later: time.monotonic() > later)
                if time.monotonic() > until:
                    break
        moving = first.moving, second.moving
        first.read(lambda: first.moving > moving[0] + 60)
        second.read(lambda: second.moving > moving[1] + 60)
        wait_for(lambda: served.health() == (200, "well\n"))
    assert served.process.poll() is None and "hangs" not in served.said
