"""The effective mass is a force by the acceleration that it makes, in the force's direction."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.control.effective_mass import effective_masses
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import RobotEntry


@given(
    st.sampled_from(list(ROBOTS.values())),
    st.floats(-0.03, 0.03),
    st.floats(-0.03, 0.03),
    st.floats(0.0, 6.28),
)
def test_it_is_force_by_acceleration(entry: RobotEntry, x: float, y: float, angle: float) -> None:
    robot, parameters = entry.make(entry.parameters()), entry.parameters()
    way, frame, system = np.array([np.cos(angle), np.sin(angle)]), robot.frame, robot.system
    q = robot.rest(frame.lift(np.array([x, y])))
    lifted = frame.lift(way) - frame.lift(np.zeros(2))
    jacobian = ca.jacobian(system.output, system.q)
    force = ca.SX(lifted)
    change = ca.substitute(system.acceleration, system.tau, system.tau + jacobian.T @ force)
    added = jacobian @ (change - system.acceleration)
    inputs = [system.q, system.v, system.tau, system.parameters]
    at_rest = q, np.zeros(system.n), np.zeros(system.n), robot.plant(parameters)
    acceleration = ca.Function("added", inputs, [added])(*at_rest).full()[:, 0]
    (mass,) = effective_masses(robot, q, parameters, way[None])
    assert mass > 0
    assert mass * (lifted @ acceleration) == pytest.approx(1.0, rel=1e-6)
