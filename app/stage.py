"""Where the two robots stand: floor, machine parts that never move, labels, and the camera."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import trimesh

from app import meshes, palette
from app.snapshot import FollowerName, TrackerName

if TYPE_CHECKING:
    import viser

BASES = {TrackerName: np.array([-0.26, 0.0, 0.0]), FollowerName: np.array([0.26, 0.0, 0.0])}
"""Origins of the robots' frames in the world [m]."""

TITLES = {
    TrackerName: ("Trajectory tracking", "chases a moving point"),
    FollowerName: ("Path following", "stays on the curve"),
}
MIDDLE = 0.075
"""x about which a robot with its path is drawn, in its own frame [m]."""

VIEW_LOW = np.array([-0.16, -0.03, -meshes.FLOOR_DEPTH - 0.02])
VIEW_HIGH = np.array([0.31, 0.03, 0.425])
"""What the camera shows of a robot, in its own frame [m]."""

FIELD_OF_VIEW = np.radians(15.0)
ELEVATION = np.radians(9.0)
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True, slots=True)
class Insets:
    """How much of the canvas panels cover at each side [px]."""

    left: float = 0.0
    right: float = 0.0
    top: float = 0.0
    bottom: float = 0.0


@dataclass(frozen=True, slots=True)
class Pose:
    """A camera's position and the point it looks at, shape (3,) each, [m]."""

    position: np.ndarray
    look_at: np.ndarray


def frame_box(
    low: np.ndarray, high: np.ndarray, width: float, height: float, insets: Insets
) -> Pose:
    """The camera that shows a box as large as the uncovered part of the canvas allows.

    Args:
        low: corner of the box with the smallest coordinates, shape (3,), [m].
        high: the opposite corner, shape (3,), [m].
        width: of the canvas [px].
        height: of the canvas [px].
        insets: what panels cover.
    """
    forward = np.array([0.0, np.cos(ELEVATION), -np.sin(ELEVATION)])
    up = np.array([0.0, np.sin(ELEVATION), np.cos(ELEVATION)])
    right = np.array([1.0, 0.0, 0.0])
    half = (high - low) / 2
    reach = {axis: float(np.abs(v) @ half) for axis, v in (("x", right), ("y", up), ("z", forward))}
    tan_y = np.tan(FIELD_OF_VIEW / 2)
    tan_x = tan_y * width / height
    free_x = max(width - insets.left - insets.right, 0.2 * width) / width
    free_y = max(height - insets.top - insets.bottom, 0.2 * height) / height
    distance = reach["z"] + max(reach["x"] / (tan_x * free_x), reach["y"] / (tan_y * free_y))
    aside = (insets.left - insets.right) / width * tan_x * distance
    above = (insets.bottom - insets.top) / height * tan_y * distance
    target = (low + high) / 2 - aside * right - above * up
    return Pose(target - distance * forward, target)


def view_of(bases: dict[str, np.ndarray], size: tuple[float, float], insets: Insets) -> Pose:
    """The camera that shows all robots on a canvas of this size [px]."""
    corners = np.stack(list(bases.values()))
    return frame_box(corners.min(0) + VIEW_LOW, corners.max(0) + VIEW_HIGH, *size, insets)


def set_initial_camera(server: viser.ViserServer, bases: dict[str, np.ndarray] = BASES) -> None:
    """Makes a new client open on the robots, before its own size is known."""
    pose = view_of(bases, (1400, 800), Insets())
    server.initial_camera.fov = FIELD_OF_VIEW
    server.initial_camera.position = pose.position
    server.initial_camera.look_at = pose.look_at


def build_stage(
    scene: viser.SceneApi, bases: dict[str, np.ndarray], titles: dict[str, tuple[str, str]]
) -> None:
    """Adds floor, lights, machine bases and labels to a client's scene."""
    corners = np.stack(list(bases.values()))
    floor = corners.mean(0) + [MIDDLE, 0.05, -meshes.FLOOR_DEPTH]
    scene.configure_environment_map(None)
    scene.add_light_ambient("/stage/ambient", intensity=1.9)
    scene.add_light_directional("/stage/front", intensity=1.5, position=(-0.4, -1.0, 0.7))
    scene.add_grid(
        "/stage/floor",
        width=2.4,
        height=1.6,
        cell_size=0.05,
        section_size=0.2,
        cell_color=palette.GRID.rgb,
        section_color=palette.GRID.toward(palette.INK, 0.12).rgb,
        plane_color=palette.FLOOR.rgb,
        plane_opacity=1.0,
        shadow_opacity=0.18,
        position=floor,
    )
    for part, mesh, colour in (
        ("base", meshes.base(), palette.FRAME),
        ("motors", meshes.motors(), palette.MOTOR),
    ):
        add_copies(scene, f"/stage/{part}", mesh, corners, colour)
    for name, base in bases.items():
        title, subtitle = titles[name]
        for text, z, size in ((title, 0.392, 0.036), (subtitle, 0.345, 0.026)):
            scene.add_label(
                f"/stage/{name}/label_{text}",
                text,
                position=base + [MIDDLE, 0.0, z],
                font_size_mode="scene",
                font_scene_height=size,
                anchor="center-center",
            )


def add_copies(
    scene: viser.SceneApi,
    name: str,
    mesh: trimesh.Trimesh,
    positions: np.ndarray,
    colour: palette.Colour | np.ndarray,
    *,
    scales: np.ndarray | None = None,
    opacity: float | None = None,
    shadow: bool = True,
) -> viser.BatchedMeshHandle:
    """Copies of one mesh at positions, shape (n, 3), [m], as one node, turned as it is.

    `colour` is one for all, or linear colours of shape (n, 3), uint8.
    """
    return scene.add_batched_meshes_simple(
        name,
        np.asarray(mesh.vertices),
        np.asarray(mesh.faces),
        np.tile(IDENTITY, (len(positions), 1)),
        positions,
        batched_scales=scales,
        batched_colors=colour.linear if isinstance(colour, palette.Colour) else colour,
        opacity=opacity,
        side="front" if opacity is None else "double",
        lod="off",
        cast_shadow=shadow and opacity is None,
        receive_shadow=shadow and opacity is None,
    )
