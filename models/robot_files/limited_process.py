"""Runs a library on a foreign file in a process of its own, with limits of time and memory.

A file that makes a library crash, hang or take all memory must end neither a notebook nor a lab.
This module is both ends: `answer_of` starts a module as a program, and that calls `serve`.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress

SECONDS = 30  # [s] of processor time
PATIENCE = 120.0  # [s] until the answer, on a busy machine
MEMORY = 2 << 30  # [B]


class ProcessEnded(Exception):
    """The process has ended without an answer.

    Attributes:
        slow: whether it took too long.
    """

    def __init__(self, slow: bool) -> None:
        super().__init__("too slow" if slow else "ended")
        self.slow = slow


def answer_of(module: str, job: bytes, seconds: int = SECONDS) -> bytes:
    """What a module answers to a job.

    Args:
        module: its name, to be run as a program.
        seconds: of processor time that it may take.

    Raises:
        ProcessEnded: it crashed, or took too much time or memory.
    """
    path = os.pathsep.join(map(os.path.abspath, filter(None, sys.path)))
    threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    try:
        ended = subprocess.run(
            [sys.executable, "-P", "-m", module, str(seconds)],
            input=job,
            capture_output=True,
            check=True,
            cwd=os.path.abspath(os.sep),
            env={**os.environ, **threads, "PYTHONPATH": path},
            timeout=PATIENCE,
        )
    except subprocess.TimeoutExpired:
        raise ProcessEnded(slow=True) from None
    except subprocess.CalledProcessError as error:
        slow = error.returncode == -getattr(signal, "SIGXCPU", 0)
        raise ProcessEnded(slow) from None
    except OSError:
        raise ProcessEnded(slow=False) from None
    return ended.stdout


def serve(work: Callable[[bytes], bytes]) -> None:
    """Read a job from stdin, and write the answer to stdout, within the limits."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints must not be mixed with the answer
    job = sys.stdin.buffer.read()
    _limit(int(sys.argv[1]))
    answers.write(work(job))
    answers.flush()
    os._exit(0)  # without running what a damaged library would do at its end


def _limit(seconds: int) -> None:
    with suppress(ImportError, ValueError, OSError):  # platforms without these limits
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
        resource.setrlimit(resource.RLIMIT_DATA, (MEMORY, MEMORY))
        resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0))
