"""CasADi functions of column vectors, evaluated at all rows of arrays in one call."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from onpath.models.arrays import Array

INSTRUCTIONS = 1000
"""Largest number of scalar operations of a function for several rows: for a small function, a call
for each row would cost more than its operations."""


class Rows:
    """A function of column vectors, (a, 1), (b, 1), … -> (c, 1), for rows of arrays. Thread-safe.

    The values of a row do not depend on the other rows, to the last bit.

    Args:
        inputs: symbols of the columns.
        output: the column, an expression in them.
    """

    def __init__(self, inputs: list[ca.SX], output: ca.SX) -> None:
        self._one = ca.Function("one", inputs, [ca.densify(output)])
        self._size = output.numel()
        self._width = max(1, min(32, INSTRUCTIONS // max(1, self._one.n_instructions())))
        self._several = _repeated(self._one, self._width)
        self._mapped = lru_cache(maxsize=16)(self._map)

    def __call__(self, *arguments: Array) -> Array:
        """The values at rows, shapes (..., a), (..., b), … -> (..., c).

        Args:
            arguments: their leading dimensions are broadcast.
        """
        shape = np.broadcast_shapes(*[each.shape[:-1] for each in arguments])
        count = math.prod(shape)
        if count == 0:
            return np.empty((*shape, self._size))
        width = self._width if count > 1 else 1
        calls = -(-count // width)
        function = self._mapped(width, calls)
        buffer: Any
        buffer, evaluate = function.buffer()
        given, result = list[Array](), np.empty((calls * width, self._size))
        for i, each in enumerate(arguments):
            rows = np.zeros((calls * width, each.shape[-1]))
            rows[:count] = np.broadcast_to(each, (*shape, each.shape[-1])).reshape(count, -1)
            buffer.set_arg(i, rows.data)
            given.append(rows)  # their memory must stay valid until the call
        buffer.set_res(0, result.data)
        evaluate()
        return result[:count].reshape(*shape, self._size)

    def _map(self, width: int, calls: int) -> ca.Function:
        return (self._one if width == 1 else self._several).map(calls)


def _repeated(function: ca.Function, width: int) -> ca.Function:
    """The function for `width` columns at once."""
    if width == 1:
        return function
    inputs = [ca.SX.sym(f"x{i}", function.size1_in(i), width) for i in range(function.n_in())]
    outputs = list[ca.SX]()
    for each in zip(*[ca.horzsplit(given) for given in inputs], strict=True):
        outputs.append(function(*each))
    return ca.Function("several", inputs, [ca.horzcat(*outputs)])
