"""Loads slow modules in the background, after the first picture has been shown.

Functions that need them earlier import them themselves.
"""

from __future__ import annotations

import time
from dataclasses import replace
from importlib import import_module
from threading import Thread

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.session import Session
from onpath.assets.messages import catalogue, languages

LATER = (
    "onpath.app.scene.strokes.sketch_board",
    "scipy.interpolate",
    "scipy.linalg",
    "scipy.signal",
)
REST = 3.0  # [s] in which the first browser can open its lab


def warm_up(store: LoopCache, rest: float = REST) -> Thread:
    """Import these modules and compile the loops of a new lab, in a thread, after `rest` [s]."""

    def work() -> None:
        time.sleep(rest)
        for run in Session(store).runs.values():
            for free in (True, False):
                store.prepare(run.robot, replace(run.kind, free=free))
        for name in LATER:
            import_module(name)
        for language in languages():
            catalogue(language)

    thread = Thread(target=work, name="warm-up", daemon=True)
    thread.start()
    return thread
