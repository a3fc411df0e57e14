"""The tube's widths against the global search for the closest point."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.paths.curve_faults import ambiguities
from onpath.models.paths.curves import Curve, circle, ellipse, nearest, segment
from onpath.models.paths.path_checks import TUBE
from onpath.models.paths.path_design import presets
from onpath.models.paths.space_curves import saddle
from onpath.models.paths.tube import curve_frames, offset, tube_width
from tests.support.drawings import star

CURVES = {name: design.curve for name, design in presets().items()}
PROPER = {name: curve for name, curve in CURVES.items() if not ambiguities(curve)}
RISING = {f"rising {name}": saddle(curve, 0.03) for name, curve in PROPER.items()}
TUBES = PROPER | RISING | {"star": star()}


def nearest_in(curve: Curve, points: Array) -> tuple[Array, Array]:
    """θ and distance of the closest points, also beyond the ends of an open curve."""
    count = 2 * curve.grid
    if curve.closed:
        grid = curve.sample(count)
    else:
        grid = np.linspace(-1.5 * np.pi, 1.5 * np.pi, count + 1)
    return nearest(curve.at, grid, points)


def test_of_a_circle_it_is_the_radius_and_of_a_line_nothing_bounds_it() -> None:
    assert tube_width(circle(0.05)) == pytest.approx(0.05, rel=1e-12)
    assert tube_width(segment((0.0, 0.0), (0.1, 0.05))) == np.inf


def test_of_an_ellipse_it_is_the_radius_at_its_sharper_ends() -> None:
    assert tube_width(ellipse((0.07, 0.04))) == pytest.approx(0.04**2 / 0.07, rel=1e-6)


@pytest.mark.parametrize("curve", TUBES.values(), ids=TUBES)
def test_within_it_the_closest_point_is_where_one_came_from(curve: Curve) -> None:
    width = min(tube_width(curve), 0.1)
    inner = np.linspace(-0.9, 0.9, 61) * np.pi
    frames, rng = curve_frames(curve, inner), np.random.default_rng(3)
    turn = rng.uniform(-np.pi, np.pi, len(inner))
    way = np.column_stack([np.cos(turn), np.sin(turn)]) if curve.dimension == 3 else turn[:, None]
    for share in (0.5, 0.97):
        xi = share * width * (way if curve.dimension == 3 else np.sign(way))
        theta, distance = nearest_in(curve, offset(frames, xi))
        assert np.allclose(distance, share * width, atol=1e-9)
        assert np.abs((theta - inner + np.pi) % (2 * np.pi) - np.pi).max() < 1e-3


def test_a_path_that_crosses_itself_has_none() -> None:
    assert tube_width(presets()["figure of eight"].curve) == 0.0


def test_an_admitted_path_has_the_tube_that_its_check_asks_for() -> None:
    for name, curve in CURVES.items():
        assert (tube_width(curve) >= 0.98 * TUBE) == (name in PROPER), name
