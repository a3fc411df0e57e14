"""Scans of a page, step by step as its module takes them."""

from __future__ import annotations

import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.wasm_loop import Scan
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import WINDOW, SplineCurve


def steps_along(
    scan: Scan, kind: Kind, curve: Curve, state: Array, count: int
) -> tuple[Array, Array]:
    """The last state of a scan along a curve, and its rows of results."""
    table = curve.table().reshape(kind.table_shape, order="F")
    pieces = float(curve.pieces) if isinstance(curve, SplineCurve) else 0.0
    rows = list[Array]()
    for _ in range(count):
        piece = int(scan.where(state, pieces)) if scan.where else 0
        read = table[:, piece : piece + WINDOW] if scan.where else table
        after, row = scan.step(state, pieces, read)
        state = after.full().ravel()
        rows.append(row.full().ravel())
    return state, np.array(rows)
