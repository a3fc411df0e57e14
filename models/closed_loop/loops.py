"""How a kernel runs: interpreted by CasADi's virtual machine, or compiled to machine code.

Both take many ticks in one call and agree to the last bit. The interpreted loop is there at once;
the compiled one, made by translated_loop.py, is an order of magnitude faster and lets other threads
run meanwhile.
"""

from __future__ import annotations

import ctypes
from typing import Protocol

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.closed_loop.kernel import Kernel

BLOCK = 16  # ticks per call of the interpreted loop, about one frame
SHORT = 100  # ticks, for which a compiled loop keeps the interpreter's lock


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
