"""The moving part of one client's 3D scene: links, markers, path, traces and what can be dragged.

Cost follows the number of property assignments, not their size: a frame of both robots together is
at most five, and viser sends none for an array that did not change.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from app import meshes, palette
from app.drag import VERTICAL_PLANE, Plane, pointer_on_plane
from app.freehand import Freehand
from app.snapshot import PathView, RobotView, Snapshot, TrackerName
from app.stage import (
    BASES,
    FIELD_OF_VIEW,
    MIDDLE,
    TITLES,
    Insets,
    add_copies,
    build_stage,
    view_of,
)

if TYPE_CHECKING:
    import viser

FORCE_SCALE = 0.005
"""Length of the force arrow [m/N]."""
FORCE_SHOWN = 0.05
"""Smallest force that is drawn [N]."""
TRACE_SEGMENTS = 120
GRAB_RADIUS = 0.02
POINT_RADIUS = 0.0065

BEARING_SCALE = np.array([1.0, 1.0, 1.0])
PEN_SCALE = np.array([0.42, 0.5, 0.42])
PEN_DEPTH = 0.0103
"""y of the pen's centre [m], such that it touches the plane y = 0."""
EXTRA_SCALE = np.array([0.4, 0.1, 0.4])
RING_SCALES = np.array([(0.85, 0.06, 0.85), (0.55, 0.06, 0.55)])
DOT_SCALES = np.array([(0.62, 0.06, 0.62), (0.42, 0.06, 0.42)])
MARKER_DEPTHS = np.array([(0.0, -0.002, 0.0), (0.0, -0.0035, 0.0)])


def _ignore(*_: object) -> None:
    """A hook that nobody set."""


@dataclass(frozen=True, slots=True)
class Hooks:
    """What the scene tells; called on viser's event loop, so they must only enqueue.

    Attributes:
        on_grab: the end-point of the named robot is pulled to a target, shape (3,), in the robot's
            frame [m]; called again whenever the target moves.
        on_release: the named robot is let go.
        on_point_dragged: a control point is at a new place, shape (3,), in the robot's frame [m].
        on_point_drag_end: the control point is let go.
        on_point_selected: a control point was clicked or grabbed.
    """

    on_grab: Callable[[str, np.ndarray], None] = _ignore
    on_release: Callable[[str], None] = _ignore
    on_point_dragged: Callable[[int, np.ndarray], None] = _ignore
    on_point_drag_end: Callable[[int], None] = _ignore
    on_point_selected: Callable[[int], None] = _ignore


def linkage_normal(bars: np.ndarray) -> np.ndarray:
    """Unit normal of the plane of links 1 and 2, away from the camera, shape (3,)."""
    (ax, ay, az), (bx, by, bz) = bars[0, 1] - bars[0, 0], bars[1, 1] - bars[1, 0]
    normal = np.array([by * az - bz * ay, bz * ax - bx * az, bx * ay - by * ax])
    length = float(np.sqrt(normal @ normal))
    if length < 1e-6:
        return np.array([0.0, 1.0, 0.0])
    return normal / (length if normal[1] >= 0.0 else -length)


def bar_poses(bars: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where the link meshes go: links 1 and 3 in the back layer, 2 and the pieces of 4 in front.

    Args:
        bars: links 1, 2, 3 and one or more pieces of link 4, shape (n, 2, 3), [m].

    Returns:
        positions (n, 3), [m], quaternions (n, 4), scalar first, and lengths (n,), [m].
    """
    normal = linkage_normal(bars)
    along = bars[:, 1] - bars[:, 0]
    lengths = np.maximum(np.linalg.norm(along, axis=1), 1e-6)
    x = along / lengths[:, None]
    y = normal - (x @ normal)[:, None] * x
    y /= np.maximum(np.linalg.norm(y, axis=1), 1e-9)[:, None]
    turns = Rotation.from_matrix(np.stack([x, y, np.cross(x, y)], axis=-1))
    depth = np.full(len(bars), meshes.FRONT_LAYER)
    depth[[0, 2]] = meshes.BACK_LAYER
    return bars[:, 0] + depth[:, None] * normal, turns.as_quat(scalar_first=True), lengths


def trace_segments(trace: np.ndarray, count: int = TRACE_SEGMENTS) -> np.ndarray:
    """A trace as exactly `count` segments, shape (count, 2, 3); the missing ones have no length.

    A constant count lets the colours stay as they are. A trace is thinned evenly, never at its
    newest end.
    """
    if len(trace) == 0:
        return np.zeros((count, 2, 3))
    step = max(1, -(-(len(trace) - 1) // count))
    kept = trace[::-1][::step][: count + 1][::-1]
    line = np.concatenate([np.repeat(kept[:1], count + 1 - len(kept), axis=0), kept])
    return np.stack([line[:-1], line[1:]], axis=1)


def fading(colour: palette.Colour, count: int = TRACE_SEGMENTS) -> np.ndarray:
    """Linear colours from nearly white to `colour` along a trace, shape (count, 2, 3), uint8."""
    shares = 0.92 * (1.0 - np.linspace(0.0, 1.0, count + 1))
    line = np.stack([colour.toward(palette.WHITE, share).linear for share in shares])
    return np.stack([line[:-1], line[1:]], axis=1)


class Scene:
    """The 3D scene of one client.

    Args:
        client: whose scene it is; nothing here touches another client or the server's scene.
        bases: origins of the robots' frames in the world, [m], by controller name.
        hooks: what the scene tells.
        plane: the plane in a robot's frame on which pointers are read.
        titles: label and second line over each robot.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        bases: dict[str, np.ndarray] = BASES,
        hooks: Hooks | None = None,
        plane: Plane = VERTICAL_PLANE,
        titles: dict[str, tuple[str, str]] = TITLES,
    ) -> None:
        self._client = client
        self._bases = {name: np.asarray(base, dtype=float) for name, base in bases.items()}
        self._hooks = hooks or Hooks()
        self._plane = plane
        self._titles = titles
        self._names = list(self._bases)
        self._lengths = np.zeros(0)
        self._path: PathView | None = None
        self._grip = np.zeros(3)
        self._grabbed: int | None = None
        self._freehand: Freehand | None = None
        self._zone: viser.BatchedMeshHandle | None = None

    def build(self, snapshot: Snapshot) -> None:
        """Creates every node, once, with as many bars, joints and points as the snapshot has."""
        scene, robots = self._client.scene, self._robots(snapshot)
        build_stage(scene, self._bases, self._titles)
        self._build_machine(robots)
        self._build_force()
        self._build_traces()
        tips = self._tips(robots)
        colours = np.array([palette.CONTROLLERS[name].linear for name in self._names])
        self._grips = add_copies(
            scene, "/grips", meshes.coin(), tips, colours, scales=self._grip_scales(), opacity=0.22
        )
        self._grips.on_drag("left")(self._tip_dragged)
        self.update_path(snapshot)
        self.update(snapshot)
        self.update_traces(snapshot)

    def update(self, snapshot: Snapshot) -> None:
        """Moves everything that moves; at about 30 Hz. Poses that are not finite are left out."""
        robots = self._robots(snapshot)
        positions, quaternions, lengths = self._bars(robots)
        parts, tips = self._parts(robots), self._tips(robots)
        if not (np.isfinite(positions).all() and np.isfinite(parts).all()):
            return
        with self._client.atomic():
            self._links.batched_positions = positions
            self._links.batched_wxyzs = quaternions
            if np.abs(lengths - self._lengths).max() > 1e-4:
                self._lengths = lengths
                self._links.batched_scales = self._link_scales(lengths)
            self._pins.batched_positions = parts
            self._grips.batched_positions = tips
            self._update_force(robots)

    def update_traces(self, snapshot: Snapshot) -> None:
        """Redraws the end-points' traces and the force's label; at 5 to 10 Hz."""
        lines = [
            trace_segments(robot.trace) + base + [0.0, 0.002, 0.0]
            for robot, base in zip(self._robots(snapshot), self._bases.values(), strict=True)
        ]
        points = np.concatenate(lines)
        if np.isfinite(points).all():
            self._traces.points = points.astype(np.float32)
        for robot, label in zip(self._robots(snapshot), self._force_labels, strict=True):
            force = float(np.linalg.norm(robot.force))
            label.visible = force > FORCE_SHOWN
            if label.visible:
                label.text = f"force {force:.0f} N"

    def update_path(self, snapshot: Snapshot) -> None:
        """Redraws the path and its control points if the path's version changed."""
        path = snapshot.path
        if self._path is not None and path.version == self._path.version:
            return
        previous, self._path = self._path, path
        with self._client.atomic():
            self._draw_path(path)
            self._draw_points(path, previous)
            self._draw_refused(path)

    def show_singular_zone(
        self, inner_radius: float, outer_radius: float, margin: float, visible: bool = True
    ) -> None:
        """Shades what lies within `margin` of the circles about the base that are singular, [m]."""
        if self._zone is not None:
            self._zone.remove()
            self._zone = None
        if not visible:
            return
        half = abs(np.diff([b[0] for b in self._bases.values()])[0]) / 2
        low = (MIDDLE - half, -meshes.FLOOR_DEPTH)
        high = (MIDDLE + half, 0.6)
        core = meshes.ring(max(0.0, inner_radius - margin), inner_radius + margin, low, high, 0.052)
        rim = meshes.ring(outer_radius - margin, outer_radius, low, high, 0.052)
        mesh = meshes.joined(core, rim)
        bases = np.stack(list(self._bases.values()))
        self._zone = add_copies(
            self._client.scene, "/zone", mesh, bases, palette.WARNING, opacity=0.16
        )

    def frame_camera(self, insets: Insets | None = None) -> None:
        """Points the client's camera so that both robots fill what panels leave of the canvas."""
        camera = self._client.camera
        size = (max(camera.image_width, 1), max(camera.image_height, 1))
        pose = view_of(self._bases, size, insets or Insets())
        with self._client.atomic():
            camera.fov = float(FIELD_OF_VIEW)
            camera.up_direction = (0.0, 0.0, 1.0)
            camera.position = pose.position
            camera.look_at = pose.look_at

    def begin_freehand(self, on_stroke: Callable[[np.ndarray], None]) -> None:
        """Lets the user draw one stroke on a robot's plane; calls back with (n, 3), [m]."""
        self.end_freehand()
        self._freehand = Freehand(self._client.scene, self._bases, self._plane, on_stroke)

    def end_freehand(self) -> None:
        """Gives up drawing; without effect when nothing is being drawn."""
        if self._freehand is not None:
            self._freehand.cancel()
            self._freehand = None

    # What the snapshot says, as arrays over both robots in the world.

    def _robots(self, snapshot: Snapshot) -> list[RobotView]:
        return [snapshot.robots[name] for name in self._names]

    def _bars(self, robots: list[RobotView]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        poses = [bar_poses(robot.bars) for robot in robots]
        bases = self._bases.values()
        positions = [pose[0] + base for pose, base in zip(poses, bases, strict=True)]
        return (
            np.concatenate(positions),
            np.concatenate([pose[1] for pose in poses]),
            np.concatenate([pose[2] for pose in poses]),
        )

    def _parts(self, robots: list[RobotView]) -> np.ndarray:
        parts: list[np.ndarray] = []
        for robot, base in zip(robots, self._bases.values(), strict=True):
            normal = linkage_normal(robot.bars)
            parts += [
                robot.joints + meshes.BOSS * normal + base,
                (robot.tip + PEN_DEPTH * normal + base)[None],
                robot.marker + MARKER_DEPTHS + base,
                robot.extra_points + MARKER_DEPTHS[:1] + base,
            ]
        return np.concatenate(parts)

    def _tips(self, robots: list[RobotView]) -> np.ndarray:
        bases = self._bases.values()
        return np.stack([robot.tip + base for robot, base in zip(robots, bases, strict=True)])

    def _link_scales(self, lengths: np.ndarray) -> np.ndarray:
        return np.column_stack([lengths, np.ones_like(lengths), np.ones_like(lengths)])

    def _grip_scales(self) -> np.ndarray:
        scale = (GRAB_RADIUS, 0.01, GRAB_RADIUS)
        return np.tile(scale, (len(self._names), 1))

    # Nodes.

    def _build_machine(self, robots: list[RobotView]) -> None:
        scene = self._client.scene
        positions, quaternions, self._lengths = self._bars(robots)
        colours, pin_scales, pin_colours = [], [], []
        for name, robot in zip(self._names, robots, strict=True):
            colour = palette.CONTROLLERS[name]
            marker = RING_SCALES if name == TrackerName else DOT_SCALES
            shade = [colour.toward(palette.INK, 0.0 if i % 2 else 0.25) for i in range(3)]
            n_front = len(robot.bars) - 3
            colours += [c.linear for c in (*shade, *[shade[1]] * n_front)]
            joints, extras = len(robot.joints), len(robot.extra_points)
            pin_scales += [*[BEARING_SCALE] * joints, PEN_SCALE, *marker, *[EXTRA_SCALE] * extras]
            dark = colour.toward(palette.INK, 0.45)
            inks = (dark, palette.WHITE) if name == TrackerName else (palette.WHITE, dark)
            pens = [palette.INK, *inks, *[palette.STEEL] * extras]
            pin_colours += [c.linear for c in (*[palette.STEEL] * joints, *pens)]
        link = meshes.link()
        self._links = scene.add_batched_meshes_simple(
            "/links",
            np.asarray(link.vertices),
            np.asarray(link.faces),
            quaternions,
            positions,
            batched_scales=self._link_scales(self._lengths),
            batched_colors=np.stack(colours),
            lod="off",
        )
        self._pins = add_copies(
            scene,
            "/pins",
            meshes.bearing(),
            self._parts(robots),
            np.stack(pin_colours),
            scales=np.array(pin_scales),
        )

    def _build_force(self) -> None:
        scene = self._client.scene
        self._arrows = scene.add_arrows(
            "/force",
            np.zeros((len(self._names), 2, 3)),
            palette.FORCE.linear,
            shaft_radius=0.0032,
            head_radius=0.0085,
            head_length=0.018,
            visible=False,
        )
        self._force_labels = [
            scene.add_label(
                f"/force_label/{name}",
                "force",
                position=base + [MIDDLE + 0.12, 0.0, -0.12],
                font_size_mode="scene",
                font_scene_height=0.022,
                anchor="center-center",
                visible=False,
            )
            for name, base in self._bases.items()
        ]

    def _build_traces(self) -> None:
        colours = [fading(palette.CONTROLLERS[name]) for name in self._names]
        self._traces = self._client.scene.add_line_segments(
            "/traces",
            np.zeros((TRACE_SEGMENTS * len(self._names), 2, 3)),
            np.concatenate(colours),
            thickness=0.006,
        )

    def _update_force(self, robots: list[RobotView]) -> None:
        forces = np.stack([robot.force for robot in robots])
        acts = bool((np.linalg.norm(forces, axis=1) > FORCE_SHOWN).any())
        if acts:
            tails = self._tips(robots) - [0.0, 0.008, 0.0]
            points = np.stack([tails, tails + FORCE_SCALE * forces], axis=1)
            self._arrows.points = points.astype(np.float32)
        self._arrows.visible = acts

    def _draw_path(self, path: PathView) -> None:
        lines = [path.points + base for base in self._bases.values()]
        segments = np.concatenate([np.stack([p[:-1], p[1:]], axis=1) for p in lines])
        self._client.scene.add_line_segments("/path", segments, palette.PATH.rgb, thickness=0.0025)

    def _draw_points(self, path: PathView, previous: PathView | None) -> None:
        count = len(path.control_points)
        colours = np.tile(palette.CONTROL_POINT.linear, (count, 1))
        if path.selected is not None:
            colours[path.selected] = palette.SELECTED.linear
        bases = self._bases.values()
        positions = np.concatenate([path.control_points + base for base in bases])
        colours = np.tile(colours, (len(bases), 1))
        if previous is not None and len(previous.control_points) == count > 0:
            self._points.batched_positions = positions
            self._points.batched_colors = colours
            return
        if previous is not None and len(previous.control_points):
            self._points.remove()
        if count:
            self._points = add_copies(
                self._client.scene,
                "/points",
                meshes.ball(),
                positions,
                colours,
                scales=np.full(len(positions), POINT_RADIUS),
            )
            self._points.on_drag("left")(self._point_dragged)
            self._points.on_click()(self._point_clicked)

    def _draw_refused(self, path: PathView) -> None:
        if len(path.refused):
            marks = [path.refused + base - [0.0, 0.012, 0.0] for base in self._bases.values()]
            positions = np.concatenate(marks)
            scales = np.full(len(positions), 0.02)
            add_copies(
                self._client.scene,
                "/refused",
                meshes.cross(),
                positions,
                palette.WARNING,
                scales=scales,
                shadow=False,
            )
        else:
            self._client.scene.remove_by_name("/refused")

    # What the mouse does. Coroutines without await: viser runs them in order.

    async def _tip_dragged(self, event: viser.SceneNodeDragEvent[viser.BatchedMeshHandle]) -> None:
        if event.instance_index is None:
            return
        name = self._names[event.instance_index]
        if event.phase == "end":
            self._hooks.on_release(name)
            return
        target = self._on_plane(event, event.end_position, name)
        if target is not None:
            self._hooks.on_grab(name, target)

    async def _point_dragged(
        self, event: viser.SceneNodeDragEvent[viser.BatchedMeshHandle]
    ) -> None:
        path = self._path
        if event.instance_index is None or path is None or not len(path.control_points):
            return
        robot, index = divmod(event.instance_index, len(path.control_points))
        name = self._names[robot]
        if event.phase == "start":
            pressed = self._on_plane(event, event.start_position, name)
            self._grip = np.zeros(3) if pressed is None else path.control_points[index] - pressed
            self._hooks.on_point_selected(index)
        target = self._on_plane(event, event.end_position, name)
        if target is not None:
            self._hooks.on_point_dragged(index, target + self._grip)
        if event.phase == "end":
            self._hooks.on_point_drag_end(index)

    async def _point_clicked(
        self, event: viser.SceneNodePointerEvent[viser.BatchedMeshHandle]
    ) -> None:
        if event.instance_index is not None and self._path is not None:
            self._hooks.on_point_selected(event.instance_index % len(self._path.control_points))

    def _on_plane(
        self,
        event: viser.SceneNodeDragEvent[viser.BatchedMeshHandle],
        pointer: tuple[float, float, float],
        name: str,
    ) -> np.ndarray | None:
        camera = event.client.camera.position
        return pointer_on_plane(camera, np.array(pointer), self._bases[name], self._plane)
