"""A process that creates files in the background: started on demand, ended when idle."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from onpath.app.common.own_laws import add_laws, laws_of_files
from onpath.models.systems.catalogue import add_chains, added_chains

IDLE = 60.0  # [s] without a call; then the process, which takes about 200 MB, is ended
ONE_THREAD = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MALLOC_ARENA_MAX": "1"}


class ExportError(Exception):
    """A file could not be created."""


class ExportDied(ExportError):
    """The process died, for instance because the machine had no memory left."""


class ExportLate(ExportError):
    """The call took too long, so its process was killed."""


class ExportStopped(ExportError):
    """The process was stopped while a call was running or waiting for its turn."""


class ExportProcess:
    """Calls functions in a process of low priority, one at a time.

    If the process dies, or takes too long and is killed, one call fails, and the next one starts
    another process.

    Args:
        idle: time without a call after which the process is ended, [s].
    """

    def __init__(self, idle: float = IDLE) -> None:
        self._idle = idle
        self._process: subprocess.Popen[bytes] | None = None
        self._added = list[tuple[Callable[[Any], None], Any]]()
        self._chains = 0  # robots from files that the process knows
        self._calls, self._stops = threading.Lock(), 0
        self._rest: threading.Timer | None = None

    @property
    def pid(self) -> int | None:
        """Process id, if the process is running."""
        return None if self._process is None else self._process.pid

    def call(self, seconds: float, work: Callable[..., Any], *arguments: Any) -> Any:
        """Return `work(*arguments)`. Concurrent calls wait for each other.

        Args:
            seconds: time-out.
            work: a module-level function whose arguments and result can be pickled.

        Raises:
            ExportError: the call failed, or its time was over before its turn.
            ExportDied: its process died.
            ExportLate: it took too long.
            ExportStopped: `stop` was called in the meantime.
        """
        stops = self._stops
        if seconds <= 0:
            raise ExportError("timed out before its turn")
        with self._calls:
            self._stop_resting()
            if self._stops != stops:
                raise ExportStopped("stopped before its turn")
            process = self._started()
            is_late = threading.Event()

            def give_up() -> None:
                is_late.set()
                process.kill()

            limit = threading.Timer(seconds, give_up)
            limit.start()
            try:
                for add, added in self._added:  # the new process finds only our own
                    _ask(process, add, (added,))
                self._added = []
                if fresh := added_chains()[self._chains :]:
                    _ask(process, add_chains, (fresh,))
                    self._chains += len(fresh)
                succeeded, result = _ask(process, work, arguments)
            except (EOFError, OSError, pickle.UnpicklingError) as error:
                self._end()
                if self._stops != stops:
                    raise ExportStopped("stopped") from error
                if is_late.is_set():
                    raise ExportLate(f"the export process was ended after {seconds:g} s") from error
                raise ExportDied(f"the export process has died: {process.returncode}") from error
            finally:
                limit.cancel()
                self._begin_resting()
        if not succeeded:
            raise ExportError(result)
        return result

    def stop(self) -> None:
        """End the process; running and waiting calls fail with `ExportStopped`."""
        self._stops += 1
        if (process := self._process) is not None:
            process.kill()
        with self._calls:
            self._stop_resting()
            self._end()

    def _started(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            self._end()
            self._added = [(add_laws, laws)] if (laws := laws_of_files()) else []
            self._chains = 0
            path = os.pathsep.join(filter(None, sys.path))
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-m", "onpath.app.exports.worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                env={**os.environ, **ONE_THREAD, "PYTHONPATH": path},
            )
        return self._process

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is not None:
            process.kill()
            for pipe in (process.stdin, process.stdout):
                if pipe is not None:
                    with suppress(OSError):
                        pipe.close()
            process.wait()

    def _begin_resting(self) -> None:
        if self._process is not None:
            self._rest = threading.Timer(self._idle, self._retire)
            self._rest.daemon = True
            self._rest.start()

    def _retire(self) -> None:
        with self._calls:
            if self._rest is threading.current_thread():  # no call has arrived in between
                self._end()

    def _stop_resting(self) -> None:
        if self._rest is not None:
            self._rest.cancel()


def _ask(
    process: subprocess.Popen[bytes], work: Callable[..., Any], arguments: tuple[Any, ...]
) -> tuple[bool, Any]:
    assert process.stdin is not None and process.stdout is not None
    pickle.dump((work, arguments), process.stdin, protocol=pickle.HIGHEST_PROTOCOL)
    process.stdin.flush()
    return pickle.load(process.stdout)
