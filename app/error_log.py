"""Logs errors that may come a thousand times: in full once, later only their number."""

from __future__ import annotations

import logging
from collections import Counter
from types import CodeType

_log = logging.getLogger(__name__)
_seen: Counter[tuple[type, CodeType | None, int]] = Counter()


def log_error(error: BaseException) -> None:
    """The traceback the first time a line raises this; then that it did so 10, 100, … times."""
    place = error.__traceback__
    while place is not None and place.tb_next is not None:
        place = place.tb_next
    code, line = (place.tb_frame.f_code, place.tb_lineno) if place is not None else (None, 0)
    _seen[type(error), code, line] += 1
    times = _seen[type(error), code, line]
    if times == 1:
        _log.error("a callback failed: %r", error, exc_info=error)
    elif str(times).strip("0") == "1":
        _log.error("a callback failed %d times by now: %r", times, error)
