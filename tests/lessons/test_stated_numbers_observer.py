"""Lesson 6: a filter and an observer, with the right model and with one that is too light."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import onpath
from onpath.app.notebook.run import Run

pytestmark = pytest.mark.thorough
LIGHT = {"error_M11": -40.0, "error_M22": -40.0}


def run(**settings: Any) -> Run:
    measured: dict[str, Any] = {"encoder_counts": 2000.0}
    return onpath.simulate(duration=8.0, K3=0.0, **measured | settings)


def largest(found: Run) -> float:
    """The largest distance from 2 s on, [mm]."""
    return 1e3 * float(np.ravel(found.distance)[np.ravel(found.t) > 2].max())


def offset(found: Run) -> float:
    """The mean distance across from 2 s on, [mm]."""
    return 1e3 * float(found.xi[np.ravel(found.t) > 2].mean())


@pytest.mark.parametrize(
    ("settings", "stated"),
    [
        ({"observer_time": 0.0}, 1.5),
        ({"observer_time": 0.0, **LIGHT}, 3.6),
        ({}, 0.1),
        (LIGHT, 6.2),
        ({"encoder_counts": 0.0, **LIGHT}, 4.6),
    ],
)
def test_the_largest_distances(settings: dict[str, float], stated: float) -> None:
    assert round(largest(run(**settings)), 1) == stated


def test_the_delay_of_the_filter_costs_a_millimetre_and_a_quarter_of_it_at_half_the_speed() -> None:
    fast, slow = (offset(run(observer_time=0.0, speed=speed)) for speed in (2 * np.pi, np.pi))
    assert fast == pytest.approx(1.0, abs=0.15)
    assert slow == pytest.approx(fast / 4, abs=0.08)
