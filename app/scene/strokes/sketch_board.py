"""A board in front of the robots for drawing a prediction with the mouse."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from onpath.app.common import palette
from onpath.app.scene.pointer_projection import intersect_ray_plane
from onpath.app.scene.stage import Stage
from onpath.app.scene.strokes.sketch_line import SketchLine
from onpath.app.scene.tones import Tones
from onpath.lessons.record import QUANTITIES
from onpath.lessons.schema import Sketch

if TYPE_CHECKING:
    import viser

FORM = 0.62  # height to width
MARGIN = 0.09  # margin between the board's edge and the axes, as a fraction of its width
PIXELS = 900  # width of the picture
CLOSEST = 0.002  # spacing of two points of a curve, as a fraction of the board's width


class SketchBoard:
    """Axes on a board that faces the camera.

    Args:
        scene: the client's scene.
        stage: where the robots stand; the board is in front of them.
        sketch: description of the axes.
        title: text above the board.
        on_drawn: called with times [s] and values, shape (n,) each, when the mouse is released.
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        stage: Stage,
        sketch: Sketch,
        title: str,
        on_drawn: Callable[[np.ndarray, np.ndarray], None],
    ) -> None:
        self._scene, self._sketch, self._on_drawn = scene, sketch, on_drawn
        self._right, self._up, self._middle, width = _placed(stage)
        self._size = width * np.array([1.0, FORM])
        self._inner = 1 - 2 * MARGIN * np.array([1.0, 1.0 / FORM])
        self._line = SketchLine(
            scene=scene,
            name="/board/line",
            look=(palette.SELECTED, 0.006),
            closest=CLOSEST,
            place=partial(self._world, above=0.003),
        )
        handle = scene.add_image(
            "/board/sheet",
            _picture(sketch, title, stage.tones),
            float(self._size[0]),
            float(self._size[1]),
            format="png",
            position=self._middle,
            wxyz=_facing(self._right, self._up),
            cast_shadow=False,
            receive_shadow=False,
        )
        handle.on_drag("left")(self._dragged)
        self._sheet = handle

    def show(self, times: np.ndarray, values: np.ndarray) -> None:
        """Set the curve from arrays, shape (n,) each."""
        self._line.begin(self._from_axes(np.column_stack([times, values])))

    def draw(self) -> None:
        """Redraw the curve; called at about 10 Hz."""
        self._line.draw()

    def remove(self) -> None:
        """Remove the board."""
        self._sheet.remove()
        self._line.remove()

    # Conversions between axis units, board coordinates (fractions from its centre) and the world.

    def _from_axes(self, points: np.ndarray) -> np.ndarray:
        low, span = self._axes()
        return ((points - low) / span - 0.5) * self._inner

    def _to_axes(self, places: np.ndarray) -> np.ndarray:
        low, span = self._axes()
        return low + span * (places / self._inner + 0.5)

    def _axes(self) -> tuple[np.ndarray, np.ndarray]:
        low = np.array([0.0, self._sketch.bottom])
        return low, np.array([self._sketch.seconds, self._sketch.top]) - low

    def _world(self, places: np.ndarray, above: float = 0.0) -> np.ndarray:
        x, y = (places * self._size).T[:, :, None]
        toward = np.cross(self._right, self._up)
        return self._middle + x * self._right + y * self._up + above * toward

    async def _dragged(self, event: viser.SceneNodeDragEvent[viser.ImageHandle]) -> None:
        if event.phase == "start":
            self._line.begin()
        seen = [event.start_position] if event.phase == "start" else []
        for pointer in (*seen, event.end_position):
            place = self._place(event.client.camera.position, np.array(pointer))
            if place is not None:
                self._line.add(place)
        if event.phase == "end" and len(points := self._line.points) > 1:
            times, values = self._to_axes(points).T
            self._on_drawn(times, values)

    def _place(self, camera: np.ndarray, pointer: np.ndarray) -> np.ndarray | None:
        """Board coordinates of a pointer, or None if it is off the board."""
        normal = np.cross(self._right, self._up)
        hit = intersect_ray_plane(camera, pointer - camera, self._middle, normal)
        if hit is None:
            return None
        offset = hit - self._middle
        place = np.array([offset @ self._right, offset @ self._up]) / self._size
        return np.clip(place, -0.5 * self._inner, 0.5 * self._inner)


def _picture(sketch: Sketch, title: str, tones: Tones) -> np.ndarray:
    """The empty axes, shape (rows, columns, 3), uint8, its lowest row first."""
    ink, sheet = tones.line.hex, tones.wall.hex
    figure = Figure(figsize=(9.0, 9.0 * FORM), dpi=PIXELS / 9.0, facecolor=sheet)
    canvas = FigureCanvasAgg(figure)
    high = MARGIN / FORM
    axes = figure.add_axes((MARGIN, high, 1 - 2 * MARGIN, 1 - 2 * high), facecolor=sheet)
    axes.set(xlim=(0.0, sketch.seconds), ylim=(sketch.bottom, sketch.top))
    axes.set_title(title, fontsize=21, pad=12, color=ink)
    axes.set_xlabel("t [s]", fontsize=16, labelpad=1, color=ink)
    axes.set_ylabel(f"[{QUANTITIES[sketch.quantity]}]", fontsize=16, labelpad=1, color=ink)
    axes.tick_params(labelsize=15, colors=ink)
    axes.grid(color=tones.path.toward(tones.wall, 0.7).hex)
    axes.spines[["left", "bottom"]].set_color(ink)
    axes.spines[["top", "right"]].set_visible(False)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[::-1, :, :3].copy()  # the scene's y axis points up


def _facing(right: np.ndarray, up: np.ndarray) -> np.ndarray:
    """Orientation of a picture with these axes as a quaternion, scalar first."""
    turn = Rotation.from_matrix(np.stack([right, up, np.cross(right, up)], axis=1))
    return turn.as_quat(scalar_first=True)


def _placed(stage: Stage) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Axes, centre and width [m] of the board: in front of all robots, facing the camera."""
    ca, sa = np.cos(stage.azimuth), np.sin(stage.azimuth)
    ce, se = np.cos(stage.elevation), np.sin(stage.elevation)
    right, up = np.array([ca, sa, 0.0]), np.array([-sa * se, ca * se, ce])
    toward = np.cross(right, up)
    corners = stage.corners
    middle = (corners.min(0) + corners.max(0)) / 2
    reach = np.abs((corners - middle) @ np.stack([right, toward], 1)).max(0)
    return right, up, middle + 0.9 * reach[1] * toward, 1.9 * float(reach[0])
