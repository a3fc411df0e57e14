"""A line about work that takes longer than its user may expect."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer

PATIENCE = 1.0  # [s]; work that takes longer is announced


@contextmanager
def announced(text: str) -> Iterator[None]:
    """Say what is being done, if it takes longer than a second.

    On the error stream of a terminal, or in a notebook's cell; nowhere else. The line is blanked
    when the work is done.
    """
    in_notebook = "ipykernel" in sys.modules
    if not (in_notebook or sys.stderr.isatty()):
        yield
        return
    stream = sys.stdout if in_notebook else sys.stderr  # which a notebook shows as a fault
    said = list[str]()

    def say() -> None:
        said.append(text)
        stream.write(f"\r{text}")
        stream.flush()

    timer = Timer(PATIENCE, say)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        if said:
            stream.write(f"\r{' ' * len(text)}\r")
            stream.flush()
