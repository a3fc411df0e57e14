"""Caches with one set of objects per thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import cache, wraps
from typing import ParamSpec, TypeVar

Asked = ParamSpec("Asked")
Made = TypeVar("Made")


def per_thread(make: Callable[Asked, Made]) -> Callable[Asked, Made]:
    """Like `functools.cache`, but every thread has its own results."""
    own = threading.local()

    @wraps(make)
    def made(*args: Asked.args, **options: Asked.kwargs) -> Made:
        if not hasattr(own, "made"):
            own.made = cache(make)
        return own.made(*args, **options)

    return made
