"""Places the lines of a drawing in the plane of a path, rounds corners, and makes one path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.path_files.stroke import Stroke
from onpath.models.paths.curve_fit import smooth_through
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.spline_fit import compared, spline_through

LARGEST = 1.0  # [m], of any coordinate
FLAT = 1e-5  # [m], from a straight line, below which points of a line are no corners
SMOOTH, ROUND = "smooth", "round"
RADIUS = 0.01  # [m], of corners
FINEST = 0.02  # [rad], turn between two points of an arc
CORNERED = 500  # corners of a line that are rounded


@dataclass(frozen=True, slots=True)
class Placing:
    """What is done with the lines of a file before they are a path.

    Attributes:
        unit: of the numbers in the file, a name of `UNITS`; None: the one that the file states,
            else metres for points, millimetres for G-code, and 1/96 inch for drawings.
        scale: factor of all lengths.
        fit: larger side of its bounding box after scaling, [m]; None: as it is.
        centre: of its bounding box, [m]; None: where it is, or with `fit` at the origin.
        corners: "smooth", or "round" for arcs of a radius in the place of corners.
        radius: of these arcs, [m].
        closed: whether the end of each line is joined to its beginning; None: as the file says,
            else a single line is.
        part: numbers of the wanted lines in a file with several, from 1, in their order; None: all.
        layer: number of a print's layer, from 1, or name of a drawing's layer; None: the first of
            a print, all of a drawing.
        turn: angle by which they are turned anticlockwise, [degrees].
    """

    unit: str | None = None
    scale: float = 1.0
    fit: float | None = None
    centre: tuple[float, float] | None = None
    corners: str = SMOOTH
    radius: float = RADIUS
    closed: bool | None = None
    part: tuple[int, ...] | None = None
    layer: str | None = None
    turn: float = 0.0


def placed(strokes: Sequence[Stroke], placing: Placing) -> list[Stroke]:
    """The lines at their place in the plane, [m].

    Raises:
        CodedError: they are then too large, or without length and have no size to fit.
    """
    turned = placing.scale * _rotation(placing.turn)
    points = [stroke.points @ turned.T for stroke in strokes]
    low, high = _box(points)
    if placing.fit is not None:
        side = float((high - low).max())
        if not side > 0:
            raise CodedError("error.points_coincide", least=2)
        points = [placing.fit / side * each for each in points]
        low, high = _box(points)
    if placing.fit is not None or placing.centre is not None:
        moved = np.array(placing.centre or (0.0, 0.0)) - (low + high) / 2
        points = [each + moved for each in points]
    farthest = max(float(np.abs(each).max()) for each in points)
    if not farthest <= LARGEST:
        raise CodedError("error.file_too_large", farthest=f"{farthest:.4g}", most=f"{LARGEST:g}")
    return [
        replace(
            stroke,
            points=each,
            closed=stroke.closed if placing.closed is None else placing.closed,
        )
        for stroke, each in zip(strokes, points, strict=True)
    ]


def _rotation(degrees: float) -> Array:
    """The matrix of a turn, exact for quarters of a turn, shape (2, 2)."""
    quarters, rest = divmod(degrees, 90)
    angle = np.deg2rad(rest)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    return np.linalg.matrix_power(np.array([[0.0, -1.0], [1.0, 0.0]]), int(quarters) % 4) @ turn


def _box(points: Sequence[Array]) -> tuple[Array, Array]:
    """The corners of the box around lines, shapes (2,)."""
    return (
        np.min([each.min(0) for each in points], axis=0),
        np.max([each.max(0) for each in points], axis=0),
    )


def curve_of(strokes: Sequence[Stroke], placing: Placing) -> SplineCurve:
    """The path of placed lines, with its deviation from the straight lines between their points.

    A single line is closed unless it is known to be open; of several, those known to be closed.
    Unless the placing says that it is open, a drawing is repeated, with the pen raised on the way
    back.

    Raises:
        CodedError: the lines are too short, or have too few points.
    """
    single = len(strokes) == 1
    given, lines = list[Array](), list[Array]()
    for stroke in strokes:
        points, closed = stroke.points, stroke.closed is True or (single and stroke.closed is None)
        line = points
        if placing.corners == ROUND:
            line = rounded(points, closed, placing.radius)
        elif not stroke.straight:
            line = smooth_through(points, closed)
        for each, some in ((points, given), (line, lines)):
            some.append(np.vstack([each, each[:1]]) if closed else each)
    closed = single and strokes[0].closed is not False
    return compared(spline_through(lines, closed, repeated=placing.closed is None), given)


def rounded(points: Array, closed: bool, radius: float) -> Array:
    """The polyline with arcs in the place of its corners, shape (n, 2) -> (k, 2), [m].

    An arc takes at most half of the shorter line beside it, and has a smaller radius if need be.

    Args:
        points: [m].
        radius: of the arcs, [m].

    Raises:
        CodedError: it has more than `CORNERED` corners.
    """
    if closed and len(points) > 1 and np.linalg.norm(points[0] - points[-1]) < FLAT:
        points = points[:-1]
    corners = _corners(points, closed)
    if len(corners) < 3:
        return corners
    before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
    line = list[Array]()
    for i, (a, corner, b) in enumerate(zip(before, corners, after, strict=True)):
        end = not closed and i in (0, len(corners) - 1)
        line += [corner] if end else _arc(a, corner, b, radius)
    return np.array(line)


def _arc(a: Array, corner: Array, b: Array, radius: float) -> list[Array]:
    """Points of the arc in the place of the corner between two others."""
    back, ahead = a - corner, b - corner
    lengths = np.linalg.norm(back), np.linalg.norm(ahead)
    back, ahead = back / lengths[0], ahead / lengths[1]
    cross = float(back[0] * ahead[1] - back[1] * ahead[0])
    turn = np.pi - abs(float(np.arctan2(cross, back @ ahead)))
    if turn < FINEST or turn > np.pi - FINEST:
        return [corner]
    reach = min(radius * np.tan(turn / 2), 0.5 * float(min(lengths)))
    begin, end, radius = corner + reach * back, corner + reach * ahead, reach / np.tan(turn / 2)
    middle = back + ahead
    centre = corner + middle * (np.hypot(reach, radius) / np.linalg.norm(middle))
    first, count = begin - centre, int(turn / FINEST) + 2
    angles = np.linspace(0, turn if cross < 0 else -turn, count)[1:-1]
    arc = [np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]]) @ first for t in angles]
    return [begin, *(centre + each for each in arc), end]


def _corners(points: Array, closed: bool) -> Array:
    """The points without those on straight lines between others, by Ramer, Douglas and Peucker.

    Raises:
        CodedError: they are more than `CORNERED`.
    """
    if closed and len(points) > 2:
        far = int(np.linalg.norm(points - points[0], axis=1).argmax())
        halves = points[: far + 1], np.vstack([points[far:], points[:1]])
        found = np.vstack([_simplified(half)[:-1] for half in halves])
        _check_corners(len(found))
        return found
    return _simplified(points)


def _check_corners(count: int) -> None:
    if count > CORNERED:
        raise CodedError("error.file_corners", most=CORNERED)


def _simplified(points: Array) -> Array:
    kept, waiting = {0, len(points) - 1}, [(0, len(points) - 1)]
    while waiting:
        begin, end = waiting.pop()
        if end - begin < 2:
            continue
        line, inner = points[end] - points[begin], points[begin + 1 : end] - points[begin]
        length = float(np.linalg.norm(line))
        if length > 0:
            share = np.clip(inner @ line / length**2, 0, 1)
            inner = inner - share[:, None] * line
        distance = np.linalg.norm(inner, axis=1)
        farthest = int(distance.argmax())
        if distance[farthest] > FLAT:
            middle = begin + 1 + farthest
            kept.add(middle)
            _check_corners(len(kept))  # before it takes long: the time goes with their number
            waiting += [(begin, middle), (middle, end)]
    return points[sorted(kept)]


def least_radius(curve: Curve) -> float:
    """The smallest radius of curvature of a path, [m]; infinite for a line."""
    most = float(np.abs(curve.curvature(curve.sample(4 * curve.grid))).max())
    return 1 / most if most > 1e-3 else inf
