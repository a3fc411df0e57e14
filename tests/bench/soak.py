"""A soak: honest simulated browsers use their labs while attackers try everything in turn."""

from __future__ import annotations

import math
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import cycle, islice

from tests.bench.attacks import ATTACKS
from tests.bench.crowd import simulated_crowd
from tests.bench.server_process import Server, serving
from tests.support.checkout import ROOT

LAST_MINUTE = 61.0  # [s] of simulated time; a lab keeps that of the last minute
LONGEST_START = 300.0  # [s] to wait for that
QUIET = 70.0  # [s] after the attacks
ROW = 60.0  # [s], longest row of the table
PLACES = 24  # for labs of attackers
LATEST = 100.0  # [ms], 99th percentile of the lateness of frames
SLOWEST = 20.0  # [Hz], new poses that each honest browser is shown
GROWN = 1.1  # largest memory after the attacks, relative to that before
MOST_LOG = 1e6  # [B]
OPTIONS = ("--classroom",)
HEAD = "time [min] attack             clients  display [Hz]  late p99 [ms]  memory [MB]  log [kB]"


@dataclass(frozen=True, slots=True)
class SoakRow:
    """One row of the table.

    Attributes:
        began: after the start of the table, [s].
        attack: made meanwhile; empty for none.
        honest: number of honest browsers that are still connected.
        slowest_hz: new poses per second, of the slowest honest browser.
        late_ms: 99th percentile of the lateness of frames, [ms].
        memory_mb: resident, of the server, at the end, [MB]; nan if unknown.
        log_bytes: size of the server's output, [B].
    """

    began: float
    attack: str
    honest: int
    slowest_hz: float
    late_ms: float
    memory_mb: float
    log_bytes: int

    def __str__(self) -> str:
        return (
            f"{self.began / 60:10.1f} {self.attack or '-':18s} {self.honest:7d} "
            f"{self.slowest_hz:13.1f} {self.late_ms:14.1f} {self.memory_mb:12.1f} "
            f"{self.log_bytes / 1e3:9.1f}"
        )


def plan(minutes: float) -> tuple[float, list[str]]:
    """Length of a row, [s], and what is tried in each, once memory is constant; empty for nothing.

    Args:
        minutes: duration of the attacks.
    """
    seconds = min(ROW, 60 * minutes / len(ATTACKS))
    quiet = [""] * math.ceil(QUIET / seconds)
    return seconds, [*islice(cycle(ATTACKS), round(60 * minutes / seconds)), *quiet]


def soak(honest: int, minutes: float, environment: Mapping[str, str]) -> Iterator[SoakRow]:
    """The rows of the table, each as soon as it is measured.

    Args:
        honest: number of honest browsers.
        minutes: duration of the attacks.
        environment: additional variables for the server, such as its data folders.

    Raises:
        ValueError: the server does not serve all honest browsers.
    """
    seconds, attacks = plan(minutes)
    with serving(environment, most=honest + PLACES, options=OPTIONS) as server:
        server.at_rest()
        yield from _rows(server, honest, seconds, attacks)


def _rows(server: Server, honest: int, seconds: float, attacks: list[str]) -> Iterator[SoakRow]:
    with (
        simulated_crowd(server, honest, seconds) as seen,
        _attackers(server) as attackers,
    ):
        next(seen)
        simulated, number = 0.0, -1
        while attacks:
            number += 1
            begins = simulated > LAST_MINUTE or number * seconds > LONGEST_START
            attack = attacks.pop(0) if begins else ""
            assert attackers.stdin is not None
            attackers.stdin.write(f"{attack}\n".encode())
            attackers.stdin.flush()
            during = next(seen)
            metrics = server.metrics(max(seconds, 1.0))
            simulated = max(simulated, min(metrics.simulated_s, default=0.0))
            yield SoakRow(
                began=number * seconds,
                attack=attack,
                honest=during.clients,
                slowest_hz=during.slowest_hz,
                late_ms=metrics.late_ms[2],
                memory_mb=metrics.rss_mb or math.nan,
                log_bytes=server.log_bytes(),
            )


@contextmanager
def _attackers(server: Server) -> Iterator[subprocess.Popen[bytes]]:
    command = [sys.executable, "-m", "tests.bench.attacks", str(server.port)]
    with subprocess.Popen(
        command, stdin=subprocess.PIPE, cwd=ROOT, start_new_session=True
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def verdict(rows: Sequence[SoakRow], honest: int) -> list[str]:
    """The bounds that were broken, in words.

    Args:
        honest: number of honest browsers at the beginning.
    """
    attacked = [number for number, row in enumerate(rows) if row.attack]
    before, after = rows[attacked[0] - 1].memory_mb, rows[-1].memory_mb
    gone = [row for row in rows if row.honest < honest or row.slowest_hz == 0]
    late = [row for row in rows if row.attack and row.late_ms > LATEST]
    slow = [row for row in rows if row.attack and 0 < row.slowest_hz < SLOWEST]
    broken = [f"{row.attack or 'nothing'}: an honest browser was not served" for row in gone]
    broken += [f"{row.attack}: frames {row.late_ms:.0f} ms late (p99)" for row in late]
    broken += [f"{row.attack}: {row.slowest_hz:.1f} poses a second" for row in slow]
    if after > GROWN * before:
        broken.append(f"memory: {before:.0f} MB before, {after:.0f} MB after")
    if rows[-1].log_bytes > MOST_LOG:
        broken.append(f"log: {rows[-1].log_bytes / 1e6:.1f} MB")
    return broken
