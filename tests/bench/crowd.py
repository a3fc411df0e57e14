"""Load test: a server process, and another process with simulated browsers.

The server uses temporary data folders. Measurement begins when every browser is shown moving
robots.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from math import nan
from pathlib import Path

import msgspec

from onpath.app.server.admission_queue import RESERVED
from onpath.app.simulation.metrics import LONGEST, Metrics
from onpath.app.viser_adapter.limits import Limits
from tests.bench.processor import Processor, watched_processor
from tests.bench.server_process import Server, serving
from tests.bench.simulated_browser import Observations
from tests.support.checkout import ROOT

MOST = Limits().max_connections_each  # clients; the server sees them at one address
SHORTEST = 1.0  # [s]
HEAD = """\
clients settled  sim slow display [Hz] frames late [ms] >50ms      CPU [%]      loop for each  labs
            [s] [Hz]  lab slowest med.  p50   p95   p99   [%] server load stolen [ns] [MB] [kB/s]"""


@dataclass(frozen=True, slots=True)
class ClientLoad:
    """What to measure.

    Attributes:
        clients: number of them.
        seconds: duration of each row, [s].
        rows: number of consecutive rows with the same clients.

    Raises:
        ValueError: a number is out of range.
    """

    clients: int
    seconds: float = 15.0
    rows: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.clients <= MOST:
            raise ValueError(f"--clients {self.clients}: expected 1 to {MOST}")
        if not SHORTEST <= self.seconds <= LONGEST:
            raise ValueError(f"--seconds {self.seconds:g}: expected {SHORTEST:g} to {LONGEST:g}")


@dataclass(frozen=True, slots=True)
class Row:
    """The result of one measurement.

    Attributes:
        seen: what the browsers observed.
        settled: time until all were shown moving robots, [s].
        labs: number of labs.
        simulation_hz: frames per second of the simulation.
        slowest_lab: simulated seconds per second.
        late_ms: lateness of frames, three quantiles, [ms].
        overdue: share of the frames more than 50 ms late.
        cpu: of the server, in cores.
        processor: of this machine.
        memory_mb: increase of the server's memory, per client, [MB]; nan if unknown.
    """

    seen: Observations
    settled: float
    labs: int
    simulation_hz: float
    slowest_lab: float
    late_ms: tuple[float, float, float]
    overdue: float
    cpu: float
    processor: Processor
    memory_mb: float

    def __str__(self) -> str:
        seen, labs, processor = self.seen, self.labs, self.processor
        p50, p95, p99 = self.late_ms
        return (
            f"{seen.clients:7d}{self.settled:8.1f}{self.simulation_hz:5.1f}{self.slowest_lab:5.2f}"
            f"{seen.slowest_hz:8.1f}{seen.median_hz:5.1f}{p50:5.1f}{p95:6.1f}{p99:6.1f}"
            f"{100 * self.overdue:6.2f}{100 * self.cpu:7.0f}{100 * seen.cpu:5.0f}"
            f"{100 * processor.stolen:7.1f}{processor.step_ns:5.0f}"
            f"{self.memory_mb:5.2f}{seen.bytes_per_s / 1e3:7.1f} {labs}"
        )


def measured(crowd: ClientLoad, environment: Mapping[str, str]) -> Iterator[Row]:
    """Rows, each as soon as it is measured.

    Args:
        environment: additional variables for the server, such as its data folders.

    Raises:
        ValueError: the server does not serve all clients.
    """
    with serving(environment, places_for(crowd.clients)) as server:
        alone = server.at_rest()
        with (
            simulated_crowd(server, crowd.clients, crowd.seconds) as seen,
            watched_processor() as processor,
        ):
            settled, before = next(seen).seconds, server.metrics()
            processor()
            for _ in range(crowd.rows):
                during = next(seen)
                after = server.metrics(crowd.seconds)
                yield _row(during, settled, processor(), alone, before, after)
                before = after


def places_for(clients: int) -> int:
    """Places of a server that admits so many clients of one address; see `AdmissionQueue`."""
    return clients * RESERVED // (RESERVED - 1) + 1


def folders(folder: Path, name: str) -> dict[str, str]:
    """Environment variables with a data folder of its own."""
    return {"XDG_DATA_HOME": str(folder / name)}


@contextmanager
def simulated_crowd(
    server: Server, clients: int, seconds: float
) -> Iterator[Iterator[Observations]]:
    """What the browsers observe: first when all have settled, then every `seconds`."""
    command = [
        sys.executable,
        "-m",
        "tests.bench.simulated_browser",
        *map(str, (server.port, clients, seconds)),
    ]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, stdout=pipe, stderr=pipe, cwd=ROOT, start_new_session=True
    ) as process:
        try:
            yield _lines(process)
        finally:
            process.kill()


def _lines(process: subprocess.Popen[bytes]) -> Iterator[Observations]:
    assert process.stdout is not None and process.stderr is not None
    for line in process.stdout:
        yield msgspec.json.decode(line, type=Observations)
    said = process.stderr.read().decode(errors="replace").strip()
    raise ValueError(said.rpartition("\n")[2] or "the simulated browsers have ended")


def _row(
    seen: Observations,
    settled: float,
    processor: Processor,
    alone: Metrics,
    before: Metrics,
    after: Metrics,
) -> Row:
    grown = (after.rss_mb or nan) - (alone.rss_mb or nan)
    return Row(
        seen=seen,
        settled=settled,
        labs=after.labs,
        simulation_hz=after.frames_per_s,
        slowest_lab=min(_speeds(before, after), default=nan),
        late_ms=after.late_ms,
        overdue=after.overdue,
        cpu=(after.cpu_s - before.cpu_s) / (after.clock - before.clock),
        processor=processor,
        memory_mb=grown / max(seen.clients, 1),
    )


def _speeds(before: Metrics, after: Metrics) -> list[float]:
    """Simulated seconds per second of each lab; nan if a lab was added or removed."""
    if before.labs != after.labs:
        return [nan]
    times = zip(before.simulated_s, after.simulated_s, strict=True)
    return [(b - a) / (after.clock - before.clock) for a, b in times]
