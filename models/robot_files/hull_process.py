"""The hulls of shapes as solids of density 1, found in a process of their own.

This module is both ends: `hulls_of` starts it as a program if there are meshes, which are foreign
files: a library that reads them may take any time.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from onpath.models.arrays import Array
from onpath.models.robot_files.chain import Shape
from onpath.models.robot_files.limited_process import ProcessEnded, answer_of, serve
from onpath.models.robot_files.shape_solids import solid_of

MOST_BYTES = 200_000_000  # of all meshes
MOST_TRIANGLES = 2_000_000  # of all meshes
LARGEST = 20.0  # [m], of a shape that is weighed: others are in another unit
AT_END = 0.01  # share of the largest distance by which corners at the end may be nearer
LIBRARY = "library"
"""Why a shape has no hull: a package that would read it is not installed."""


class Hull(msgspec.Struct, frozen=True):
    """A solid of density 1.

    Attributes:
        volume: [m³].
        centre: of mass, [m].
        inertia: about that, 3 rows, [m⁵].
        far: its end: the middle of the corners that are farthest from the axis z, [m].
        fault: why there is none; empty if there is one.
    """

    volume: float = 0.0
    centre: tuple[float, ...] = ()
    inertia: tuple[tuple[float, ...], ...] = ()
    far: tuple[float, ...] = ()
    fault: str = ""


def hulls_of(shapes: Sequence[Shape]) -> list[Hull]:
    """The convex hulls of shapes; those that cannot be read say so.

    Shapes without meshes, and no shapes at all, need no other process.
    """
    if not any(shape.kind == "mesh" for shape in shapes):
        return _hulls(shapes)
    job = msgspec.msgpack.encode(shapes, enc_hook=_listed)
    try:
        found = msgspec.msgpack.decode(answer_of(__name__, job), type=list[Hull])
    except (ProcessEnded, msgspec.MsgspecError):
        return [Hull(fault="ended")] * len(shapes)
    return found if len(found) == len(shapes) else [Hull(fault="ended")] * len(shapes)


def _listed(array: Any) -> Any:
    return array.tolist()


def _array(_: Any, values: Any) -> Array:
    return np.array(values, dtype=float)


def _answer(job: bytes) -> bytes:
    shapes = msgspec.msgpack.decode(job, type=list[Shape], dec_hook=_array)
    return msgspec.msgpack.encode(_hulls(shapes))


def _hulls(shapes: Sequence[Shape]) -> list[Hull]:
    size, triangles, found = 0, 0, list[Hull]()
    for shape in shapes:
        try:
            size += Path(shape.file).stat().st_size if shape.file else 0
            if size > MOST_BYTES:
                raise ValueError("too many bytes")
            solid = solid_of(shape)
            triangles += len(solid.faces)
            if triangles > MOST_TRIANGLES:
                raise ValueError("too many triangles")
            found.append(_hull(solid))
        except ImportError:
            found.append(Hull(fault=LIBRARY))
        except Exception as error:  # a library may raise anything about a user's file
            found.append(Hull(fault=str(error)[:80] or type(error).__name__))
    return found


def _hull(solid: Any) -> Hull:
    hull: Any = solid.convex_hull
    if not np.ptp(hull.vertices, axis=0).max() < LARGEST or not hull.volume > 0:
        raise ValueError("no solid")
    away = np.hypot(*hull.vertices[:, :2].T)
    far = hull.vertices[away >= (1 - AT_END) * away.max()].mean(axis=0)
    return Hull(
        volume=float(hull.volume),
        centre=tuple(map(float, hull.center_mass)),
        inertia=tuple(tuple(map(float, row)) for row in hull.moment_inertia),
        far=tuple(map(float, far)),
    )


if __name__ == "__main__":
    serve(_answer)
