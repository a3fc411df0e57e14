"""Two ways to run a kernel: interpreted by CasADi's virtual machine, or compiled to machine code.

Both run many ticks per call and agree bit by bit. The interpreted loop is available at once. The
compiled loop (translated_loop.py) is an order of magnitude faster and, in long calls, releases the
Python interpreter's lock.
"""

from __future__ import annotations

import ctypes
from typing import Protocol

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.closed_loop.kernel import Kernel

BLOCK = 16  # ticks per call of the interpreted loop, about one frame of the display
SHORT = 100  # ticks up to which a compiled loop does not release the interpreter's lock


class Loop(Protocol):
    """A kernel that can be run."""

    @property
    def kernel(self) -> Kernel:
        """The kernel."""
        ...

    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        """Advance by `ticks`.

        Args:
            state, settings: flat vectors, laid out as the kernel's `state` and `settings`.
            table: `Curve.table()`.

        Returns:
            The new state, shape (kernel.state.size,), and the log rows, (ticks, kernel.log.size).
        """
        ...


class InterpretedLoop:
    """Runs a kernel in CasADi's virtual machine.

    Not thread-safe: use one instance per thread.
    """

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
    """Runs machine code through ctypes. Thread-safe.

    Calls of more than `SHORT` ticks release the interpreter's lock. Shorter ones keep it: a frame's
    worth of ticks takes some microseconds, while reacquiring the lock from a busy thread takes
    about a hundred times as long.

    Args:
        kernel: the kernel that was compiled.
        address: of `void onpath_run(const double* settings, const double* curve, double* state,
            double* log, long long ticks)`, which advances the state and fills the log.
        owner: the object that keeps the machine code in memory.
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
    """Address of the data of a contiguous array; faster than `array.ctypes.data`."""
    return _addressof(_begin(array.data))
