"""A single call of a CasADi function on arrays."""

from __future__ import annotations

import casadi as ca
import numpy as np

from onpath.models.arrays import Array


def evaluated(function: ca.Function, *arguments: Array) -> list[Array]:
    """The results of a function, at a third of the cost of the usual call. Thread-safe.

    Args:
        function: with dense inputs and outputs.
        arguments: its inputs as C-ordered arrays of their transposes: a matrix has one row for
            each of its columns. The results are the same, shape (columns, rows).
    """
    buffer, evaluate = function.buffer()
    given = [np.ascontiguousarray(each, dtype=np.float64) for each in arguments]
    for i, argument in enumerate(given):
        if argument.size != function.numel_in(i):
            raise ValueError(f"argument {i}: {argument.size} numbers, not {function.numel_in(i)}")
        buffer.set_arg(i, argument.ravel().data)
    results = [np.empty(function.size_out(i)[::-1]) for i in range(function.n_out())]
    for i, result in enumerate(results):
        buffer.set_res(i, result.data)
    evaluate()
    return results
