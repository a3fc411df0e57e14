"""Colours of the scene that depend on the background: a light wall, or a dark one."""

from __future__ import annotations

from dataclasses import dataclass

from onpath.app.common import palette
from onpath.app.common.palette import Colour


@dataclass(frozen=True, slots=True)
class Tones:
    """Colours of a light or of a dark scene.

    Attributes:
        wall: behind the robots, which assets/page/style.css draws; traces fade into it.
        floor, cells, sections: the ground, and its fine and coarse lines.
        line: strokes, axes and hatches.
        arc: arcs of the angles.
        path, point: the path and its control points.
        frame: the robots' bases.
        metal: motors and brakes.
        force: arrows of forces.
    """

    wall: Colour
    floor: Colour
    cells: Colour
    sections: Colour
    line: Colour
    arc: Colour
    path: Colour
    point: Colour
    frame: Colour
    metal: Colour
    force: Colour


LIGHT = Tones(
    wall=palette.WHITE,
    floor=palette.FLOOR,
    cells=palette.GRID,
    sections=palette.GRID.toward(palette.INK, 0.08),
    line=palette.INK,
    arc=palette.SLATE,
    path=palette.PATH,
    point=palette.CONTROL_POINT,
    frame=palette.FRAME,
    metal=palette.MOTOR,
    force=palette.FORCE,
)
DARK = Tones(
    wall=Colour(27, 33, 41),
    floor=Colour(30, 36, 44),
    cells=Colour(52, 60, 71),
    sections=Colour(66, 76, 89),
    line=Colour(230, 233, 238),
    arc=Colour(195, 202, 212),
    path=Colour(176, 186, 199),
    point=Colour(188, 196, 208),
    frame=Colour(128, 136, 148),
    metal=Colour(98, 108, 122),
    force=Colour(230, 120, 205),
)
