"""What is read, compiled and imported in the background, after the first picture.

What is needed earlier is imported, or read, where it is needed.
"""

from __future__ import annotations

import mimetypes
import time
from dataclasses import replace
from importlib import import_module
from io import BytesIO
from threading import Thread

import numpy as np

from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.session import Session
from onpath.assets.messages import languages
from onpath.lessons.course import Course
from onpath.lessons.words import Words

LATER = (
    "onpath.app.scene.strokes.sketch_board",
    "scipy.interpolate",
    "scipy.linalg",
    "scipy.signal",
)
REST = 3.0  # [s] in which the first browser can open its lab


def warm_up(store: LoopCache, course: Course, rest: float = REST) -> Thread:
    """After `rest` [s], in a thread: read the lessons, compile loops, import these modules."""

    def work() -> None:
        time.sleep(rest)
        for versions in (*course.lessons.values(), *course.tests.values()):
            list(versions.values())
        for run in Session(store).runs.values():
            for free in (True, False):
                store.prepare(run.robot, replace(run.kind, free=free))
        for name in LATER:
            import_module(name)
        _import_picture_formats()
        for language in languages():
            Words(language)("full.text", places=2)  # a plural, whose rules are imported with it
        mimetypes.init()  # the types of files, for downloads

    thread = Thread(target=work, name="warm-up", daemon=True)
    thread.start()
    return thread


def _import_picture_formats() -> None:
    """Encode a picture as viser does for a board to sketch on, which imports all formats."""
    import_module("imageio.v3").imwrite(BytesIO(), np.zeros((1, 1, 3), np.uint8), extension=".png")
