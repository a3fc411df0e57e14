"""Waiting for something that another thread or process does."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any


def wait_for(condition: Callable[[], Any], seconds: float, state: Callable[[], str] = str) -> Any:
    """Return the value of `condition` as soon as it is true.

    Args:
        state: describes what was found instead, for the failure on time-out.
    """
    deadline = time.monotonic() + seconds
    while not (result := condition()):
        assert time.monotonic() < deadline, f"waited in vain {state()}"
        time.sleep(0.005)
    return result
