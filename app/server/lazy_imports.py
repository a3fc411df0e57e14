"""What takes long and is not needed for the first picture, made ready when that is shown.

Who asks for it sooner gets it by the imports inside the functions that need it.
"""

from __future__ import annotations

import time
from dataclasses import replace
from importlib import import_module
from threading import Thread

from onpath.app.lab.loop_cache import LoopCache
from onpath.app.lab.session import Session

LATER = (
    "onpath.app.scene.sketch_board",
    "scipy.signal",
)
REST = 3.0  # [s] for the first browser to open its lab


def warm_up(store: LoopCache, rest: float = REST) -> Thread:
    """Import the rest and have a new lab's loops compiled, in a thread, after a while."""

    def work() -> None:
        time.sleep(rest)
        for run in Session(store).runs.values():
            for free in (True, False):
                store.prepare(run.robot, replace(run.kind, free=free))
        for name in LATER:
            import_module(name)

    thread = Thread(target=work, name="warm-up", daemon=True)
    thread.start()
    return thread
