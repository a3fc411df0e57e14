"""The nearest path that a robot can follow to one that it cannot.

It is looked for among smoothed, scaled and moved versions of the curve. With the centre c of its
points, a version is

    c' + s (σ_τ(θ) - c),   c' = (1 - u) c,

where σ_τ has its k-th coefficients multiplied by exp(-τ (k² - 1)), which is the flow of heat along
the curve without its first harmonic; an open curve keeps its ends. The versions are tried from the
nearest one on. The part of the way to it that is needed is then found by bisection. A drawing,
whose corners are rounded anyway, is only scaled and moved, and fitted anew: its bends, too, would
become smaller.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product

import numpy as np

from onpath.models.arrays import Array
from onpath.models.paths.curve_faults import FINER, curve_faults
from onpath.models.paths.curve_fit import with_deviation
from onpath.models.paths.curves import HARMONICS, PERIOD, Curve, SeriesCurve, from_terms
from onpath.models.paths.path_checks import LEAST_MARGIN, TUBE
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.paths.spline_fit import compared, spline_through

SMOOTHINGS = (0.0, 0.001, 0.003, 0.006, 0.01, 0.02, 0.04, 0.08, 0.15, 0.4, 1.0)  # τ
SCALES = np.append(np.linspace(0.1, 1.0, 19), [1.15, 1.3, 1.5, 1.75, 2.0, 2.5, 3.0])  # s
SHIFTS = (0.0, 0.15, 0.3, 0.5, 0.7, 0.85, 1.0)  # u; at 1 the centre is the robot's home
BISECTIONS = 6
MOST_FITS = 5  # of a drawing
SAMPLES = 30  # points at which versions are compared
CHECKED = 240  # points at which their curvature is checked
SLACK = 1.001  # of the quick checks, which sample other points


def nearest_path(reach: Callable[[Array], Array], curve: Curve) -> Curve | None:
    """The nearest version of a plane curve that a robot can follow; None if there is none.

    Its `deviation` is from the points that the curve was fitted to, or else from the curve; that of
    a drawing is an upper bound.

    Args:
        reach: the robot's `Robot.margin`, shape (n, 2) -> (n,).
        curve: with finite coefficients.
    """
    if isinstance(curve, SplineCurve):
        return _nearest_drawing(reach, curve)
    assert isinstance(curve, SeriesCurve)
    theta = np.linspace(-np.pi, np.pi, SAMPLES)
    start, smoothed = curve.at(theta), [_smoothed(curve, tau) for tau in SMOOTHINGS]
    centre = start.mean(axis=0)
    curves = [from_terms(curve.closed, terms) for terms in smoothed]
    outlines = [each.at(theta) for each in curves]
    bends = [float(np.abs(each.curvature(each.sample(CHECKED))).max()) for each in curves]
    ways = [
        (i, scale, shift)
        for i, scale, shift in product(range(len(SMOOTHINGS)), SCALES.tolist(), SHIFTS)
    ]
    moves = [(1 - shift - scale) * centre for _, scale, shift in ways]
    apart = [
        float(np.abs(scale * outlines[i] + move - start).max())
        for (i, scale, _), move in zip(ways, moves, strict=True)
    ]
    for k in sorted(range(len(ways)), key=lambda k: apart[k]):
        i, scale, _ = ways[k]
        if bends[i] > SLACK * scale / TUBE:
            continue  # before the slower checks
        if not reach(scale * outlines[i] + moves[k]).min() >= LEAST_MARGIN / SLACK:
            continue
        terms = scale * smoothed[i]
        terms[0] += moves[k]
        if not curve_faults(reach, from_terms(curve.closed, terms)):
            found = _part_of_the_way(reach, curve, terms)
            line = curve.at(np.linspace(-np.pi, np.pi, 512)) if curve.given is None else curve.given
            line = line[:-1] if curve.closed else line
            return replace(with_deviation(found, line), given=curve.given)
    return None


def _nearest_drawing(reach: Callable[[Array], Array], curve: SplineCurve) -> SplineCurve | None:
    """The nearest drawing of another size or at another place; see `nearest_path`."""
    z = curve.at(curve.sample())
    centre, ways = z.mean(axis=0), [*product(SCALES.tolist(), SHIFTS)]
    moves = [(1 - shift - scale) * centre for scale, shift in ways]
    apart = [
        float(np.abs(scale * z + move - z).max())
        for (scale, _), move in zip(ways, moves, strict=True)
    ]
    least, tried = SLACK * LEAST_MARGIN, 0
    for k in sorted(range(len(ways)), key=lambda k: apart[k]):
        growth, move, low, high = ways[k][0] - 1, moves[k], 0.0, 1.0
        if not reach(z + growth * z + move).min() >= least:
            continue
        for _ in range(BISECTIONS):
            middle = (low + high) / 2
            is_within = reach(z + middle * (growth * z + move)).min() >= least
            low, high = (low, middle) if is_within else (middle, high)
        lines = _drawn_lines(curve)
        moved = [line + high * (growth * line + move) for line in lines]
        returns = curve.closed and bool(curve.raised)
        found = spline_through(moved, curve.closed and not returns, repeated=returns)
        if not curve_faults(reach, found):
            far = curve.deviation + compared(found, lines).deviation
            return replace(found, deviation=far, given=curve.given)
        if (tried := tried + 1) == MOST_FITS:
            break
    return None


def _drawn_lines(curve: SplineCurve) -> list[Array]:
    """Points close to each other on each of the strokes, shape (n, 2) each, [m]."""
    ends = [-np.pi, *(end for link in curve.raised for end in link), np.pi]
    count = FINER * curve.grid
    return [
        curve.at(np.linspace(begin, end, max(2, round(count * (end - begin) / PERIOD))))
        for begin, end in zip(ends[::2], ends[1::2], strict=True)
        if end > begin  # after the way back there is no stroke
    ]


def _smoothed(curve: SeriesCurve, tau: float) -> Array:
    """The coefficients of σ_τ, as those of `Curve.terms`."""
    order = np.arange(1.0, HARMONICS + 1)
    factor = np.exp(-tau * (order**2 - 1))
    weights = np.concatenate([[1.0], factor, factor] if curve.closed else [[1.0], factor])
    terms = curve.terms() * weights[:, None]
    if not curve.closed:
        ends = np.array([-np.pi, np.pi])
        left, right = curve.at(ends) - from_terms(False, terms).at(ends)
        terms[0] += (left + right) / 2
        terms[1] += (right - left) / 2
    return terms


def _part_of_the_way(
    reach: Callable[[Array], Array], curve: SeriesCurve, terms: Array
) -> SeriesCurve:
    """The curve nearest to the first one on the way to a version that can be followed."""
    begin, low, high = curve.terms(), 0.0, 1.0
    for _ in range(BISECTIONS):
        middle = (low + high) / 2
        tried = from_terms(curve.closed, (1 - middle) * begin + middle * terms)
        low, high = (middle, high) if curve_faults(reach, tried) else (low, middle)
    return from_terms(curve.closed, (1 - high) * begin + high * terms)
