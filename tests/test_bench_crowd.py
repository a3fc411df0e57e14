"""The bench of a crowd: a real server, real websockets, and numbers that can be."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from app.bench_crowd import HEAD, Crowd, folders, measured
from app.bench_server import serving
from app.cli import run_command

CLIENTS, SECONDS = 3, 1.0
WORKERS = 2 if sys.platform == "linux" else 1


def test_a_small_crowd_on_a_real_server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CC", "none")
    crowd = Crowd(CLIENTS, WORKERS, SECONDS, rows=2)
    rows = list(measured(crowd, folders(tmp_path, "data")))
    assert len(rows) == 2
    for row in rows:
        seen = row.seen
        assert seen.clients == CLIENTS == sum(row.labs) and len(row.labs) == WORKERS
        assert seen.seconds == pytest.approx(SECONDS, abs=1.0) and row.settled > 0
        assert 10 < row.simulation_hz < 62 and 0.1 < row.slowest_lab < 1.1
        assert 1 < seen.slowest_hz <= seen.median_hz < 62
        p50, p95, p99 = row.late_ms
        assert p50 <= p95 <= p99
        assert 0 < row.cpu < 4 and 0 < seen.cpu < 4
        assert seen.bytes_per_s > 1e3
        if sys.platform == "linux":
            assert 0 < row.memory_mb < 100
        assert len(str(row).rstrip()) < len(HEAD.splitlines()[0])
    assert (tmp_path / "data" / "onpath" / "onpath.db").exists()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--clients 0", "--clients 0: expected 1 to 900"),
        ("--clients 3 1000", "--clients 1000: expected 1 to 900"),
        ("--clients -1", "--clients"),
        ("--clients x", "--clients"),
        ("--clients 1 --workers 0", "--workers 0: expected 1 to 64"),
        ("--clients 1 --seconds 0", "--seconds 0: expected 1 to 60"),
        ("--clients 1 --seconds nan", "--seconds nan: expected 1 to 60"),
        ("--clients 1 --minutes -1", "--minutes -1: expected 1 or more"),
        ("--clients 1 --quick", "--quick"),
        ("--workers 2", "go with --clients"),
        ("--minutes 2", "go with --clients"),
    ],
)
def test_what_cannot_be_measured_is_refused_in_words(
    options: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_command(["bench", *options.split()]) == 2
    out = capsys.readouterr()
    assert said in out.err and out.err.count("\n") == 1 and not out.out


def test_a_server_that_ends_says_why(tmp_path: Path) -> None:
    environment = folders(tmp_path, "data")
    with (
        serving(environment, most=0) as server,
        pytest.raises(ValueError, match=r"ended: .*--most-clients 0: expected 1 or more"),
    ):
        server.vitals()
