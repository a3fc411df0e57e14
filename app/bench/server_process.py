"""A real server for the bench: started like a user's, queried for its metrics, and stopped."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException
from typing import IO

import msgspec

from onpath.app.server.lazy_imports import REST
from onpath.app.simulation.metrics import WINDOW, Metrics
from onpath.app.viser_adapter.request_filter import HEALTH

PATIENCE = 60.0  # [s] until all workers must have answered
LAST_WORDS = 20.0  # [s] that the server has to stop
STILL = 0.5  # [MB], largest growth of a server at rest


@dataclass(frozen=True, slots=True)
class Server:
    """A running server.

    Attributes:
        port: at which it listens.
        workers: number of its processes.
        begun: time at which it was started, by `time.monotonic`, [s].
        process: the server, or the parent of the workers.
        said: its output.
    """

    port: int
    workers: int
    begun: float
    process: subprocess.Popen[bytes]
    said: IO[bytes]

    def metrics(self, seconds: float = WINDOW) -> dict[int, Metrics]:
        """Metrics of each worker, by process id.

        New connections go to the least-loaded worker; so connections to those that have answered
        are held open until all have.

        Raises:
            ValueError: some do not answer.
        """
        with ExitStack() as held:
            return self._metrics(seconds, held)

    def _metrics(self, seconds: float, held: ExitStack) -> dict[int, Metrics]:
        reported: dict[int, Metrics] = {}
        until, trouble = time.monotonic() + PATIENCE, ""
        while len(reported) < self.workers:
            if self.process.poll() is not None:
                self.said.seek(0)
                said = self.said.read().decode(errors="replace").strip()
                raise ValueError("the server has ended: " + said.rpartition("\n")[2])
            if time.monotonic() > until:
                raise ValueError(
                    f"{len(reported)} of {self.workers} workers say how they are{trouble}"
                )
            try:
                measured = self._ask(seconds)
                if measured.pid in reported:
                    held.enter_context(socket.create_connection(("127.0.0.1", self.port)))
                reported[measured.pid] = measured
            except (OSError, HTTPException, msgspec.DecodeError) as error:
                trouble = f": {error}"
                time.sleep(0.05)
        return reported

    def _ask(self, seconds: float) -> Metrics:
        connection = HTTPConnection("127.0.0.1", self.port, timeout=10.0)
        try:
            connection.request("GET", f"{HEALTH}?seconds={seconds:g}")
            return msgspec.json.decode(connection.getresponse().read(), type=Metrics)
        finally:
            connection.close()

    def log_bytes(self) -> int:
        """Size of its output so far, [B]."""
        return os.fstat(self.said.fileno()).st_size

    def at_rest(self) -> dict[int, Metrics]:
        """Metrics before any client has come, after `warm_up` has finished."""
        sizes: list[tuple[float, float]] = []
        while True:
            measured, now = self.metrics(), time.monotonic()
            sizes.append((now, sum(each.rss_mb or 0.0 for each in measured.values())))
            lately = [size for when, size in sizes if when > now - REST - 1.0]
            if len(lately) < len(sizes) and max(lately) - min(lately) < STILL:
                return measured
            time.sleep(0.3)


@contextmanager
def serving(
    environment: Mapping[str, str],
    workers: int = 1,
    most: int = 64,
    options: Sequence[str] = ("--log-level", "error"),
) -> Iterator[Server]:
    """A running server; each worker takes `most` clients."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    command = [sys.executable, "-m", "onpath", "serve", "--port", str(port)]
    command += ["--workers", str(workers), "--most-clients", str(most), *options]
    with tempfile.TemporaryFile() as said:
        begun = time.monotonic()
        process = subprocess.Popen(
            command, env={**os.environ, **environment}, stdout=said, stderr=said
        )
        try:
            yield Server(port, workers, begun, process, said)
        finally:
            _stop(process)


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(LAST_WORDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
