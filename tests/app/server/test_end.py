"""How a server ends: what was changed last is stored, and nothing is logged that went wrong."""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from onpath.app.storage.records import Records
from tests.support.lab_process import LabProcess, free_ports
from tests.support.student import Student
from tests.support.waiting import wait_for

pytestmark = [
    pytest.mark.thorough,
    pytest.mark.skipif(sys.platform == "win32", reason="no such signals"),
]

WAIT = 60.0  # [s]; only ends a test that would hang
SIGNALS = pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM])


@pytest.fixture
def served(tmp_path: Path) -> Iterator[LabProcess]:
    database = f"sqlite:///{tmp_path / 'labs.db'}"
    under_nohup = signal.signal(signal.SIGHUP, signal.SIG_DFL)  # perhaps; then it would be ignored
    made = LabProcess(free_ports(1)[0], ["--database", database], log=tmp_path / "log")
    signal.signal(signal.SIGHUP, under_nohup)
    made.wait_until_well()
    yield made
    made.kill()


def has_ended(served: LabProcess, end: signal.Signals) -> bool:
    """Whether it has ended; if not, it gets the signal once more."""
    if served.process.poll() is None:
        served.process.send_signal(end)
    return served.process.poll() is not None


def workers(served: LabProcess) -> str:
    """Ids of its child processes."""
    lists = Path(f"/proc/{served.process.pid}/task").glob("*/children")
    return "".join(each.read_text() for each in lists)


@pytest.mark.parametrize("end", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_however_often_it_is_told_to_end_the_last_change_is_stored(
    served: LabProcess, tmp_path: Path, end: signal.Signals
) -> None:
    with Student(f"ws://127.0.0.1:{served.port}") as student:
        student.open()
        student.settle("K2", 44.0)
        wait_for(lambda: has_ended(served, end), WAIT)
    assert served.exit_code() == 0
    records = Records(f"sqlite:///{tmp_path / 'labs.db'}")
    assert "'K2': 44.0" in str(records.load(student.code))
    records.close()
    assert "Traceback" not in served.said


@SIGNALS
def test_a_file_that_is_being_made_is_given_up_without_a_complaint(
    served: LabProcess, end: signal.Signals
) -> None:
    with Student(f"ws://127.0.0.1:{served.port}") as student:
        student.open()
        student.read(lambda: student.moving > 10)
        student.tell({"is": "make", "file": "picture"})
        wait_for(lambda: workers(served), WAIT)
        served.process.send_signal(end)
        assert served.exit_code() == 0
    assert "Traceback" not in served.said and "ERROR" not in served.said
