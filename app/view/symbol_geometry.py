"""What a lesson's symbols of joints mean on a robot: an angle's arc, a joint, a distance.

The page's data channel tells them while someone points at such a symbol. Symbols of anything else
are drawn by the page from what it knows; see assets/web/core/symbols.ts.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import get_args

import casadi as ca
import numpy as np

from onpath.app.channel.symbol_messages import JointSymbol
from onpath.app.lab.snapshots.snapshot import END, Motion
from onpath.app.view.label_geometry import Arc, arcs_of, plane_of, within_half
from onpath.lessons.symbols import SYMBOLS
from onpath.models.arrays import Array
from onpath.models.systems.robots import Robot

ARC = 0.05
"""Radius of the arc at the elbow [m]."""
_JOINTS = {SYMBOLS[name][2]: name for name in ("q_1", "q_2")}
AT_JOINTS: tuple[JointSymbol, ...] = get_args(JointSymbol)
"""The symbols whose meaning depends on the kind of robot."""


def has_meaning(symbol: str, robot: Robot) -> bool:
    """Whether a robot has what a symbol means."""
    if symbol not in AT_JOINTS:
        return True
    drawing = robot.drawing
    if symbol in ("delta", "rho"):
        return drawing.elbow is not None
    named = [angle.name for angle in drawing.angles]
    named += [] if drawing.waist is None else [drawing.waist.name]
    named += [name for spot in drawing.spots for name in spot.name.split(", ")]
    return SYMBOLS[symbol][2] in named


def symbol_lines(symbol: str, robot: Robot, motion: Motion) -> list[Array]:
    """What a symbol of a joint means on each robot, as points of the output space.

    Args:
        symbol: one that has a meaning for the robot, see `has_meaning`; or "bars".

    Returns:
        For each robot a line, a joint, or the ends of all bars, shape (k, p) with k = 1 for a
        joint, [m].
    """
    bars = motion.counts.bars
    if symbol == "bars":
        return [robot.output_at(drawn[: 6 * bars].reshape(-1, 3)) for drawn in motion.drawn]
    function = _function(symbol, robot, bars)
    points = (
        np.array(function(drawn[: 6 * bars].reshape(-1, 3).T, motion.point(i, END))).T
        for i, drawn in enumerate(motion.drawn)
    )
    return [robot.output_at(np.nan_to_num(each)) for each in points]


@lru_cache(maxsize=64)
def _function(symbol: str, robot: Robot, bars: int) -> ca.Function:
    """Ends of all bars (3, 2 n) and the end-point (3, 1) -> the points, (3, k), [m]."""
    ends, tip = ca.SX.sym("ends", 3, 2 * bars), ca.SX.sym("tip", 3)
    line = next(_lines(symbol, robot, ends, tip))
    return ca.Function("symbol", [ends, tip], [ca.densify(ca.cse(line))])


def _lines(symbol: str, robot: Robot, ends: ca.SX, tip: ca.SX) -> Iterator[ca.SX]:
    """The line or joint of a symbol, if the robot has it."""
    drawing, plane = robot.drawing, plane_of(robot, ends, tip)
    links = [ends[:, 2 * angle.bar + 1] for angle in drawing.angles]
    for number, arc in enumerate(arcs_of(robot, ends, plane)):
        if _JOINTS.get(arc.name) == symbol:
            link = arc.way[:, -1] if arc.both else links[number]
            yield ca.horzcat(link, arc.centre, arc.way)
    for spot in drawing.spots:
        if symbol in map(_JOINTS.get, spot.name.split(", ")):
            yield ends[:, spot.end]
    if drawing.elbow is None:
        return
    base, elbow, end = ends[:, 0], ends[:, drawing.elbow], ends[:, -1]
    if symbol == "rho":
        yield ca.horzcat(base, end)
    elif symbol == "delta":
        begin = plane.angle(base - elbow)
        yield Arc(
            name="δ",
            centre=elbow,
            radius=ARC,
            begin=begin,
            turn=within_half(plane.angle(end - elbow) - begin),
            basis=(plane.ahead, ca.SX(ca.DM([0, 0, 1]))),
        ).way
