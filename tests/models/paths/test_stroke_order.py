"""Strokes in an order with quick links are the same strokes, and the pen is up for less time."""

from __future__ import annotations

from itertools import pairwise, permutations, product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.paths.spline_fit import MOST_RAISED, raised_share, spline_through
from onpath.models.paths.stroke_order import Places, ordered

SEEDS = st.integers(0, 2**32 - 1)
TURN = np.linspace(0, 2 * np.pi, 25)[:-1]


def duration(a: Places, leaving: Places, b: Places, arriving: Places) -> Array:
    """Of a link with a turn at each end; as long from b to a, both turned round."""
    way = b - a + 1e-9
    turns = np.abs(np.angle(way / leaving)) + np.abs(np.angle(arriving / way))
    return np.abs(way) + 0.03 * turns


def drawing(seed: int, count: int, ring: bool) -> list[Array]:
    """Curved strokes at random places, and perhaps a circle."""
    rng, t = np.random.default_rng(seed), np.linspace(0, 1, 24)[:, None]
    begin, middle, end = rng.uniform(-0.06, 0.06, (3, count, 1, 2))
    found = [*((1 - t) ** 2 * begin + 2 * t * (1 - t) * middle + t**2 * end)]
    if ring:
        around = rng.uniform(0.005, 0.02) * np.column_stack([np.cos(TURN), np.sin(TURN)])
        around += rng.uniform(-0.05, 0.05, 2)
        found.insert(int(rng.integers(count)), np.vstack([around, around[:1]]))
    return found


def links(lines: list[Array], returns: bool) -> float:
    """The time of all links, [s]."""
    time = 0.0
    for before, after in pairwise([*lines, *lines[:1]] if returns else lines):
        c, a, b, d = (complex(*each) for each in (*before[-2:], *after[:2]))
        sides = a, (a - c) / abs(a - c), b, (d - b) / abs(d - b)
        time += float(duration(*map(np.array, sides)))
    return time


def points_of(line: Array) -> list[tuple[float, ...]]:
    """The points of a stroke, whichever way it is drawn."""
    ring = np.array_equal(line[0], line[-1])
    return sorted(map(tuple, line[:-1] if ring else line))


@given(SEEDS, st.integers(1, 12), st.booleans(), st.booleans())
def test_every_stroke_is_drawn_once_and_links_take_no_longer(
    seed: int, count: int, ring: bool, returns: bool
) -> None:
    lines = drawing(seed, count, ring)
    found = ordered(lines, returns, duration)
    assert sorted(map(points_of, found)) == sorted(map(points_of, lines))
    ends = [line[[0, -1]].tolist() for line in found if not np.array_equal(line[0], line[-1])]
    drawn = [line[[0, -1]].tolist() for line in lines if not np.array_equal(line[0], line[-1])]
    assert all(each in drawn or each[::-1] in drawn for each in ends)
    assert links(found, returns) <= links(lines, returns) * (1 + 1e-9)


@settings(max_examples=15)
@given(SEEDS, st.booleans())
def test_a_few_strokes_are_drawn_nearly_in_the_best_order(seed: int, returns: bool) -> None:
    lines = drawing(seed, 4, ring=False)
    best = min(
        links([each[::way] for each, way in zip(order, ways, strict=True)], returns)
        for order in permutations(lines)
        for ways in product((1, -1), repeat=4)
    )
    assert links(ordered(lines, returns, duration), returns) <= 1.05 * best


@settings(max_examples=5)
@given(SEEDS, st.integers(2, 6), st.booleans())
def test_the_pen_is_up_as_long_in_whatever_order_a_file_has_the_strokes(
    seed: int, count: int, ring: bool
) -> None:
    lines, rng = drawing(seed, count, ring), np.random.default_rng(seed)
    mixed = [lines[i][:: rng.choice((1, -1))] for i in rng.permutation(len(lines))]
    one, other = (raised_share(spline_through(each)) for each in (lines, mixed))
    assert one <= max(MOST_RAISED, 1.25 * other) and other <= max(MOST_RAISED, 1.25 * one)
