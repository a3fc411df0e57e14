"""What an exported page computes is what the lab computes."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.page_functions import _fault, stop_reasons
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import FASTEST_JOINT

STATES = 1500
MISSING = (np.nan, np.inf, -np.inf)


def states(n: int) -> Array:
    """Random q and v, shape (STATES, 2, n): small and large, too fast, and not finite."""
    rng = np.random.default_rng(n)
    found = rng.uniform(-np.pi, np.pi, (STATES, 2, n))
    found *= 10.0 ** rng.integers(-3, 1, (STATES, 2, n))
    found[rng.random((STATES, 2, n)) < 0.02] = FASTEST_JOINT * 1.1
    for value in MISSING:
        found[rng.random((STATES, 2, n)) < 0.005] = value
    return found


@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_a_page_stops_every_robot_when_the_lab_does_and_says_the_same(name: str) -> None:
    entry = ROBOTS[name]
    robot, parameters = entry.make(entry.parameters()), entry.parameters()
    law = "velocity_field"  # commands torques, of which nothing is foreseen
    fault, seen = _fault(robot), set[int]()
    for q, v in states(robot.system.n):
        found = robot.fault(q[None], v[None], parameters)
        number = int(fault(q, v, 0.0))
        reasons = stop_reasons(robot, parameters, q if np.isfinite(q).all() else None, law)
        assert bool(number) == (found is not None)
        if found is not None and np.isfinite(q).all():
            assert reasons[number - 1] == found[1]
        seen.add(number)
    assert seen == set(range(len(stop_reasons(robot, parameters, None, law))))
