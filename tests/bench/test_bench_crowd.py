"""The crowd benchmark: a real server, real websockets, and plausible numbers."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

from onpath.app.server.admission_queue import AdmissionQueue
from tests.bench.__main__ import run_command
from tests.bench.crowd import HEAD, MOST, ClientLoad, folders, measured, places_for
from tests.bench.server_process import serving
from tests.support.checkout import ROOT
from tests.support.waiting import wait_for

CLIENTS, SECONDS = 3, 1.0


@pytest.mark.thorough
def test_a_small_crowd_on_a_real_server(tmp_path: Path) -> None:
    crowd = ClientLoad(CLIENTS, SECONDS, rows=2)
    rows = list(measured(crowd, folders(tmp_path, "data")))
    assert len(rows) == 2
    for row in rows:
        seen = row.seen
        assert seen.clients == CLIENTS == row.labs
        assert seen.seconds > 0.9 * SECONDS and row.settled > 0
        assert 0 < row.simulation_hz < 62 and 0 < row.slowest_lab < 1.1  # low on a busy machine
        assert 0 < seen.slowest_hz <= seen.median_hz < 62
        p50, p95, p99 = row.late_ms
        assert p50 <= p95 <= p99 and 0 <= row.overdue <= 1
        assert (row.overdue < 0.01) == (p99 <= 50)
        assert 0 < row.cpu < 4 and 0 < seen.cpu < 4
        assert seen.bytes_per_s > 1e3 and 1 < row.processor.step_ns < 1e4
        if sys.platform == "linux":
            assert 0 < row.memory_mb < 100 and 0 <= row.processor.stolen < 1
        assert len(str(row).rpartition(" ")[0]) == len(HEAD.splitlines()[1])
    assert (tmp_path / "data" / "onpath" / "onpath.db").exists()


def test_a_measured_server_admits_all_clients_from_one_address() -> None:
    for clients in range(1, MOST + 1):
        queue, inside = AdmissionQueue(places_for(clients)), list[int]()
        for number in range(clients):
            queue.admit(
                number,
                enter=lambda n=number: inside.append(n),
                wait=lambda *_: None,
                address="127.0.0.1",
                always=False,
            )
        assert inside == list(range(clients))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--clients 0", "--clients 0: expected 1 to 300"),
        ("--clients 3 1000", "--clients 1000: expected 1 to 300"),
        ("--clients -1", "--clients"),
        ("--clients 1 --seconds 0", "--seconds 0: expected 1 to 60"),
        ("--clients 1 --seconds nan", "--seconds nan: expected 1 to 60"),
        ("--clients 1 --minutes -1", "--minutes -1: expected 1 or more"),
        ("--clients 1 --quick", "--quick"),
        ("--minutes 2", "go with --clients"),
    ],
)
def test_what_cannot_be_measured_is_refused_in_words(
    options: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(options.split()) == 2
    out = capsys.readouterr()
    assert said in out.err and out.err.count("\n") == 1 and not out.out


def processes_of(folder: Path) -> list[str]:
    """What runs and was told of that folder."""
    found: list[str] = []
    for told in Path("/proc").glob("[0-9]*/environ"):
        try:
            if str(folder).encode() in told.read_bytes():
                found.append((told.parent / "cmdline").read_text().replace("\0", " "))
        except OSError:  # it has ended, or is not ours
            continue
    return found


def has_browsers(folder: Path) -> bool:
    """Whether a bench that was told of that folder simulates browsers that are connected by now.

    One that is stopped while a process begins cannot know of that yet.
    """
    named = [p for p in processes_of(folder) if "tests.bench.simulated_browser" in p]
    ports = [f":{int(process.split()[-3]):04X} 01" for process in named]  # 01: established
    return bool(ports) and ports[0] in Path("/proc/net/tcp").read_text(encoding="utf-8")


@pytest.mark.thorough
@pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
def test_stopping_a_bench_stops_its_server(tmp_path: Path) -> None:
    """Both at once: each waits until its server is at rest before its browsers come."""
    command = [sys.executable, "-m", "tests.bench", "--clients", "2", "--seconds", "60"]
    pipe = subprocess.PIPE
    with ExitStack() as started:
        benches: dict[signal.Signals, tuple[Path, subprocess.Popen[bytes]]] = {}
        for how in (signal.SIGINT, signal.SIGTERM):
            folder = tmp_path / how.name
            folder.mkdir()
            environment = {**os.environ, "TMPDIR": str(folder)}
            bench = subprocess.Popen(command, cwd=ROOT, env=environment, stdout=pipe, stderr=pipe)
            benches[how] = folder, started.enter_context(bench)
            started.callback(bench.kill)
        for how, (folder, bench) in benches.items():
            wait_for(lambda b=bench, f=folder: b.poll() is not None or has_browsers(f), 120.0)
            assert bench.poll() is None
            assert any("serve" in each for each in processes_of(folder))
            bench.send_signal(how)
        for folder, bench in benches.values():
            _, said = bench.communicate(timeout=60.0)
            assert bench.returncode == 130 and said == b""
            assert not processes_of(folder) and not list(folder.iterdir())


def test_a_server_that_ends_says_why(tmp_path: Path) -> None:
    environment = folders(tmp_path, "data")
    with (
        serving(environment, most=0) as server,
        pytest.raises(ValueError, match=r"ended: .*--most-clients 0: expected 1 or more"),
    ):
        server.metrics()
