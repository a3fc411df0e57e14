"""A bend, a crossing and a cusp are found wherever they are in a long drawing, and only there."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.paths.curve_faults import Fault, ambiguities, curve_faults
from onpath.models.paths.path_checks import LEAST_RADIUS
from onpath.models.paths.spline_curves import DEGREE, SplineCurve

PIECES = 400
LENGTH = 1.0  # [m]
PLACES = st.floats(0.1, 0.9)  # shares of a drawing


def everywhere(z: Array) -> Array:
    """A workspace without borders."""
    return np.ones(len(z))


def along_the_line(shape: Array, share: float) -> SplineCurve:
    """A straight drawing of 400 pieces; a shape of control points replaces some in the middle."""
    x = np.linspace(0.0, LENGTH, PIECES + DEGREE)
    line = np.stack([x, 0 * x], axis=-1)
    at = int(share * PIECES)
    shape = shape + line[at]
    rest = line[at:] + shape[-1] - line[at]
    return SplineCurve(False, np.vstack([line[:at], shape, rest])[: PIECES + DEGREE])


def checks(faults: list[Fault]) -> list[str]:
    """Their names."""
    return [fault.check for fault in faults]


def near(fault: Fault, curve: SplineCurve, share: float) -> bool:
    """Whether it is within ten pieces of the planted shape, and nowhere else."""
    begin, end = (-np.pi + 2 * np.pi * (share + each) for each in (-0.05, 0.08))
    there = curve.at(np.linspace(begin, end, 400))
    low, high = there.min(0), there.max(0)
    return bool(((fault.points >= low - 1e-3) & (fault.points <= high + 1e-3)).all())


def turn(radius: float, degrees: float) -> Array:
    """Control points of an arc to the left, [m]."""
    angle = np.deg2rad(np.linspace(0.0, degrees, 12))
    return radius * np.stack([np.sin(angle), 1 - np.cos(angle)], axis=-1)


@settings(max_examples=20)
@given(PLACES)
def test_a_straight_drawing_has_no_faults(share: float) -> None:
    curve = along_the_line(np.zeros((1, 2)), share)
    assert curve_faults(everywhere, curve) == [] == ambiguities(curve)


@settings(max_examples=20)
@given(PLACES, st.floats(0.2, 0.8))
def test_a_bend_that_is_too_sharp_is_found_where_it_is(share: float, part: float) -> None:
    curve = along_the_line(turn(part * LEAST_RADIUS, 90.0), share)
    (fault,) = curve_faults(everywhere, curve)
    assert fault.check == "bends_sharply" and near(fault, curve, share)


@settings(max_examples=20)
@given(PLACES, st.floats(1.5, 8.0))
def test_a_bend_that_can_be_followed_is_no_fault(share: float, part: float) -> None:
    curve = along_the_line(turn(part * LEAST_RADIUS, 60.0), share)
    theta = curve.sample(64 * curve.pieces)
    sharp = bool((np.abs(curve.curvature(theta)) > 1.02 / LEAST_RADIUS).any())
    assert checks(curve_faults(everywhere, curve)) == ["bends_sharply"] * sharp


@settings(max_examples=20)
@given(PLACES)
def test_a_cusp_is_found(share: float) -> None:
    curve = along_the_line(np.zeros((10, 2)), share)  # it stops there
    assert "cusp" in checks(curve_faults(everywhere, curve))


@settings(max_examples=20)
@given(PLACES, st.floats(1e-3, 0.03))
def test_a_crossing_is_found_where_it_is(share: float, radius: float) -> None:
    curve = along_the_line(turn(radius, 360.0), share)
    (fault,) = ambiguities(curve)
    assert fault.check == "crosses" and near(fault, curve, share)


@settings(max_examples=20)
@given(PLACES, st.floats(1e-3, 0.03))
def test_where_the_pen_is_up_nothing_bends_or_crosses(share: float, radius: float) -> None:
    curve = along_the_line(turn(radius, 360.0), share)
    low, high = -np.pi + 2 * np.pi * (share + np.array([-0.05, 0.08]))
    curve = SplineCurve(False, curve.points, raised=((float(low), float(high)),))
    assert ambiguities(curve) == [] == curve_faults(everywhere, curve)


def test_outside_of_the_workspace_is_a_fault_also_with_the_pen_up() -> None:
    curve = SplineCurve(False, along_the_line(np.zeros((1, 2)), 0.5).points, raised=((0.0, 1.0),))
    (fault,) = curve_faults(lambda z: np.where(abs(z[:, 0] - 0.6) < 0.01, -1.0, 1.0), curve)
    assert fault.check == "outside" and len(fault.points) > 5
