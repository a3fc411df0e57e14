"""Jobs for the export process in tests; it imports them by name."""

from __future__ import annotations

import os
import time
from pathlib import Path


def die(*_: object) -> bytes:
    """End the process as a crash does."""
    os._exit(9)


def hang(begun: Path) -> None:
    """A job without an end; the file is there once it is under way."""
    begun.touch()
    while True:
        time.sleep(60.0)
