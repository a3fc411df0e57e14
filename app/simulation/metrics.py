"""Performance metrics of a server process, served at /health. Contains no personal data."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qs

import msgspec

from onpath.app.simulation.simulation_thread import SimulationThread

WINDOW, LONGEST = 10.0, 60.0  # [s], length of the measured interval: default and maximum
OVERDUE = 0.05  # [s] of lateness from which a frame counts as overdue
QUANTILES = (0.5, 0.95, 0.99)
MEMORY = Path("/proc/self/statm")  # Linux only


@dataclass(frozen=True, slots=True)
class Metrics:
    """Metrics of one process.

    Attributes:
        pid: process id.
        clock: time of the measurement, [s]; comparable only with clocks of the same machine.
        frames_per_s: recent frame rate of the simulation thread.
        late_ms: median, 95th and 99th percentile of the lateness of recent frames, [ms].
        overdue: share of recent frames that are more than 50 ms late.
        labs: number of labs that have a viewer now.
        simulated_s: simulated time of each of them since its last reset, [s], oldest lab first.
        cpu_s: CPU time of the process, [s].
        rss_mb: resident memory, [MB]; None if the system does not report it.
    """

    pid: int
    clock: float
    frames_per_s: float
    late_ms: tuple[float, float, float]
    overdue: float
    labs: int
    simulated_s: tuple[float, ...]
    cpu_s: float
    rss_mb: float | None


def metrics_json(thread: SimulationThread, query: str) -> str:
    """The metrics as JSON.

    Args:
        query: query string; "seconds=20" sets the interval; invalid queries are ignored.
    """
    try:
        seconds = float(parse_qs(query)["seconds"][0])
    except (KeyError, ValueError):
        seconds = WINDOW
    seconds = seconds if 1.0 <= seconds <= LONGEST else WINDOW
    return msgspec.json.encode(measure_metrics(thread, seconds)).decode() + "\n"


def measure_metrics(thread: SimulationThread, seconds: float = WINDOW) -> Metrics:
    """Measure this process over the last `seconds`."""
    now = time.perf_counter()
    began, lateness = thread.frames.latest().T
    since = max(now - seconds, float(began[0])) if len(began) else now
    late = sorted(lateness[began > since].tolist())
    p50, p95, p99 = (_quantile_ms(late, part) for part in QUANTILES)
    seen = [lab for lab in thread.labs if lab.display is not None]
    return Metrics(
        pid=os.getpid(),
        clock=round(now, 4),
        frames_per_s=round(len(late) / max(now - since, 0.1), 2),
        late_ms=(p50, p95, p99),
        overdue=round(sum(each > OVERDUE for each in late) / max(len(late), 1), 5),
        labs=len(seen),
        simulated_s=tuple(round(lab.simulation.time, 3) for lab in seen),
        cpu_s=round(time.process_time(), 3),
        rss_mb=_resident(),
    )


def _quantile_ms(ordered: list[float], part: float) -> float:
    return round(1e3 * ordered[int(part * len(ordered))], 3) if ordered else 0.0


def _resident() -> float | None:
    try:
        pages = int(MEMORY.read_text("ascii").split()[1])
    except OSError:
        return None
    return round(pages * os.sysconf("SC_PAGE_SIZE") / 1e6, 2)
