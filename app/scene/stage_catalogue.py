"""The stage of each robot in the catalogue."""

from __future__ import annotations

import numpy as np
import trimesh

from onpath.app.common import palette
from onpath.app.lab.snapshot import FollowerName, TrackerName
from onpath.app.scene import meshes
from onpath.app.scene.pointer_projection import VERTICAL_PLANE, DragPlane
from onpath.app.scene.stage import Stage
from onpath.models.paths.frames import SlantedPlane
from onpath.models.systems.robots import Robot

IN_PATH_PLANE, HORIZONTAL = "path's plane", "horizontal plane"


def _side_by_side(apart: float, azimuth: float = 0.0) -> dict[str, np.ndarray]:
    """As seen by a camera from the right by an angle, [rad]."""
    half = apart / 2 * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    return {TrackerName: -half, FollowerName: half}


def _rigid_parts() -> list[tuple[str, trimesh.Trimesh, palette.Colour]]:
    return [("base", meshes.base(), palette.FRAME), ("motors", meshes.motors(), palette.MOTOR)]


def _flexible_parts() -> list[tuple[str, trimesh.Trimesh, palette.Colour]]:
    return [
        ("pedestal", meshes.pedestal(), palette.FRAME),
        ("turntable", meshes.turntable(), palette.MOTOR),
    ]


RIGID = Stage(
    bases=_side_by_side(0.52),
    low=np.array([-0.16, -0.03, -meshes.FLOOR_DEPTH - 0.02]),
    high=np.array([0.31, 0.03, 0.425]),
    elevation=float(np.radians(9.0)),
    azimuth=0.0,
    path_plane=VERTICAL_PLANE,
    pulls={IN_PATH_PLANE: VERTICAL_PLANE},
    away=np.array([0.0, 1.0, 0.0]),
    depths=(meshes.BACK_LAYER, meshes.FRONT_LAYER, meshes.BOSS, meshes.PEN_DEPTH),
    title=np.array([0.075, 0.0, 0.392]),
    note=np.array([0.075, 0.0, -0.11]),
    force=np.array([0.205, 0.0, -0.11]),
    force_scale=0.005,
    sheet=((-0.15, -meshes.FLOOR_DEPTH - 0.01), (0.3, 0.325), -0.06),
    parts=_rigid_parts,
)

# Drawn with (y1, y2, y3) at (y2, -y1, l1 + y3): the plane y1 = b y2 + d is b x + y = -d.
_SLANTED = SlantedPlane()
_ASIDE = float(np.radians(24.0))
_PATH_PLANE = DragPlane(np.array([0.0, -_SLANTED.d, 0.0]), np.array([_SLANTED.b, 1.0, 0.0]))
FLEXIBLE = Stage(
    bases=_side_by_side(0.56, _ASIDE),
    low=np.array([-0.12, -0.54, -meshes.FLOOR_DEPTH]),
    high=np.array([0.12, 0.12, 0.47]),
    elevation=float(np.radians(30.0)),
    azimuth=_ASIDE,
    path_plane=_PATH_PLANE,
    pulls={
        IN_PATH_PLANE: _PATH_PLANE,
        HORIZONTAL: DragPlane(np.zeros(3), np.array([0.0, 0.0, 1.0])),
    },
    away=np.array([-1.0, 0.0, 0.0]),
    depths=(meshes.BACK_LAYER - meshes.FRONT_LAYER, 0.0, meshes.BOSS - meshes.FRONT_LAYER, 0.0),
    title=np.array([0.0, 0.0, 0.475]),
    note=np.array([0.0, -0.5, 0.08]),
    force=np.array([0.0, -0.5, 0.13]),
    force_scale=0.04,
    sheet=((-0.24, 0.1), (0.24, 0.5), -0.56),
    parts=_flexible_parts,
)
STAGES = {"five_bar": RIGID, "flexible": FLEXIBLE}


def stage_of(robot: Robot) -> Stage:
    """Where a robot stands."""
    return STAGES[robot.name]
