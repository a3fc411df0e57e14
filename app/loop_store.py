"""Where sessions get their loops: interpreted at once, compiled as soon as that is ready."""

from __future__ import annotations

import logging
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import platformdirs

from models.loop_kind import Kind
from models.loops import CompiledLoop, InterpretedLoop, Loop, compile_loop, find_compiler
from models.robots import Robot
from models.simulation import kernel_of

log = logging.getLogger(__name__)
Key = tuple[Robot, Kind]


def cache_folder() -> Path:
    """Where compiled loops are kept between runs."""
    return Path(platformdirs.user_cache_dir("onpath")) / "loops"


class LoopStore:
    """Loops by robot and kind. `get` never waits for a compiler.

    Args:
        compiler: path of the C compiler, or None to do without.
        folder: cache of compiled loops.
    """

    def __init__(self, compiler: str | None = None, folder: Path | None = None) -> None:
        self._compiler = compiler
        self._folder = folder or cache_folder()
        self._compiled: dict[Key, CompiledLoop] = {}
        self._interpreted: dict[Key, InterpretedLoop] = {}
        self._wanted: set[Key] = set()
        self._pool = ThreadPoolExecutor(1, "compile") if compiler else None
        self._lock = threading.Lock()

    @staticmethod
    def with_system_compiler() -> LoopStore:
        """The usual one."""
        compiler = find_compiler()
        if compiler is None:
            log.info("no C compiler found: the lab runs without one, more slowly")
        return LoopStore(compiler)

    def get(self, robot: Robot, kind: Kind) -> Loop:
        """The fastest loop there is now. Call from the simulation thread only."""
        key = (robot, kind)
        ready = self._compiled.get(key)
        if ready is not None:
            return ready
        pool = self._pool  # the other thread may give it up meanwhile
        if pool is not None and key not in self._wanted:
            self._wanted.add(key)
            pool.submit(self._compile, key)
        if key not in self._interpreted:
            self._interpreted[key] = InterpretedLoop(kernel_of(robot, kind))
        return self._interpreted[key]

    def progress(self) -> tuple[int, int]:
        """(compiled, asked for)."""
        return len(self._compiled), len(self._wanted)

    def close(self) -> None:
        """Give up what is still to be compiled."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)

    def _compile(self, key: Key) -> None:
        assert self._compiler is not None
        if self._pool is None:
            return  # it failed before, and would again
        try:
            loop = compile_loop(kernel_of(*key), self._folder, self._compiler)
        except Exception as error:  # whatever it is, the lab goes on without
            log.warning("cannot compile a loop, the interpreted one goes on: %s", error)
            self._pool = None
            self._wanted = set(self._compiled)
            return
        with self._lock:
            self._compiled[key] = loop
