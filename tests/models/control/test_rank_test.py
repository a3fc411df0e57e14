"""The rank test falls to zero where, and only where, the linkage collapses."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.control.rank_test import rank_map, rank_number
from onpath.models.systems.catalogue import FIVE_BAR
from onpath.models.systems.five_bar_robot import rigid_five_bar
from onpath.models.systems.system import conditioning

ROBOT, DEFAULTS = rigid_five_bar(), FIVE_BAR.parameters()


@pytest.mark.parametrize("angle", [0.3, 1.1, 2.4])
def test_zero_exactly_where_the_links_are_collinear(angle: float) -> None:
    for turns in (0.0, np.pi):
        collapsed = np.array([angle, angle + turns])
        assert rank_number(ROBOT, DEFAULTS, collapsed) < 1e-12
        assert rank_number(ROBOT, DEFAULTS, collapsed + [0.0, 0.2]) > 0.02


def test_map_is_positive_inside_and_falls_to_zero_at_the_rim() -> None:
    base = np.array([-0.2, -0.2])  # the base pivot in output coordinates
    direction = np.array([np.cos(0.9), np.sin(0.9)])
    radii = np.array([0.05, 0.15, 0.28, 0.35, 0.39, 0.3999, 0.41])
    values = rank_map(ROBOT, DEFAULTS, base + radii[:, None] * direction)
    assert np.isnan(values[-1])
    assert np.all(values[:-1] > 0)
    assert np.all(np.diff(values[2:-1]) < 0)
    assert values[-2] < 0.05 * values[2]


def test_number_does_not_depend_on_units() -> None:
    matrix = np.array([[3.0, 1.0], [0.5, 0.2]])
    assert np.isclose(conditioning(matrix), conditioning(1e3 * matrix), rtol=1e-12)
    assert 0 < conditioning(matrix) < conditioning(np.eye(2)) == 1
    assert conditioning(np.zeros((2, 2))) == 0
