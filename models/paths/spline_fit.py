"""Fits a curve of many pieces to the strokes of a drawing.

The strokes are rounded a little, joined by raised links, and given a speed that slows for bends.
The parameter of the curve is the time of this speed profile, from -π to π: while θ' is constant,
every law passes bends slowly. With D the design matrix of the B-splines and z the points at even
times, the control points p minimise

    |D p - z|² + w |Δ³ p|².

Source: C. de Boor, A Practical Guide to Splines, Springer, 2001, chapters X and XIV; for the second
term Eilers and Marx, Flexible smoothing with B-splines and penalties, Statistical Science 11, 1996.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.curve_fit import APART, DENSE, apart, check_length
from onpath.models.paths.curves import PERIOD
from onpath.models.paths.path_checks import LEAST_RADIUS
from onpath.models.paths.spline_curves import DEGREE, MOST_PIECES, SplineCurve, grained
from onpath.models.paths.stroke_order import Duration, Places, ordered

ROUNDINGS = ((2e-4, 1.0), (3e-4, 1.1), (4e-4, 1.2), (5e-4, 1.35), (6e-4, 1.5), (8e-4, 2.0))
"""Width of the smoothing, [m], and factor of the caps' radius; the later ones if bends need it."""
STEP = 1e-4  # [m], arc length between two points of a line, unless it is long
MOST_STEPS = 40_000  # of a line
MOST_SEEN = 100_000  # places of a curve that are compared with its drawing
CUSP = float(np.cos(np.deg2rad(110)))  # cosine of the turn from which a corner is a cusp
CAP = (6e-4, 1.2e-3)  # [m], least and largest radius of the half circle in the place of a cusp
TAPER = 8  # length along which a line makes room for this half circle, in radii
QUICK = 0.314  # [m/s], speed on straight lines: that of the usual circle
HASTE = 1.5  # factor of `QUICK` where the pen is up
TURNING = 2.0  # [m/s²], acceleration in bends and along the path: that of the usual circle
SWING = 30.0  # [rad/s], of the tangent in bends; a held arm keeps a bend up to 2 √K1, usually 40
SLOW = 0.05  # least speed as a share of `QUICK`, so that σ' is nowhere 0
AT_ENDS = 0.3  # the same at the ends of an open path
EASING = 2e-3  # [m], over which bends are averaged, and the speed is smoothed
CLOSE = 0.0025  # deviation at which pieces suffice, as a share of the drawing's size
HOPELESS = 0.02  # the same beyond which the most pieces are too few, however round the corners are
FIRST_PIECES = 24
DENSITY = 12  # points on each piece
STIFFNESS = 1e-7  # w, for each point of a piece
TREMOR = 1.5e-3  # [m], width of the smoothing of a line drawn by hand
DECIMALS = 4  # of the duration, [s], and of the ends of links, [rad]
LINK_RADII = (1.5e-3, 3e-3)  # [m], of a link's arcs, and a larger one in large drawings
_SENSES = np.array([[1, 1, -1, -1], [1, -1, 1, -1]])  # of both arcs of a link: 1 turns left
MOST_RAISED = 0.3  # share of the time that the pen may be up in a drawing that is repeated


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """Strokes and links as one line.

    Attributes:
        points: close to each other, shape (n, 2), [m]; a closed line ends with its first point.
        pen: whether the pen is down at them, shape (n,).
        closed: whether the line is closed.
    """

    points: Array
    pen: Array
    closed: bool


def spline_through(
    strokes: Sequence[Array], closed: bool = False, repeated: bool = False
) -> SplineCurve:
    """The path along strokes; between them the pen is raised.

    They are drawn in their order and direction, unless the pen would then be up for more than
    `MOST_RAISED` of the time; then in those of `ordered`. That does not suffice for short strokes:
    a link takes about 0.1 s, since the tangent turns by at most `SWING`. In 120 random drawings
    of 120 mm, links took 28 % with strokes of 80 mm and more on average, 31 % with 60 to 80 mm, and
    41 % with 30 to 45 mm, instead of 50, 53 and 61 % in the order of the file.

    It is rounded as little as is needed for bends of `LEAST_RADIUS`. Its control points are
    multiples of `GRAIN`, and its times have `DECIMALS`, so that it can be told in whole numbers.

    Args:
        strokes: each of shape (n, 2), [m].
        closed: whether a single stroke is joined to its beginning.
        repeated: whether a drawing that is not closed is drawn again and again: at its end the pen
            is raised and goes back to the beginning. Not if the pen would then be up for more than
            `MOST_RAISED` of the time, as after a straight line.

    Raises:
        ValueError: points of a wrong shape or not finite, fewer than two of a stroke that are
            apart from each other (three of a closed one), or a length below `SHORTEST`.
    """
    closed = closed and len(strokes) == 1
    lines = _cleaned(strokes, closed)
    if repeated and not closed:
        found = _in_order(lines, closed, returns=True)
        if raised_share(found) <= MOST_RAISED:
            return found
    return _in_order(lines, closed, returns=False)


def _in_order(lines: list[Array], closed: bool, returns: bool) -> SplineCurve:
    """The path along lines in their order, or in a quicker one; see `spline_through`."""
    size = float(np.ptp(np.vstack(lines), axis=0).max())
    line = _joined([_even(each)[0] for each in lines], closed, returns, size)
    steps = np.diff(_times(line, _bends(line)))
    if steps[line.pen[1:] == 0].sum() <= MOST_RAISED * steps.sum():  # about; the fit tells exactly
        found = _through(lines, closed, returns)
        if raised_share(found) <= MOST_RAISED:
            return found
    return _through(ordered(lines, returns, _quickest(size)), closed, returns)


def raised_share(curve: SplineCurve) -> float:
    """The share of the time in which the pen is up."""
    return sum(end - begin for begin, end in curve.raised) / PERIOD


def _through(lines: list[Array], closed: bool, returns: bool = False) -> SplineCurve:
    """The path along lines without points that coincide; see `spline_through`."""
    size = float(np.ptp(np.vstack(lines), axis=0).max())
    sharpest, best = np.inf, None
    for width, factor in ROUNDINGS:
        cap = factor * float(np.clip(0.008 * size, *CAP))
        smooth = [_rounded(each, closed, width, cap) for each in lines]
        line = _joined(smooth, closed, returns, size)
        found, off = _fitted(line, CLOSE * size)
        bend = _sharpest(found)
        if bend < sharpest:
            sharpest, best = bend, found
        if bend <= 1 / LEAST_RADIUS or off > HOPELESS * size:
            break
    assert best is not None
    return compared(best, lines)


def _cleaned(strokes: Sequence[Array], closed: bool) -> list[Array]:
    """The strokes without points that coincide; those that are a single point are left out.

    A closed one ends with its first point.

    Raises:
        ValueError: see `spline_through`.
    """
    kept = [apart(stroke) for stroke in strokes]
    if closed and kept and len(kept[0]) > 2 and np.linalg.norm(kept[0][0] - kept[0][-1]) > APART:
        kept[0] = np.vstack([kept[0], kept[0][:1]])
    lines = [line for line in kept if len(line) > (3 if closed else 1)]
    if not lines:
        raise CodedError("error.points_coincide", least=3 if closed else 2)
    check_length(sum(float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum()) for line in lines))
    return lines


def _rounded(points: Array, closed: bool, width: float, cap: float) -> Array:
    """A stroke at even steps, smoothed by a Gaussian of some width, with caps of a radius, [m]."""
    even, step = _even(points)
    even = _capped(even, step, closed, cap)
    even, step = _even(even)
    return _smoothed(even, closed, width / step)


def steadied(points: Array, closed: bool) -> Array:
    """A line drawn by hand without the hand's tremor, at even steps, shape (n, 2) -> (k, 2), [m].

    Args:
        points: more than one.
        closed: whether it is closed; it then ends with its first point.
    """
    even, step = _even(np.vstack([points, points[:1]]) if closed else points)
    return _smoothed(even, closed, TREMOR / step)


def _smoothed(even: Array, closed: bool, width: float) -> Array:
    """A line, smoothed by a Gaussian of a width in steps; an open one keeps its ends."""
    from scipy.ndimage import gaussian_filter1d  # slow to import; see app/server/warm_up.py

    if closed:
        smooth = gaussian_filter1d(even[:-1], width, axis=0, mode="wrap")
        return np.vstack([smooth, smooth[:1]])
    pad = min(len(even) - 1, int(4 * width) + 1)
    before = 2 * even[:1] - even[pad:0:-1]
    after = 2 * even[-1:] - even[-2 : -pad - 2 : -1]
    smooth = gaussian_filter1d(np.vstack([before, even, after]), width, axis=0)
    return smooth[pad:-pad]


def _even(points: Array) -> tuple[Array, float]:
    """The points of a polyline at even steps, and the step [m]."""
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    count = int(np.clip(s[-1] / STEP, 32, MOST_STEPS))
    at: Array = np.linspace(0.0, float(s[-1]), count + 1)
    return np.stack([np.interp(at, s, points[:, i]) for i in (0, 1)], axis=-1), float(s[-1] / count)


def _capped(points: Array, step: float, closed: bool, radius: float) -> Array:
    """A line at even steps with half circles of a radius in the place of its cusps.

    Before a cusp the line gives way to one side, and after it to the other one.
    """
    ring = points[:-1] if closed else points
    reach = max(2, round(1.5 * radius / step))
    if len(ring) < 4 * reach:
        return points
    cosine, outward = _turns(ring, closed, reach)
    if closed:  # begin where it is straight
        seam = int(cosine.argmax())
        ring, cosine, outward = (np.roll(each, -seam, axis=0) for each in (ring, cosine, outward))
    parts, begin = list[Array](), 0
    moved = ring.copy()
    for i in _cusps(cosine, outward, reach):
        along = outward[i] / max(float(np.linalg.norm(outward[i])), 1e-30)
        side = np.array([-along[1], along[0]])
        if (ring[max(i - reach, 0)] - ring[min(i + reach, len(ring) - 1)]) @ side < 0:
            side = -side
        taper = round(TAPER * radius / step)
        for sign, index in (
            (1, np.arange(max(i - taper, 0), i)[::-1]),
            (-1, np.arange(i + 1, min(i + taper, len(ring)))),
        ):
            share = np.arange(1, len(index) + 1) / taper
            room = radius * (1 - share**2 * (3 - 2 * share))
            there = sign * ((ring[index] - ring[i]) @ side)
            moved[index] += sign * np.maximum(room - there, 0.0)[:, None] * side
        angle = np.linspace(0.0, np.pi, 2 * reach + 1)[:, None]
        arc = ring[i] + radius * (np.cos(angle) * side + (np.sin(angle) - 1) * along)
        cut = round(radius / step)
        parts += [moved[begin : i - cut], arc]  # later cusps may move these points, too
        begin = i + cut + 1
    result = np.vstack([*parts, moved[begin:]])
    if not closed:
        return result
    first = int(np.linalg.norm(result - points[0], axis=1).argmin())
    result = np.roll(result, -first, axis=0)
    return np.vstack([result, result[:1]])


def _turns(ring: Array, closed: bool, reach: int) -> tuple[Array, Array]:
    """Cosine of the turn at each point, between points some steps away, and where it points to."""
    places, count = np.arange(len(ring)), len(ring)
    back, ahead = (
        ring[(places + k) % count if closed else np.clip(places + k, 0, count - 1)] - ring
        for k in (-reach, reach)
    )
    lengths = np.linalg.norm(back, axis=1) * np.linalg.norm(ahead, axis=1)
    cosine = -(back * ahead).sum(axis=1) / np.maximum(lengths, 1e-30)
    if not closed:
        cosine[:reach] = cosine[-reach:] = 1.0
    return cosine, -(back + ahead)


def _cusps(cosine: Array, outward: Array, reach: int) -> list[int]:
    """Places of the cusps, which stand out most among their neighbours."""
    heights = np.where(cosine < CUSP, np.linalg.norm(outward, axis=1), 0.0)
    found = list[int]()
    for i in np.flatnonzero(heights).tolist():
        highest = heights[i] >= heights[max(i - reach, 0) : i + reach + 1].max()
        if highest and (not found or i - found[-1] > 2 * reach):
            found.append(i)
    return found


def _joined(strokes: list[Array], closed: bool, returns: bool, size: float) -> Line:
    """Strokes with links between them, and one from the last to the first if it `returns`."""
    parts, pens = [strokes[0]], [np.ones(len(strokes[0]), dtype=bool)]
    for before, after in pairwise(strokes):
        link = _link(before, after, size)
        parts += [link, after]
        pens += [np.zeros(len(link), dtype=bool), np.ones(len(after), dtype=bool)]
    if returns:
        link = _link(strokes[-1], strokes[0], size)
        parts += [link, strokes[0][:1]]
        pens += [np.zeros(len(link), dtype=bool), np.ones(1, dtype=bool)]
    return Line(np.vstack(parts), np.concatenate(pens), closed or returns)


def _link(before: Array, after: Array, size: float) -> Array:
    """Points from the end of one line to the beginning of another one, without those two.

    It is the quickest way that leaves and arrives along the lines, of two arcs of equal radius and
    the straight line between them.

    Source: L. E. Dubins, American Journal of Mathematics 79 (1957).
    """
    a, b = np.array(complex(*before[-1])), np.array(complex(*after[0]))
    leaving, arriving = _direction(before[-4:]), _direction(after[:4])
    ways = [
        (float(time), radius, way, turns[:, way], straights[way], alongs[way])
        for radius in _link_radii(size)
        for turns, straights, alongs in [_arcs(a, leaving, b, arriving, radius)]
        for way, time in enumerate(_link_times(turns, straights, radius))
    ]
    _, radius, way, (begin, end), straight, along = min(ways, key=lambda each: each[0])
    first, last = _SENSES[:, way]
    c, d = a + 1j * first * radius * leaving, b + 1j * last * radius * arriving
    turn = np.arange(0.0, begin, STEP / radius)
    back = np.arange(0.0, end, STEP / radius)
    parts = (
        c - 1j * first * radius * leaving * np.exp(1j * first * turn),
        c - 1j * first * radius * along + along * np.arange(0.0, straight, STEP),
        d - 1j * last * radius * along * np.exp(1j * last * back),
    )
    points: Places = np.concatenate(parts)[1:]
    return np.stack([points.real, points.imag], axis=-1)


def _link_radii(size: float) -> tuple[float, ...]:
    """Of the arcs of a link; a small one turns back to a near stroke without a loop."""
    return *LINK_RADII, max(LINK_RADII[-1], 0.04 * size)


def _arcs(
    a: Places, leaving: Places, b: Places, arriving: Places, radius: float
) -> tuple[Array, Array, Places]:
    """The links from a to b, by the senses of their arcs, see `_SENSES`.

    Args:
        a, leaving, b, arriving: both places [m] and the directions there, of equal shapes.
        radius: of the arcs, [m].

    Returns:
        The angles of both arcs, (2, 4, ...), [rad]; the lengths of the straight lines between
        them, (4, ...), [m], infinite where there is no such link; and their directions, (4, ...).
    """
    first, last = _SENSES.reshape(2, 4, *(1,) * a.ndim)
    between = b + 1j * last * radius * arriving - a - 1j * first * radius * leaving
    apart = radius * (last - first)
    squared = np.abs(between) ** 2 - apart**2
    possible = (squared >= 0) & (between != 0)
    straight: Array = np.sqrt(np.where(possible, squared, 0.0))
    ways: Places = np.where(possible, between, 1.0).astype(np.complex128)
    ways /= np.where(possible, straight + 1j * apart, 1.0)
    along: Places = ways / np.abs(ways)
    length: Array = np.where(possible, straight, np.inf)
    begin = first * np.angle(along / leaving) % PERIOD
    end = last * np.angle(arriving / along) % PERIOD
    return np.stack([begin, end]), length, along


def _link_times(turns: Array, straights: Array, radius: float) -> Array:
    """About the times of links, as in `_times`, (4, ...), [s]; see `_arcs`."""
    gain, most = TURNING * HASTE**2, HASTE * QUICK
    slow = min(SWING * radius, HASTE * (TURNING * radius) ** 0.5, most)
    fast = np.minimum(np.sqrt(slow**2 + gain * straights), most)
    even = straights - (fast**2 - slow**2) / gain
    return turns.sum(axis=0) * radius / slow + 2 * (fast - slow) / gain + even / fast


def _quickest(size: float) -> Duration:
    """The time of the quickest link between places of a drawing of a size, for `ordered`."""

    def duration(a: Places, leaving: Places, b: Places, arriving: Places) -> Array:
        times = [
            _link_times(*_arcs(a, leaving, b, arriving, radius)[:2], radius).min(axis=0)
            for radius in _link_radii(size)
        ]
        return np.min(times, axis=0)

    return duration


def _direction(points: Array) -> Places:
    along = complex(*(points[-1] - points[0]))
    direction: Places = np.array(along / abs(along))
    return direction


def _times(line: Line, bends: Array) -> Array:
    """Time at which each point of a line is passed, shape (n,), [s].

    The speed is at most `QUICK`, the acceleration in bends and along the line `TURNING`, and the
    tangent turns by at most `SWING`. With the pen up, speed and acceleration are `HASTE` and
    `HASTE`² times as large.

    Args:
        bends: curvature at the points, not negative, shape (n,), [1/m].
    """
    haste = np.where(line.pen, 1.0, HASTE)
    steps = np.maximum(np.linalg.norm(np.diff(line.points, axis=0), axis=1), 1e-9)
    bends = np.maximum(bends, 1e-9)
    speed = np.minimum(haste * np.sqrt(TURNING / bends), SWING / bends)
    speed = np.clip(speed, SLOW * QUICK, haste * QUICK)
    if not line.closed:
        speed[[0, -1]] = np.minimum(speed[[0, -1]], AT_ENDS * QUICK)
    squared, gain = speed**2, 2 * TURNING * haste[1:] ** 2 * steps
    for _ in range(2 if line.closed else 1):  # the second pass knows what comes over the seam
        if line.closed:
            squared[[0, -1]] = squared[[0, -1]].min()
        squared = _reachable(_reachable(squared, gain)[::-1], gain[::-1])[::-1]
    slowness = _eased(1 / np.sqrt(squared), steps, line.closed)
    return np.concatenate([[0.0], np.cumsum(steps * (slowness[1:] + slowness[:-1]) / 2)])


def _bends(line: Line) -> Array:
    """Mean curvature around each point, over `EASING` to both sides, [1/m].

    Over less, a circle of straight lines would have sharp bends.
    """
    along = np.diff(line.points, axis=0)
    angle = np.unwrap(np.arctan2(along[:, 1], along[:, 0]))
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(along, axis=1))])
    middle = (s[1:] + s[:-1]) / 2
    if line.closed:
        turn = angle[-1] - angle[0]
        turn += float(np.angle(np.exp(1j * (angle[0] - angle[-1]))))
        middle = np.concatenate([middle - s[-1], middle, middle + s[-1]])
        angle = np.concatenate([angle - turn, angle, angle + turn])
    ahead, back = (np.interp(s + d, middle, angle) for d in (EASING, -EASING))
    return np.abs(ahead - back) / (2 * EASING)


def _reachable(squared: Array, gain: Array) -> Array:
    """v² that bounded acceleration reaches from the left, if each step may add `gain` to it."""
    reserve = np.concatenate([[0.0], np.cumsum(gain)])
    return np.minimum.accumulate(squared - reserve) + reserve


def _eased(slowness: Array, steps: Array, closed: bool) -> Array:
    """1/v, smoothed along the line: bends are passed no quicker than before."""
    from scipy.ndimage import gaussian_filter1d, maximum_filter1d

    width = EASING / float(np.median(steps))
    mode = "wrap" if closed else "nearest"
    high = maximum_filter1d(slowness, 2 * int(width) + 1, mode=mode)
    return np.asarray(gaussian_filter1d(high, width, mode=mode), dtype=float)


def _fitted(line: Line, close: float) -> tuple[SplineCurve, float]:
    """A line as a path of as many pieces as are needed to be `close` to it, and how close it is.

    Both are in [m]; with `MOST_PIECES` it may be farther away.

    The bends of a first fit decide on the speed of the second one.
    """
    time = _times(line, _bends(line))
    first, _ = _in_pieces(line, time, close)
    theta = -np.pi + PERIOD * time / time[-1]
    return _in_pieces(line, _times(line, np.abs(first.curvature(theta))), close)


def _in_pieces(line: Line, time: Array, close: float) -> tuple[SplineCurve, float]:
    """The path of a line that is passed at given times, and how far it is from it, [m]."""
    pieces = FIRST_PIECES
    while True:
        at: Array = np.linspace(0.0, float(time[-1]), DENSITY * pieces + 1)
        z = np.stack([np.interp(at, time, line.points[:, i]) for i in (0, 1)], axis=-1)
        points, there = _least_squares(z, pieces, line.closed)
        raised, duration = _raised(line.pen, time), round(float(time[-1]), DECIMALS)
        curve = SplineCurve(line.closed, grained(points), raised=raised, duration=duration)
        down = np.interp(at, time, line.pen.astype(float)) > 0.5
        off = float(np.abs(there - z)[down].max())
        if pieces == MOST_PIECES or (off < close and _sharpest(curve) < 1 / LEAST_RADIUS):
            return curve, off
        pieces = min(3 * pieces // 2, MOST_PIECES)


def _sharpest(curve: SplineCurve) -> float:
    """The largest curvature, [1/m]."""
    return float(np.abs(curve.curvature(curve.sample(2 * curve.grid))).max())


def _least_squares(z: Array, pieces: int, closed: bool) -> tuple[Array, Array]:
    """Control points of the spline nearest to points at even times, and its points there."""
    from scipy.interpolate import BSpline
    from scipy.sparse import csc_array, diags_array
    from scipy.sparse.linalg import spsolve

    x = np.linspace(0.0, pieces, len(z))
    knots = np.arange(-DEGREE, pieces + DEGREE + 1, dtype=float)
    design: Any = csc_array(BSpline.design_matrix(x, knots, DEGREE))
    count = pieces + DEGREE
    third: Any = csc_array(
        diags_array([-1.0, 3.0, -3.0, 1.0], offsets=[0, 1, 2, 3], shape=(count - 3, count))
    )
    if closed:
        wrap: Any = csc_array(
            (np.ones(count), (np.arange(count), np.arange(count) % pieces)), shape=(count, pieces)
        )
        design, third = design @ wrap, third @ wrap
    weights = np.ones(len(z))
    weights[[0, -1]] = 1.0 if closed else 100.0  # an open path begins and ends where it should
    weighted = diags_array(weights) @ design
    normal = design.T @ weighted + STIFFNESS * DENSITY * (third.T @ third)
    points = np.asarray(spsolve(csc_array(normal), weighted.T @ z), dtype=float)
    there = np.asarray(design @ points, dtype=float)
    return (np.vstack([points, points[:DEGREE]]) if closed else points), there


def _raised(pen: Array, time: Array) -> tuple[tuple[float, float], ...]:
    """The stretches of θ where the pen is up, [rad]."""
    edges = np.flatnonzero(np.diff(pen.astype(int)))
    theta = -np.pi + PERIOD * time / time[-1]
    return tuple(
        (round(float(theta[begin]), DECIMALS), round(float(theta[end + 1]), DECIMALS))
        for begin, end in zip(edges[::2], edges[1::2], strict=True)
    )


def compared(curve: SplineCurve, lines: Sequence[Array]) -> SplineCurve:
    """The curve with the drawing that it was given, and its deviation from it.

    Args:
        lines: straight between their points, shape (n, 2) each, [m].
    """
    from scipy.spatial import KDTree

    dense = np.vstack([_even(line)[0] for line in lines])
    count = min(int(2 * float(curve.arc(np.array(np.pi))) / STEP), MOST_SEEN)
    theta = curve.sample(max(4 * curve.grid, count))
    seen = curve.at(theta[curve.draws(theta)])
    distances = KDTree(dense).query(seen)[0], KDTree(seen).query(dense)[0]
    thin = sum(len(line) for line in lines) // DENSE + 1
    gap = np.full((1, 2), np.nan)
    given = np.vstack([part for line in lines for part in (gap, line[::thin])][1:])
    return replace(curve, deviation=float(np.concatenate(distances).max()), given=given)
