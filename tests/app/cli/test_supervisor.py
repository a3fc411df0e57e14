"""A lab that crashes starts again by itself; one that is ended does not."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from onpath.app.cli import main
from onpath.app.cli.serve import Serve
from tests.support.checkout import ROOT
from tests.support.waiting import wait_for

WAIT = 60.0  # [s]; only ends a test that would hang
pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="nothing supervises here")

# Serves by waiting, and notes each life in a file; the second argument is what it does before.
PROGRAM = """
import os, signal, sys, time
from pathlib import Path
from onpath.app.cli import supervisor

def serve(again):
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(3))
    signal.signal(signal.SIGINT, lambda *_: sys.exit(3))
    signal.signal(signal.SIGHUP, lambda *_: sys.exit(3))
    with Path(sys.argv[1]).open("a") as lives:
        print(os.getpid(), again, file=lives)
    exec(sys.argv[2])
    while True:
        time.sleep(0.05)

supervisor.SOON, supervisor.CHECK = float(sys.argv[3]), 0.05
sys.exit(supervisor.supervised(serve))
"""


class Lab:
    """Such a lab, and the processes that have served."""

    def __init__(self, folder: Path, does: str, soon: float, environment: dict[str, str]) -> None:
        self._lives = folder / "lives"
        self.log = folder / "log"
        command = [sys.executable, "-c", PROGRAM, str(self._lives), does, str(soon)]
        given = {key: value for key, value in os.environ.items() if key != "NOTIFY_SOCKET"}
        with self.log.open("wb") as log:
            self.parent = subprocess.Popen(command, cwd=ROOT, env=given | environment, stderr=log)

    @property
    def lives(self) -> list[int]:
        return [int(line.split()[0]) for line in self._lines]

    @property
    def told(self) -> list[str]:
        """Whether each life was told that another was before it."""
        return [line.split()[1] for line in self._lines]

    @property
    def _lines(self) -> list[str]:
        return self._lives.read_text("ascii").splitlines() if self._lives.exists() else []

    def life(self, number: int) -> int:
        """The process of a life, which may have to begin."""
        wait_for(lambda: len(self.lives) > number, WAIT)
        return self.lives[number]

    def code(self) -> int:
        return self.parent.wait(WAIT)


def is_gone(process: int) -> bool:
    """Whether a process has ended; its parent may not have been told."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    state = Path(f"/proc/{process}/stat")
    return state.exists() and state.read_text("ascii").rpartition(")")[2].split()[0] == "Z"


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Callable[..., Lab]]:
    labs = list[Lab]()

    def make(does: str = "", soon: float = 0.0, **environment: str) -> Lab:
        labs.append(Lab(tmp_path, does, soon, environment))
        return labs[-1]

    yield make
    for each in labs:
        each.parent.kill()
        each.parent.wait()
        for process in each.lives:
            with suppress(ProcessLookupError):
                os.kill(process, signal.SIGKILL)


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_a_lab_that_is_killed_starts_again_until_it_is_ended(
    lab: Callable[..., Lab], end: signal.Signals
) -> None:
    under_nohup = signal.signal(signal.SIGHUP, signal.SIG_DFL)  # perhaps; then it would be ignored
    made = lab()
    signal.signal(signal.SIGHUP, under_nohup)
    for number in range(3):
        os.kill(made.life(number), signal.SIGKILL)
    last = made.life(3)
    made.parent.send_signal(end)
    assert made.code() == 3 and is_gone(last) and len(made.lives) == 4
    assert made.log.read_text("utf-8").count("it starts again") == 3
    assert made.told == ["False", "True", "True", "True"]


def test_a_lab_that_is_told_to_end_all_the_time_ends_once(lab: Callable[..., Lab]) -> None:
    made = lab()
    made.life(0)
    while made.parent.poll() is None:
        made.parent.terminate()
    assert made.code() == 3 and len(made.lives) == 1
    assert "Traceback" not in made.log.read_text("utf-8")


def test_a_lab_in_a_terminal_that_may_be_closed_goes_on(lab: Callable[..., Lab]) -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as `nohup` does
    try:
        made = lab()
    finally:
        signal.signal(signal.SIGHUP, before)
    made.life(0)
    made.parent.send_signal(signal.SIGHUP)
    made.parent.terminate()
    assert made.code() == 3 and len(made.lives) == 1


def test_a_lab_that_hung_starts_again(lab: Callable[..., Lab]) -> None:
    made = lab("len(Path(sys.argv[1]).read_text().splitlines()) > 2 or os._exit(os.EX_SOFTWARE)")
    made.life(2)
    made.parent.terminate()
    assert made.code() == 3 and len(made.lives) == 3


@pytest.mark.parametrize("code", [0, 1, 2, 130])
def test_a_lab_that_ends_by_itself_does_not_start_again(lab: Callable[..., Lab], code: int) -> None:
    made = lab(f"sys.exit({code})")
    assert made.code() == code and len(made.lives) == 1


def test_a_lab_that_crashes_as_soon_as_it_starts_does_not_do_it_again(
    lab: Callable[..., Lab],
) -> None:
    made = lab("os.kill(os.getpid(), signal.SIGSEGV)", WAIT)
    assert made.code() == 128 + signal.SIGSEGV and len(made.lives) == 1


def test_a_lab_ends_with_its_parent(lab: Callable[..., Lab]) -> None:
    made = lab()
    served = made.life(0)
    made.parent.kill()
    wait_for(lambda: is_gone(served), WAIT)


def test_where_something_else_supervises_the_process_itself_serves(
    lab: Callable[..., Lab],
) -> None:
    made = lab(NOTIFY_SOCKET="/nowhere")
    assert made.life(0) == made.parent.pid


def test_a_lab_that_starts_again_opens_no_further_tab(monkeypatch: pytest.MonkeyPatch) -> None:
    opens = list[bool]()
    monkeypatch.setattr(Serve, "run", lambda self: opens.append(self.open))
    monkeypatch.setattr(main, "supervised", lambda serve: serve(False) + serve(True))
    monkeypatch.setattr(sys, "argv", ["onpath", "--open"])
    with pytest.raises(SystemExit, match="0"):
        main.main()
    assert opens == [True, False]
