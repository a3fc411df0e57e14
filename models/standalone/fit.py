"""Fits a path's curve to its control points, for pages without a server.

The same as `closed_through` and `open_through` of models/paths/curve_fit.py, for a fixed number of
points, as functions that `wasm_loop.py` translates. A spline is a list of pieces, each of `PIECE`
numbers: the knot where it begins, how many of the fine knots lie in it, and its coefficients.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.closed_loop.wasm_loop import Scan
from onpath.models.paths.curve_fit import SAMPLES, SHORTEST
from onpath.models.paths.curves import ORDERS, TERMS, from_terms, terms_of
from onpath.models.paths.projection import basis

FINE = 16 * SAMPLES  # intervals of the spline between the points whose distances are summed
PIECE = 10
CLOSEST = 1e-4  # [m], nearer control points count as one
Columns = list[ca.SX]


@lru_cache(maxsize=64)
def spline_function(closed: bool, count: int) -> ca.Function:
    """Control points, (2, count) -> pieces, (PIECE, n + 1), first state of `arc_scan`, and results.

    These are (bad, length). The last piece only ends the others. `bad` is 1 if two neighbours
    coincide, 2 if the path is too short, else 0; the length is in [mm].
    """
    given = ca.SX.sym("points", 2, count)
    points = ca.horzsplit(given) + ([given[:, 0]] if closed else [])
    steps = [after - before for before, after in pairwise(points)]
    gaps = [ca.sqrt(ca.dot(step, step)) for step in steps]
    width = [ca.sqrt(gap) for gap in gaps]
    slope = [step / h for step, h in zip(steps, width, strict=True)]
    bend = (_periodic if closed else _natural)(width, slope)
    knots = [ca.SX(0)]
    for h in width:
        knots.append(knots[-1] + h)
    fine, pieces = knots[-1] / FINE, Columns()
    for i, h in enumerate(width):
        first = slope[i] - h * (2 * bend[i] + bend[i + 1]) / 6
        third = (bend[i + 1] - bend[i]) / (6 * h)
        end = ca.SX(FINE) if i == len(width) - 1 else _before(knots[i + 1], fine)
        inside = end - _before(knots[i], fine)
        pieces.append(ca.vertcat(knots[i], inside, points[i], first, bend[i] / 2, third))
    pieces.append(ca.vertcat(knots[-1] + 1, ca.SX.zeros(PIECE - 1)))
    ends = points[-2 if closed else -1] - points[0]
    apart = ca.SX(1)
    for gap in [*gaps, ca.sqrt(ca.dot(ends, ends))]:
        apart = ca.fmin(apart, gap > CLOSEST)
    length = sum(gaps[: count - 1], ca.SX(0))
    bad = ca.if_else(apart, 2 * (length < SHORTEST), 1)
    start = ca.vertcat(0, 0, points[0], fine)
    results = [ca.horzcat(*pieces), start, ca.vertcat(bad, 1e3 * length)]
    return ca.Function("spline", [given], [ca.densify(each) for each in results])


def _before(knot: ca.SX, fine: ca.SX) -> ca.SX:
    """Number of the fine knots 0, fine, 2 fine... below a knot."""
    return -ca.floor(-knot / fine)


def _natural(width: Columns, slope: Columns) -> Columns:
    """Second derivatives at the knots of a spline that is straight at its ends."""
    zero, inner = ca.SX.zeros(2), range(1, len(width))
    found = _tridiagonal(
        [2 * (width[i - 1] + width[i]) for i in inner],
        [width[i] for i in inner][:-1],
        [6 * (slope[i] - slope[i - 1]) for i in inner],
    )
    return [zero, *found, zero]


def _periodic(width: Columns, slope: Columns) -> Columns:
    """Second derivatives at the knots of a closed spline, by the formula of Sherman and Morrison.

    Row i of the system: w_(i-1) M_(i-1) + 2 (w_(i-1) + w_i) M_i + w_i M_(i+1) = 6 (d_i - d_(i-1)).
    """
    n, corner = len(width), width[-1]
    main = [2 * (width[i - 1] + width[i]) for i in range(n)]
    right = [6 * (slope[i] - slope[i - 1]) for i in range(n)]
    pivot = -main[0]
    unit = [pivot, *[ca.SX(0)] * (n - 2), corner]
    main = [main[0] - pivot, *main[1:-1], main[-1] - corner**2 / pivot]
    both = [ca.vertcat(r, u) for r, u in zip(right, unit, strict=True)]
    found = _tridiagonal(main, width[:-1], both)
    share = (found[0] + corner / pivot * found[-1]) / (
        1 + found[0][2] + corner / pivot * found[-1][2]
    )
    bends = [each[:2] - share[:2] * each[2] for each in found]
    return [*bends, bends[0]]


def _tridiagonal(main: Columns, beside: Columns, right: Columns) -> Columns:
    """The solution of a symmetric tridiagonal system with vectors on its right side."""
    main, right = list(main), list(right)
    for i, b in enumerate(beside):
        factor = b / main[i]
        main[i + 1] -= factor * b
        right[i + 1] -= factor * right[i]
    found = [right[-1] / main[-1]] if main else []
    for i in range(len(beside) - 1, -1, -1):
        found.insert(0, (right[i] - beside[i] * found[0]) / main[i])
    return found


def arc_scan() -> Scan:
    """Arc length along a spline: one step for each fine knot of a piece.

    State: number of the knot, length up to it, the point there, and the distance between knots.
    Constants: the piece, and the next one. Result: (knot, length up to it, and up to the next one).
    """
    state, pieces = ca.SX.sym("state", 5), ca.SX.sym("pieces", PIECE, 2)
    number, length, here, fine = state[0], state[1], state[2:4], state[4]
    there = _on(pieces, (number + 1) * fine)
    step = there - here
    after = length + ca.sqrt(ca.dot(step, step))
    following = ca.vertcat(number + 1, after, there, fine)
    row = ca.vertcat(number * fine, length, after)
    return scan_of(0, [state, pieces, ca.SX.sym("rows", 0)], [following, row])


def resample_scan(closed: bool) -> Scan:
    """Points at equal arc length, each times the basis at its θ, and summed.

    State: number of the next point, total length, distance of fine knots, and the sums, (2, TERMS).
    The constants are those of `arc`, and the rows are its results.
    """
    state, pieces = ca.SX.sym("state", 3 + 2 * TERMS), ca.SX.sym("pieces", PIECE, 2)
    row = ca.SX.sym("row", 3)
    number, total, fine = state[0], state[1], state[2]
    knot, length, after = row[0], row[1], row[2]
    wanted = ca.fmin(number * total / (SAMPLES if closed else SAMPLES - 1), total)
    here = ca.logic_and(number < SAMPLES, wanted <= after)
    share = (wanted - length) / ca.fmax(after - length, 1e-300)
    point = here * _on(pieces, knot + share * fine)
    theta = -np.pi + number * (2 * np.pi / (SAMPLES if closed else SAMPLES - 1))
    sums = state[3:] + ca.vec(point @ basis(theta, closed).T)
    return scan_of(
        3, [state, pieces, row], [ca.vertcat(number + here, total, fine, sums), ca.SX(0, 1)]
    )


@lru_cache(maxsize=2)
def table_function(closed: bool) -> ca.Function:
    """The last state of `resample_scan` -> `Curve.table` of the curve that fits best."""
    state, count = ca.SX.sym("state", 3 + 2 * TERMS), terms_of(closed)
    theta = np.linspace(-np.pi, np.pi, SAMPLES, endpoint=not closed)
    x = ca.SX.sym("x")
    values = ca.Function("basis", [x], [basis(x, closed)])(theta[None]).full()[:count]
    gram: Array = np.asarray(np.linalg.inv(values @ values.T), dtype=float)
    gram[np.abs(gram) < 1e-15] = 0.0
    terms = ca.reshape(state[3:], 2, TERMS)[:, :count] @ ca.sparsify(ca.DM(gram))
    series = from_terms(closed, np.eye(count)).series  # (ORDERS, TERMS, count)
    orders = [terms @ ca.sparsify(ca.DM(series[order].T)) for order in range(ORDERS)]
    return ca.Function("table", [state], [ca.densify(ca.vertcat(*orders))])


def _on(pieces: ca.SX, knot: ca.SX) -> ca.SX:
    """The point of a spline at a knot in the first of two pieces, or in the second, (2, 1)."""
    piece = ca.if_else(knot < pieces[0, 1], pieces[:, 0], pieces[:, 1])
    u, coefficients = knot - piece[0], ca.reshape(piece[2:], 2, 4)
    point = coefficients[:, 3]
    for i in (2, 1, 0):
        point = coefficients[:, i] + u * point
    return point


def scan_of(stride: int, inputs: Columns, outputs: Columns) -> Scan:
    """A scan from the symbols of its inputs and the expressions of its outputs."""
    step = ca.Function("step", inputs, [ca.densify(each) for each in ca.cse(outputs)])
    return Scan(step, stride)
