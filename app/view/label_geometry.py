"""Positions of a robot's labels: arcs of its joint angles, its lengths, and the axes of y.

Everything follows from the drawing, in the robot's own frame: x right, y away, z up, [m]. Labels
move with the robots, so this is a CasADi function, made once for each robot.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.systems.drawing import Angle, Length
from onpath.models.systems.robots import Robot

UP = ca.SX(ca.DM([0, 0, 1]))
ARC, STEP = 0.058, 0.02
"""Radius of the first arc, and the increase to each further one [m]."""
BEYOND = 0.016
"""How far outside an arc its name stands, and its reference line ends [m]."""
BESIDE = 0.026
"""Distance between a length's line and its name [m]."""
BEFORE = 0.016
"""How far in front of the links' plane arcs are drawn [m]."""
IN_FRONT = 0.1
"""How far before a joint of a chain its name stands, as a share of the reach."""
WAIST_RADIUS, WAIST_HEIGHT = 0.09, -0.028
"""The arc of the waist: around the turntable's plate [m]."""
AXIS = 0.075
"""Length of an axis [m]."""
SIDES = 16
"""Straight pieces of an arc."""
LEAST = 1e-9
"""Shorter vectors have no direction [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class Mark:
    """One label.

    Attributes:
        name: as shown.
        place: where the name stands, (3, 1), [m].
        lines: begin and end of lines as columns, (3, 2 n), [m].
    """

    name: str
    place: ca.SX
    lines: ca.SX


@dataclass(frozen=True, slots=True, eq=False)
class Arc:
    """The arc of an angle.

    Attributes:
        name: of the angle, as shown.
        centre: (3, 1), [m].
        radius: [m].
        begin: where it begins, from the first vector of the basis, [rad].
        turn: how far it turns, [rad].
        basis: unit vectors of its plane.
        at: where along the arc the name stands, from 0 to 1.
        both: whether there is a line at its end, too.
    """

    name: str
    centre: ca.SX
    radius: float
    begin: ca.SX
    turn: ca.SX
    basis: tuple[ca.SX, ca.SX]
    at: float = 0.5
    both: bool = False

    def points(self, far: float, turned: ca.SX) -> ca.SX:
        """Points at a distance from the centre, in directions (1, k), as columns (3, k)."""
        u, v = self.basis
        ray = u @ ca.cos(turned) + v @ ca.sin(turned)
        return self.centre @ ca.DM.ones(1, turned.shape[1]) + far * ray

    @property
    def way(self) -> ca.SX:
        """Points of the arc, (3, SIDES + 1), [m]."""
        shares = ca.DM(np.linspace(0.0, 1.0, SIDES + 1)).T
        return self.points(self.radius, self.begin + self.turn @ shares)


@dataclass(frozen=True, slots=True, eq=False)
class LinksPlane:
    """The plane of the links.

    Attributes:
        ahead: the horizontal direction in it from which angles are measured, (3, 1).
        near: its unit normal towards the viewer, (3, 1).
        start: the direction from which the waist's angle is measured, (3, 1).
    """

    ahead: ca.SX
    near: ca.SX
    start: ca.SX

    def angle(self, vector: ca.SX) -> ca.SX:
        """Angle of a vector in the plane from the horizontal, [rad]."""
        return ca.atan2(vector[2], ca.dot(vector, self.ahead))

    def left_of(self, vector: ca.SX) -> ca.SX:
        """The unit vector in the plane to the left of a direction, as angles are measured."""
        along, up = ca.dot(vector, self.ahead), vector[2]
        return (along * UP - up * self.ahead) / ca.fmax(ca.hypot(along, up), LEAST)


@dataclass(frozen=True, slots=True, eq=False)
class LabelFunction:
    """Labels of one kind of robot.

    Attributes:
        names: of angles and lengths, k of them.
        function: ends of all bars (3, 2 n) and the end-point (3, 1) -> places of the names, (3, k),
            then begin and end of all lines as columns, (3, 2 m); together (3, k + 2 m), [m].
    """

    names: list[str]
    function: ca.Function


@lru_cache(maxsize=64)
def label_function(robot: Robot, bars: int) -> LabelFunction:
    """The labels of a robot with so many bars."""
    ends, tip = ca.SX.sym("ends", 3, 2 * bars), ca.SX.sym("tip", 3)
    marks = list(_marks(robot, ends, tip))
    parts = [*(mark.place for mark in marks), *(mark.lines for mark in marks)]
    flat = ca.densify(ca.horzcat(ca.SX(3, 0), *parts))
    function = ca.Function("labels", [ends, tip], ca.cse([flat]))
    return LabelFunction([mark.name for mark in marks], function)


def axes_of(robot: Robot) -> np.ndarray:
    """The axes of y from its origin, begin and end, shape (p, 2, 3), [m]."""
    origin, *ends = robot.position(np.vstack([np.zeros(robot.system.p), np.eye(robot.system.p)]))
    return np.array([(origin, origin + AXIS * (end - origin)) for end in ends])


def _marks(robot: Robot, ends: ca.SX, tip: ca.SX) -> Iterator[Mark]:
    drawing, plane = robot.drawing, plane_of(robot, ends, tip)
    for arc in arcs_of(robot, ends, plane):
        yield _mark(arc, plane)
    for length in drawing.lengths:
        yield _length(length, plane, ends)
    for spot in drawing.spots:
        place = ends[:, spot.end] + IN_FRONT * robot.reach * plane.near
        yield Mark(spot.name, place, ca.SX(3, 0))


def arcs_of(robot: Robot, ends: ca.SX, plane: LinksPlane) -> Iterator[Arc]:
    """The arcs of a robot's joint angles."""
    waist = robot.drawing.waist
    for number, angle in enumerate(robot.drawing.angles):
        yield _angle(angle, ARC + number * STEP, plane, ends)
    if waist is not None:
        across = ca.cross(UP, plane.start)
        yield Arc(
            name=waist.name,
            centre=WAIST_HEIGHT * UP,
            radius=WAIST_RADIUS,
            begin=ca.SX(0),
            turn=ca.atan2(ca.dot(plane.ahead, across), ca.dot(plane.ahead, plane.start)),
            basis=(plane.start, across),
            both=True,
        )


def plane_of(robot: Robot, ends: ca.SX, tip: ca.SX) -> LinksPlane:
    """The plane of a robot's links.

    Args:
        ends: of its bars, (3, 2 n), [m].
        tip: its end-point, (3, 1), [m].
    """
    drawing, waist = robot.drawing, robot.drawing.waist
    start = ahead = ca.SX(ca.DM([1, 0, 0]))
    if waist is not None:
        origin, first = robot.position(np.eye(2, robot.system.p, -1))
        level = (first - origin) * [1.0, 1.0, 0.0]
        start = ca.SX(ca.DM(level / np.linalg.norm(level)))
        forward = tip if waist.bar is None else _along(ends, waist.bar)
        flat = ca.vertcat(forward[:2], 0)
        length = ca.hypot(flat[0], flat[1])
        ahead = ca.if_else(length > LEAST, flat / ca.fmax(length, LEAST), start)
    normal = ca.cross(ahead, UP)
    away = normal[0] * drawing.away[0] + normal[1] * drawing.away[1]
    return LinksPlane(ahead, ca.if_else(away > 0, -normal, normal), start)


def _along(ends: ca.SX, bar: int) -> ca.SX:
    return ends[:, 2 * bar + 1] - ends[:, 2 * bar]


def _angle(angle: Angle, radius: float, plane: LinksPlane, ends: ca.SX) -> Arc:
    begin = ca.SX(0) if angle.after is None else plane.angle(_along(ends, angle.after))
    turn = angle.near + within_half(plane.angle(_along(ends, angle.bar)) - begin - angle.near)
    return Arc(
        name=angle.name,
        centre=ends[:, 2 * angle.bar],
        radius=radius,
        begin=begin,
        turn=turn,
        basis=(plane.ahead, UP),
        at=angle.at,
    )


def within_half(angle: ca.SX) -> ca.SX:
    """The same angle within ±π, [rad]."""
    return ca.atan2(ca.sin(angle), ca.cos(angle))


def _mark(arc: Arc, plane: LinksPlane) -> Mark:
    """An arc with the line from which it is measured, and its name outside."""
    if not arc.both:
        arc = replace(arc, centre=arc.centre + BEFORE * plane.near)
    way, far = arc.way, arc.radius + BEYOND
    ends = [arc.begin, arc.begin + arc.turn] if arc.both else [arc.begin]
    arms = [part for end in ends for part in (arc.centre, arc.points(far, end))]
    pieces = ca.reshape(ca.vertcat(way[:, :-1], way[:, 1:]), 3, 2 * SIDES)
    place = arc.points(far, arc.begin + arc.at * arc.turn)
    return Mark(arc.name, place, ca.horzcat(pieces, *arms))


def _length(length: Length, plane: LinksPlane, ends: ca.SX) -> Mark:
    count = ends.shape[1]
    begin, end = ends[:, length.begin % count], ends[:, length.end % count]
    aside = (-BESIDE if length.right else BESIDE) * plane.left_of(end - begin)
    return Mark(length.name, begin + length.at * (end - begin) + aside, ca.SX(3, 0))
