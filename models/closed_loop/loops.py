"""Two ways to run a kernel: interpreted by CasADi's virtual machine, or compiled to machine code.

Both run many ticks per call, of one robot or of several, and agree bit by bit. The interpreted loop
is available at once. The compiled loop (translated_loop.py) is an order of magnitude faster and, in
long calls, releases the Python interpreter's lock. A batch is four times as fast again for many
robots, and agrees within rounding.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from math import prod
from typing import Protocol

import numpy as np
from typing_extensions import override

from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_vectors import LoopLayouts

BLOCK = 16  # ticks per call of the interpreted loop, about one frame of the display
SHORT = 1000  # ticks, of all robots, up to which a compiled loop keeps the interpreter's lock


class ManyLoop(Protocol):
    """A kernel that can be run for many robots at once.

    Attributes:
        layouts: of its flat vectors.
    """

    layouts: LoopLayouts

    def run_many(
        self,
        states: Sequence[Array] | Array,
        settings: Sequence[Array],
        tables: Sequence[Array],
        ticks: int,
    ) -> tuple[Array, Array]:
        """Advance several robots by `ticks`.

        Args:
            states, settings: flat vectors, laid out as `layouts`, one per robot.
            tables: `Curve.table()`, one per robot.

        Returns:
            The new states, (robots, layouts.state.size), and log rows, (robots, ticks,
            layouts.log.size).
        """
        ...


class Loop(ManyLoop, Protocol):
    """A kernel that can be run for one robot or many, with the same bits."""

    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        """Advance by `ticks`.

        Args:
            state, settings: flat vectors, laid out as `layouts`.
            table: `Curve.table()`.

        Returns:
            The new state, shape (layouts.state.size,), and the log rows, (ticks, layouts.log.size).
        """
        ...


class InterpretedLoop(Loop):
    """Runs a kernel in CasADi's virtual machine.

    Not thread-safe: use one instance per thread.
    """

    def __init__(self, kernel: Kernel) -> None:
        self.layouts = kernel.layouts
        self._blocks = {size: Buffered(kernel.block(size)) for size in (BLOCK, 1)}

    @override
    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        rows = np.empty((ticks, self.layouts.log.size))
        done = 0
        while done < ticks:
            size = BLOCK if ticks - done >= BLOCK else 1
            state, row = self._blocks[size](state, settings, table)
            rows[done : done + size] = row.reshape(size, -1)
            done += size
        return state.copy(), rows

    @override
    def run_many(
        self,
        states: Sequence[Array] | Array,
        settings: Sequence[Array],
        tables: Sequence[Array],
        ticks: int,
    ) -> tuple[Array, Array]:
        inputs = zip(states, settings, tables, strict=True)
        runs = [self.run(state, given, table, ticks) for state, given, table in inputs]
        return np.stack([after for after, _ in runs]), np.stack([rows for _, rows in runs])


class CompiledLoop(Loop):
    """Runs machine code through ctypes. Thread-safe.

    Calls of more than `SHORT` ticks release the interpreter's lock. Shorter ones keep it: they take
    half a millisecond, or a few with a flexible robot, while reacquiring the lock from a busy
    thread may take 5 ms.

    Args:
        layouts: those of its flat vectors.
        address: of `void onpath_run(const double* settings, const double* curves, double* states,
            double* logs, long long ticks, long long robots)`, which advances the states and fills
            the logs. Each array holds the robots' data one after the other.
        owner: the object that keeps the machine code in memory.
    """

    def __init__(self, layouts: LoopLayouts, address: int, owner: object) -> None:
        self.layouts = layouts
        self._short = ctypes.PYFUNCTYPE(*_SIGNATURE)(address)
        self._long = ctypes.CFUNCTYPE(*_SIGNATURE)(address)
        self._owner = owner

    @override
    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        after, rows = self.run_many([state], [settings], [table], ticks)
        return after[0], rows[0]

    @override
    def run_many(
        self,
        states: Sequence[Array] | Array,
        settings: Sequence[Array],
        tables: Sequence[Array],
        ticks: int,
    ) -> tuple[Array, Array]:
        layouts, robots = self.layouts, len(states)
        after = _stacked(states, robots, layouts.state.size)
        inputs = _stacked(settings, robots, layouts.settings.size)
        curves = _stacked(tables, robots, prod(layouts.table_shape))
        rows = np.empty((robots, ticks, layouts.log.size))
        run = self._short if ticks * robots <= SHORT else self._long
        run(_address(inputs), _address(curves), _address(after), _address(rows), ticks, robots)
        return after, rows


class BatchedLoop(ManyLoop):
    """Runs machine code that advances several robots with the same instructions. Thread-safe.

    Args:
        layouts: those of its flat vectors.
        address: of the same function as of a `CompiledLoop`, each of whose numbers stands for a
            vector of them, one of each of `lanes` robots, and `robots` for the number of vectors.
        owner: the object that keeps the machine code in memory.
        lanes: robots that advance together.
    """

    def __init__(self, layouts: LoopLayouts, address: int, owner: object, lanes: int) -> None:
        self.layouts, self._lanes, self._owner = layouts, lanes, owner
        self._run = ctypes.CFUNCTYPE(*_SIGNATURE)(address)

    @override
    def run_many(
        self,
        states: Sequence[Array] | Array,
        settings: Sequence[Array],
        tables: Sequence[Array],
        ticks: int,
    ) -> tuple[Array, Array]:
        layouts, robots = self.layouts, len(states)
        after = self._in_lanes(states, robots, layouts.state.size)
        inputs = self._in_lanes(settings, robots, layouts.settings.size)
        curves = self._in_lanes(tables, robots, prod(layouts.table_shape))
        groups = len(after)
        rows = np.empty((groups, ticks, layouts.log.size, self._lanes))
        self._run(*map(_address, (inputs, curves, after, rows)), ticks, groups)
        state = np.moveaxis(after, 2, 1).reshape(-1, layouts.state.size)
        log = np.moveaxis(rows, 3, 1).reshape(-1, ticks, layouts.log.size)
        return state[:robots], log[:robots]

    def _in_lanes(self, vectors: Sequence[Array] | Array, count: int, size: int) -> Array:
        """Vectors (count, size) as (groups, size, lanes); the last one fills the last group."""
        stacked = _stacked(vectors, count, size)
        groups = -(-count // self._lanes)
        filled = np.empty((groups * self._lanes, size))
        filled[:count], filled[count:] = stacked, stacked[-1]
        return np.ascontiguousarray(filled.reshape(groups, self._lanes, size).swapaxes(1, 2))


def _stacked(vectors: Sequence[Array] | Array, count: int, size: int) -> Array:
    """A new array (count, size) of flat vectors; faster than `np.stack`.

    Raises:
        ValueError: the number of vectors or their size differs.
    """
    return np.concatenate(vectors, dtype=float).reshape(count, size)


_SIGNATURE = (None, *[ctypes.c_void_p] * 4, *[ctypes.c_longlong] * 2)
_begin = (ctypes.c_char * 0).from_buffer
_addressof = ctypes.addressof


def _address(array: Array) -> int:
    """Address of the data of a contiguous array; faster than `array.ctypes.data`."""
    return _addressof(_begin(array.data))
