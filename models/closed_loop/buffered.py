"""A CasADi function called on flat arrays, at a tenth of the price of its usual call."""

from __future__ import annotations

from typing import Any

import casadi as ca
import numpy as np

from onpath.models.arrays import Array


class Buffered:
    """A function with memory of its own for what goes in and out. One thread at a time."""

    def __init__(self, function: ca.Function) -> None:
        self._arguments = [np.zeros(function.nnz_in(i)) for i in range(function.n_in())]
        self._results = [np.zeros(function.nnz_out(i)) for i in range(function.n_out())]
        buffer: Any
        buffer, self._evaluate = function.buffer()
        for i, argument in enumerate(self._arguments):
            buffer.set_arg(i, argument.data)
        for i, result in enumerate(self._results):
            buffer.set_res(i, result.data)
        self._buffer = buffer  # keeps the memory alive

    def __call__(self, *arguments: Array | float) -> list[Array]:
        """Dense matrices, by columns, flat; the results are overwritten by the next call."""
        for own, given in zip(self._arguments, arguments, strict=True):
            own[:] = given
        self._evaluate()
        return self._results
