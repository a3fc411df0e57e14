"""How a server process fares, in numbers: what /health tells. Nothing in it is of a person."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import parse_qs

import msgspec

from onpath.app.simulation.simulation_thread import SimulationThread

WINDOW, LONGEST = 10.0, 60.0  # [s] looked back at: usually, at most
OVERDUE = 0.05  # [s] late
QUANTILES = (0.5, 0.95, 0.99)
MEMORY = Path("/proc/self/statm")  # Linux alone


@dataclass(frozen=True, slots=True)
class Metrics:
    """Of one process.

    Attributes:
        pid: which process.
        clock: when this was, [s]; of use only together with another `clock` of this machine.
        frames_per_s: of the simulation thread, lately.
        late_ms: frames, lately: half of them are less late than the first, 95 % than the second,
            99 % than the third.
        overdue: share of them that are more than 50 ms late.
        labs: that somebody looks at now.
        simulated_s: by each of these since it was set back last, [s], in the order of coming.
        cpu_s: spent since the process began, [s].
        rss_mb: of memory, now, [MB]; None where the system does not tell.
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


def asked_vitals(simulation: SimulationThread, query: str) -> str:
    """The vitals as JSON.

    Args:
        query: of the address: "seconds=20" to look back further; nonsense is ignored.
    """
    try:
        seconds = float(parse_qs(query)["seconds"][0])
    except (KeyError, ValueError):
        seconds = WINDOW
    seconds = seconds if 1.0 <= seconds <= LONGEST else WINDOW
    return msgspec.json.encode(vitals(simulation, seconds)).decode() + "\n"


def vitals(simulation: SimulationThread, seconds: float = WINDOW) -> Metrics:
    """How this process fares; `seconds` are looked back at."""
    now = time.perf_counter()
    frames = simulation.frames.copy()
    since = max(now - seconds, frames[0][0]) if frames else now
    late = sorted(late for began, late in frames if began > since)
    p50, p95, p99 = (_quantile_ms(late, part) for part in QUANTILES)
    seen = [lab for lab in simulation.labs if lab.view is not None]
    return Metrics(
        pid=os.getpid(),
        clock=round(now, 4),
        frames_per_s=round(len(late) / max(now - since, 0.1), 2),
        late_ms=(p50, p95, p99),
        overdue=round(sum(each > OVERDUE for each in late) / max(len(late), 1), 5),
        labs=len(seen),
        simulated_s=tuple(round(lab.session.time, 3) for lab in seen),
        cpu_s=round(time.process_time(), 3),
        rss_mb=_resident(),
    )


def _quantile_ms(ordered: list[float], part: float) -> float:
    return round(1e3 * ordered[int(part * len(ordered))], 3) if ordered else 0.0


def _resident() -> float | None:
    try:
        pages = int(MEMORY.read_text().split()[1])
    except OSError:
        return None
    return round(pages * os.sysconf("SC_PAGE_SIZE") / 1e6, 2)
