"""Notices when the simulation thread or the event loop hangs, and ends the process.

Whatever supervises the process starts it again: systemd, Kubernetes, a container's restart policy,
or `app.cli.supervisor`. A process that only gets too little of the processor does not hang.
"""

from __future__ import annotations

import asyncio
import faulthandler
import logging
import os
import signal
import socket
import sys
import threading
from collections import defaultdict
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

from onpath.app.common.periodic import Periodic
from onpath.app.server.processor_time import ProcessorTime
from onpath.app.simulation.simulation_thread import SimulationThread

log = logging.getLogger(__name__)

EXIT_CODE = getattr(os, "EX_SOFTWARE", 70)  # which Windows does not have
CHECKS = 20  # in a row without a sign of life, after which a thread counts as hanging
BEAT = 0.1  # [s] between an event loop's signs of life


@dataclass(frozen=True, slots=True)
class Sign:
    """A sign of life of one thread.

    Attributes:
        value: returns what keeps changing while the thread works.
        thread: returns its native id.
    """

    value: Callable[[], object]
    thread: Callable[[], int]


class SilenceClock(Protocol):
    """See `ProcessorTime`."""

    def check(self) -> None:
        """Begin another interval."""
        ...

    def counted(self, thread: int, most: float) -> float:
        """How much of the last interval counts for a silent thread, [s]."""
        ...


class Watchdog:
    """Watches signs of life.

    Silence is counted as `ProcessorTime` does. A suspended process is suspended together with its
    watchdog, so it has missed at most one check.

    Args:
        seconds: time without a sign of life after which something counts as hanging, [s]; after
            twice this time the process ends. 0 for no watch.
        end: ends the process.
        clock: counts silence.

    Attributes:
        trouble: a sentence about what hangs; empty if nothing does.
    """

    def __init__(
        self,
        seconds: float,
        end: Callable[[], object] | None = None,
        clock: SilenceClock | None = None,
    ) -> None:
        self._seconds, self._end = seconds, end or _end_process
        self._clock: SilenceClock = clock or ProcessorTime()
        self._signs: Mapping[str, Sign] = {}
        self._seen: dict[str, object] = {}
        self._silent = defaultdict[str, float](float)  # [s] since the last sign of life
        self._checks = Periodic("watchdog", seconds / CHECKS, self.check)
        self.trouble = ""

    def start(self, signs: Mapping[str, Sign]) -> None:
        """Watch these signs of life, each by the name of its source."""
        if not self._seconds:
            return
        self._signs = signs
        if hasattr(signal, "SIGPROF"):
            faulthandler.register(signal.SIGPROF, chain=True)
        self._checks.start()

    def stop(self) -> None:
        """End the watch."""
        self._checks.stop()
        _limit_processor_time(0.0)

    def check(self) -> None:
        """Look once at all signs of life."""
        _limit_processor_time(2 * self._seconds)
        _tell_systemd()
        self._clock.check()
        for name, sign in self._signs.items():
            seen = sign.value()
            if seen == self._seen.get(name):
                self._silent[name] += self._clock.counted(sign.thread(), self._seconds / CHECKS)
            else:
                self._silent[name] = 0.0
            self._seen[name] = seen
        name, silent = max(self._silent.items(), key=lambda each: each[1])
        before, self.trouble = self.trouble, f"{name} hangs" if silent >= self._seconds else ""
        if self.trouble and not before:
            log.critical(
                "%s: no sign of life for %g s; without one in the next %g s this process ends",
                self.trouble,
                self._seconds,
                self._seconds,
            )
        elif before and not self.trouble:
            log.warning("%s no longer", before)
        if silent >= 2 * self._seconds:
            self._end()


def signs_of_life(
    simulation_thread: SimulationThread, loop: asyncio.AbstractEventLoop
) -> dict[str, Sign]:
    """The frame count of a simulation thread, and a count that an event loop increments."""
    count = network = 0

    def beat() -> None:
        nonlocal count, network
        count += 1
        network = threading.get_native_id()
        loop.call_later(BEAT, beat)

    loop.call_soon_threadsafe(beat)
    return {
        "the simulation thread": Sign(
            lambda: simulation_thread.frames.count, lambda: simulation_thread.thread.native_id or 0
        ),
        "the event loop": Sign(lambda: count, lambda: network),
    }


def _limit_processor_time(seconds: float) -> None:
    """End the process by SIGPROF after this processor time, unless called again; 0 for never.

    This ends a process in which one thread never releases the interpreter, so that the watchdog
    cannot look. A suspended process uses no processor time.
    """
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_PROF, seconds)


def _tell_systemd() -> None:
    """Tell systemd that this process is not suspended, if its unit has WatchdogSec."""
    address = os.environ.get("NOTIFY_SOCKET", "")
    if address:  # systemd is there, and so are Unix sockets
        with suppress(OSError), socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as to:
            to.sendto(b"WATCHDOG=1", address.replace("@", "\0", 1))


def _end_process() -> None:
    """End the process at once, without waiting for threads, and print where each of them is.

    On Windows nobody would start it again: there, what hangs is only said.
    """
    if hasattr(os, "fork"):
        faulthandler.dump_traceback(sys.stderr)
        os._exit(EXIT_CODE)
