"""Fewer points of a curve, with all its peaks."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array


def peaks(curves: Sequence[Array], most: int) -> NDArray[np.intp]:
    """Which points of some curves of one length to keep, in order: all, if there are few enough.

    Else the first, the last, and of each of equally long stretches the least and the greatest of
    every curve.

    Args:
        curves: shape (n,) each, numbers without NaN.
        most: points to keep at most.
    """
    count = len(curves[0])
    if count <= most:
        return np.arange(count)
    kept = [0, count - 1]
    for stretch in stretches(count, len(curves), most):
        for curve in curves:
            part = curve[stretch]
            kept += [stretch.start + int(part.argmin()), stretch.start + int(part.argmax())]
    return np.unique(kept)


def stretches(count: int, curves: int, most: int) -> list[slice]:
    """Stretches of points of which `peaks` keeps the extremes."""
    ends = np.linspace(0, count, max(1, (most - 2) // (2 * curves)) + 1).astype(int)
    return [slice(a, b) for a, b in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)]
