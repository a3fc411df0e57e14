"""At the end of its travel a slide comes to its buffer and stands there; a run goes on."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.closed_loop.faults import fault_in
from onpath.models.closed_loop.simulation import FREE, Push, kind_of, settings_vector
from onpath.models.paths.curves import circle
from onpath.models.paths.distance import path_distance
from onpath.models.systems.cart_pendulum import TRAVEL
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.slides import BUFFER, DEPTH, buffers
from tests.support.pulls import begin_at, first_state, loop_of, parameters_of, pushed

LAW, HANDS = "path_following", 12
SLIDE, RATE = ca.SX.sym("slide"), ca.SX.sym("rate")
FORCE = ca.Function("force", [SLIDE, RATE], [buffers(SLIDE, RATE, TRAVEL)])


@given(st.floats(-TRAVEL - DEPTH, TRAVEL + DEPTH), st.floats(-5, 5))
def test_a_buffer_only_pushes_inwards_and_not_before_it_is_touched(x: float, rate: float) -> None:
    force, depth = float(FORCE(x, rate)), abs(x) - TRAVEL
    if depth <= 0:
        assert force == 0
    else:
        pressed = BUFFER.stiffness * depth + BUFFER.damping * np.sign(x) * rate
        wanted = min(max(pressed, 0), BUFFER.largest)
        assert force == pytest.approx(-np.sign(x) * wanted, rel=1e-9, abs=1e-9)


def test_a_cart_pulled_over_the_ends_of_its_rail_stands_there_and_comes_back() -> None:
    """By hands as far away as the lab lets them be."""
    parameters, curve = parameters_of("cart_pendulum"), circle(0.05)
    robot = ROBOTS["cart_pendulum"].make(parameters)
    loop = loop_of(robot, kind_of(LAW, parameters, curve))
    layouts, rng = loop.layouts, np.random.default_rng(3)
    free = settings_vector(robot, layouts, parameters, curve, FREE)
    begins = [begin_at(robot, curve, theta) for theta in rng.uniform(-3, 3, HANDS)]
    states = np.array([first_state(robot, layouts, curve, begin) for begin in begins])
    way = rng.uniform(0, 2 * np.pi, HANDS)
    targets = robot.reach * np.column_stack([np.cos(way), np.sin(way)])
    hands = [pushed(layouts, free, Push(robot.frame.lift(target))) for target in targets]
    for settings in (hands, [free] * HANDS):
        states, rows = loop.run_many(states, settings, [curve.table()] * HANDS, 2500)
        for own in rows:
            assert fault_in(robot, layouts.log, LAW, own, parameters) is None
        log = layouts.log.unpack(rows)
        slides = np.abs(log["q"][..., :2]).max(axis=-1)
        assert slides.max() < TRAVEL + DEPTH
        last = slides[:, -1] - TRAVEL
        if settings is hands:  # all stand still, many of them at a buffer
            assert (last > 0).sum() >= HANDS // 3 and last.max() < 0.2 * DEPTH
            assert np.abs(log["v"][:, -1, :2]).max() < 0.05
    ends = log["y"][:, -500:].reshape(-1, robot.system.p)
    assert path_distance(robot.frame, curve, ends).max() < 5e-3
