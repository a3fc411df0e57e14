"""The quick check that a five-bar has had no fault never overlooks one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.five_bar_robot import SHORT, rigid_five_bar

ROBOT, TICKS = rigid_five_bar(), 16
HOME = ROBOT.rest(np.zeros(2))
Number = st.one_of(st.floats(-4, 4), st.floats(-150, 150), st.just(np.nan), st.just(np.inf))


def runs(*ends: tuple[np.ndarray, np.ndarray], ticks: int = TICKS) -> tuple[np.ndarray, np.ndarray]:
    """Joint angles and velocities of runs that rest at home until their last tick."""
    q, v = np.tile(HOME, (len(ends), ticks, 1)), np.zeros((len(ends), ticks, 2))
    for i, (angle, rate) in enumerate(ends):
        q[i, -1], v[i, -1] = angle, rate
    return q, v


@given(st.lists(st.tuples(*[Number] * 4), min_size=1, max_size=4))
def test_calm_runs_end_without_a_fault(ends: list[tuple[float, float, float, float]]) -> None:
    q, v = runs(*[(np.array(end[:2]), np.array(end[2:])) for end in ends])
    with np.errstate(invalid="ignore"):
        calm = ROBOT.is_calm(q, v)
    for each in zip(q, v, strict=True):
        assert not calm or ROBOT.fault(*each, FiveBarParameters()) is None


def test_one_run_that_is_not_calm_is_enough() -> None:
    still = np.zeros(2)
    assert ROBOT.is_calm(*runs((HOME, still), (HOME, still)))
    for angle, rate in (
        (HOME, np.array([30.0, 0.0])),
        (np.array([0.3, 0.1]), still),
        (np.array([np.nan, 0.1]), still),
        (HOME, np.array([0.0, np.nan])),
    ):
        assert not ROBOT.is_calm(*runs((HOME, still), (angle, rate)))


@pytest.mark.parametrize(("ticks", "calm"), [(SHORT, True), (SHORT + 1, False)])
def test_a_long_run_is_not_judged_by_its_end(ticks: int, calm: bool) -> None:
    assert ROBOT.is_calm(*runs((HOME, np.zeros(2)), ticks=ticks)) == calm
