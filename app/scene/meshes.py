"""Meshes of the robots' parts, in their frames: x right, y away from the camera, z up.

`part_shapes.py` has made the parts beforehand.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from onpath.assets import asset_path

PARTS = "parts.npz"
LINK_THICKNESS = 0.012
GRIP = (0.02, 0.009, 0.02)  # half-axes of the area at an end-point that can be grabbed [m]
ARROWHEAD = (0.013, 0.0215, 0.0065)  # of a grip: begin and end from its middle, half width [m]
FLOOR_DEPTH = 0.115  # default depth of the floor below the base pivot [m]
RAIL = (0.0125, 0.0185)  # inner and outer edge of a brake's rails, from its middle [m]
WALL = (0.13, 0.04)  # length of the drawn part of a wall, and its depth behind the surface [m]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles with their corners counter-clockwise as seen from outside.

    Attributes:
        vertices: shape (n, 3), [m].
        faces: indices of their corners, shape (k, 3).
    """

    vertices: np.ndarray
    faces: np.ndarray


@lru_cache
def part(name: str) -> Mesh:
    """A part by its name in `part_shapes.all_parts`; a ball has the radius 1.

    Raises:
        KeyError: there is no such part.
    """
    with np.load(asset_path(PARTS)) as arrays:
        return Mesh(arrays[f"{name}.vertices"], arrays[f"{name}.faces"].astype(np.uint32))


def ball(radius: float) -> Mesh:
    """A sphere of the given radius, [m]."""
    unit = part("ball")
    return Mesh(unit.vertices * radius, unit.faces)


def grip() -> Mesh:
    """The front of a lens about an end-point, with arrowheads that say that it can be pulled.

    It is deep enough to be picked before a control point inside it. The scene then decides which
    of the two is selected.
    """
    unit = part("ball")
    lens, front = unit.vertices * GRIP, (unit.vertices[unit.faces, 1] < 1e-6).all(axis=1)
    begin, end, half = ARROWHEAD
    right = np.array([(end, 0.0), (begin, half), (begin, -half)])
    turns = [np.array([(c, -s), (s, c)]) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    flat = np.concatenate([right @ turn for turn in turns])
    sheets = [np.insert(flat, 1, -GRIP[1] - depth, axis=1) for depth in (0.0, 0.001)]
    heads = np.concatenate(sheets)  # two layers: where it is translucent, denser than the lens
    faces = np.arange(len(heads)).reshape(-1, 3) + len(lens)
    return Mesh(np.concatenate([lens, heads]), np.concatenate([unit.faces[front], faces]))


def base(height: float = FLOOR_DEPTH) -> Mesh:
    """The base plate on the floor, and two uprights that carry the motors at a height, [m]."""
    usual = part("base")
    lower = np.where(usual.vertices[:, 2] < -FLOOR_DEPTH / 2, height - FLOOR_DEPTH, 0.0)
    return Mesh(usual.vertices - np.outer(lower, [0.0, 0.0, 1.0]), usual.faces)


def sheet(low: tuple[float, float], high: tuple[float, float], y: float) -> Mesh:
    """A rectangle in (x, z) at depth y, facing the camera, [m]."""
    (x0, z0), (x1, z1) = low, high
    corners = np.array([(x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)])
    return Mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))
