"""What a robot's file draws for a body, as meshes by trimesh."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from onpath.models.robot_files.chain import Shape

MOST_TRIANGLES = 500_000  # of a mesh in a file
LARGEST_SHAPE = 100.0  # [m]
ROUND = 16  # points of a circle


def solid_of(shape: Shape) -> Any:
    """A shape in its body's frame, a `trimesh.Trimesh`.

    Raises:
        ValueError: it is empty, not finite, or has too many triangles.
        Exception: whatever a library raises about a user's file.
    """
    trimesh: Any = import_module("trimesh")  # whose types are incomplete
    x, y, z = shape.size
    if shape.triangles is not None:
        solid = trimesh.Trimesh(*shape.triangles, process=False)
    elif shape.kind == "mesh":
        path = Path(shape.file)
        with path.open("rb") as file:  # without a resolver, it can name no other files
            loaded = trimesh.load_mesh(file, file_type=path.suffix[1:].lower(), process=False)
        solid = trimesh.Trimesh(loaded.vertices, loaded.faces, process=False)
        solid.apply_scale(shape.size)
    elif shape.kind == "box":
        solid = trimesh.creation.box(extents=(x, y, z))
    elif shape.kind == "sphere":
        solid = trimesh.creation.icosphere(subdivisions=2)
        solid.apply_scale(shape.size)
    elif shape.kind == "capsule":
        solid = trimesh.creation.capsule(radius=x, height=z, count=[6, ROUND])
    else:
        solid = trimesh.creation.cylinder(radius=x, height=z, sections=ROUND)
    if not 0 < len(solid.faces) <= MOST_TRIANGLES:
        raise ValueError(f"{len(solid.faces)} triangles: expected 1 to {MOST_TRIANGLES}")
    if not np.isfinite(solid.vertices).all() or np.abs(solid.vertices).max() > LARGEST_SHAPE:
        raise ValueError("larger than 100 m")
    place = np.eye(4)
    place[:3, :3], place[:3, 3] = shape.rotation, shape.translation
    solid.apply_transform(place)
    return solid
