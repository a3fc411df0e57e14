"""The shapes of the robots' parts, which trimesh makes, joins and smooths.

`python -m onpath.app.scene.part_shapes` writes them to assets/parts.npz. A lab that made them
itself would show its first picture half a second later.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from trimesh import Trimesh
from trimesh.convex import convex_hull
from trimesh.creation import icosphere, revolve
from trimesh.graph import smooth_shade
from trimesh.transformations import rotation_matrix
from trimesh.util import concatenate

from onpath.app.scene.meshes import FLOOR_DEPTH, LINK_THICKNESS, PARTS, RAIL, WALL
from onpath.assets import asset_path

SHARP = np.radians(30.0)  # sharper edges are not smoothed
ROUND = 24  # points of a full circle
SMALL_ROUND = 16  # points of the circle of a small part, of which there are many
TOWARDS_VIEWER = rotation_matrix(np.pi / 2, [1.0, 0.0, 0.0])  # turns the axis z to -y

Profile = Sequence[tuple[float, float]]
"""Radius and height along the axis of a solid of revolution, in order of the heights [m]."""
Layers = tuple[float, float]
"""y of the front and the back of a plate [m]."""


def crisp(*solids: Trimesh) -> Trimesh:
    """Closed solids as one mesh whose vertices are not shared across sharp edges.

    The page computes the normal of a vertex from its triangles, and would round edges whose
    vertices are shared.
    """
    smooth = [smooth_shade(solid, angle=SHARP, facet_minarea=None) for solid in solids]
    joined: Any = concatenate(smooth)
    return joined


def turned(profile: Profile, points: int = ROUND, upright: bool = False) -> Trimesh:
    """A solid of revolution.

    Args:
        points: of a circle.
        upright: whether its axis is z; otherwise it points towards the viewer.
    """
    line = [(0.0, profile[0][1]), *profile, (0.0, profile[-1][1])]
    return revolve(line, sections=points, transform=None if upright else TOWARDS_VIEWER)


def plate(outline: np.ndarray, layers: Layers, chamfer: float = 0.0) -> Trimesh:
    """A plate with chamfered edges.

    Args:
        outline: convex, in (x, z), shape (n, 2), [m].
        chamfer: width of the chamfer [m].
    """
    low, high = outline.min(axis=0), outline.max(axis=0)
    middle, half = (low + high) / 2, (high - low) / 2
    inner = middle + (outline - middle) * (1.0 - chamfer / half)
    return chamfered(inner, outline, layers, chamfer)


def chamfered(inner: np.ndarray, outline: np.ndarray, layers: Layers, depth: float) -> Trimesh:
    """A plate whose front and back have the inner outline.

    Args:
        depth: distance of the whole outline from the front and from the back [m].
    """
    front, back = layers
    rings = [(inner, front), (outline, front + depth), (outline, back - depth), (inner, back)]
    return convex_hull(np.concatenate([np.insert(ring, 1, y, axis=1) for ring, y in rings]))


def rectangle(low: tuple[float, float], high: tuple[float, float]) -> np.ndarray:
    """The corners of a rectangle in (x, z), shape (4, 2), [m]."""
    (x0, z0), (x1, z1) = low, high
    return np.array([(x0, z0), (x1, z0), (x1, z1), (x0, z1)])


USUAL_LINK = 0.2  # [m], length of a link for which the parts have their usual size


def link() -> Trimesh:
    """A machined bar from x = 0 to 1, to be scaled along x: chamfered, a pocket in either face.

    A turned disc is cut in two, and its halves are put at the bar's ends, which the bearings cover.
    Edges are smoothed as they are at the length of a usual link.
    """
    half = LINK_THICKNESS / 2
    pocket = [(0.0052, half - 0.0036), (0.0078, half)]
    edge = [(0.0122, half), (0.014, half - 0.0016)]
    front = [*pocket, *edge]
    solid = turned([*((r, -h) for r, h in front), *reversed(front)], SMALL_ROUND + 2)
    x, y, z = solid.vertices.T
    begins = np.where(np.hypot(x, z) < 0.01, 0.13, 0.0)  # of the pocket, and of the bar
    ends = 0.5 + np.sign(np.round(x, 9)) * (0.5 - begins)  # the axis stays in the middle
    solid.vertices = np.column_stack([USUAL_LINK * ends + 0.8 * x, y, z])
    bar = crisp(solid)
    bar.apply_scale([1.0 / USUAL_LINK, 1.0, 1.0])
    return bar


def blade() -> Trimesh:
    """A piece of a thin upright strip from x = 0 to 1, slightly longer, so that pieces overlap."""
    return crisp(plate(rectangle((-0.03, -0.016), (1.03, 0.016)), (-0.0012, 0.0012), 0.0004))


def bearing() -> Trimesh:
    """A bearing through both layers with a bolt head towards the camera, about its centre.

    Scaled per instance, it also serves as the pen and as the flat discs that mark points.
    """
    back = [(0.0108, -0.0165), (0.012, -0.015), (0.012, 0.015), (0.0112, 0.0165)]
    seal = [(0.0092, 0.0165), (0.0086, 0.0148), (0.0068, 0.0148), (0.0062, 0.0168)]
    bolt = [(0.0044, 0.0168), (0.0042, 0.0195), (0.0034, 0.0203)]
    return crisp(turned([*back, *seal, *bolt], SMALL_ROUND))


def motors() -> Trimesh:
    """Two coaxial motors on the base pivot, in front of and behind the links."""
    front = [(0.024, 0.004), (0.026, 0.006), (0.026, 0.034), (0.0235, 0.037)]
    cap = [(0.018, 0.037), (0.018, 0.041), (0.0165, 0.0425)]
    back = [(0.023, -0.111), (0.026, -0.108), (0.026, -0.064)]
    return crisp(turned([*front, *cap]), turned(back))


def base() -> Trimesh:
    """The base plate on the floor, and two uprights that carry the motors above it."""
    floor = -FLOOR_DEPTH
    angle = np.linspace(0.0, np.pi, ROUND)
    head = 0.03 * np.column_stack([np.cos(angle), np.sin(angle)])
    upright = np.concatenate([head, [(-0.042, floor + 0.008), (0.042, floor + 0.008)]])
    return crisp(
        plate(upright, (-0.004, 0.008), 0.002),
        plate(upright, (0.054, 0.066), 0.002),
        plate(rectangle((-0.1, floor), (0.1, floor + 0.014)), (-0.06, 0.13), 0.003),
    )


def pedestal() -> Trimesh:
    """A round foot and column that carry a rotating waist."""
    floor = -FLOOR_DEPTH
    foot = [(0.1, floor), (0.1, floor + 0.012), (0.096, floor + 0.016)]
    column = [(0.045, floor + 0.016), (0.04, floor + 0.03), (0.04, -0.055), (0.05, -0.045)]
    return crisp(turned(foot, upright=True), turned(column, upright=True))


def turntable() -> Trimesh:
    """The rotating plate on the pedestal and its hub, both rotationally symmetric."""
    disc = [(0.062, -0.044), (0.064, -0.042), (0.064, -0.03), (0.061, -0.027)]
    hub = [(0.024, -0.027), (0.022, -0.014), (0.012, -0.01)]
    return crisp(turned(disc, upright=True), turned(hub, upright=True))


def cross() -> Trimesh:
    """An x of size 1 m in the plane y = 0, which marks a rejected position; to be scaled down."""
    arm = rectangle((-0.5, -0.09), (0.5, 0.09))
    turn = np.sqrt(0.5) * np.array([[1.0, 1.0], [-1.0, 1.0]])
    return crisp(*(plate(arm @ way, (-0.06, 0.06), 0.02) for way in (turn, turn.T)))


def jaws(half: float) -> list[Trimesh]:
    """Rails at both sides of an end-point, `half` long to either side, and what presses them."""
    inner, outer = RAIL
    back, screw, end = outer + 0.014, outer + 0.021, outer + 0.027
    jaw = np.array([(outer, -0.022), (outer, 0.022), (back, 0.011), (back, -0.011)])
    outlines = [
        rectangle((inner, -half), (outer, half)),
        jaw,
        rectangle((back, -0.005), (screw, 0.005)),
        rectangle((screw, -0.015), (end, 0.015)),
    ]
    layers = (-0.014, -0.001)  # in front of the path, on both sides of the pen
    mirror = np.array([-1.0, 1.0])
    both = [*outlines, *(outline * mirror for outline in outlines)]
    return [plate(outline, layers, 0.001) for outline in both]


def guide() -> Trimesh:
    """What holds an end-point, and lets it slide along z between its rails."""
    return crisp(*jaws(0.045))


def clamp() -> Trimesh:
    """What leaves an end-point no way to move: jaws from all four sides."""
    across = jaws(RAIL[0])
    for solid in across:
        solid.apply_transform(rotation_matrix(np.pi / 2, [0.0, 1.0, 0.0]))
    return crisp(*jaws(RAIL[0]), *across)


WALL_LAYERS = (-0.016, -0.002)  # away from the viewer, so that the path stays visible [m]


def wall_body() -> Trimesh:
    """A wall's solid side, by which it is dragged: along x, with its surface at z = 0 above it."""
    half, depth = WALL[0] / 2, WALL[1]
    return crisp(plate(rectangle((-half, -depth), (half, 0.0)), WALL_LAYERS, 0.001))


def wall_lines() -> Trimesh:
    """A wall's surface, hatched on its solid side, and dashes where it goes on to both sides."""
    half, depth = WALL[0] / 2, WALL[1]
    lines = [rectangle((-half, -0.004), (half, 0.0))]
    for x in np.arange(-half + 0.005, half - 0.02, 0.02):
        below = -0.7 * depth
        lines.append(np.array([(x, below), (x + 0.004, below), (x + 0.024, 0.0), (x + 0.02, 0.0)]))
    beyond = half + 0.01 + 0.02 * np.arange(4)
    for x in (*beyond, *(-beyond - 0.01)):
        lines.append(rectangle((x, -0.002), (x + 0.01, 0.0)))
    return crisp(*(plate(line, WALL_LAYERS) for line in lines))


def hand() -> Trimesh:
    """A hand from below that holds the origin between thumb and finger."""
    palm = finger((0.034, -0.030), (0.050, -0.046), 0.017, 0.016, (-0.046, -0.024))
    wrist = finger((0.050, -0.046), (0.074, -0.070), 0.0125, 0.0135, (-0.043, -0.027))
    thumb = finger((0.024, -0.036), (0.004, -0.006), 0.0085, 0.0055, (-0.042, -0.026))
    index = finger((0.040, -0.020), (0.027, 0.004), 0.0075, 0.0068, (-0.042, -0.028))
    pointed = finger((0.027, 0.004), (0.006, 0.004), 0.0068, 0.0052, (-0.042, -0.028))
    others = [
        finger((0.046, -0.024), (0.046 + right, -0.024 + up), 0.0072, 0.0064, (-0.040, -0.026))
        for right, up in ((-0.004, 0.030), (0.009, 0.027), (0.019, 0.017))
    ]
    return crisp(*others, palm, wrist, thumb, index, pointed)


SMALLER = 0.85
"""The scale of the hand, so that the path stays visible beside it."""


def finger(
    begin: tuple[float, float],
    end: tuple[float, float],
    first: float,
    last: float,
    layers: Layers,
) -> Trimesh:
    """A plate about two circles of these radii, whose centres are in (x, z), [m]."""
    angle = np.linspace(0.0, 2 * np.pi, 16, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.sin(angle)])

    def outline(inset: float) -> np.ndarray:
        ends = begin + (first - inset) * circle, end + (last - inset) * circle
        return SMALLER * np.concatenate(ends)

    return chamfered(outline(0.0022), outline(0.0), layers, 0.0022)


def all_parts() -> dict[str, Trimesh]:
    """All parts by name."""
    made = [link, blade, bearing, motors, base, pedestal, turntable, cross, hand, guide, clamp]
    return {
        **{make.__name__: make() for make in [*made, wall_body, wall_lines]},
        "ball": icosphere(subdivisions=2),
    }


def write(file: Path) -> None:
    """Write all parts for `meshes.part`: vertices as float32, and faces."""
    arrays = dict[str, np.ndarray]()
    for name, mesh in all_parts().items():
        arrays[f"{name}.vertices"] = mesh.vertices.astype(np.float32)
        arrays[f"{name}.faces"] = mesh.faces.astype(np.uint16)
    np.savez_compressed(file, **arrays)  # type: ignore[arg-type]


if __name__ == "__main__":
    write(asset_path(".") / PARTS)
