"""The signals at which the lab stores the last changes and ends."""

from __future__ import annotations

import signal

_CLOSED = [each for each in signal.Signals if each.name == "SIGHUP"]  # the terminal; not on Windows
END_SIGNALS = (
    signal.SIGINT,
    signal.SIGTERM,
    *(each for each in _CLOSED if signal.getsignal(each) is signal.SIG_DFL),  # `nohup` ignores it
)
