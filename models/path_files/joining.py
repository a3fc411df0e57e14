"""Joins lines that touch: many programs write a line in pieces, each a path of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from onpath.models.arrays import Array
from onpath.models.path_files.stroke import Stroke

TOUCHING = 1e-3  # of the drawing's size, largest distance of ends that are joined
SPECK = 2e-3  # of the drawing's size, of lines that are too small to be seen
ROUNDED = 7  # decimals of equal coordinates, [m]
End = tuple[int, bool]
"""Number of a piece, and whether its last point is meant."""


@dataclass(frozen=True, slots=True, eq=False)
class Joined:
    """Lines whose pieces are joined.

    Attributes:
        strokes: the lines.
        repeats: number of pieces that are drawn only once, though the file repeats them, as the
            passes of a tool.
        specks: number of lines that are left out, because they are too small to be seen.
    """

    strokes: list[Stroke]
    repeats: int = 0
    specks: int = 0


def joined(strokes: Sequence[Stroke]) -> Joined:
    """The lines of pieces that touch.

    A piece that begins where the one before it in the file ended is joined to it. Of the other
    ends, two that meet are joined where no third one does; the later piece may be turned for it. A
    line whose own ends meet is closed. Its place in the order and its name are those of its
    earliest piece.

    Args:
        strokes: straight between their points.
    """
    low = np.min([each.points.min(0) for each in strokes], axis=0)
    high = np.max([each.points.max(0) for each in strokes], axis=0)
    with np.errstate(all="ignore"):
        size = float((high - low).max())
    if not 0 < size < np.inf:
        return Joined([*strokes])
    different = _different(strokes)
    repeats, strokes = len(strokes) - len(different), different
    reach = TOUCHING * size
    partner = _partners(strokes, reach)
    lines, done = list[Stroke](), set[int]()
    for i in range(len(strokes)):
        if i not in done:
            chain = _chain(i, partner)
            done.update(piece for piece, _ in chain)
            lines.append(_together(strokes, i, chain, reach))
    seen = [each for each in lines if np.ptp(each.points, axis=0).max() >= SPECK * size]
    return Joined(seen, repeats, len(lines) - len(seen)) if seen else Joined(lines, repeats)


def _different(strokes: Sequence[Stroke]) -> list[Stroke]:
    """The lines without those that repeat an earlier one, in either direction."""
    found = dict[bytes, Stroke]()
    for stroke in strokes:
        with np.errstate(all="ignore"):
            rounded = stroke.points.round(ROUNDED) + 0.0
        ways = rounded.tobytes(), rounded[::-1].tobytes()
        found.setdefault(min(ways), stroke)
    return list(found.values())


def _partners(strokes: Sequence[Stroke], reach: float) -> dict[End, End]:
    """For each end that is joined, the other one."""
    open_ = [not _is_ring(each, reach) for each in strokes]
    partner = dict[End, End]()
    for i, (a, b) in enumerate(pairwise(strokes)):
        if open_[i] and open_[i + 1] and np.linalg.norm(a.points[-1] - b.points[0]) <= reach:
            partner |= {(i, True): (i + 1, False), (i + 1, False): (i, True)}
    free = [
        (i, last)
        for i in range(len(strokes))
        for last in (False, True)
        if open_[i] and (i, last) not in partner
    ]
    for a, b in _pairs([strokes[i].points[-1 if last else 0] for i, last in free], reach):
        if free[a][0] != free[b][0]:
            partner |= {free[a]: free[b], free[b]: free[a]}
    return partner


def _pairs(points: list[Array], reach: float) -> list[tuple[int, int]]:
    """Points that meet where no third one does."""
    from scipy.spatial import cKDTree

    if len(points) < 2:
        return []
    tree = cKDTree(np.array(points))
    count: Any = tree.query_ball_point(tree.data, reach, return_length=True)
    nearest: Any = tree.query(tree.data, k=2)[1]
    pairs = list[tuple[int, int]]()
    for a in np.flatnonzero(count == 2).tolist():
        b = int(nearest[a].sum()) - a
        if a < b and count[b] == 2:
            pairs.append((a, b))
    return pairs


def _is_ring(stroke: Stroke, reach: float) -> bool:
    """Whether its own ends meet."""
    gap = float(np.linalg.norm(stroke.points[0] - stroke.points[-1]))
    return bool(stroke.closed) or (gap <= reach and stroke.length > 4 * reach)


def _chain(piece: int, partner: dict[End, End]) -> list[End]:
    """The pieces of a line in order, and whether each is followed from its beginning on."""
    begin = (piece, True)
    while (before := partner.get((begin[0], not begin[1]))) is not None:
        begin = before
        if begin[0] == piece:  # a ring
            break
    chain, at = [begin], begin
    while (after := partner.get(at)) is not None and after[0] != begin[0]:
        at = (after[0], not after[1])
        chain.append(at)
    return chain


def _together(strokes: Sequence[Stroke], first: int, chain: list[End], reach: float) -> Stroke:
    """One line of the pieces of a chain."""
    parts = [strokes[i].points if ahead else strokes[i].points[::-1] for i, ahead in chain]
    points = np.vstack([parts[0], *(part[1:] for part in parts[1:])])
    line = replace(strokes[first], points=points, closed=False)
    if not _is_ring(replace(line, closed=strokes[first].closed and len(chain) == 1), reach):
        return line
    return replace(line, points=np.vstack([points[:-1], points[:1]]), closed=True)
