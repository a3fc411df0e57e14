"""The optional tube around the path, and the curves of constant θ and of constant ξ in it."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, log10
from typing import TYPE_CHECKING

import numpy as np

from onpath.app.common import palette
from onpath.app.lab.snapshots.snapshot import PathSnapshot
from onpath.app.scene.meshes import Mesh
from onpath.app.scene.stage import Stage, add_copies
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.tube import CurveFrames, curve_frames, offset, tube_width
from onpath.models.systems.robots import Robot

if TYPE_CHECKING:
    import viser

WIDEST = 0.06
"""Radius up to which a tube is drawn [m]."""
LINES = 24
"""Curves of constant θ: one every 15 degrees of a circle."""
OFFSETS, LEAST_STEP = 4, 0.005
"""Number of curves of constant ξ on each side of the path, and their least distance [m]."""
ALONG = 120
"""Steps along a series; a drawing has at least `Curve.grid`."""
AROUND = 16
"""Points around the tube of a space curve."""
SPREAD = 0.97
"""Share of the tube's width that is drawn: at its rim, curves may collapse to a point."""
BEHIND = {"fill": 0.006, "grid": 0.004}
"""Depths behind the path's plane [m]."""
FILL, GRID_LINE = palette.SELECTED, palette.STEEL


@dataclass(frozen=True, slots=True, eq=False)
class TubeShape:
    """A tube and its coordinate curves in the robot's own frame, [m].

    Attributes:
        width: of the tube, [m]; infinite for a straight line.
        step: between curves of constant ξ, [m].
        degrees: between curves of constant θ, [degrees].
        fill: the band, or in space the tube's surface.
        normals: curves of constant θ, shape (n, 2, 3).
        offsets: curves of constant ξ, shape (k, 2, 3).
    """

    width: float
    step: float
    degrees: float
    fill: Mesh
    normals: np.ndarray
    offsets: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class TubeSizes:
    """Sizes of a tube, [m].

    Attributes:
        width: see `TubeShape`.
        shown: how far from the path it is drawn.
        step: see `TubeShape`.
        across: distances of the curves of constant ξ on one side.
    """

    width: float
    shown: float
    step: float
    across: np.ndarray


def tube_sizes(curve: Curve) -> TubeSizes:
    """The sizes of the tube around a curve, as it is drawn."""
    width = tube_width(curve)
    shown = SPREAD * min(width, WIDEST)
    step = _round_step(max(shown / OFFSETS, LEAST_STEP))
    across = np.arange(1, floor(shown / step + 1e-9) + 1) * step
    return TubeSizes(width=width, shown=shown, step=step, across=across)


def tube_shape(robot: Robot, path: PathSnapshot) -> TubeShape:
    """The tube around a path as it is drawn."""
    curve = path.curve
    sizes = tube_sizes(curve)
    shown, across = sizes.shown, sizes.across
    along = ALONG
    if isinstance(curve, SplineCurve):
        along = LINES * ceil(curve.grid / LINES)
    theta = np.linspace(-np.pi, np.pi, along + 1)
    frames = curve_frames(curve, theta)
    in_space = curve.dimension == 3
    at = curve_frames(curve, theta[:: along // LINES])

    def placed(points: np.ndarray) -> np.ndarray:
        return robot.position(robot.frame.lift(points))

    return TubeShape(
        width=sizes.width,
        step=sizes.step,
        degrees=360 / LINES,
        fill=_skin(placed(_rim(frames, shown) if in_space else _edges(frames, shown))),
        normals=placed(_spokes(at, shown) if in_space else _edges(at, shown)),
        offsets=placed(_offsets(frames, np.concatenate([-across[::-1], across]))),
    )


def _round_step(step: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten, at most `step`, [m]."""
    power = 10.0 ** floor(log10(step))
    return next(power * digit for digit in (5, 2, 1) if power * digit <= step * (1 + 1e-9))


def _polyline(points: np.ndarray) -> np.ndarray:
    """Segments of polylines, (..., n, d) -> (k, 2, d)."""
    pieces = np.stack([points[..., :-1, :], points[..., 1:, :]], axis=-2)
    return pieces.reshape(-1, 2, points.shape[-1])


def _edges(frames: CurveFrames, width: float) -> np.ndarray:
    """Points on both sides of a planar curve, shape (n, 2, 2)."""
    return np.stack([offset(frames, np.array([s * width])) for s in (-1, 1)], axis=1)


def _rim(frames: CurveFrames, width: float) -> np.ndarray:
    """Circles around a space curve, shape (n, AROUND + 1, 3)."""
    turn = np.linspace(0, 2 * np.pi, AROUND + 1)
    xi = width * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return offset(frames, xi[:, None]).transpose(1, 0, 2)


def _spokes(frames: CurveFrames, width: float) -> np.ndarray:
    """Both normals of a space curve on both sides, and the circle through their ends, at every θ.

    Returns:
        Shape (k, 2, 3).
    """
    axes = width * np.eye(2)
    normals = [np.stack([offset(frames, -axis), offset(frames, axis)], axis=1) for axis in axes]
    return np.concatenate([*normals, _polyline(_rim(frames, width))])


def _offsets(frames: CurveFrames, across: np.ndarray) -> np.ndarray:
    """Curves at these distances along each normal, shape (k, 2, d)."""
    axes = np.eye(frames.normals.shape[1])
    return np.concatenate([_polyline(offset(frames, across[:, None, None] * a)) for a in axes])


def _skin(rows: np.ndarray) -> Mesh:
    """The surface between neighbouring rows of points, shape (n, m, 3)."""
    n, m, _ = rows.shape
    corner = (np.arange(n - 1)[:, None] * m + np.arange(m - 1)).ravel()
    one = np.column_stack([corner, corner + 1, corner + m])
    other = np.column_stack([corner + 1, corner + m + 1, corner + m])
    return Mesh(rows.reshape(-1, 3), np.concatenate([one, other]))


class TubeNodes:
    """Nodes of one tube, at every robot.

    Args:
        scene: the client's scene.
        stage: where the robots stand.
    """

    def __init__(
        self, scene: viser.SceneApi, stage: Stage, shape: TubeShape, fill: bool, grid: bool
    ) -> None:
        away = stage.away
        self._nodes: list[viser.SceneNodeHandle] = []
        if fill:
            back = stage.origins + BEHIND["fill"] * away
            band = add_copies(scene, "/show/tube", shape.fill, back, FILL, opacity=0.22)
            self._nodes.append(band)
        if grid:
            back = stage.origins + BEHIND["grid"] * away
            lines = np.concatenate([shape.normals, shape.offsets])
            points = (back[:, None, None] + lines).reshape(-1, 2, 3)
            node = scene.add_line_segments("/show/grid", points, GRID_LINE.rgb, thickness=0.0008)
            self._nodes.append(node)

    def remove(self) -> None:
        """Remove all nodes."""
        for node in self._nodes:
            node.remove()
