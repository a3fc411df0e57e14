"""Meshes of the robot's parts, in its frame: x right, y away from the camera, z up.

Every shape is a loft: closed rings with equal numbers of points, connected in order and capped.
Edges sharper than 30 degrees are split, so that the viewer's smooth shading does not round them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

SHARP = np.radians(30.0)
ROUND = 40  # points of a full circle

LINK_THICKNESS = 0.012
GRIP = (0.02, 0.009, 0.02)  # half-axes of the area at an end-point that can be grabbed [m]
FLOOR_DEPTH = 0.17  # depth of the floor below the base pivot [m]


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles, whose corners are counter-clockwise as seen from outside.

    Attributes:
        vertices: shape (n, 3), [m].
        faces: indices of their corners, shape (k, 3).
    """

    vertices: np.ndarray
    faces: np.ndarray

    @property
    def corners(self) -> np.ndarray:
        """The corners of each face, shape (k, 3, 3), [m]."""
        return self.vertices[self.faces]

    @property
    def normals(self) -> np.ndarray:
        """Unit normals of the faces, shape (k, 3)."""
        a, b, c = self.corners.transpose(1, 0, 2)
        normals = np.cross(b - a, c - a)
        return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def loft(rings: np.ndarray) -> Mesh:
    """A closed solid through rings.

    Args:
        rings: shape (m, n, 3), [m]; convex, and neighbouring rings correspond point by point.

    Returns:
        A mesh whose faces point outward.
    """
    m, n, _ = rings.shape
    start = np.arange(m - 1)[:, None] * n
    here, there = np.arange(n), np.roll(np.arange(n), -1)
    a, b = start + here, start + there
    sides = np.stack([np.stack([a, b, a + n], -1), np.stack([b, b + n, a + n], -1)]).reshape(-1, 3)
    first, last = m * n, m * n + 1
    caps = [
        np.column_stack([there, here, np.full(n, first)]),
        np.column_stack([here + (m - 1) * n, there + (m - 1) * n, np.full(n, last)]),
    ]
    vertices = np.concatenate([rings.reshape(-1, 3), [rings[0].mean(0), rings[-1].mean(0)]])
    mesh = Mesh(vertices, np.concatenate([sides, *caps]))
    is_inside_out = np.linalg.det(mesh.corners).sum() < 0.0  # six times the volume
    return Mesh(vertices, mesh.faces[:, ::-1]) if is_inside_out else mesh


def crisp(*solids: Mesh) -> Mesh:
    """Closed solids as one mesh with split edges."""
    return joined(*map(_with_split_edges, solids))


def _with_split_edges(solid: Mesh) -> Mesh:
    """Faces that are connected by edges that are not sharp share their vertices, others do not."""
    faces, normals = solid.faces, solid.normals
    edges = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2))
    one, other = np.lexsort(edges.T).reshape(-1, 2).T // 3  # the two faces at each edge
    is_smooth = (normals[one] * normals[other]).sum(1) > np.cos(SHARP)
    one, other = one[is_smooth], other[is_smooth]
    groups, spreads = np.arange(len(faces)), True
    while spreads:  # the smallest number of a group's faces
        before = groups.copy()
        smaller = np.minimum(groups[one], groups[other])
        np.minimum.at(groups, one, smaller)
        np.minimum.at(groups, other, smaller)
        spreads = bool((groups < before).any())
    corners = np.column_stack([np.repeat(groups, 3), faces.ravel()])
    kept, numbers = np.unique(corners, axis=0, return_inverse=True)
    return Mesh(solid.vertices[kept[:, 1]], numbers.reshape(-1, 3))


def turned(profile: list[tuple[float, float]], points: int = ROUND) -> Mesh:
    """A solid of revolution about y, from (radius, y) pairs, [m]."""
    angle = np.linspace(0.0, 2.0 * np.pi, points, endpoint=False)
    circle = np.column_stack([np.cos(angle), np.zeros(points), np.sin(angle)])
    return loft(np.stack([radius * circle + [0.0, y, 0.0] for radius, y in profile]))


def extruded(outline: np.ndarray, front: float, back: float, chamfer: float) -> Mesh:
    """A plate with chamfered edges.

    Args:
        outline: convex outline in (x, z), counter-clockwise, shape (n, 2), [m].
        front, back: y of the faces, [m].
        chamfer: width of the chamfer, [m].
    """
    low, high = outline.min(0), outline.max(0)
    centre, half = (low + high) / 2, (high - low) / 2
    inner = centre + (outline - centre) * (1.0 - chamfer / half)
    layers = [(inner, front), (outline, front + chamfer), (outline, back - chamfer), (inner, back)]
    return loft(np.stack([np.insert(ring, 1, y, axis=1) for ring, y in layers]))


def _stadium(inset: float, half_width: float, cap: float) -> np.ndarray:
    """Outline of a bar along x with round ends, shape (n, 2)."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, ROUND // 2)
    right = np.column_stack([1.0 + cap * np.cos(angle) - inset, half_width * np.sin(angle)])
    left = np.column_stack([inset - cap * np.cos(angle), -half_width * np.sin(angle)])
    return np.concatenate([right, left])


@lru_cache
def link() -> Mesh:
    """A machined bar from x = 0 to 1, to be scaled along x: chamfered, a pocket in either face.

    Scaling turns its round ends into half ellipses. They are circular for 0.2 m, and the bearings
    cover them.
    """
    half, chamfer, pocket = LINK_THICKNESS / 2, 0.0016, 0.0036
    rim, edge = _stadium(0.008, 0.0122, 0.055), _stadium(0.0, 0.014, 0.055)
    mouth, bed = _stadium(0.13, 0.0078, 0.03), _stadium(0.138, 0.0052, 0.03)
    layers = [(bed, pocket - half), (mouth, -half), (rim, -half), (edge, chamfer - half)]
    mirrored = [(ring, -y) for ring, y in reversed(layers)]
    return crisp(loft(np.stack([np.insert(ring, 1, y, axis=1) for ring, y in layers + mirrored])))


@lru_cache
def blade() -> Mesh:
    """A piece of a thin upright strip from x = 0 to 1, slightly longer, so that pieces overlap."""
    outline = np.array([(1.03, 0.011), (-0.03, 0.011), (-0.03, -0.011), (1.03, -0.011)])
    return crisp(extruded(outline, -0.0022, 0.0022, 0.0008))


@lru_cache
def bearing() -> Mesh:
    """A bearing through both layers with a bolt head towards the camera, axis y, about its centre.

    Scaled per instance, it also serves as the pen and as the flat discs that mark points.
    """
    back = [(0.0108, 0.0165), (0.012, 0.015), (0.012, -0.015), (0.0112, -0.0165)]
    seal = [(0.0092, -0.0165), (0.0086, -0.0148), (0.0068, -0.0148), (0.0062, -0.0168)]
    bolt = [(0.0044, -0.0168), (0.0042, -0.0195), (0.0034, -0.0203)]
    return crisp(turned(back + seal + bolt))


@lru_cache
def grip() -> Mesh:
    """A lens about an end-point, deep enough to be picked before a control point inside it.

    The scene then decides which of the two is selected.
    """
    unit = ball(1.0)
    return Mesh(unit.vertices * GRIP, unit.faces)


@lru_cache
def motors() -> Mesh:
    """Two coaxial motors on the base pivot, in front of and behind the links."""
    front = [(0.024, -0.004), (0.026, -0.006), (0.026, -0.034), (0.0235, -0.037)]
    cap = [(0.018, -0.037), (0.018, -0.041), (0.0165, -0.0425)]
    back = [(0.026, 0.064), (0.026, 0.108), (0.023, 0.111)]
    return crisp(turned(front + cap), turned(back))


@lru_cache
def base(height: float = FLOOR_DEPTH) -> Mesh:
    """The base plate on the floor, and two uprights that carry the motors at a height, [m]."""
    floor = -height
    angle = np.linspace(0.0, np.pi, ROUND)
    head = 0.03 * np.column_stack([np.cos(angle), np.sin(angle)])
    upright = np.concatenate([head, [(-0.042, floor + 0.008), (0.042, floor + 0.008)]])
    foot = np.array([(0.1, floor + 0.014), (-0.1, floor + 0.014), (-0.1, floor), (0.1, floor)])
    return crisp(
        extruded(upright, -0.004, 0.008, 0.002),
        extruded(upright, 0.054, 0.066, 0.002),
        extruded(foot, -0.06, 0.13, 0.003),
    )


def _upright(solid: Mesh) -> Mesh:
    """A solid of revolution about y, rotated so that its axis is z."""
    x, y, z = solid.vertices.T
    return Mesh(np.column_stack([x, -z, y]), solid.faces)


@lru_cache
def pedestal() -> Mesh:
    """A round foot and column that carry a rotating waist."""
    floor = -FLOOR_DEPTH
    foot = [(0.1, floor), (0.1, floor + 0.012), (0.096, floor + 0.016)]
    column = [(0.045, floor + 0.016), (0.04, floor + 0.03), (0.04, -0.055), (0.05, -0.045)]
    return crisp(_upright(turned(foot)), _upright(turned(column)))


@lru_cache
def turntable() -> Mesh:
    """The rotating plate on the pedestal and its hub, both rotationally symmetric."""
    plate = [(0.062, -0.044), (0.064, -0.042), (0.064, -0.03), (0.061, -0.027)]
    hub = [(0.024, -0.027), (0.022, -0.014), (0.012, -0.01)]
    return crisp(_upright(turned(plate)), _upright(turned(hub)))


@lru_cache
def ball(radius: float) -> Mesh:
    """A sphere of the given radius, [m]."""
    angle = np.linspace(-0.45 * np.pi, 0.45 * np.pi, ROUND // 4)
    profile = [(float(radius * np.cos(a)), float(radius * np.sin(a))) for a in angle]
    return turned(profile, ROUND // 2)


@lru_cache
def cross() -> Mesh:
    """An x of size 1 m in the plane y = 0, which marks a rejected position; to be scaled down."""
    arm = np.array([(0.5, 0.09), (-0.5, 0.09), (-0.5, -0.09), (0.5, -0.09)])
    turn = np.sqrt(0.5) * np.array([[1.0, 1.0], [-1.0, 1.0]])
    return crisp(*(extruded(arm @ r, -0.06, 0.06, 0.02) for r in (turn, turn.T)))


RAIL = (0.0125, 0.0165)  # inner and outer edge of a brake's jaws, from its middle [m]
_RAIL_LAYERS = (-0.014, -0.001)  # in front of the path, on both sides of the pen [m]


def _jaws(half: float) -> Mesh:
    """Two bars at both sides of an end-point, joined at their ends, `half` long to either side."""
    inner, outer = RAIL
    bar = np.array([(inner, -half), (outer, -half), (outer, half), (inner, half)])
    end = np.array([(-outer, half), (outer, half), (outer, half + 0.006), (-outer, half + 0.006)])
    outlines = bar, bar - [inner + outer, 0.0], end, end - [0.0, 2 * half + 0.006]
    return crisp(*(extruded(outline, *_RAIL_LAYERS, 0.001) for outline in outlines))


@lru_cache
def guide() -> Mesh:
    """A brake that leaves an end-point free along z: it slides between two rails."""
    return _jaws(0.055)


@lru_cache
def clamp() -> Mesh:
    """A brake that leaves an end-point no way to move."""
    return _jaws(0.013)


WALL = (0.13, 0.04)  # length of the drawn part of a wall, and its depth behind the surface [m]
_WALL_LAYERS = (-0.016, -0.002)  # away from the viewer, so that the path stays visible [m]


@lru_cache
def wall_body() -> Mesh:
    """A wall's solid side, by which it is dragged: along x, with its surface at z = 0 above it."""
    half, depth = WALL[0] / 2, WALL[1]
    outline = np.array([(-half, -depth), (half, -depth), (half, 0.0), (-half, 0.0)])
    return crisp(extruded(outline, *_WALL_LAYERS, 0.001))


@lru_cache
def wall_lines() -> Mesh:
    """A wall's surface, hatched on its solid side, and dashes where it goes on to both sides."""
    half, depth = WALL[0] / 2, WALL[1]
    plate = np.array([(-half, -0.004), (half, -0.004), (half, 0.0), (-half, 0.0)])
    lines = [plate]
    for x in np.arange(-half + 0.005, half - 0.02, 0.02):
        slanted = [(x, -0.7 * depth), (x + 0.004, -0.7 * depth), (x + 0.024, 0.0), (x + 0.02, 0.0)]
        lines.append(np.array(slanted))
    beyond = half + 0.01 + 0.02 * np.arange(4)
    for x in (*beyond, *(-beyond - 0.01)):
        lines.append(np.array([(x, -0.002), (x + 0.01, -0.002), (x + 0.01, 0.0), (x, 0.0)]))
    return crisp(*(extruded(line, *_WALL_LAYERS, 0.0002) for line in lines))


def sheet(low: tuple[float, float], high: tuple[float, float], y: float) -> Mesh:
    """A rectangle in (x, z) at depth y, facing the camera, [m]."""
    (x0, z0), (x1, z1) = low, high
    corners = np.array([(x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)])
    return Mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]))


def joined(*parts: Mesh) -> Mesh:
    """The parts as one mesh."""
    begins = np.cumsum([0, *(len(part.vertices) for part in parts[:-1])])
    faces = [part.faces + begin for part, begin in zip(parts, begins, strict=True)]
    return Mesh(np.concatenate([part.vertices for part in parts]), np.concatenate(faces))
