"""Reduces the number of points of a curve without losing its peaks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array


def peaks(curves: Sequence[Array], most: int) -> NDArray[np.intp]:
    """Indices of the points to keep of several curves of equal length, in increasing order.

    At most `most` points are all kept. Otherwise the first and the last are kept, and
    the minimum and maximum of every curve on each of a number of equally long intervals.

    Args:
        curves: shape (n,) each, without NaN.
        most: largest number of points to keep.
    """
    count = len(curves[0])
    if count <= most:
        return np.arange(count)
    kept = [0, count - 1]
    for interval in intervals(count, len(curves), most):
        for curve in curves:
            part = curve[interval]
            kept += [interval.start + int(part.argmin()), interval.start + int(part.argmax())]
    return np.unique(kept)


def intervals(count: int, curves: int, most: int) -> list[slice]:
    """The intervals of points of which `peaks` keeps the extremes."""
    ends = np.linspace(0, count, max(1, (most - 2) // (2 * curves)) + 1).astype(int)
    return [slice(a, b) for a, b in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)]
