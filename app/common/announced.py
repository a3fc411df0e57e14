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
        sys.stderr.write(f"\r{text}")
        sys.stderr.flush()

    timer = Timer(PATIENCE, say)
    timer.daemon = True
    timer.start()
    try:
        yield
    finally:
        timer.cancel()
        timer.join()
        if said:
            sys.stderr.write(f"\r{' ' * len(text)}\r")
            sys.stderr.flush()
