"""The drawing of a robot beyond its bars and joints: data that a model may provide.

Points are in the robot's frame (x right, y away from the viewer, z up, base pivot at the origin),
in metres. The defaults suit a robot whose links move in the vertical plane y = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Point = tuple[float, float, float]

FRONT_LAYER = 0.022
"""Depth of the front layer of links behind the robot's plane [m]."""
BACK_LAYER = 0.038
"""Depth of the back layer [m]."""
BOSS = (FRONT_LAYER + BACK_LAYER) / 2
"""Depth of the middle of the bearings, which span both layers [m]."""
PEN_DEPTH = 0.0103
"""Depth of the pen's centre, at which the pen touches the robot's plane [m]."""


@dataclass(frozen=True, slots=True)
class Depths:
    """Depths along the normal of the links' plane, away from the viewer, [m]."""

    back: float = BACK_LAYER
    front: float = FRONT_LAYER
    boss: float = BOSS
    pen: float = PEN_DEPTH


@dataclass(frozen=True, slots=True)
class Angle:
    """A joint angle to label, measured in the links' plane at the beginning of a bar.

    Attributes:
        name: as shown, such as "q₁".
        bar: the bar to which the angle leads.
        after: the bar from whose direction it is measured; None: from the horizontal.
        near: of the values 2π apart, the one nearest to this is shown, [rad].
        at: position of the name along the arc, from 0 to 1.
    """

    name: str
    bar: int
    after: int | None = None
    near: float = math.pi / 2
    at: float = 0.5


@dataclass(frozen=True, slots=True)
class Waist:
    """The angle by which the links' plane turns about the vertical, from the axis of y1.

    Attributes:
        name: as shown.
        bar: a bar whose horizontal projection points forward; None: that of the end-point does.
    """

    name: str
    bar: int | None = None


@dataclass(frozen=True, slots=True)
class Spot:
    """A name beside a joint.

    Attributes:
        name: as shown, such as "q₁".
        end: number of the end of a bar at which the joint is; bar i has 2 i and 2 i + 1.
    """

    name: str
    end: int


@dataclass(frozen=True, slots=True)
class Length:
    """A length to label.

    Attributes:
        name: as shown, such as "ℓ₁".
        begin, end: numbers of the ends of bars between which it extends; bar i has 2 i and 2 i + 1.
        at: position of the name between them, from 0 to 1.
        right: whether the name is to the right of the line from begin to end, not to the left.
    """

    name: str
    begin: int
    end: int
    at: float = 0.5
    right: bool = False


@dataclass(frozen=True, slots=True)
class Drawing:
    """The data from which the scene draws a robot; what is None follows from bars and reach.

    Links lie alternately in the back and the front layer, so that they do not intersect.

    Attributes:
        strip: number of the last bars that are pieces of one flexible strip; the others are links.
        motors: joints that are drawn as motors besides those at the base pivot.
        base: support of the robot: two uprights with motors, a column with a turntable, or none,
            of what is seen from above. With "links", the robot stands on the floor, and
            `app/scene/link_nodes.py` draws the bodies of its chain.
        axes: directions of the outputs in the robot's frame, orthonormal; None: two outputs are
            its x and z, three its x, y and z.
        away: horizontal direction (x, y) across the links, away from the viewer, of unit length.
        depths: of the layers.
        elevation, azimuth: angles of the camera, downward and from the right, [rad].
        box: opposite corners of the box that the camera shows of one robot.
        apart: distance between the base pivots of neighbouring robots, [m].
        title: position of the title.
        note: position of the note that the drawing is not to scale.
        force_scale: length of the force's arrow, [m/N].
        sheet: low and high corner (x, z), and y, of the area for freehand strokes.
        angles, waist, lengths, spots: labels that are shown on demand, as in the paper's figures 1
            and 4.
        elbow: number of the end of a bar at which the elbow is, of an arm of two links from the
            beginning of the first bar; bar i has 2 i and 2 i + 1. None: it is no such arm.
    """

    strip: int = 0
    motors: tuple[int, ...] = ()
    base: Literal["uprights", "pedestal", "links", "none"] = "uprights"
    axes: tuple[Point, ...] | None = None
    away: tuple[float, float] = (0.0, 1.0)
    depths: Depths = Depths()
    elevation: float = math.radians(9.0)
    azimuth: float = 0.0
    box: tuple[Point, Point] | None = None
    apart: float | None = None
    title: Point | None = None
    note: Point | None = None
    force_scale: float = 0.005
    sheet: tuple[tuple[float, float], tuple[float, float], float] | None = None
    angles: tuple[Angle, ...] = ()
    waist: Waist | None = None
    lengths: tuple[Length, ...] = ()
    spots: tuple[Spot, ...] = ()
    elbow: int | None = None
