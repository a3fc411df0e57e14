"""The static surroundings of the robots: floor, fixed parts, labels, and the camera."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.scene.ground import FADING, KEY_LIGHT, RADIUS, painted_shadow
from onpath.app.scene.meshes import Mesh
from onpath.app.scene.pointer_projection import Box, DragPlane
from onpath.app.scene.tones import LIGHT, Tones
from onpath.app.viser_adapter.frame_channel import update_node
from onpath.app.viser_adapter.images import add_png
from onpath.lessons.sides import side_titles
from onpath.lessons.words import ENGLISH, Words
from onpath.models.arrays import Array
from onpath.models.control.laws.registry import law_named

if TYPE_CHECKING:
    import viser

FIELD_OF_VIEW = np.radians(15.0)
DOWN = np.array([0.0, 1.0, 0.0, 0.0])
"""Orientation of a picture that lies on the ground, seen from above."""
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
FIRST_SIZE = 1400.0, 800.0
"""Of a canvas, until a browser has reported its own [px]."""
HIGHER = 0.3
"""How much higher than the middle the robots are, as a share of half of the room that is left."""
FACING, STEEPEST, AROUND = 0.75, np.radians(65.0), 1.5
"""A path's plane is seen well if the cosine between its normal and the view is larger; the steepest
view of one that is not; room around the path, as a multiple of its size."""
TEXT = 0.022
"""Usual height of text in the scene [m]."""
TITLE, AIM = (0.0, 0.03), (0.037, 0.022)
"""Lines above a robot: offset below the title's position, and height, [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class PlanePicture:
    """A picture that is ready to be shown.

    Attributes:
        low, high: opposite corners in the path's plane, shape (2,), [m].
        png: the picture.
    """

    low: Array
    high: Array
    png: bytes


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """Placement of a kind of robot, and its view. Points are in the robot's own frame, [m].

    Attributes:
        bases: origins of the robots' frames in the world, [m], by side.
        low, high: opposite corners of a box about a robot, shape (3,).
        outline: points that the camera shows of a robot, shape (k, 3).
        floor: height of the floor, negative.
        elevation, azimuth: angles of the camera above the horizontal and to the right, [rad].
        path_plane: plane of the path, in which control points are dragged; its point is the home of
            the end-point.
        pulls: planes through the end-point in which it is pulled, by name, the default first;
            their own points do not matter.
        reach: largest distance of an end-point from the origin of the robot's frame, [m].
        axes: origin of the path's plane, and its two coordinate directions, shape (3,) each.
        zone: shading of the nearly singular points in that plane.
        title: position of the title; the second line is lower by a third of its height.
        note: position of the note that the drawing is not to scale.
        force_scale: length of the force's arrow [m/N].
        sheet: low and high corner (x, z), and y, of the sheet for a freehand stroke.
        motors: joints that are drawn as motors.
        parts: fixed parts, with colours.
        bodies: shapes of the moving bodies; empty: bars and joints are drawn.
        tones: colours that depend on the background.
        plain: whether the scene is built for browsers that draw in software: with painted
            shadows and simple shading.
    """

    bases: dict[str, np.ndarray]
    low: np.ndarray
    high: np.ndarray
    outline: np.ndarray
    floor: float
    elevation: float
    azimuth: float
    path_plane: DragPlane
    pulls: dict[str, DragPlane]
    reach: float
    axes: tuple[Array, Array, Array]
    zone: Callable[[], PlanePicture]
    title: np.ndarray
    note: np.ndarray
    force_scale: float
    sheet: tuple[tuple[float, float], tuple[float, float], float]
    motors: tuple[int, ...]
    parts: Callable[[], list[tuple[str, Mesh, palette.Colour]]]
    tones: Tones = LIGHT
    bodies: tuple[Mesh, ...] = ()
    plain: bool = False

    @property
    def origins(self) -> np.ndarray:
        """Origins of the robots' frames, shape (k, 3), [m]."""
        return np.stack(list(self.bases.values()))

    @property
    def away(self) -> np.ndarray:
        """Unit normal of the path's plane, away from the camera's initial position, shape (3,)."""
        normal = self.path_plane.normal / np.linalg.norm(self.path_plane.normal)
        turn, level = self.azimuth, np.cos(self.elevation)
        forward = [-np.sin(turn) * level, np.cos(turn) * level, -np.sin(self.elevation)]
        return normal if normal @ forward > 0 else -normal

    @property
    def reachable(self) -> Box:
        """Region of drags: as far from the home of the end-point as the robot reaches.

        A hand's target is limited in the same way in the lab.
        """
        home, outer = self.path_plane.point, self.reach
        return Box(home - outer, home + outer)

    @property
    def corners(self) -> np.ndarray:
        """The outlines of all robots in the world, shape (k, 3), [m]."""
        return (self.origins[:, None] + self.outline).reshape(-1, 3)


@dataclass(frozen=True, slots=True)
class Pose:
    """A camera's position and the point it looks at, shape (3,) each, [m]."""

    position: np.ndarray
    look_at: np.ndarray


def view_of(
    stage: Stage, size: tuple[float, float], top: float = 0.0, path: Array | None = None
) -> Pose:
    """The camera that shows all robots as large as the canvas allows below a margin.

    Args:
        size: width and height of the canvas [px].
        top: height of the margin [px].
        path: points of a path in a robot's frame, shape (n, 3), [m]. If its plane is seen from the
            side, the camera rises, and it is the paths that are as large as the canvas allows.
    """
    elevation, corners = stage.elevation, stage.corners
    if path is not None and _facing(stage, elevation) < FACING:
        elevation = max(np.linspace(elevation, STEEPEST, 16), key=lambda e: _facing(stage, e))
        middle = (path.min(0) + path.max(0)) / 2
        corners = (stage.origins[:, None] + middle + AROUND * (path - middle)).reshape(-1, 3)
    return _fitted(stage, elevation, corners, size, top)


def _facing(stage: Stage, elevation: float) -> float:
    """Cosine between the camera's axis and the normal of the path's plane, not negative."""
    turn, level = stage.azimuth, np.cos(elevation)
    forward = [-np.sin(turn) * level, np.cos(turn) * level, -np.sin(elevation)]
    normal = stage.path_plane.normal
    return float(abs(normal @ forward) / np.linalg.norm(normal))


def _fitted(
    stage: Stage, elevation: float, corners: Array, size: tuple[float, float], top: float
) -> Pose:
    """The camera at an elevation [rad] that shows points of the world, shape (k, 3), largest."""
    width, height = size
    ce, se = np.cos(elevation), np.sin(elevation)
    ca, sa = np.cos(stage.azimuth), np.sin(stage.azimuth)
    right = np.array([ca, sa, 0.0])
    forward = np.array([-sa * ce, ca * ce, -se])
    up = np.array([-sa * se, ca * se, ce])
    seen = corners @ np.stack([right, up, forward], 1)
    middle = (seen.min(0) + seen.max(0)) / 2
    centre = middle @ np.stack([right, up, forward])
    x, y, z = (seen - middle).T
    tan_y = np.tan(FIELD_OF_VIEW / 2)
    tan_x = tan_y * width / height
    # tangent of the angle from the axis up to the margin, and half of its sum with tan_y
    upward = tan_y * (1 - 2 * top / height)
    half_y = max(upward + tan_y, 0.4 * tan_y) / 2
    # all points are below the margin if the camera, moved up, is as far away as each needs
    across = np.abs(x) / tan_x - z
    up_and_down = np.maximum(-y - tan_y * z, y - upward * z) / half_y
    distance = float(max(across.max(), up_and_down.max()))
    above = (upward - tan_y) / 2 * distance
    room = np.min(upward * (distance + z) - y - above)
    above += HIGHER * max(room, 0.0)
    target = centre - above * up
    return Pose(target - distance * forward, target)


def set_initial_camera(server: viser.ViserServer, stage: Stage) -> None:
    """Set the camera with which new clients open, before their canvas size is known."""
    pose = view_of(stage, FIRST_SIZE)
    server.initial_camera.fov = FIELD_OF_VIEW
    server.initial_camera.position = pose.position
    server.initial_camera.look_at = pose.look_at


def build_stage(scene: viser.SceneApi, stage: Stage) -> list[viser.BatchedMeshHandle]:
    """Add ground, lights and the robots' bases to a client's scene; returns the bases.

    A robot without a base is seen from above, so there is no ground beneath it.
    """
    _add_lights(scene, casts_shadow=not stage.plain)
    parts = stage.parts()
    if parts and stage.plain:
        _add_painted_shadow(scene, stage)
    elif parts:
        _add_ground(scene, stage)
    bases = [
        add_copies(scene, f"/stage/{part}", mesh, stage.origins, colour)
        for part, mesh, colour in parts
    ]
    shade(bases, stage)
    return bases


def shade(parts: Iterable[viser.BatchedMeshHandle], stage: Stage) -> None:
    """Shade parts in steps, without highlights, on a plain stage: that is drawn faster."""
    if stage.plain:
        for part in parts:
            part.material = "toon5"


def _add_ground(scene: viser.SceneApi, stage: Stage) -> None:
    grid = scene.add_grid(
        "/stage/floor",
        plane="xy",
        infinite_grid=True,
        fade_from="origin",
        fade_distance=RADIUS,
        fade_strength=FADING,
        cell_size=0.05,
        section_size=0.2,
        cell_color=stage.tones.cells.rgb,
        section_color=stage.tones.sections.rgb,
        plane_color=stage.tones.floor.rgb,
        plane_opacity=1.0,
        shadow_opacity=0.5,
    )
    _put(grid, stage)


def _add_painted_shadow(scene: viser.SceneApi, stage: Stage) -> None:
    solids = tuple(mesh for _, mesh, _ in stage.parts())
    origins = tuple(map(tuple, stage.origins.tolist()))
    picture, size = painted_shadow(solids, origins, stage.floor)
    _put(add_png(scene, "/stage/floor", picture, size, np.zeros(3), DOWN), stage)


def _put(ground: viser.SceneNodeHandle, stage: Stage) -> None:
    """Put the ground at its height.

    viser does not send a position of 0, and a browser keeps that of the robot before this one.
    """
    place = stage.origins.mean(0) + [0.0, 0.0, stage.floor]
    ground.position = place - [0.0, 0.0, 1.0]
    ground.position = place


def _add_lights(scene: viser.SceneApi, casts_shadow: bool) -> None:
    """A studio: one light that casts shadows, from the left above, a soft one, one from behind."""
    scene.configure_environment_map(None)
    scene.configure_default_lights(enabled=False)
    scene.add_light_hemisphere(
        "/stage/sky", sky_color=(255, 255, 255), ground_color=(205, 200, 196), intensity=2.2
    )
    scene.add_light_directional(
        "/stage/key", intensity=2.9, position=KEY_LIGHT, cast_shadow=casts_shadow
    )
    scene.add_light_directional("/stage/rim", intensity=0.8, position=(0.6, 0.8, 0.5))


def add_text(
    scene: viser.SceneApi,
    name: str,
    text: str,
    position: np.ndarray,
    size: float = TEXT,
    below: float = 0.0,
) -> viser.LabelHandle:
    """Add text of height `size`, `below` lower than a position, [m]."""
    return scene.add_label(
        name,
        text,
        position=position - [0.0, 0.0, below],
        font_size_mode="scene",
        font_scene_height=size,
        anchor="center-center",
    )


class ChangingText:
    """A text in the scene that is replaced, or hidden while empty; see `add_text`."""

    def __init__(
        self,
        scene: viser.SceneApi,
        name: str,
        position: np.ndarray,
        size: float = TEXT,
        below: float = 0.0,
    ) -> None:
        self.label = add_text(scene, name, "", position, size, below)
        self.label.visible = False
        self._shown = ""

    def show(self, text: str) -> None:
        """Show a text; sends nothing if it is shown already."""
        if text == self._shown:
            return
        self._shown = text
        if text:
            update_node(self.label, text=text)
        self._update()

    def _update(self) -> None:
        visible = bool(self._shown)
        if self.label.visible != visible:
            self.label.visible = visible


class Titles:
    """Text above the robots: their control laws, and what they are doing.

    A robot without a caption does what its law says; the law's aim is then shown instead.
    """

    def __init__(self, scene: viser.SceneApi, stage: Stage, words: Words = ENGLISH) -> None:
        self._words, self._laws = words, dict[str, str]()
        self._titles, self._captions = dict[str, str](), dict[str, str]()
        self._texts = {
            side: [
                ChangingText(
                    scene,
                    f"/titles/{side}/{part}",
                    position=base + stage.title,
                    size=size,
                    below=below,
                )
                for part, (below, size) in (("law", TITLE), ("aim", AIM))
            ]
            for side, base in stage.bases.items()
        }

    def show(self, laws: dict[str, str], captions: dict[str, str]) -> None:
        """Show law and caption of each side; sends nothing if they are shown already."""
        if laws == self._laws and captions == self._captions:
            return
        self._captions = captions
        if laws != self._laws:
            self._laws, self._titles = laws, side_titles(laws, self._words)
        for side, title in self._titles.items():
            law, below = self._texts[side]
            law.show(title)
            below.show(captions[side] or self._words(f"aim.{law_named(laws[side]).aim}"))


def add_copies(
    scene: viser.SceneApi,
    name: str,
    mesh: Mesh,
    positions: np.ndarray,
    colour: palette.Colour | np.ndarray,
    *,
    scales: np.ndarray | None = None,
    opacity: float | None = None,
    shadow: bool = True,
) -> viser.BatchedMeshHandle:
    """Add copies of one mesh at positions, shape (n, 3), [m], as one node, without rotation.

    Args:
        colour: of all copies, or linear colours of each, shape (n, 3), uint8.
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
