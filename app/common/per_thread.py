"""Caches with one set of objects per thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cache, wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def per_thread(make: Callable[P, T]) -> Callable[P, T]:
    """Like `functools.cache`, but every thread has its own results."""
    local = threading.local()

    @wraps(make)
    def cached(*args: P.args, **kwargs: P.kwargs) -> T:
        if not hasattr(local, "cached"):
            local.cached = cache(make)
        return local.cached(*args, **kwargs)

    return cached
