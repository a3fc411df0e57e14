"""How a robot is drawn besides its bars and joints: pure data that a model may carry.

Points are in the robot's frame (x right, y away from the viewer, z up, base pivot at the origin),
in metres. The defaults serve a robot whose links move in the vertical plane y = 0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

Point = tuple[float, float, float]

FRONT_LAYER = 0.022
"""Depth of the front layer of links behind the robot's plane [m]."""
BACK_LAYER = 0.038
"""The same for the back layer [m]."""
BOSS = (FRONT_LAYER + BACK_LAYER) / 2
"""Depth of the bearings' middle: they span both layers [m]."""
PEN_DEPTH = 0.0103
"""Depth of the pen's centre, such that it touches the robot's plane [m]."""


@dataclass(frozen=True, slots=True)
class Depths:
    """Depths along the normal of the links' plane, away from the viewer, [m]."""

    back: float = BACK_LAYER
    front: float = FRONT_LAYER
    boss: float = BOSS
    pen: float = PEN_DEPTH


@dataclass(frozen=True, slots=True)
class Drawing:
    """What the scene needs to know of a robot; whatever is None follows from its bars and reach.

    Links lie in the back layer and the front layer in turn, so that none runs through another.

    Attributes:
        strip: how many of the last bars are pieces of one strip that bends; the others are links.
        motors: joints that are drawn as motors, besides those at the base pivot.
        base: what carries the robot: two uprights with motors, or a column with a turntable.
        away: horizontal direction (x, y) across the links, away from the viewer, of unit length.
        depths: of the layers.
        elevation, azimuth: the camera looks down, and comes from the right, by these, [rad].
        box: opposite corners of what the camera shows of one robot.
        apart: between the base pivots of neighbouring robots, [m].
        title: where the title is.
        note: where the drawing says that it is not to scale.
        force: where the force's size is written.
        force_scale: length of the force's arrow, [m/N].
        sheet: low and high corner (x, z), and y, of the sheet that takes a freehand stroke.
    """

    strip: int = 0
    motors: tuple[int, ...] = ()
    base: Literal["uprights", "pedestal"] = "uprights"
    away: tuple[float, float] = (0.0, 1.0)
    depths: Depths = Depths()
    elevation: float = math.radians(9.0)
    azimuth: float = 0.0
    box: tuple[Point, Point] | None = None
    apart: float | None = None
    title: Point | None = None
    note: Point | None = None
    force: Point | None = None
    force_scale: float = 0.005
    sheet: tuple[tuple[float, float], tuple[float, float], float] | None = None
