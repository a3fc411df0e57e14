"""The speed that the bends of a drawing allow."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.closed_loop.loop_vectors import loop_layouts
from onpath.models.closed_loop.reference_speed import kept_speed
from onpath.models.closed_loop.simulation import FREE, kind_of, settings_vector
from onpath.models.control.bend_limit import speed_on
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS
from tests.support.drawings import scrawl


@settings(max_examples=10)
@given(
    st.integers(0, 2**32),
    st.sampled_from([1000.0, 250.0, 100.0]),
    st.floats(0, 1600),
    st.floats(-20, 20),
)
def test_the_tangent_of_a_drawing_turns_slowly_enough(
    seed: int, rate: float, k1: float, speed: float
) -> None:
    parameters = replace(ROBOTS["five_bar"].parameters(), control_rate=rate, K1=k1, speed=speed)
    curve = scrawl(seed)
    slowed, wanted = speed_on(parameters, curve), speed / curve.duration
    assert slowed == wanted or (abs(slowed) < abs(wanted) and slowed * wanted > 0)
    theta = np.random.default_rng(seed).uniform(-np.pi, np.pi, 500)
    tangent = np.arctan2(*curve.at(theta, 1).T)
    ahead = np.arctan2(*curve.at(theta + 1e-7, 1).T)
    turn = np.abs((ahead - tangent + np.pi) % (2 * np.pi) - np.pi) / 1e-7 * abs(slowed)
    most = min(0.15 * rate, 2 * np.sqrt(k1) if k1 > 0 else np.inf)
    assert turn.max() <= 1.1 * most + 1e-3
    assert speed_on(parameters, circle(0.001)) == speed  # a series keeps its speed
    robot = ROBOTS["five_bar"].make(parameters)
    layouts = loop_layouts(robot.system, kind_of("path_following", parameters, curve))
    settings = layouts.settings.unpack(settings_vector(robot, layouts, parameters, curve, FREE))
    named = {name: ca.SX(ca.DM(value)) for name, value in settings.items()}
    assert float(ca.evalf(kept_speed(named))) == pytest.approx(slowed, rel=1e-12)  # in a loop
