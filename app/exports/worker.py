"""The process that creates files: reads jobs from stdin and writes their results to stdout.

export_process.py starts it as `python -m onpath.app.exports.worker`. It ends when its input is
closed, so it does not outlive the lab.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import traceback
from contextlib import suppress
from typing import BinaryIO

NICENESS = 5  # the simulation has priority, but a third of its share remains on a busy machine
MOST_MEMORY = 2 << 30  # [B], data limit; more raises MemoryError here instead of exhausting the lab


def main() -> None:
    """Serve jobs until the input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is handled by the lab
    _limit()
    jobs, results = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # library output must not corrupt the results
    with suppress(EOFError, BrokenPipeError):
        while True:
            serve(jobs, results)


def serve(jobs: BinaryIO, results: BinaryIO) -> None:
    """Run one job, a function and its arguments. The reply is (success, result).

    Raises:
        EOFError: there are no more jobs.
    """
    work, arguments = pickle.load(jobs)
    try:
        answer = True, work(*arguments)
    except Exception:  # reported to the caller
        answer = False, traceback.format_exc()
    pickle.dump(answer, results, protocol=pickle.HIGHEST_PROTOCOL)
    results.flush()


def _limit() -> None:
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    with suppress(ImportError, ValueError, OSError):  # platforms without resource limits
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))


if __name__ == "__main__":
    main()
