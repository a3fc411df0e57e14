"""The hovercraft: where its rank test fails, and what its heading does, by hand.

By hand are m (x, z)'' = (u1 + u2) e - c (x, z)' and J φ'' = w (u1 - u2), and what follows from
them for a pen at the distance d in front of the centre of mass.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import onpath
from onpath.models.arrays import Array
from onpath.models.control.forecast import SINGULAR, forecast, growth_rate, zero_dynamics_at
from onpath.models.control.rank_test import rank_number
from onpath.models.systems.hovercraft import (
    ASIDE,
    GYRATION,
    MASS,
    PLACES,
    HovercraftParameters,
    hovercraft,
)

OFF = ["front", "behind"]
numbers = st.floats(-2, 2)
drags = st.floats(0, 2)


def parameters(pen: str, drag: float = 0.0) -> HovercraftParameters:
    return HovercraftParameters(pen=pen, drag=drag)


def sideways(phi: float) -> Array:
    return np.array([-math.sin(phi), math.cos(phi)])


@given(st.sampled_from([*PLACES]), numbers, numbers, st.floats(-4, 4))
def test_the_decoupling_matrix_has_the_determinant_of_the_docstring(
    pen: str, x: float, z: float, phi: float
) -> None:
    robot, q = hovercraft(pen), np.array([x, z, phi])
    system = robot.system
    p = robot.model(parameters(pen))
    jacobian = np.array([[1, 0, -PLACES[pen] * math.sin(phi)], [0, 1, PLACES[pen] * math.cos(phi)]])
    gain = np.array(system.function("input_gain")(q, np.zeros(3), p))
    found = abs(np.linalg.det(jacobian @ gain))
    wanted = 2 * ASIDE * abs(PLACES[pen]) / (MASS * MASS * GYRATION**2)
    assert found == pytest.approx(wanted, rel=1e-9, abs=1e-9)
    is_singular = rank_number(robot, parameters(pen), q, by_model=True) < 1e-9
    assert is_singular == (pen == "centre")


@pytest.mark.parametrize("pen", PLACES)
def test_condition_11_fails_at_the_centre_of_mass_alone(pen: str) -> None:
    robot, p = hovercraft(pen), parameters(pen)
    found = forecast(robot, "path_following", p, robot.rest(np.zeros(2)))
    assert found == (SINGULAR if pen == "centre" else None)


@given(st.sampled_from(OFF), drags, st.tuples(*[numbers] * 5))
def test_the_heading_obeys_the_equation_by_hand(
    pen: str, drag: float, drawn: tuple[float, ...]
) -> None:
    """φ'' = (y'' + (c/m) y') · n / d at φ' = 0, in every state; without drag, (a/d) sin(ψ - φ)."""
    phi, *rest = drawn
    rate, acceleration = np.array(rest[:2]), np.array(rest[2:])
    robot, p = hovercraft(pen), parameters(pen, drag)
    q = np.array([0.0, 0.0, phi])
    zero = zero_dynamics_at(robot, p, q)
    found = float(zero.acceleration(q, rate, acceleration, robot.model(p)))
    d, damping = PLACES[pen], drag / MASS
    assert found == pytest.approx((acceleration + damping * rate) @ sideways(phi) / d, abs=1e-9)
    if not drag:
        a, psi = np.hypot(*acceleration), math.atan2(acceleration[1], acceleration[0])
        assert found == pytest.approx(a / d * math.sin(psi - phi), abs=1e-9)


@given(st.sampled_from(OFF), drags, numbers)
def test_at_rest_every_heading_is_an_equilibrium(pen: str, drag: float, phi: float) -> None:
    robot, p = hovercraft(pen), parameters(pen, drag)
    q = np.array([0.0, 0.0, phi])
    exponents = zero_dynamics_at(robot, p, q).exponents(q, robot.model(p))[0]
    assert np.sort(exponents.real) == pytest.approx([-drag / MASS, 0.0], abs=1e-6)
    assert growth_rate(robot, p, q) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("pen", OFF)
@pytest.mark.parametrize("drag", [0.0, 0.5])
def test_on_the_circle_the_heading_swings_as_the_equation_says(pen: str, drag: float) -> None:
    """The equation alone, for the steady circle, against the closed loop from 3 s on."""
    run = onpath.simulate("hovercraft", "circle", duration=9.0, pen=pen, drag=drag)
    robot, d, damping = hovercraft(pen), PLACES[pen], drag / MASS
    late = run.t >= 3.0
    t, q, v = run.t[late], run.q[late], run.v[late]
    tip = robot.endpoint(q)
    centre, radius = (tip.max(0) + tip.min(0)) / 2, np.ptp(tip[:, 0]) / 2
    place = np.unwrap(np.arctan2(*(tip - centre).T[::-1]))
    pace = (place[-1] - place[0]) / (t[-1] - t[0])

    def rates(time: float, state: Array) -> list[float]:
        phi, rate = state
        at = place[0] + pace * (time - t[0])
        outward, along = np.array([math.cos(at), math.sin(at)]), sideways(at)
        pushed = -(pace**2) * radius * outward + damping * pace * radius * along
        return [rate, float(pushed @ sideways(phi)) / d - damping * rate]

    start = [q[0, 2], v[0, 2]]
    by_hand = solve_ivp(rates, (t[0], t[-1]), start, t_eval=t, rtol=1e-9, atol=1e-9).y[0]
    assert np.ptp(by_hand - pace * t) > 0.1  # it swings about the direction that turns
    assert np.abs(by_hand - q[:, 2]).max() < 0.02


@pytest.mark.parametrize("pen", OFF)
def test_with_drag_nose_or_tail_end_in_the_direction_of_the_thrust(pen: str) -> None:
    """The steady turn: φ'' = 0 and φ' = the rate of turning, so the nose lags behind the thrust."""
    run = onpath.simulate("hovercraft", "circle", duration=30.0, pen=pen, drag=0.5)
    robot, damping = hovercraft(pen), 0.5 / MASS
    tip = robot.endpoint(run.q)
    outward = (tip - (tip.max(0) + tip.min(0)) / 2)[-1]
    pace = 2.0
    pushed = -(pace**2) * outward + damping * pace * np.array([-outward[1], outward[0]])
    lead = float(pushed @ sideways(run.q[-1, 2])) / PLACES[pen]
    assert lead == pytest.approx(damping * pace, abs=0.02)
    facing = float(pushed @ np.array([math.cos(run.q[-1, 2]), math.sin(run.q[-1, 2])]))
    assert facing * PLACES[pen] > 0
