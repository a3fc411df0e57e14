"""Reads, compiles and imports in the background, after the first picture.

Anything that is needed earlier is read or imported where it is needed. All of it takes seconds, in
which a class that comes back after a restart would wait for its votes: it is done piece by piece,
while the frames of the simulation are on time, with rests.
"""

from __future__ import annotations

import gc
import logging
import mimetypes
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib import import_module
from io import BytesIO
from threading import Thread

import numpy as np

from onpath.app.common.error_log import log_warning
from onpath.app.common.on_time import wait_until_on_time
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.simulation import Simulation
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.assets.messages import languages
from onpath.lessons.course import Course
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import RobotEntry

log = logging.getLogger(__name__)
LATER = (
    "scipy.interpolate",
    "scipy.linalg",
    "scipy.signal",
)
REST = 3.0  # [s] left to the first browser to open its lab
PATIENCE = 3.0  # [s] for which each part waits while frames are late
TRIES = 5
SHARE = 0.8  # share of the time left to others


def warm_up(loop_cache: LoopCache, course: Course, rest: float = REST) -> Thread:
    """After `rest` [s], in a thread: read lessons, compile loops, import modules, build robots.

    A part that fails, for instance because too many files are open, is tried again after a rest.
    Each part waits while frames are late, and afterwards rests, so that others get `SHARE` of the
    time; if `rest` is 0, it does neither.
    """

    def make_loops() -> None:
        Simulation(loop_cache).prepare_loops()

    def import_rest() -> None:
        _import_picture_formats()
        for language in languages():
            Words(language)("full.text", places=2)  # a plural, whose rules are imported with it
        mimetypes.init()  # the types of files, for downloads

    def work() -> None:
        read = (*course.lessons.values(), *course.tests.values())
        parts: list[Callable[[], object]] = [make_loops]
        parts += [partial(versions.get, language) for versions in read for language in versions]
        parts += [*(partial(import_module, name) for name in LATER), import_rest]
        parts += [partial(build_robot, loop_cache, entry) for entry in tuple(ROBOTS.values())]
        tries = TRIES
        while parts and tries:
            time.sleep(rest)
            tries -= 1
            parts = [part for part in parts if not _succeeds(part, gently=rest > 0)]
        gc.freeze()  # else each full collection scans all of this again and stops every thread

    thread = Thread(target=work, name="warm-up", daemon=True)
    thread.start()
    return thread


def build_robot(loop_cache: LoopCache, entry: RobotEntry) -> None:
    """Build the equations, checks and drawings of a robot, before somebody chooses it."""
    home = np.zeros((1, 2))
    lab = Lab(loop_cache, entry)
    take_page_snapshot(lab, 1.0)
    robot = lab.simulation.robot
    robot.margin(home)
    q = robot.rest(robot.frame.lift(home))
    robot.fault(q, np.zeros_like(q), lab.simulation.parameters)


def compile_loops(loop_cache: LoopCache, entry: RobotEntry) -> None:
    """Compile the loops that a new lab with a robot needs, before anybody waits for them.

    Those of a robot with many joints take seconds.
    """
    runs = Simulation(loop_cache, entry).runs.values()
    loops = [(run.robot, replace(run.kind, free=free)) for run in runs for free in (True, False)]
    for i, (robot, kind) in enumerate(loops, 1):
        log.info("compiling %s: %d of %d", entry.label, i, len(loops))
        loop_cache.make(robot, kind)


def _succeeds(part: Callable[[], object], *, gently: bool) -> bool:
    """Do a part, so gently that others get their time, or at once; returns whether it is done."""
    if gently:
        wait_until_on_time(PATIENCE)
    begun = time.monotonic()
    try:
        part()
    except Exception as error:  # the first user of this part will wait for it
        log_warning("not prepared yet: %r", error)
        return False
    finally:
        if gently:
            time.sleep(SHARE / (1 - SHARE) * (time.monotonic() - begun))
    return True


def _import_picture_formats() -> None:
    """Encode a picture as viser does for an image in the scene, which imports all formats."""
    import_module("imageio.v3").imwrite(BytesIO(), np.zeros((1, 1, 3), np.uint8), extension=".png")
