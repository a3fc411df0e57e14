"""How a kernel runs: interpreted by CasADi's virtual machine, or compiled to machine code.

Both take many ticks in one call and agree to 1e-12 over 1000 ticks. The interpreted loop is there
at once; the compiled one is an order of magnitude faster and lets other threads run meanwhile. A C
compiler makes it here, and LLVM, where there is none, in models/translated_loop.py.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Protocol

import casadi as ca
import numpy as np

from models.buffered import Buffered
from models.kernel import Kernel
from models.system import Array

BLOCK = 16  # ticks per call of the interpreted loop, about one frame
SHORT = 100  # ticks, for which a compiled loop keeps the interpreter's lock
FLAGS = (
    *("-O3", "-march=native", "-fno-math-errno", "-fno-trapping-math"),
    "-ffp-contract=off",  # rounds as the interpreter does: both loops agree to the last bit
    *("-fPIC", "-fno-semantic-interposition", "-shared"),
)

_HEAD = "#define CASADI_SYMBOL_EXPORT static\n"
_DRIVER = """
__attribute__((nonnull))
void onpath_run(const double* restrict settings, const double* restrict curve,
                double* restrict state, double* restrict log, long long ticks) {{
  double next[{state}];
  const double* arg[] = {{state, settings, curve}};
  for (long long k = 0; k < ticks; ++k) {{
    double* res[] = {{next, log + k * {log}}};
    onpath_tick(arg, res, 0, 0, 0);
    for (int i = 0; i < {state}; ++i) state[i] = next[i];
  }}
}}
"""


class Loop(Protocol):
    """A kernel that runs."""

    @property
    def kernel(self) -> Kernel:
        """What runs."""
        ...

    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        """Advance by `ticks`.

        Args:
            state, settings: flat vectors, laid out as the kernel says.
            table: `Curve.table()`.

        Returns:
            The new state, shape (kernel.state.size,), and the rows, (ticks, kernel.log.size).
        """
        ...


class InterpretedLoop:
    """Runs in CasADi's virtual machine. One thread at a time."""

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel
        self._blocks = {size: Buffered(kernel.block(size)) for size in (BLOCK, 1)}

    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        """See `Loop.run`."""
        rows = np.empty((ticks, self.kernel.log.size))
        done = 0
        while done < ticks:
            size = BLOCK if ticks - done >= BLOCK else 1
            state, row = self._blocks[size](state, settings, table)
            rows[done : done + size] = row.reshape(size, -1)
            done += size
        return state.copy(), rows


class CompiledLoop:
    """Runs machine code through ctypes. Re-entrant.

    Other Python threads run during a long call, but not during a frame's worth: that takes some
    microseconds, and to get the interpreter back from a busy thread takes a hundred times as long.

    Args:
        address: of `void onpath_run(const double* settings, const double* curve, double* state,
            double* log, long long ticks)`, which advances the state and fills the log.
        owner: what keeps the machine code in memory.
    """

    def __init__(self, kernel: Kernel, address: int, owner: object) -> None:
        self.kernel = kernel
        self._width = kernel.log.size
        self._short = ctypes.PYFUNCTYPE(*_SIGNATURE)(address)
        self._long = ctypes.CFUNCTYPE(*_SIGNATURE)(address)
        self._owner = owner

    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        """See `Loop.run`."""
        after = np.array(state, dtype=float)
        rows = np.empty((ticks, self._width))
        settings = np.ascontiguousarray(settings, dtype=float)
        table = np.ascontiguousarray(table, dtype=float)
        run = self._short if ticks <= SHORT else self._long
        run(_address(settings), _address(table), _address(after), _address(rows), ticks)
        return after, rows


_SIGNATURE = (None, *[ctypes.c_void_p] * 4, ctypes.c_longlong)
_begin = (ctypes.c_char * 0).from_buffer
_addressof = ctypes.addressof


def _address(array: Array) -> int:
    """Of the numbers of a contiguous array; quicker than `array.ctypes.data`."""
    return _addressof(_begin(array.data))


def find_compiler() -> str | None:
    """Path of the system's C compiler, or None."""
    return shutil.which(os.environ.get("CC", "cc"))


def compile_loop(kernel: Kernel, folder: Path, compiler: str) -> CompiledLoop:
    """Compile a kernel, or take it from the cache in `folder`.

    The cache key is a hash of the source, the compiler and the flags, so that a stale or foreign
    library is never loaded.

    Raises:
        RuntimeError: the compiler failed; the message has its first lines.
    """
    source = generate_source(kernel)
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False)
    key = "\n".join((source, version.stdout, *FLAGS, _processor()))
    name = hashlib.sha256(key.encode()).hexdigest()[:24]
    library = folder / f"{name}.so"
    if not library.exists():
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            file, built = Path(scratch) / "loop.c", Path(scratch) / "loop.so"
            file.write_text(source)
            command = [compiler, *FLAGS, str(file), "-o", str(built), "-lm"]
            outcome = subprocess.run(command, capture_output=True, text=True, check=False)
            if outcome.returncode:
                raise RuntimeError(f"{compiler} failed: {outcome.stderr.strip()[:500]}")
            os.replace(built, library)
    return load_loop(kernel, library)


def load_loop(kernel: Kernel, library: Path) -> CompiledLoop:
    """The loop of a shared library with `onpath_run`; see `CompiledLoop`."""
    code = ctypes.CDLL(str(library))
    address = ctypes.cast(code.onpath_run, ctypes.c_void_p).value
    assert address is not None
    return CompiledLoop(kernel, address, code)


def generate_source(kernel: Kernel) -> str:
    """C of the kernel's tick and the loop around it."""
    generator = ca.CodeGenerator("loop", {"with_header": False})
    generator.add(kernel.tick())
    driver = _DRIVER.format(state=kernel.state.size, log=kernel.log.size)
    return _HEAD + generator.dump() + driver


def _processor() -> str:
    """What -march=native depends on."""
    try:
        info = Path("/proc/cpuinfo").read_text()
    except OSError:
        return ""
    return "".join(line for line in info.splitlines() if line.startswith("flags"))[:4000]
