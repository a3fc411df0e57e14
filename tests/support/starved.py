"""A process that gets a small part of a processor, as on a laptop that shares its screen."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

CGROUPS = Path("/sys/fs/cgroup")
PERIOD = 0.1  # [s]


@contextmanager
def starved(process: int, share: float = 0.1) -> Iterator[None]:
    """Give a process a share of one processor, by a control group if this user may make one.

    Otherwise it is stopped for the rest of the time.
    """
    group = _made_group(f"onpath-{process}", share)
    if group is None:
        with _stopped_by_turns(process, share):
            yield
        return
    (group / "cgroup.procs").write_text(str(process))
    try:
        yield
    finally:
        with suppress(ProcessLookupError):
            (group.parent / "cgroup.procs").write_text(str(process))
        with suppress(OSError):  # its children may still be there
            group.rmdir()


def _made_group(name: str, share: float) -> Path | None:
    period, quota = round(1e6 * PERIOD), round(1e6 * PERIOD * share)
    for parent, limits in (
        (CGROUPS / "cpu", {"cpu.cfs_period_us": f"{period}", "cpu.cfs_quota_us": f"{quota}"}),
        (CGROUPS, {"cpu.max": f"{quota} {period}"}),
    ):
        group = parent / name
        try:
            group.mkdir()
        except OSError:
            continue
        if all((group / limit).exists() for limit in limits):
            for limit, value in limits.items():
                (group / limit).write_text(value)
            return group
        group.rmdir()
    return None


@contextmanager
def _stopped_by_turns(process: int, share: float) -> Iterator[None]:
    over = threading.Event()

    def turns() -> None:
        while not over.is_set():
            os.kill(process, signal.SIGSTOP)
            over.wait(PERIOD * (1 - share))
            os.kill(process, signal.SIGCONT)
            over.wait(PERIOD * share)

    thread = threading.Thread(target=turns, daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()
