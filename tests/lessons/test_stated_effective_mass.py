"""What lessons 3 and 5 say of the ellipse of the effective mass on the circle."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.control.effective_mass import effective_masses
from onpath.models.systems.catalogue import FIVE_BAR

pytestmark = pytest.mark.thorough

BASE = np.array([-0.2, -0.2])  # the pivot, in the path's plane, [m]
RADIUS = 0.05  # [m]
ROBOT = FIVE_BAR.make(FIVE_BAR.parameters())
WAYS = np.array([[np.cos(a), np.sin(a)] for a in np.radians(np.arange(0, 180, 1))])


def masses(degrees: float) -> np.ndarray:
    """Effective mass at a place of the circle in each of the directions, [kg]."""
    place = RADIUS * np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    q = ROBOT.rest(ROBOT.frame.lift(place))
    return effective_masses(ROBOT, q, FIVE_BAR.parameters(), WAYS)


def test_the_ellipse_is_longest_at_the_upper_right_within_20_degrees_of_outwards() -> None:
    places = np.arange(-180, 180, 5)
    largest = [masses(float(degrees)).max() for degrees in places]
    where = places[int(np.argmax(largest))]
    assert 30 <= where <= 60
    way = WAYS[int(np.argmax(masses(float(where))))]
    place = RADIUS * np.array([np.cos(np.radians(where)), np.sin(np.radians(where))])
    outwards = (place - BASE) / np.linalg.norm(place - BASE)
    assert abs(way @ outwards) > np.cos(np.radians(20))


def test_at_36_degrees_below_it_is_heavier_sideways_than_up_and_down() -> None:
    mass = masses(-36.0)
    assert mass[0] == pytest.approx(0.57, abs=0.005)
    assert mass[90] == pytest.approx(0.30, abs=0.005)
