"""`onpath serve` in a separate process, for tests; started again as systemd does."""

from __future__ import annotations

import os
import random
import signal
import socket
import subprocess
import sys
from collections.abc import Mapping, Sequence
from contextlib import ExitStack, suppress
from http.client import HTTPConnection, HTTPException
from pathlib import Path

from tests.support.checkout import ROOT
from tests.support.waiting import wait_for

WAIT = 180.0  # [s]; only ends a test that would hang
PROGRAM = ("-m", "onpath")
SUPERVISED = {"NOTIFY_SOCKET": "/nowhere"}  # else it would start itself again


def free_ports(count: int) -> list[int]:
    """Successive ones, of those that no system gives to whoever asks for any."""
    while True:
        ports = [random.randrange(20000, 32000)]
        ports += [ports[0] + i for i in range(1, count)]
        with ExitStack() as probes, suppress(OSError):
            for port in ports:
                probes.enter_context(socket.create_server(("127.0.0.1", port)))
            return ports


class LabProcess:
    """One process at one port.

    Args:
        options: of `onpath serve`, besides the port.
        environment: additional variables.
        program: the interpreter's arguments before these options.
        log: file for what it says on standard error, which is this process's if None.
    """

    def __init__(
        self,
        port: int,
        options: Sequence[str],
        environment: Mapping[str, str] = {},
        program: Sequence[str] = PROGRAM,
        log: Path | None = None,
    ) -> None:
        self.port, self._environment = port, {**os.environ, **SUPERVISED, **environment}
        self._log = log
        self._command = [sys.executable, *program, "--port", str(port), *options]
        self.process = self._started()

    def _started(self) -> subprocess.Popen[bytes]:
        with ExitStack() as stack:
            stderr = None if self._log is None else stack.enter_context(self._log.open("ab"))
            return subprocess.Popen(self._command, cwd=ROOT, env=self._environment, stderr=stderr)

    @property
    def said(self) -> str:
        """What it has logged, in all its lives."""
        return "" if self._log is None else self._log.read_text("utf-8")

    def wait_until_well(self) -> None:
        """Wait until it serves."""
        wait_for(lambda: self.process.poll() is not None or self.health()[0] == 200, WAIT)
        assert self.process.poll() is None

    def health(self) -> tuple[int, str]:
        """What it says to strangers who ask how it is; 0 without an answer."""
        connection = HTTPConnection("127.0.0.1", self.port, timeout=1.0)
        with suppress(OSError, HTTPException):
            connection.request("GET", "/health", headers={"Host": "elsewhere"})
            answer = connection.getresponse()
            return answer.status, answer.read().decode()
        return 0, ""

    def kill(self) -> None:
        """kill -9."""
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()

    def exit_code(self) -> int:
        """Wait until it has ended."""
        return self.process.wait(WAIT)

    def start_again(self, waits: bool = True) -> None:
        """As whatever supervises it does when it has ended."""
        assert self.process.poll() is not None
        self.process = self._started()
        if waits:
            self.wait_until_well()

    def connections(self) -> int:
        """Number of its open connections."""
        if self.process.poll() is not None:
            return 0
        own: set[str] = set()
        for descriptor in Path(f"/proc/{self.process.pid}/fd").iterdir():
            with suppress(OSError):
                own.add(os.readlink(descriptor).removeprefix("socket:["))
        here = f":{self.port:04X}"
        rows = [
            line.split()
            for line in Path("/proc/net/tcp").read_text(encoding="utf-8").splitlines()[1:]
        ]
        return sum(row[3] == "01" and row[1].endswith(here) and f"{row[9]}]" in own for row in rows)
