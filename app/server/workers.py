"""Several lab processes behind one address: starts, restarts and stops them.

Any process can serve any connection: they all serve the same page, and load labs from a shared
database.
"""

from __future__ import annotations

import logging
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from onpath.app.server.handover import CAN_HAND_OVER, CHANNEL, Reception
from onpath.app.storage.database_url import DATABASE
from onpath.app.viser_adapter.sockets import listen, reserve
from onpath.assets import asset_path

log = logging.getLogger(__name__)

MOST = 64
AGAIN = 1.0  # [s] before a worker that died is restarted
LAST_WORDS = 10.0  # [s] that a worker has to stop before it is killed
MARK = "ONPATH_WORKER"  # environment variable of a worker
USAGE = 2  # exit code for invalid options; restarting would not help


class Options(Protocol):
    """The options of the command line; see `app.cli.serve.Serve`."""

    @property
    def host(self) -> str: ...
    @property
    def port(self) -> int: ...
    @property
    def lessons(self) -> Path | None: ...
    @property
    def database(self) -> str | None: ...
    @property
    def keep_days(self) -> int: ...
    @property
    def most_labs(self) -> int: ...
    @property
    def origin(self) -> tuple[str, ...]: ...
    @property
    def trusted_proxy(self) -> tuple[str, ...]: ...
    @property
    def workers(self) -> int: ...
    @property
    def most_clients(self) -> int: ...
    @property
    def hang_seconds(self) -> float: ...
    @property
    def successive_ports(self) -> bool: ...
    @property
    def classroom(self) -> bool: ...
    @property
    def socket(self) -> Path | None: ...
    @property
    def log_level(self) -> str: ...


def supervise(options: Options, secrets: Mapping[str, str] | None = None) -> None:
    """Run workers until Ctrl-C or SIGTERM.

    Args:
        options: valid according to `check`.
        secrets: environment variables for the workers.

    Raises:
        ValueError: a worker rejects its options.
        OSError: a port is not available.
    """
    logging.basicConfig(level=options.log_level.upper(), format="%(levelname)s %(message)s")
    apart = options.successive_ports or not CAN_HAND_OVER
    places = options.workers if apart else 1
    hold = reserve if apart else listen
    held = [hold(options.host, options.port + i if options.port else 0) for i in range(places)]
    ports = [place.getsockname()[1] for place in held]
    reception = None if apart else Reception(held[0])
    workers = [
        Worker(
            number + 1,
            _command(options, ports[number % places]),
            {**(secrets or {}), **_database(options)},
            cores,
            reception,
        )
        for number, cores in enumerate(shares(_cores(), options.workers))
    ]
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        for worker in workers:
            worker.start()
        _announce(options.host, ports, len(workers))
        _watch(workers, time.sleep if reception is None else reception.attend)
    except KeyboardInterrupt:
        log.info("stopping")
    finally:
        if reception is not None:
            reception.close()
        _stop(workers)
        for place in held:
            place.close()


@dataclass(slots=True)
class Worker:
    """One process. Its output is repeated on ours, with its number in front.

    Attributes:
        number: from 1.
        command: that starts it.
        secrets: additional environment variables.
        cores: on which it may run; empty: on all.
        reception: hands connections to it, unless it has a port of its own.
        process: None before `start`.
        died: time at which it was found to have ended, [s], or None.
    """

    number: int
    command: list[str]
    secrets: dict[str, str] = field(default_factory=dict, repr=False)
    cores: frozenset[int] = frozenset()
    reception: Reception | None = field(default=None, repr=False)
    process: subprocess.Popen[bytes] | None = None
    died: float | None = None
    _reader: threading.Thread | None = field(default=None, repr=False)

    def start(self) -> None:
        """Start or restart it, in a session of its own, so that it does not receive our Ctrl-C."""
        pipe = subprocess.PIPE
        environment = {**os.environ, MARK: "1", **self.secrets}
        channel = None if self.reception is None else self.reception.join()
        if channel is not None:
            environment[CHANNEL] = str(channel.fileno())
        self.process = subprocess.Popen(
            self.command,
            env=environment,
            stdin=pipe,
            stdout=pipe,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            pass_fds=() if channel is None else [channel.fileno()],
        )
        if channel is not None:
            channel.close()
        self.died = None
        if self.cores:
            with suppress(OSError):  # it has ended already, or the cores are not ours any more
                os.sched_setaffinity(self.process.pid, self.cores)
        self._reader = threading.Thread(target=self._repeat, args=(self.process,), daemon=True)
        self._reader.start()

    def look(self) -> None:
        """Restart it if it died `AGAIN` seconds ago.

        Raises:
            ValueError: it rejected its options.
        """
        code = self.process.poll() if self.process else None
        if code is None:
            return
        if code == USAGE:
            raise ValueError(f"worker {self.number} cannot start, see above")
        if self.died is None:
            self.died = time.monotonic()
            log.warning("worker %d has ended (%d), it is started again", self.number, code)
        elif time.monotonic() - self.died > AGAIN:
            self.start()

    def _repeat(self, process: subprocess.Popen[bytes]) -> None:
        assert process.stdout is not None
        for line in process.stdout:
            text = line.decode(errors="replace").rstrip()
            sys.stderr.write(f"[worker {self.number}] {text}\n")


def shares(cores: Sequence[int], workers: int) -> list[frozenset[int]]:
    """The cores of each worker: disjoint where there are enough; empty where none are known.

    Only one thread of a Python process runs at a time, and handing over is faster on the same core:
    sixty labs on two cores are simulated 10 % faster this way.
    """
    return [frozenset(cores[i % max(len(cores), 1) :: workers]) for i in range(workers)]


def _cores() -> list[int]:
    """The cores that this process may use; none where the system does not tell."""
    return sorted(os.sched_getaffinity(0)) if sys.platform == "linux" else []


def is_worker() -> bool:
    """Whether this process is a worker. If so, it will end when its parent does."""

    def wait() -> None:
        while os.read(0, 1024):
            pass
        os.kill(os.getpid(), signal.SIGTERM)

    if MARK not in os.environ:
        return False
    threading.Thread(target=wait, name="parent", daemon=True).start()
    return True


def check(options: Options) -> None:
    """Check the options.

    Raises:
        ValueError: they are invalid for several workers.
    """
    if not 1 < options.workers <= MOST:
        raise ValueError(f"--workers {options.workers}: expected 1 to {MOST}")
    if options.socket:
        raise ValueError("--socket is for one process: leave out --workers")


def _command(options: Options, port: int) -> list[str]:
    """The command that starts a worker."""
    command = [sys.executable, "-P", "-m", "onpath", "serve"]
    command += ["--host", options.host, "--port", str(port), "--log-level", options.log_level]
    command += ["--most-clients", str(options.most_clients)]
    command += ["--hang-seconds", str(options.hang_seconds)]
    command += ["--lessons", str(options.lessons)] if options.lessons else []
    command += ["--keep-days", str(options.keep_days), "--most-labs", str(options.most_labs)]
    command += ["--classroom"] if options.classroom else []
    command += [word for origin in options.origin for word in ("--origin", origin)]
    return command + [w for proxy in options.trusted_proxy for w in ("--trusted-proxy", proxy)]


def _database(options: Options) -> dict[str, str]:
    """The environment variable with the database's URL, if there is one."""
    return {DATABASE: options.database} if options.database else {}


def _announce(host: str, ports: list[int], workers: int) -> None:
    shown = "localhost" if host in ("127.0.0.1", "0.0.0.0", "::") else host
    if len(ports) == 1:
        log.info("%d workers at http://%s:%d  (Ctrl-C stops them)", workers, shown, ports[0])
        return
    log.info("%d workers at the ports %s  (Ctrl-C stops them)", workers, ports)
    readme = asset_path("deploy") / "README.md"
    log.info("for one address, put a proxy in front: see %s", readme)


def _watch(workers: list[Worker], wait: Callable[[float], None]) -> None:
    while True:
        for worker in workers:
            worker.look()
        wait(0.1)


def _stop(workers: list[Worker]) -> None:
    """Stop all workers at the same time; kill those that do not stop within `LAST_WORDS`."""
    running = [w.process for w in workers if w.process is not None]
    for process in running:
        process.terminate()
    until = time.monotonic() + LAST_WORDS
    for process in running:
        try:
            process.wait(max(until - time.monotonic(), 0.1))
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
