"""The order and direction in which the strokes of a drawing are drawn, for quick raised links.

A stroke is drawn in one of several ways: forwards or backwards, and a ring also from other places.
The order is that of the nearest neighbours, improved by 2-opt: a part of it is turned round, with
each of its strokes, as long as that saves time. From one way of a stroke to one of another, a link
takes as long as from the other one, turned round, to the first one, turned round.

Source: G. A. Croes, A method for solving traveling-salesman problems, Operations Research 6 (1958).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from onpath.models.arrays import Array

MOST_STROKES = 100  # that are put in order; the pieces of a curve suffice for fewer
BEGINS = 4  # places from which a ring may be drawn
STARTS = 12  # ways with which an order begins, of which the best one is taken
ROUNDS = 20  # of improvements, at most
GAIN = 1e-9  # [s], least saving
Places = NDArray[np.complex128]
Duration = Callable[[Places, Places, Places, Places], Array]
"""(from where, in which direction, to where, in which direction) -> the time of a link, [s]."""


def ordered(strokes: Sequence[Array], returns: bool, duration: Duration) -> list[Array]:
    """The strokes in an order with quick links; as they are if they are too many.

    Args:
        strokes: shape (n, 2) each, without points that coincide; a ring ends as it begins.
        returns: whether a link leads from the last one to the first one.
        duration: of links, for arrays of equal shapes.
    """
    if not 1 < len(strokes) <= MOST_STROKES:
        return [*strokes]
    choices = [_ways(stroke) for stroke in strokes]
    ways = [way for each in choices for way in each]
    owner = np.repeat(np.arange(len(strokes)), [len(each) for each in choices])
    times = _times(ways, duration)
    if not returns:  # a stroke of no length anywhere, with which the order begins and ends
        times = np.pad(times, (0, 2))
        owner = np.append(owner, [len(strokes)] * 2)
    none = [] if returns else [len(ways)]
    tours = [_improved(times, owner, [*none, way]) for way in range(min(len(ways), STARTS))]
    tour = min(tours, key=lambda each: times[each, np.roll(each, -1)].sum())
    return [ways[way] for way in tour.tolist() if way < len(ways)]


def _ways(stroke: Array) -> list[Array]:
    """The ways in which a stroke may be drawn, each followed by the same one turned round."""
    found = [stroke]
    if np.array_equal(stroke[0], stroke[-1]):
        ring = stroke[:-1]
        begins = sorted({len(ring) * k // BEGINS for k in range(BEGINS)})
        found = [np.vstack([ring[k:], ring[: k + 1]]) for k in begins]
    return [way for each in found for way in (each, each[::-1])]


def _times(ways: Sequence[Array], duration: Duration) -> Array:
    """The time of a link from the end of each way to the beginning of each other one, [s]."""
    begin, second, before, end = (_places([way[k] for way in ways]) for k in (0, 1, -2, -1))
    arriving: Places = (second - begin) / np.abs(second - begin)
    leaving: Places = (end - before) / np.abs(end - before)
    times = np.empty((len(ways), len(ways)))
    for i, row in enumerate(times):  # all at once would take much memory
        here: Places = np.repeat(end[i : i + 1], len(ways))
        way: Places = np.repeat(leaving[i : i + 1], len(ways))
        row[:] = duration(here, way, begin, arriving)
    return times


def _places(points: list[Array]) -> Places:
    found: Places = np.array([complex(*point) for point in points])
    return found


def _improved(times: Array, owner: NDArray[np.int_], first: list[int]) -> NDArray[np.int_]:
    """A way of each stroke: the first ones, then always the nearest one, improved."""
    found, left = [*first], ~np.isin(owner, owner[first])
    while left.any():
        found.append(int(np.where(left, times[found[-1]], np.inf).argmin()))
        left &= owner != owner[found[-1]]
    tour = np.array(found)
    for _ in range(ROUNDS):
        if not (_turned(times, tour) | _redrawn(times, owner, tour)):
            break
    return tour


def _turned(times: Array, tour: NDArray[np.int_]) -> bool:
    """Turn round the part of the order from each stroke on that saves most; whether any did."""
    better = False
    for i in range(1, len(tour) - 1):
        after = np.append(tour[i + 1 :], tour[0])
        old = times[tour[i - 1], tour[i]] + times[tour[i:], after]
        saved = old - times[tour[i - 1], tour[i:] ^ 1] - times[tour[i] ^ 1, after]
        j = int(saved.argmax())
        if saved[j] > GAIN:
            tour[i : i + j + 1] = tour[i : i + j + 1][::-1] ^ 1
            better = True
    return better


def _redrawn(times: Array, owner: NDArray[np.int_], tour: NDArray[np.int_]) -> bool:
    """Draw each stroke in the way that saves most; whether any did."""
    better = False
    for i in range(len(tour)):
        before, after = tour[i - 1], tour[(i + 1) % len(tour)]
        own = np.flatnonzero(owner == owner[tour[i]])
        taken = times[before, own] + times[own, after]
        k = int(taken.argmin())
        if times[before, tour[i]] + times[tour[i], after] - taken[k] > GAIN:
            tour[i] = own[k]
            better = True
    return better
