"""Starts the lab again when its process has crashed or hung, if nothing else does.

A child serves, and its parent waits: without threads, and before anything large is imported. Labs
and classes are in the database, so their pages come back by themselves. systemd, which says that it
supervises, starts a process again itself. Windows has no `fork`; there, nobody does.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from contextlib import suppress

from onpath.app.common.end_signals import END_SIGNALS

SOON = 5.0  # [s] after its start; a lab that ends sooner would only fail again
CHECK = 0.5  # [s] between a child's checks whether its parent lives


def supervised(serve: Callable[[bool], int]) -> int:
    """Serve in a child, and again if it crashes or hangs; return its exit code.

    Args:
        serve: serves until it is asked to stop, and returns the exit code; told whether an earlier
            process has served before it.
    """
    if not hasattr(os, "fork") or "NOTIFY_SOCKET" in os.environ:
        return serve(False)
    child, told, again = 0, 0, False

    def hand_on(number: int, _: object) -> None:
        nonlocal told
        if told:  # by a signal that came before the others were ignored
            return
        told = number
        for each in END_SIGNALS:  # else another one would cut Python's own end short
            signal.signal(each, signal.SIG_IGN)
        if child:
            with suppress(ProcessLookupError):  # it has just ended
                os.kill(child, number)

    handlers = {number: signal.signal(number, hand_on) for number in END_SIGNALS}
    while not told:
        begun = time.monotonic()
        child = 0
        signal.pthread_sigmask(signal.SIG_BLOCK, END_SIGNALS)  # until it is known to whom they go
        if not told and not (child := os.fork()):
            for number, handler in handlers.items():
                signal.signal(number, handler)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, END_SIGNALS)
            threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()
            return serve(again)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, END_SIGNALS)
        if not child:
            break
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        goes_on = code < 0 or code == os.EX_SOFTWARE  # see `app.server.watchdog`
        if told or not goes_on or time.monotonic() - begun < SOON:
            return code if code >= 0 else 128 - code
        again = True
        print(f"onpath: the lab has ended with code {code}; it starts again", file=sys.stderr)
    return 128 + told


def _end_with(parent: int) -> None:
    """End this process as soon as its parent has ended, however that came."""
    while os.getppid() == parent:
        time.sleep(CHECK)
    os.kill(os.getpid(), signal.SIGTERM)
