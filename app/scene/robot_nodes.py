"""Moving nodes of all robots: links, bearings, pens, markers, grips, arrows, traces."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import Counts, RobotSnapshot
from onpath.app.scene import meshes
from onpath.app.scene.arrows import Arrows, ArrowShape
from onpath.app.scene.contact_nodes import FORCE_SHOWN
from onpath.app.scene.poses import Poses, difference, trace_segments
from onpath.app.scene.stage import IDENTITY, Stage, add_copies, shade
from onpath.app.viser_adapter.frame_channel import NodeGroup, update_node
from onpath.models.control.laws.registry import law_named

if TYPE_CHECKING:
    import viser

NEGLIGIBLE = 1e-6
"""Changes of lengths, rotations and forces below this are not drawn [m, N]."""
FORCE = ArrowShape(shaft_radius=0.0032, head_radius=0.0085, head_length=0.018, shortest=0.004)
TRACE_SEGMENTS = 48
TRACE_DEPTHS = (0.012, 0.002)
"""Depth of the trace behind the path, and of older laps behind newer ones [m]."""

TAPERED, GHOST = 0.55, 0.4
"""Widths of a flexible strip at its end, and of the straight one, which an unbent strip hides."""

# Scales of the bearing's mesh, which also serves as pen and as the discs of a marker.
BEARING = (1.25, 1.0, 1.25)
MOTOR = (1.8, 1.5, 1.8)
PEN = (0.42, 0.5, 0.42)
EXTRA = (0.4, 0.1, 0.4)
RING = ((1.0, 0.06, 1.0), (0.72, 0.06, 0.72))
DOT = ((0.62, 0.06, 0.62), (0.42, 0.06, 0.42))
LARGE = 2.0
"""How much wider a marker is in a narrow picture."""


@lru_cache(maxsize=32)  # for every page
def fading(colour: palette.Colour, wall: palette.Colour, count: int = TRACE_SEGMENTS) -> np.ndarray:
    """Linear colours from nearly `wall` to `colour` along a trace, shape (count, 2, 3), uint8."""
    shares = 0.92 * (1.0 - np.linspace(0.0, 1.0, count + 1))
    line = np.stack([colour.toward(wall, share).linear for share in shares])
    return np.stack([line[:-1], line[1:]], axis=1)


def link_scales(lengths: np.ndarray, widths: np.ndarray | float = 1.0) -> np.ndarray:
    """Per-axis scales of the link's mesh, shape (n, 3)."""
    return np.column_stack([lengths, np.ones_like(lengths), widths * np.ones_like(lengths)])


def bar_colours(side: str, counts: Counts) -> np.ndarray:
    """Linear colours of a robot's bars, shape (n, 3): every other link is behind and darker.

    Pieces of a flexible strip are in front and lighter.
    """
    front = palette.OF_SIDE[side]
    back, strip = front.toward(palette.INK, 0.25), front.toward(palette.WHITE, 0.35)
    links = [back if each else front for each in counts.behind[: counts.links]]
    return np.stack([each.linear for each in [*links, *[strip] * counts.strip]])


def part_looks(
    side: str, law: str, counts: Counts, motors: Sequence[int] = (), is_narrow: bool = False
) -> tuple[list[tuple[float, ...]], list[np.ndarray]]:
    """Scales and linear colours of a robot's bearings, pen, marker and extra points.

    Joints in `motors` are drawn as motors. The marker of a law that aims at a reference point is a
    ring; that of the closest point is a dot with a white rim. Each consists of two discs, one in
    front of the other, wider if the picture is narrow.
    """
    extras = counts.marks
    dark = palette.OF_SIDE[side].toward(palette.INK, 0.45)
    discs, inks = DOT, (palette.WHITE, dark)
    if law_named(law).aim == "theta_ref":
        discs, inks = RING, (dark, palette.WHITE)
    wider = LARGE if is_narrow else 1.0
    discs = tuple((wider * x, depth, wider * z) for x, depth, z in discs)
    driven = [i in motors for i in range(counts.joints)]
    joints = [palette.MOTOR if motor else palette.STEEL for motor in driven]
    colours = [*joints, palette.INK, *inks, *[palette.STEEL] * extras]
    sizes = [MOTOR if motor else BEARING for motor in driven]
    return [*sizes, PEN, *discs, *[EXTRA] * extras], [c.linear for c in colours]


def _add_traces(scene: viser.SceneApi, stage: Stage) -> viser.LineSegmentsHandle:
    wall = stage.tones.wall
    return scene.add_line_segments(
        "/traces",
        np.zeros((TRACE_SEGMENTS * len(stage.bases), 2, 3)),
        np.concatenate([fading(palette.OF_SIDE[side], wall) for side in stage.bases]),
        thickness=0.006,
    )


def _trace_origins(origins: np.ndarray) -> np.ndarray:
    """Origins of the segments of all robots' traces, shape (count, 1, 3), [m]."""
    depths = np.zeros((TRACE_SEGMENTS, 3))
    depths[:, 1] = np.linspace(*TRACE_DEPTHS, TRACE_SEGMENTS)
    return (origins[:, None] + depths).reshape(-1, 1, 3)


class Bars:
    """Some of the bars as copies of one mesh along x from 0 to 1.

    Args:
        rows: of these bars in `Poses`.
        colours: linear colours of these bars, shape (k, 3).
        widths: of these bars, relative to the mesh's.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        name: str,
        mesh: meshes.Mesh,
        rows: slice,
        colours: np.ndarray,
        poses: Poses,
        widths: np.ndarray | float = 1.0,
    ) -> None:
        self._rows, self._widths = rows, widths
        self._lengths = poses["lengths"][rows]
        scales = link_scales(self._lengths, widths)
        self.node = add_copies(scene, name, mesh, poses["bars"][rows], colours, scales=scales)

    def update_lengths(self, poses: Poses) -> None:
        """Rescale the bars if lengths have changed."""
        lengths = poses["lengths"][self._rows]
        if difference(lengths, self._lengths) > 1e-4:
            self._lengths = lengths
            update_node(self.node, batched_scales=link_scales(lengths, self._widths))

    def properties(self, poses: Poses) -> list[tuple[viser.BatchedMeshHandle, str, slice]]:
        """The moving properties and their places in `Poses.whole`; see `NodeGroup`."""
        return [
            (self.node, "batched_positions", poses.span("bars", self._rows)),
            (self.node, "batched_wxyzs", poses.span("quaternions", self._rows)),
        ]


class BodyNode:
    """One moving body of all robots, as copies of its mesh.

    Args:
        number: of the body.
        sides: of the robots.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        number: int,
        mesh: meshes.Mesh,
        sides: Sequence[str],
        poses: Poses,
    ) -> None:
        self._rows = slice(number * len(sides), (number + 1) * len(sides))
        tints = [palette.OF_SIDE[side] for side in sides]
        colours = [tint.toward(palette.INK, 0.2) if number % 2 else tint for tint in tints]
        inks = np.stack([colour.linear for colour in colours])
        self.node = add_copies(scene, f"/bodies/{number}", mesh, poses["bodies"][self._rows], inks)

    def properties(self, poses: Poses) -> list[tuple[viser.BatchedMeshHandle, str, slice]]:
        """The moving properties and their places in `Poses.whole`; see `NodeGroup`."""
        return [
            (self.node, "batched_positions", poses.span("bodies", self._rows)),
            (self.node, "batched_wxyzs", poses.span("attitudes", self._rows)),
        ]


class RobotNodes:
    """Nodes shared by all robots, to keep the number of messages small.

    Args:
        scene: the client's scene.
        stage: where the robots stand.
        counts: numbers of parts of each robot.
        laws: their control laws.
        poses: their initial poses.
        is_narrow: whether the page is so narrow that markers must be larger.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        counts: Counts,
        laws: dict[str, str],
        poses: Poses,
        is_narrow: bool = False,
    ) -> None:
        self._laws, self._is_narrow = laws, is_narrow
        self._counts, self._motors = counts, stage.motors
        self._bases = bases = stage.bases
        self._force_scale = stage.force_scale
        self._drawn = poses
        bodies = [
            BodyNode(scene, number, mesh, list(bases), poses)
            for number, mesh in enumerate(stage.bodies)
        ]
        self.bodies = [body.node for body in bodies]
        self._bars = [] if bodies else self._add_bars(scene, counts, poses)
        self._parts = self._add_parts(scene, poses)
        shade([self._parts, *(each.node for each in (*self._bars, *bodies))], stage)
        self._turns = np.tile(IDENTITY, (len(poses["turns"]), 1))
        self.grips = add_copies(
            scene,
            "/grips",
            meshes.grip(),
            poses["tips"],
            np.stack([palette.OF_SIDE[side].toward(palette.INK, 0.5).linear for side in bases]),
            opacity=0.42,
        )
        self._traces = _add_traces(scene, stage)
        self._trace_origins = _trace_origins(stage.origins)
        self._traced = self._trace_origins
        nowhere = np.zeros((len(bases), 2, 3))
        self._arrows = Arrows(
            scene, "/force", points=nowhere, colour=stage.tones.force, shape=FORCE
        )
        self._acting = False
        self._moving = NodeGroup(
            [
                *(moving for each in (*self._bars, *bodies) for moving in each.properties(poses)),
                (self._parts, "batched_positions", poses.span("parts")),
                (self.grips, "batched_positions", poses.span("tips")),
            ]
        )
        self._seldom_changing = np.zeros_like(poses.seldom_changing)
        self._draw(poses)

    def _add_bars(self, scene: viser.SceneApi, counts: Counts, poses: Poses) -> list[Bars]:
        links = slice(len(self._bases) * counts.links)
        strips = slice(links.stop, len(self._bases) * counts.bars)
        is_link = np.arange(counts.bars) < counts.links
        colours_of_robots = [bar_colours(side, counts) for side in self._bases]
        bars = [
            Bars(
                scene,
                "/links",
                mesh=meshes.part("link"),
                rows=links,
                colours=np.concatenate([colours[is_link] for colours in colours_of_robots]),
                poses=poses,
            )
        ]
        if counts.strip:
            bars.append(
                Bars(
                    scene,
                    "/beams",
                    mesh=meshes.part("blade"),
                    rows=strips,
                    colours=np.concatenate([colours[~is_link] for colours in colours_of_robots]),
                    poses=poses,
                    widths=np.tile(np.linspace(1.0, TAPERED, counts.strip), len(self._bases)),
                )
            )
        if counts.marks:
            straight = slice(strips.stop, None)
            grey = np.tile(palette.MUTED.linear, (len(self._bases) * counts.marks, 1))
            bars.append(
                Bars(
                    scene,
                    "/straight",
                    mesh=meshes.part("blade"),
                    rows=straight,
                    colours=grey,
                    poses=poses,
                    widths=GHOST,
                )
            )
        return bars

    def _add_parts(self, scene: viser.SceneApi, poses: Poses) -> viser.BatchedMeshHandle:
        scales, colours = self._part_looks()
        mesh = meshes.part("bearing")
        return add_copies(scene, "/parts", mesh, poses["parts"], colours, scales=scales)

    def _part_looks(self) -> tuple[np.ndarray, np.ndarray]:
        """`part_looks` of all robots, shape (parts, 3) each."""
        counts, motors, narrow = self._counts, self._motors, self._is_narrow
        looks = [part_looks(side, law, counts, motors, narrow) for side, law in self._laws.items()]
        scales = [scale for scales, _ in looks for scale in scales]
        return np.array(scales), np.stack([colour for _, colours in looks for colour in colours])

    def update_laws(self, laws: dict[str, str]) -> None:
        """Redraw the markers if laws have changed."""
        if laws != self._laws:
            self._laws = laws
            scales, colours = self._part_looks()
            update_node(self._parts, batched_scales=scales)
            self._parts.batched_colors = colours

    def update(self, poses: Poses) -> None:
        """Move the robots, and redraw forces, rotations and lengths that have changed.

        Sends nothing while the robots stand still.
        """
        if poses.is_news(self._drawn):
            self._drawn = poses
            self._draw(poses)

    def _draw(self, poses: Poses) -> None:
        self._moving.update(poses.whole)
        if self._acting or difference(poses.seldom_changing, self._seldom_changing) > NEGLIGIBLE:
            self._seldom_changing = poses.seldom_changing
            self._draw_seldom_changing(poses)

    def _draw_seldom_changing(self, poses: Poses) -> None:
        """Draw lengths and rotations if they have changed, and forces with their arrows."""
        for bars in self._bars:
            bars.update_lengths(poses)
        turns = poses["turns"]
        if difference(turns, self._turns) > 1e-3:
            self._turns = turns
            update_node(self._parts, batched_wxyzs=turns)
        forces = poses["forces"]
        acts = max(map(abs, forces.ravel().tolist())) > FORCE_SHOWN
        if acts or self._acting:
            tails = poses["tips"] - [0.0, 0.01, 0.0]
            self._arrows.draw(np.stack([tails, tails + self._force_scale * forces], axis=1))
        self._acting = acts

    def update_traces(self, robots: list[RobotSnapshot]) -> None:
        """Redraw the traces if they have changed."""
        lines = [trace_segments(robot.trace, TRACE_SEGMENTS) for robot in robots]
        points = np.concatenate(lines) + self._trace_origins
        if 0.0 < difference(points, self._traced) < np.inf:  # false if there is a NaN
            self._traced = points
            update_node(self._traces, points=points)
