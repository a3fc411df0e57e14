"""The stage of a robot, derived from its bars, reach and plane unless its drawing overrides it."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from itertools import product

import casadi as ca
import numpy as np

from onpath.app.common import palette
from onpath.app.scene import meshes
from onpath.app.scene.body_meshes import BodyMeshes, body_meshes
from onpath.app.scene.plane_picture import zone_picture
from onpath.app.scene.pointer_projection import DragPlane
from onpath.app.scene.stage import Stage
from onpath.app.scene.tones import LIGHT, Tones
from onpath.models.arrays import Array
from onpath.models.control.sides import LEFT, RIGHT
from onpath.models.paths.path_checks import LEAST_MARGIN
from onpath.models.systems.drawing import Drawing
from onpath.models.systems.robots import Robot

IN_PATH_PLANE, HORIZONTAL = "path's plane", "horizontal plane"
LARGEST_PATH = 0.075
"""Usual extent of paths from their centre, for which the view has room [m]."""
USUAL_PATH, ROOM = 0.05, 0.25
"""Radius of the circle with which a lab begins [m], and room beside it for pulling at the robots,
as a share of the distance between them."""
ASIDE, ABOVE, BELOW = 0.03, 0.095, 0.05
"""Margins beside the bars, above them for the title, and between them and the floor [m]."""
THIN = 0.03
"""Half of the depth of robots in the vertical plane [m]."""

Parts = list[tuple[str, meshes.Mesh, palette.Colour]]


@lru_cache(maxsize=64)
def stage_of(robot: Robot, tones: Tones = LIGHT, plain: bool = False) -> Stage:
    """The stage of a robot, with the colours of a light or of a dark scene; see `Stage.plain`."""
    drawing = robot.drawing
    low, high = (np.array(corner) for corner in drawing.box or _box(robot))
    shapes = None if robot.chain is None else body_meshes(robot.chain)
    floor = min(-meshes.FLOOR_DEPTH, float(low[2]) + 0.02) if shapes is None else shapes.floor
    middle = float(low[0] + high[0]) / 2
    apart = float(high[0] - low[0]) if drawing.apart is None else drawing.apart
    plane = _path_plane(robot)
    parts = partial(_parts, drawing, floor, tones, shapes)
    pulls = {IN_PATH_PLANE: plane}
    if robot.system.p > 2 and plane.normal[:2].any():
        pulls[HORIZONTAL] = DragPlane(np.zeros(3), np.array([0.0, 0.0, 1.0]))
    return Stage(
        bases=_side_by_side(apart, drawing.azimuth),
        low=low,
        high=high,
        outline=np.vstack([_outline(robot, low, high, parts), _room(robot, apart)]),
        floor=floor,
        elevation=drawing.elevation,
        azimuth=drawing.azimuth,
        path_plane=plane,
        pulls=pulls,
        reach=robot.reach,
        axes=_axes(robot),
        zone=lambda: zone_picture(stage_of(robot), robot),
        title=np.array(drawing.title or (middle, 0.0, high[2] - 0.025)),
        note=np.array(drawing.note or (middle, 0.0, floor + 0.06)),
        force_scale=drawing.force_scale,
        sheet=drawing.sheet
        or ((low[0] + 0.01, floor - 0.01), (high[0] - 0.01, high[2] - 0.1), -0.06),
        motors=drawing.motors,
        parts=parts,
        tones=tones,
        bodies=() if shapes is None else shapes.moving,
        plain=plain,
    )


def _side_by_side(apart: float, azimuth: float) -> dict[str, np.ndarray]:
    """Frame origins side by side, as seen by a camera at this angle to the right, [rad]."""
    half = apart / 2 * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    return {LEFT: -half, RIGHT: half}


def _path_plane(robot: Robot) -> DragPlane:
    """The plane of the paths in the robot's frame, its normal away from the viewer."""
    origin, right, up = _axes(robot)
    normal = np.cross(right, up)
    return DragPlane(origin, -normal if normal[1] < 0 else normal)


def _axes(robot: Robot) -> tuple[Array, Array, Array]:
    """Origin of the path's plane, and its two coordinate directions, in the robot's frame."""
    origin, right, up = robot.position(robot.frame.lift(np.array([(0.0, 0.0), (1, 0), (0, 1)])))
    return origin, right - origin, up - origin


def _outline(robot: Robot, low: Array, high: Array, parts: Callable[[], Parts]) -> Array:
    """Points about a robot within its box, (k, 3); the corners of the box if seen from in front.

    Seen from aside, much of a long box is empty, and the camera would stay too far away.

    Args:
        parts: gives its fixed parts.
    """
    corners = np.array(list(product(*np.stack([low, high], axis=1))))
    if not robot.drawing.azimuth or robot.chain is not None:
        return corners
    bars, _ = _bars(robot)
    margins = np.array(list(product((-ASIDE, ASIDE), repeat=3)))
    near = (bars[:, None] + margins).reshape(-1, 3)
    return np.clip(np.vstack([near, *(mesh.vertices for _, mesh, _ in parts())]), low, high)


def _room(robot: Robot, apart: float) -> Array:
    """Points of the path's plane to which an end-point is pulled from its usual path, (4, 3)."""
    origin, right, up = _axes(robot)
    far = USUAL_PATH + ROOM * apart
    ways = np.array([side / np.linalg.norm(side) for side in (right, up)])
    return origin + far * np.vstack([ways, -ways])


def _bars(robot: Robot) -> tuple[Array, Array]:
    """Ends of the bars, shape (k, 3), [m], while the end-point is on a path, and configurations."""
    side = np.linspace(-LARGEST_PATH, LARGEST_PATH, 5)
    z = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    q = robot.rest(robot.frame.lift(z[robot.margin(z) >= LEAST_MARGIN]))
    symbols = ca.SX.sym("q", robot.system.n)
    bars = ca.Function("bars", [symbols], [ca.densify(robot.skeleton(symbols, ca.SX(1))[0])])
    return np.vstack([bars(joints).full().T for joints in q]), q


def _box(robot: Robot) -> tuple[Array, Array]:
    """Corners of a box around the base pivot and the bars while the end-point is on a path."""
    bars, q = _bars(robot)
    points = np.vstack([bars, np.zeros((1, 3))])
    if robot.chain is not None:
        points = np.vstack([points, body_meshes(robot.chain).corners(robot.chain, q)])
    low, high = points.min(axis=0), points.max(axis=0)
    if robot.chain is not None:
        return low - [ASIDE, ASIDE, BELOW], high + [ASIDE, ASIDE, ABOVE]
    low[2] = min(low[2] - BELOW, -meshes.FLOOR_DEPTH) - 0.02
    return low - [ASIDE, THIN, 0.0], high + [ASIDE, THIN, ABOVE]


def _parts(drawing: Drawing, floor: float, tones: Tones, shapes: BodyMeshes | None) -> Parts:
    """Fixed parts that support the robot."""
    if shapes is not None:
        return [("base", shapes.base, tones.frame)]
    if drawing.base == "none":
        return []
    if drawing.base == "pedestal":
        return [
            ("pedestal", meshes.part("pedestal"), tones.frame),
            ("turntable", meshes.part("turntable"), tones.metal),
        ]
    return [
        ("base", meshes.base(-floor), tones.frame),
        ("motors", meshes.part("motors"), tones.metal),
    ]
