"""Where a path goes, and its closest point, for pages without a server.

`wasm_loop.py` translates the scans. Their constant is the number of pieces of a drawing, and their
rows are the curve's table: a step reads the control points of one piece, or all of a series.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.page_functions import lift_of
from onpath.models.closed_loop.wasm_loop import Scan
from onpath.models.paths.curves import PERIOD
from onpath.models.paths.projection import LocalCurve, basis, spline_basis, windowed
from onpath.models.paths.spline_curves import WINDOW
from onpath.models.systems.robots import Robot

GRID = 128
"""Points of a series from which the search for the closest one begins; a drawing has more."""
REFINEMENTS = 4
STEP = 0.1  # [rad], largest step of Newton's method on a series
PIECES = 1.5  # the same on a drawing, whose strands may be close to each other


def curve_scans(robot: Robot, kind: Kind) -> dict[str, Scan]:
    """The scans for paths of a kind; y is in the output space, (p, 1), [m].

    curve: from (number, θ of number 0, step, last θ) -> rows (σ, σ', σ'', σ''') at the next θ
    nearest: `REFINEMENTS` + 1 steps from (θ, y) -> rows (distance from y to the path at θ, the
        point there), after each of which θ is nearer to the closest point
    lowest: from (θ, y, number, squared distance) along rows of evenly spaced points, whose distance
        in θ is the constant -> the same state, with the θ of the nearest one
    """
    state, pieces = ca.SX.sym("state", 4), ca.SX.sym("pieces")
    number, begin, step, last = ca.vertsplit(state)

    def every(at: LocalCurve) -> tuple[ca.SX, ca.SX]:
        after = ca.vertcat(number + 1, begin, step, last)
        return after, ca.vertcat(at.sigma, at.first, at.second, at.third)

    theta = ca.fmin(begin + number * step, last)
    scans = {
        "curve": scan_on(kind, state, pieces, theta, every),
        "nearest": _nearest(robot, kind),
        "lowest": _lowest(robot),
    }
    return scans


def scan_on(
    kind: Kind,
    state: ca.SX,
    pieces: ca.SX,
    theta: ca.SX,
    of: Callable[[LocalCurve], tuple[ca.SX, ca.SX]],
) -> Scan:
    """A scan each of whose steps needs the curve at one θ.

    Args:
        state, pieces: symbols of the state and of the number of pieces.
        theta: of the place.
        of: the curve there -> the next state, and the row of results.
    """
    where = None
    if kind.spline:
        columns, piece = spline_basis(theta, kind.closed, pieces)
        table = ca.SX.sym("window", kind.dimension, WINDOW)
        values, where = windowed([table], columns), ca.Function("where", [state, pieces], [piece])
    else:
        table = ca.SX.sym("table", *kind.table_shape)
        values = table @ basis(theta, kind.closed)
    outputs = of(LocalCurve.from_values(theta, kind.closed, values))
    dense = [ca.densify(each) for each in ca.cse([*outputs])]
    step = ca.Function("step", [state, pieces, table], dense)
    return Scan(step, 0, where=where, row=kind.dimension)


def beyond_function(robot: Robot, kind: Kind) -> ca.Function:
    """(values at an end of an open path, sign of θ there, y) -> (distance, closest point) of the
    half-line by which the curve continues."""
    lift, y = lift_of(robot, kind), ca.SX.sym("y", robot.system.p)
    values, sign = ca.SX.sym("values", kind.value_rows), ca.SX.sym("sign")
    sigma, first, *_ = ca.vertsplit(values, kind.dimension)
    tip, away = lift(sigma, False), sign * lift(first, True)
    point = tip + ca.fmax(ca.dot(y - tip, away), 0) / ca.dot(away, away) * away
    return ca.Function("beyond", [values, sign, y], [ca.densify(_away(y, point))])


def _nearest(robot: Robot, kind: Kind) -> Scan:
    """Newton's method for (σ - y) · σ' = 0, as in `onpath.models.paths.distance`."""
    state, pieces = ca.SX.sym("state", 1 + robot.system.p), ca.SX.sym("pieces")
    theta, y, lift = state[0], state[1:], lift_of(robot, kind)
    reach = ca.fmin(STEP, PIECES * PERIOD / pieces) if kind.spline else STEP

    def improved(at: LocalCurve) -> tuple[ca.SX, ca.SX]:
        point, first = lift(at.sigma, False), lift(at.first, True)
        squared, gap = ca.dot(first, first), point - y
        slope = ca.fmax(squared + ca.dot(gap, lift(at.second, True)), 0.2 * squared)
        step = ca.fmin(ca.fmax(ca.dot(gap, first) / slope, -reach), reach)
        return ca.vertcat(theta - step, y), _away(y, point)

    return scan_on(kind, state, pieces, theta, improved)


def _lowest(robot: Robot) -> Scan:
    p, span = robot.system.p, ca.SX.sym("span")
    state, point = ca.SX.sym("state", p + 3), ca.SX.sym("point", p)
    theta, y, number, lowest = state[0], state[1 : p + 1], state[p + 1], state[p + 2]
    squared = ca.dot(point - y, point - y)
    theta = ca.if_else(squared < lowest, number * span - np.pi, theta)
    after = ca.vertcat(theta, y, number + 1, ca.fmin(squared, lowest))
    inputs = [state, span, point]
    return Scan(ca.Function("step", inputs, [ca.densify(after), ca.SX(0, 1)]), p)


def scan_of(stride: int, inputs: list[ca.SX], outputs: list[ca.SX]) -> Scan:
    """A scan from the symbols of its inputs and the expressions of its outputs."""
    step = ca.Function("step", inputs, [ca.densify(each) for each in ca.cse(outputs)])
    return Scan(step, stride)


def _away(y: ca.SX, point: ca.SX) -> ca.SX:
    """The distance of y from a point, and the point."""
    return ca.vertcat(ca.sqrt(ca.dot(point - y, point - y)), point)
