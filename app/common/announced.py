"""A line about work that takes longer than its user may expect."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Timer

PATIENCE = 1.0  # [s]


@contextmanager
def announced(text: str) -> Iterator[None]:
    """Say on the error stream what is being done, if it takes longer than a second.

    Only in a terminal or a notebook; there, the line is blanked when the work is done.
    """
    if not (sys.stderr.isatty() or "ipykernel" in sys.modules):
        yield
        return
    said = list[str]()

    def say() -> None:
        said.append(text)
        print(f"\r{text}", end="", file=sys.stderr, flush=True)

    timer = Timer(PATIENCE, say)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        if said:
            print(f"\r{' ' * len(text)}\r", end="", file=sys.stderr, flush=True)
