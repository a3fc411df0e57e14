"""The signals at which the lab stores the last changes and ends."""

from __future__ import annotations

import signal

_CLOSED = getattr(signal, "SIGHUP", None)  # when the terminal is closed
_HEEDED = _CLOSED is not None and signal.getsignal(_CLOSED) is signal.SIG_DFL  # not with `nohup`
END_SIGNALS = (signal.SIGINT, signal.SIGTERM, *([_CLOSED] if _HEEDED else []))
