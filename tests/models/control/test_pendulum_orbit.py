"""The orbit of the cart's pendulum: it is a motion, it attracts, and the law stays on it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import onpath
from onpath.models.arrays import Array
from onpath.models.control.laws.law import PLAN
from onpath.models.control.pendulum_orbit import ORDER, Pendulum, orbit_plan
from onpath.models.systems.cart_pendulum import LENGTH
from onpath.models.systems.system import GRAVITY

MASS, SIDES = 0.1, {"hanging": 1.0, "upright": -1.0}
TOP = (0.0, 0.05)


def pendulum(side: str, friction: float = 0.001) -> Pendulum:
    return Pendulum(SIDES[side] * MASS * LENGTH / 2, MASS * LENGTH**2 / 3, friction)


def energy(own: Pendulum, phi: Array, rate: Array) -> Array:
    inertia = own.inertia + own.moment * own.reach * np.cos(phi) ** 2
    return inertia * rate**2 / 2 + GRAVITY * own.moment * (1 - np.cos(phi))


def gains_at(own: Pendulum, plan: Array, phi: float, rate: float) -> Array:
    """k1, k2, k3 and e_r."""
    psi = np.arctan2(-rate / own.rate, phi)
    waves = np.arange(1, ORDER + 1) * psi
    return plan.reshape(4, -1) @ np.concatenate([[1.0], np.cos(waves), np.sin(waves)])


def lap(own: Pendulum, plan: Array, swing: float, driven: bool = True) -> tuple[float, Array]:
    """Period, and the matrix of a lap of the linearized (I, e - e_r, e' - e_r'), by scipy."""

    def slope(_: float, state: Array) -> Array:
        phi, rate = state[:2]
        k = gains_at(own, plan, phi, rate)[:3]
        if not driven:
            k[0] = 0
        pull = -own.moment * np.cos(phi) * rate
        moved = state[2:].reshape(3, 3)
        w = -k @ moved
        change = np.array([pull * w, moved[2], w])
        return np.concatenate([own.slope(state[:2]), change.ravel()])

    def down(_: float, state: Array) -> float:
        return float(state[0])

    begin = np.concatenate([[swing, 0.0], np.eye(3).ravel()])
    found = solve_ivp(slope, (0, 5), begin, events=down, rtol=1e-9, atol=1e-12)
    assert found.t_events is not None
    period = 4 * float(found.t_events[0][0])
    return period, solve_ivp(slope, (0, period), begin, rtol=1e-9).y[2:, -1].reshape(3, 3)


@pytest.mark.thorough
@settings(max_examples=10, deadline=None)
@given(st.sampled_from(sorted(SIDES)), st.floats(0.02, 0.3))
def test_a_lap_shrinks_what_is_off_the_orbit(side: str, swing: float) -> None:
    own = pendulum(side)
    plan = orbit_plan(own, swing)
    multipliers = np.abs(np.linalg.eigvals(lap(own, plan, swing)[1]))
    assert multipliers.max() < 0.6
    without = np.abs(np.linalg.eigvals(lap(own, plan, swing, driven=False)[1]))
    assert without.max() == pytest.approx(1, abs=1e-4)  # the constraint alone has no orbit


@pytest.mark.parametrize(
    ("side", "period", "largest"), [("upright", 0.82, 0.05), ("hanging", 1.32, 0.21)]
)
def test_period_and_multipliers_are_those_that_are_told(
    side: str, period: float, largest: float
) -> None:
    own = pendulum(side)
    found, matrix = lap(own, orbit_plan(own, 0.1), 0.1)
    multipliers = np.sort(np.abs(np.linalg.eigvals(matrix)))
    assert found == pytest.approx(period, abs=0.005)
    assert multipliers[-1] == pytest.approx(largest, abs=0.01) and multipliers[1] < 1e-4


@pytest.mark.parametrize("side", SIDES)
def test_with_friction_the_constraint_moves_as_its_plan_says(side: str) -> None:
    """Without w, e_r obeys e_r'' = -p φ' / (S cos φ), and φ moves as without friction."""
    own, frictionless = pendulum(side, 0.002), pendulum(side, 0.0)
    plan, swing = orbit_plan(own, 0.2), 0.2
    step, state = 1e-3, np.array([swing, 0.0])
    drift = list[float]()
    for _ in range(1500):
        drift.append(float(gains_at(own, plan, *state)[3]))
        middle = state + step / 2 * own.slope(state)
        state = state + step * own.slope(middle)
    assert np.abs(drift).max() > 1e-3
    rates = np.gradient(np.array(drift), step)
    state, wanted = np.array([swing, 0.0]), list[float]()
    for _ in range(1500):
        wanted.append(-own.friction / own.moment * float(np.arctanh(np.sin(state[0]))))
        middle = state + step / 2 * own.slope(state)
        state = state + step * own.slope(middle)
    assert np.abs(rates - wanted)[5:-5].max() < 0.02 * np.abs(wanted).max()
    assert not orbit_plan(frictionless, swing).reshape(4, -1)[3].any()


@pytest.mark.thorough
@pytest.mark.parametrize(("pivot", "near"), [(0.0, 1e-3), (0.001, 1e-3), (0.01, 1e-2)])
@pytest.mark.parametrize(("side", "settled"), [("upright", 3.0), ("hanging", 9.0)])
def test_the_cart_finds_its_orbit_and_keeps_it(
    side: str, settled: float, pivot: float, near: float
) -> None:
    """For 8 s within 0.1 % of its energy; with ten times the pivot's usual friction, within 1 %."""
    run = onpath.simulate(
        "cart_pendulum",
        law="orbital_stabilization",
        pendulum=side,
        pivot=pivot,
        start=TOP,
        duration=settled + 8,
    )
    q, v = run.trajectory.fields["q"], run.trajectory.fields["v"]
    own = pendulum(side, pivot)
    share = energy(own, q[:, 2], v[:, 2]) / (GRAVITY * own.moment * (1 - np.cos(0.1)))
    assert run.stopped_at is None and run.max_distance < 1e-4
    assert np.abs(share[round(1000 * settled) :] - 1).max() < near


@pytest.mark.thorough
def test_the_amplitude_is_the_one_that_is_set() -> None:
    for swing in (0.05, 0.12):
        run = onpath.simulate(
            "cart_pendulum",
            law="orbital_stabilization",
            pendulum="upright",
            start=TOP,
            duration=6,
            orbit_swing=swing,
        )
        reached = np.abs(run.trajectory.fields["q"][-2000:, 2]).max()
        assert reached == pytest.approx(swing, rel=1e-3)


def test_the_numbers_of_the_plan_fit() -> None:
    assert len(orbit_plan(pendulum("upright"), 0.1)) <= PLAN
