"""Logging of events that may repeat many times: errors once in full, warnings at a limited rate."""

from __future__ import annotations

import logging
import time
from collections import Counter, deque
from types import CodeType

_log = logging.getLogger(__name__)
_MINUTE, _MOST_WARNINGS = 60.0, 10
_warned: deque[float] = deque(maxlen=_MOST_WARNINGS)
_seen: Counter[tuple[type, CodeType | None, int]] = Counter()


def log_error(error: BaseException) -> None:
    """Log an error with its traceback when a line first raises it, then the 10th, 100th, … time."""
    raised = error.__traceback__
    while raised is not None and raised.tb_next is not None:
        raised = raised.tb_next
    code, line = (raised.tb_frame.f_code, raised.tb_lineno) if raised is not None else (None, 0)
    _seen[type(error), code, line] += 1
    times = _seen[type(error), code, line]
    if times == 1:
        _log.error("a callback failed: %r", error, exc_info=error)
    elif str(times).strip("0") == "1":
        _log.error("a callback failed %d times by now: %r", times, error)


def log_warning(message: str, *arguments: object) -> None:
    """Log a warning, unless ten have been logged in the last minute."""
    now = time.monotonic()
    if len(_warned) == _MOST_WARNINGS and now - _warned[0] < _MINUTE:
        return
    _warned.append(now)
    _log.warning(message, *arguments)
    if len(_warned) == _MOST_WARNINGS and now - _warned[0] < _MINUTE:
        _log.warning("no more warnings of this kind for up to a minute")
