"""The meshes of a chain's bodies: those of its file, or capsules about its joints.

`read_shapes` reads files that users bring. For these it is called in a process of its own, with a
time limit (`server/robot_shapes.py`); this package's own files are read here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from onpath.app.scene.meshes import Mesh
from onpath.assets import asset_path
from onpath.models.arrays import Array
from onpath.models.robot_files.chain import Body, Chain, Shape
from onpath.models.robot_files.file_masses import INSTALL, THICKEST, THICKNESS, THINNEST
from onpath.models.robot_files.shape_solids import ROUND, solid_of
from onpath.models.systems.rigid_chain import frame_poses

DRAWN_TRIANGLES = 1_500  # of a body, if the mesh can be simplified
MOST_DRAWN = 6_000  # of a body, if it cannot
SHARP = np.radians(30.0)  # sharper edges are not smoothed


@dataclass(frozen=True, eq=False)
class BodyMeshes:
    """What is drawn of a chain.

    Attributes:
        base: of the base, in its frame.
        moving: of the moving bodies, each in its own frame.
        floor: height of the floor, on which the base stands, [m].
    """

    base: Mesh
    moving: tuple[Mesh, ...]
    floor: float

    def corners(self, chain: Chain, q: Array) -> Array:
        """The corners of boxes about all bodies at configurations, (k, n) -> (..., 3), [m]."""
        symbols = ca.SX.sym("q", chain.n)
        poses = ca.Function("poses", [symbols], [*frame_poses(chain, symbols)])
        found = [_box_of(self.base)]
        for joints in q:
            places, turns = (part.full().T for part in poses.call([ca.DM(joints)]))
            for mesh, place, turn in zip(self.moving, places, turns, strict=True):
                found.append(_turned(_box_of(mesh), turn) + place)
        return np.vstack(found)


_READ: dict[Chain, Sequence[Mesh | None]] = {}
_MADE: dict[Chain, BodyMeshes] = {}


def keep_shapes(chain: Chain, shapes: Sequence[Mesh | None]) -> None:
    """Keep what `read_shapes` has returned for a chain."""
    _READ[chain] = shapes


def body_meshes(chain: Chain) -> BodyMeshes:
    """The meshes of a chain; for a user's file, those that `keep_shapes` has kept."""
    made = _MADE.get(chain)
    if made is None:
        shapes = _READ.get(chain)
        if shapes is None:
            shapes = read_shapes(chain)[0] if is_own(chain) else [None] * (chain.n + 1)
        made = _MADE[chain] = _completed(chain, shapes)
    return made


def is_own(chain: Chain) -> bool:
    """Whether all meshes of a chain are this package's."""
    own = asset_path("robots").resolve()
    meshes = [s for shapes in _all_shapes(chain) for s in shapes if s.kind == "mesh"]
    return all(shape.file and Path(shape.file).is_relative_to(own) for shape in meshes)


def read_shapes(chain: Chain) -> tuple[list[Mesh | None], list[tuple[str, str]]]:
    """The meshes of base and bodies, None where there are none.

    Returns:
        Also the names of files that could not be read, with reasons.
    """
    meshes, left_out = list[Mesh | None](), list[tuple[str, str]]()
    for shapes in _all_shapes(chain):
        solids = list[Any]()
        for shape in shapes:
            try:
                solids.append(solid_of(shape))
            except Exception as error:  # a library may raise anything about a user's file
                left_out.append((_name_of(shape), _reason(error)))
        mesh = _joined(solids) if solids else None
        if solids and mesh is None:
            left_out.append((_name_of(shapes[0]), INSTALL))
        meshes.append(mesh)
    return meshes, left_out


def _all_shapes(chain: Chain) -> list[tuple[Shape, ...]]:
    return [chain.base, *(body.shapes for body in chain.bodies)]


def _name_of(shape: Shape) -> str:
    return Path(shape.file).name or shape.kind


def _reason(error: Exception) -> str:
    if isinstance(error, ImportError):
        return INSTALL
    return (str(error).splitlines() or [type(error).__name__])[0][:80]


def _joined(solids: list[Any]) -> Mesh | None:
    """Solids as one mesh, simplified; None if it is too large and cannot be simplified."""
    import trimesh
    from trimesh.graph import smooth_shade

    whole: Any = trimesh.util.concatenate(solids)
    whole.merge_vertices(merge_norm=True, merge_tex=True)
    if len(whole.faces) > DRAWN_TRIANGLES:
        try:
            whole = whole.simplify_quadric_decimation(face_count=DRAWN_TRIANGLES)
        except ImportError:
            if len(whole.faces) > MOST_DRAWN:
                return None
    smooth = smooth_shade(whole, angle=SHARP, facet_minarea=None)
    return Mesh(np.asarray(smooth.vertices, np.float32), np.asarray(smooth.faces, np.uint32))


def _completed(chain: Chain, shapes: Sequence[Mesh | None]) -> BodyMeshes:
    """Capsules for the bodies that have no mesh."""
    ends = [*(body.translation for body in chain.bodies[1:]), chain.tip]
    length = sum(float(np.linalg.norm(each)) for each in ends)
    radius = float(np.clip(THICKNESS * length, THINNEST, THICKEST))
    moving = tuple(
        mesh or _capsule(body, end, radius)
        for mesh, body, end in zip(shapes[1:], chain.bodies, ends, strict=True)
    )
    base = shapes[0] or _foot(chain.bodies[0].translation, radius)
    return BodyMeshes(base=base, moving=moving, floor=float(base.vertices[:, 2].min()))


def _capsule(body: Body, end: Array, radius: float) -> Mesh:
    """A bearing about the joint's axis, or a rail along it, and a rod to the end of the body."""
    from trimesh.creation import cylinder, icosphere

    slides = body.joint.slides
    height = 3.5 * radius if slides else 2.4 * radius
    solids: list[Any] = [cylinder(radius if slides else 1.25 * radius, height, sections=ROUND)]
    if np.linalg.norm(end) > radius / 2:
        solids.append(_rod(end, 0.85 * radius))
    else:
        solids.append(icosphere(subdivisions=2, radius=radius))
    mesh = _joined(solids)
    assert mesh is not None
    return mesh


def _foot(first: Array, radius: float) -> Mesh:
    """A plate on the floor, z = 0, and a rod from it to the first joint."""
    from trimesh.creation import cylinder

    plate: Any = cylinder(2.5 * radius, height=radius / 2, sections=2 * ROUND)
    plate.apply_translation([0, 0, radius / 4])
    solids = [plate]
    if np.linalg.norm(first) > radius / 2:
        rod = _rod(first, radius)
        if first[2] >= 0:
            rod.vertices[:, 2] = np.maximum(rod.vertices[:, 2], 0.0)
        solids.append(rod)
    mesh = _joined(solids)
    assert mesh is not None
    return mesh


def _rod(end: Array, radius: float) -> Any:
    """A capsule from the origin to a point, a trimesh."""
    from trimesh.creation import capsule
    from trimesh.geometry import align_vectors

    length = float(np.linalg.norm(end))
    rod: Any = capsule(height=length, radius=radius, count=[6, ROUND])
    rod.apply_translation([0, 0, length / 2])
    rod.apply_transform(np.asarray(align_vectors([0, 0, 1], end / length)))
    return rod


def _box_of(mesh: Mesh) -> Array:
    """The corners of a mesh's box, shape (8, 3)."""
    ends = np.stack([mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)])
    picks = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
    return np.take_along_axis(ends, picks, axis=0)


def _turned(points: Array, quaternion: Array) -> Array:
    """Points turned by a unit quaternion, scalar first."""
    w, vector = quaternion[0], quaternion[1:]
    across = 2 * np.cross(vector, points)
    return points + w * across + np.cross(vector, across)
