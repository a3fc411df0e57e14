"""Where sessions get their loops: interpreted at once, compiled as soon as that is ready.

The system's C compiler makes the compiled ones, or LLVM in this process where there is none that
works.
"""

from __future__ import annotations

import logging
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import platformdirs

from models.kernel import Kernel
from models.loop_kind import Kind
from models.loops import CompiledLoop, InterpretedLoop, Loop, compile_loop, find_compiler
from models.robots import Robot
from models.simulation import kernel_of
from models.translated_loop import translate_loop

log = logging.getLogger(__name__)
Key = tuple[Robot, Kind]


def cache_folder() -> Path:
    """Where compiled loops are kept between runs."""
    return Path(platformdirs.user_cache_dir("onpath")) / "loops"


class LoopStore:
    """Loops by robot and kind. `get` never waits for a compiler.

    Args:
        compiler: path of the C compiler, or None to translate loops in this process.
        folder: cache of what the C compiler made.
    """

    def __init__(self, compiler: str | None = None, folder: Path | None = None) -> None:
        self._compiler = compiler
        self._folder = folder or cache_folder()
        self._compiled: dict[Key, CompiledLoop] = {}
        self._interpreted: dict[Key, InterpretedLoop] = {}
        self._wanted: set[Key] = set()
        self._pool: ThreadPoolExecutor | None = ThreadPoolExecutor(1, "compile")
        self._lock = threading.Lock()

    @staticmethod
    def with_system_compiler() -> LoopStore:
        """The usual one."""
        compiler = find_compiler()
        if compiler is None:
            log.info("no C compiler found: loops are translated instead, in this process")
        return LoopStore(compiler)

    def get(self, robot: Robot, kind: Kind) -> Loop:
        """The fastest loop there is now. Call from the simulation thread only."""
        key = (robot, kind)
        ready = self._compiled.get(key)
        if ready is not None:
            return ready
        if key not in self._interpreted:
            self._interpreted[key] = InterpretedLoop(kernel_of(robot, kind))
        pool = self._pool  # the other thread may give it up meanwhile
        if pool is not None and key not in self._wanted:
            self._wanted.add(key)
            pool.submit(self._compile, key)
        return self._interpreted[key]

    def progress(self) -> tuple[int, int]:
        """(compiled, asked for)."""
        return len(self._compiled), len(self._wanted)

    def close(self) -> None:
        """Give up what is still to be compiled."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)

    def _compile(self, key: Key) -> None:
        if self._pool is None:
            return  # it failed before, and would again
        try:
            loop = self._made(kernel_of(*key))
        except Exception as error:  # whatever it is, the lab goes on without
            log.warning("cannot compile a loop, the interpreted one goes on: %s", error)
            self._pool = None
            self._wanted = set(self._compiled)
            return
        with self._lock:
            self._compiled[key] = loop

    def _made(self, kernel: Kernel) -> CompiledLoop:
        if self._compiler is not None:
            try:
                return compile_loop(kernel, self._folder, self._compiler)
            except Exception as error:  # whatever it is, there is another way
                log.warning("the C compiler fails, loops are translated instead: %s", error)
                self._compiler = None
        return translate_loop(kernel)
