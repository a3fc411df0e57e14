"""A real server for the bench: started like a user's, queried for its metrics, and stopped."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from http.client import HTTPConnection, HTTPException
from typing import IO

import msgspec

from onpath.app.server.warm_up import REST
from onpath.app.simulation.metrics import WINDOW, Metrics
from onpath.app.viser_adapter.request_filter import HEALTH

PATIENCE = 60.0  # [s] until it must have answered
LAST_WORDS = 20.0  # [s] that the server has to stop
STILL = 0.5  # [MB], largest growth of a server at rest


@dataclass(frozen=True, slots=True)
class Server:
    """A running server.

    Attributes:
        port: at which it listens.
        begun: time at which it was started, by `time.monotonic`, [s].
        process: the server.
        said: its output.
    """

    port: int
    begun: float
    process: subprocess.Popen[bytes]
    said: IO[bytes]

    def metrics(self, seconds: float = WINDOW) -> Metrics:
        """Its metrics.

        Raises:
            ValueError: it does not answer.
        """
        until = time.monotonic() + PATIENCE
        while True:
            if self.process.poll() is not None:
                self.said.seek(0)
                said = self.said.read().decode(errors="replace").strip()
                raise ValueError("the server has ended: " + said.rpartition("\n")[2])
            try:
                return self._ask(seconds)
            except (OSError, HTTPException, msgspec.DecodeError) as error:
                if time.monotonic() > until:
                    raise ValueError(f"the server does not say how it is: {error}") from None
                time.sleep(0.05)

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

    def at_rest(self) -> Metrics:
        """Metrics before any client has come, after `warm_up` has finished."""
        sizes: list[tuple[float, float]] = []
        while True:
            measured, now = self.metrics(), time.monotonic()
            sizes.append((now, measured.rss_mb or 0.0))
            lately = [size for when, size in sizes if when > now - REST - 1.0]
            if len(lately) < len(sizes) and max(lately) - min(lately) < STILL:
                return measured
            time.sleep(0.3)


@contextmanager
def serving(
    environment: Mapping[str, str],
    most: int = 64,
    options: Sequence[str] = ("--log-level", "error"),
) -> Iterator[Server]:
    """A running server that takes `most` clients."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = int(probe.getsockname()[1])
    command = [sys.executable, "-m", "onpath", "serve", "--port", str(port)]
    command += ["--most-clients", str(most), *options]
    with tempfile.TemporaryFile() as said:
        begun = time.monotonic()
        process = subprocess.Popen(
            command, env={**os.environ, **environment}, stdout=said, stderr=said
        )
        try:
            yield Server(port, begun, process, said)
        finally:
            _stop(process)


def _stop(process: subprocess.Popen[bytes]) -> None:
    process.terminate()
    try:
        process.wait(LAST_WORDS)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
