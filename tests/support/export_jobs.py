"""Jobs for the export process in tests; it imports them by name."""

from __future__ import annotations

import os
import time
from pathlib import Path


def die(*_: object) -> bytes:
    """End the process as a crash does."""
    os._exit(9)


def sleep_after_touching(file: Path, seconds: float) -> None:
    """Create a file, which tells that the job has begun, and sleep."""
    file.touch()
    time.sleep(seconds)
