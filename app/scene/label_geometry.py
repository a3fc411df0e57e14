"""Where the labels of a robot stand: arcs of its joint angles, its lengths, and the axes of y.

Everything is computed from what is drawn, in the robot's own frame: x right, y away, z up, [m].
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, cos, pi, remainder, sin

import numpy as np

from onpath.models.systems.drawing import Angle, Waist
from onpath.models.systems.robots import Robot

UP = np.array([0.0, 0.0, 1.0])
ARC, STEP = 0.058, 0.02
"""Radius of the first arc, and how much larger each further one is [m]."""
BEYOND = 0.016
"""How far outside its arc the name of an angle stands, and a reference line ends [m]."""
BESIDE = 0.026
"""How far from the middle of a length its name stands [m]."""
BEFORE = 0.016
"""How far in front of the links' plane arcs are drawn [m]."""
WAIST_RADIUS, WAIST_HEIGHT = 0.09, -0.028
"""The arc of the waist: on the turntable's plate [m]."""
AXIS = 0.075
"""Length of an axis [m]."""
SIDES = 16
"""Straight pieces of an arc."""


@dataclass(frozen=True, slots=True, eq=False)
class Labelled:
    """What is labelled of one robot.

    Attributes:
        names: of angles and lengths, k of them.
        places: where these names stand, shape (k, 3), [m].
        lines: arcs and their reference lines, shape (n, 2, 3), [m].
    """

    names: list[str]
    places: np.ndarray
    lines: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class LinksPlane:
    """The plane of the links.

    Attributes:
        ahead: the horizontal direction in it from which angles are measured, of unit length.
        near: its unit normal towards the viewer.
        start: the direction from which the waist's angle is measured.
    """

    ahead: np.ndarray
    near: np.ndarray
    start: np.ndarray


def labelled(robot: Robot, ends: np.ndarray, tip: np.ndarray) -> Labelled:
    """Arcs of the joint angles, and places of all names.

    Args:
        ends: begin and end of every bar as drawn, shape (2 n, 3), [m].
        tip: the end-point, shape (3,), [m].
    """
    drawing = robot.drawing
    plane = _plane(robot, ends, tip)
    names, places, lines = list[str](), list[np.ndarray](), list[np.ndarray]()
    for number, angle in enumerate(drawing.angles):
        arc, place = _arc(angle, ARC + number * STEP, plane, ends)
        names.append(angle.name)
        places.append(place)
        lines.append(arc)
    if drawing.waist is not None:
        arc, place = _waist_arc(plane)
        names.append(drawing.waist.name)
        places.append(place)
        lines.append(arc)
    for length in drawing.lengths:
        begin, end = ends[length.begin], ends[length.end]
        names.append(length.name)
        aside = (-BESIDE if length.right else BESIDE) * _left_of(end - begin, plane)
        places.append(begin + length.at * (end - begin) + aside)
    drawn = np.concatenate(lines) if lines else np.zeros((0, 2, 3))
    return Labelled(names, np.array(places).reshape(-1, 3), drawn)


def axes_of(robot: Robot) -> np.ndarray:
    """The axes of y from its origin, begin and end, shape (p, 2, 3), [m]."""
    origin, *ends = robot.place(np.vstack([np.zeros(robot.system.p), np.eye(robot.system.p)]))
    return np.array([(origin, origin + AXIS * (end - origin)) for end in ends])


def _plane(robot: Robot, ends: np.ndarray, tip: np.ndarray) -> LinksPlane:
    waist, drawing = robot.drawing.waist, robot.drawing
    start = np.array([1.0, 0.0, 0.0])
    ahead = start
    if waist is not None:
        origin, first = robot.place(np.eye(2, robot.system.p, -1))
        start = _level(first - origin, start)
        ahead = _level(_forward(waist, ends, tip), start)
    normal = np.cross(ahead, UP)
    away = normal[0] * drawing.away[0] + normal[1] * drawing.away[1]
    return LinksPlane(ahead, -normal if away > 0 else normal, start)


def _forward(waist: Waist, ends: np.ndarray, tip: np.ndarray) -> np.ndarray:
    return tip if waist.bar is None else _along(ends, waist.bar)


def _along(ends: np.ndarray, bar: int) -> np.ndarray:
    return ends[2 * bar + 1] - ends[2 * bar]


def _level(vector: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """The horizontal part of a vector, of unit length; another one where there is none."""
    flat = vector * [1.0, 1.0, 0.0]
    length = float(np.linalg.norm(flat))
    return flat / length if length > 1e-9 else otherwise


def _left_of(vector: np.ndarray, plane: LinksPlane) -> np.ndarray:
    """The unit vector in the links' plane to the left of a direction, as angles are measured."""
    along, up = float(vector @ plane.ahead), float(vector @ UP)
    length = max(float(np.hypot(along, up)), 1e-9)
    return (along * UP - up * plane.ahead) / length


def _arc(
    angle: Angle, radius: float, plane: LinksPlane, ends: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Arc and reference line of an angle, (n, 2, 3), and the place of its name, (3,)."""
    begin = 0.0 if angle.after is None else _direction(_along(ends, angle.after), plane)
    end = _direction(_along(ends, angle.bar), plane)
    turn = angle.near + remainder(end - begin - angle.near, 2 * pi)
    centre = ends[2 * angle.bar] + BEFORE * plane.near
    return _drawn(centre, radius, (begin, turn), (plane.ahead, UP), angle.at)


def _direction(vector: np.ndarray, plane: LinksPlane) -> float:
    """Angle of a vector in the links' plane from the horizontal, [rad]."""
    return atan2(float(vector @ UP), float(vector @ plane.ahead))


def _waist_arc(plane: LinksPlane) -> tuple[np.ndarray, np.ndarray]:
    """Arc and lines of the waist's angle, and the place of its name."""
    across = np.cross(UP, plane.start)
    turn = atan2(float(plane.ahead @ across), float(plane.ahead @ plane.start))
    centre = WAIST_HEIGHT * UP
    return _drawn(centre, WAIST_RADIUS, (0.0, turn), (plane.start, across), 0.5, both=True)


def _drawn(
    centre: np.ndarray,
    radius: float,
    angles: tuple[float, float],
    basis: tuple[np.ndarray, np.ndarray],
    at: float,
    both: bool = False,
) -> tuple[np.ndarray, np.ndarray]:
    """An arc with the line from which it is measured, and outside it a place for a name.

    Args:
        angles: where it begins, and how far it turns, [rad].
        basis: unit vectors of its plane.
        at: where along the arc the name stands, from 0 to 1.
        both: whether there is a line at its end, too.
    """
    begin, turn = angles
    u, v = basis
    turned = begin + np.linspace(0.0, turn, SIDES + 1)[:, None]
    line = centre + radius * (np.cos(turned) * u + np.sin(turned) * v)
    rays = [centre + (radius + BEYOND) * (cos(a) * u + sin(a) * v) for a in (begin, begin + turn)]
    arms = [(centre, ray) for ray in (rays if both else rays[:1])]
    middle = begin + at * turn
    place = centre + (radius + BEYOND) * (cos(middle) * u + sin(middle) * v)
    return np.concatenate([np.stack([line[:-1], line[1:]], axis=1), np.array(arms)]), place
