"""The process that makes files: reads jobs from its input, writes what they give to its output.

Started by export_process.py as `python -m onpath.app.exports.worker`. It ends when its input does,
so it does not outlive the lab.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import traceback
from contextlib import suppress
from typing import BinaryIO

NICENESS = 5  # the frames come first, but a third of their share is left on a busy machine
MOST_MEMORY = 2 << 30  # [B] of data; more is a MemoryError here, and not the lab's


def main() -> None:
    """Serve until the input ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the lab
    _limit()
    jobs, results = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no result
    with suppress(EOFError, BrokenPipeError):
        while True:
            serve(jobs, results)


def serve(jobs: BinaryIO, results: BinaryIO) -> None:
    """One job: a function and its arguments. The answer is (whether it succeeded, what it gave).

    Raises:
        EOFError: there are no more.
    """
    work, arguments = pickle.load(jobs)
    try:
        answer = True, work(*arguments)
    except Exception:  # told to whoever asked
        answer = False, traceback.format_exc()
    pickle.dump(answer, results, protocol=pickle.HIGHEST_PROTOCOL)
    results.flush()


def _limit() -> None:
    if hasattr(os, "nice"):
        os.nice(NICENESS)
    with suppress(ImportError, ValueError, OSError):  # where there are no such limits
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (MOST_MEMORY, MOST_MEMORY))


if __name__ == "__main__":
    main()
