"""Computations of a page without a server while a control point of a path is dragged.

The checks are those of models/paths/path_checks.py; `wasm_loop.py` translates the functions and
scans.
"""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.page_functions import GRID, lift_of, placed, view_of
from onpath.models.closed_loop.wasm_loop import Scan
from onpath.models.paths.path_checks import (
    POINT_CHECKS,
    PathPoint,
    StrandPair,
    crosses,
    narrow,
    sampled_theta,
)
from onpath.models.paths.path_design import REACH
from onpath.models.paths.projection import basis
from onpath.models.standalone.fit import mix_function, scan_of
from onpath.models.systems.robots import Robot, margin_of

CHECKS = (*POINT_CHECKS, "narrow")
"""The last numbers of a row of `check`; `strands` finds "crosses"."""
ROW = 3 + len(CHECKS)
OUTLINE = 241
"""Points of a path as it is drawn."""


def edit_functions(robot: Robot, kind: Kind) -> dict[str, ca.Function]:
    """The functions for planar paths of a kind.

    spot: a point z of the path's plane -> its position in the picture, (2, 1)
    planar: (z, from, to) -> z moved as the picture's point moves
    toward: (z, target, share) -> that share of the way, within ±REACH
    mix: see `mix_function`
    """
    z, target, share = ca.SX.sym("z", 2), ca.SX.sym("target", 2), ca.SX.sym("share")
    begin, end = ca.SX.sym("begin", 2), ca.SX.sym("end", 2)
    lift, (seen, offset) = lift_of(robot, kind), view_of(robot)
    axes = ca.horzcat(*(lift(ca.SX(ca.DM(each)), True) for each in ([1, 0], [0, 1])))
    moved = z + ca.inv(placed(robot, axes, seen)) @ (end - begin)
    limited = ca.fmax(ca.fmin(z + share * (target - z), REACH), -REACH)
    return {
        "spot": ca.Function("spot", [z], [placed(robot, lift(z, False), seen) + offset]),
        "planar": ca.Function("planar", [z, begin, end], [moved]),
        "toward": ca.Function("toward", [z, target, share], [limited]),
        "mix": mix_function(int(np.prod(kind.table_shape))),
    }


def edit_scans(robot: Robot, kind: Kind) -> dict[str, Scan]:
    """The scans for planar paths of a kind; the constants are the table.

    grid: `GRID` steps from state 0 -> the argument `grid` of `distance`
    outline: `OUTLINE` steps from state 0 -> points of the path in the picture
    check: `SAMPLES` + 1 steps from (0, 0, 0, 0) -> rows (z, arc length, 1 or 0 for `CHECKS`)
    strands: compares a point with later ones, see `_strands`; constants are its row and the
        next, rows those of the later points
    """
    lift, (seen, offset) = lift_of(robot, kind), view_of(robot)
    return {
        "grid": _points(kind, GRID, lambda z: lift(z, False)),
        "outline": _points(
            kind, OUTLINE, lambda z: placed(robot, lift(z, False), seen) + offset, to_the_end=True
        ),
        "check": _check(robot, kind),
        "strands": _strands(kind),
    }


def _points(kind: Kind, count: int, of: Callable[[ca.SX], ca.SX], to_the_end: bool = False) -> Scan:
    """A function of evenly spaced points of a path; state: the number of the next point."""
    number, table = ca.SX.sym("number"), ca.SX.sym("table", *kind.table_shape)
    inner = count if kind.closed and not to_the_end else count - 1
    theta = number * (2 * np.pi / inner) - np.pi
    point = (table @ basis(theta, kind.closed))[: kind.table_shape[0] // 4]
    return scan_of(0, [number, table, ca.SX.sym("rows", 0)], [number + 1, of(point)])


def _check(robot: Robot, kind: Kind) -> Scan:
    """The scan "check"; the last row of a closed curve is its first point."""
    state, table = ca.SX.sym("state", 4), ca.SX.sym("table", *kind.table_shape)
    number, length, before = state[0], state[1], state[2:]
    theta = sampled_theta(number, kind.closed)
    z, first, second, _ = ca.vertsplit(table @ basis(theta, kind.closed), 2)
    step = z - before
    length = ca.if_else(number == 0, 0, length + ca.sqrt(ca.dot(step, step)))
    margin = margin_of(robot, lift_of(robot, kind)(z, False))
    at = PathPoint(first, second, margin)
    row = ca.vertcat(z, length, *(check(at) for check in POINT_CHECKS.values()), 0)
    after = ca.vertcat(number + 1, length, z)
    return scan_of(0, [state, table, ca.SX.sym("rows", 0)], [after, row])


def _strands(kind: Kind) -> Scan:
    """Whether the strand at a point comes near another one, or crosses it.

    State: 1 if it is near one, 1 if it crosses one, the place (2), and the length of the path.
    """
    state = ca.SX.sym("state", 5)
    here, rows = ca.SX.sym("own", 2 * ROW), ca.SX.sym("rows", 2 * ROW)
    arc = ca.fabs(rows[2] - here[2])
    if kind.closed:
        arc = ca.fmin(arc, state[4] - arc)
    (a, d), (b, e) = _segment(here), _segment(rows)
    pair = StrandPair(a=a, d=d, b=b, e=e, arc=arc)
    near, hit = narrow(pair), crosses(pair)
    place = ca.if_else(hit, pair.place, state[2:4])
    after = ca.vertcat(ca.fmax(state[0], near), ca.fmax(state[1], hit), place, state[4])
    row = ca.vertcat(rows[: ROW - 1], ca.fmax(rows[ROW - 1], near))
    return scan_of(ROW, [state, here, rows], [after, row])


def _segment(rows: ca.SX) -> tuple[ca.SX, ca.SX]:
    """From the point of a row to that of the next one: begin and direction."""
    return rows[:2], rows[ROW : ROW + 2] - rows[:2]
