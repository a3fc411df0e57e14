"""Laws of the flexible five-bar: mechanics checked against the moving points of the beam."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
import pytest
from scipy.linalg import eigh

from onpath.models.arrays import Array
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.flexible_five_bar import (
    HOME,
    PLANTS,
    RIGID,
    flexible_five_bar,
)
from onpath.models.systems.flexible_links import load_links
from onpath.models.systems.flexible_robot import flexible_five_bar_robot
from onpath.models.systems.system import (
    MechanicalSystem,
    conditioning,
    decoupling_matrix,
    lagrange_bias,
)
from tests.support.finite_elements import beam_of_elements, rigidity

LINKS = load_links()
BEAM = beam_modes(3, LINKS.beam)
SEEDS = range(8)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(60)
STATIONS, SHARES = LINKS.beam * (NODES + 1) / 2, LINKS.beam * WEIGHTS / 2  # of the beam
LOSSLESS = {"b1": 0.0, "b2": 0.0, "b3": 0.0, "zeta": 0.0}


@lru_cache
def robot(modes: int = 3, plant: str = "lagrangian") -> MechanicalSystem:
    return flexible_five_bar(modes, plant)


def numbers(alpha: float = 1.0, **changes: float) -> Array:
    return robot().parameter_vector(LINKS.lumped(alpha) | changes)


def poses(seed: int, modes: int = 3) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    size = np.concatenate([np.ones(RIGID), 0.03 / np.arange(1, modes + 1) ** 2])
    q, v = size * rng.normal(size=(2, RIGID + modes))
    return q + np.concatenate([HOME, np.zeros(modes)]), 3 * v


def points(q: Array, s: Array) -> tuple[Array, Array]:
    """Where the beam's points are, (k, 3), and their distance from the waist's axis, (k,)."""
    reach = LINKS.link1 * np.cos(q[0]) - s * np.cos(q[1])
    w = beam_modes(q.size - RIGID, LINKS.beam).shapes(s) @ q[RIGID:]
    height = LINKS.link1 * np.sin(q[0]) - s * np.sin(q[1])
    ahead, aside = np.array([np.cos(q[2]), np.sin(q[2])]), np.array([-np.sin(q[2]), np.cos(q[2])])
    return np.column_stack([np.outer(reach, ahead) + np.outer(w, aside), height]), reach


def kinetic_energy(q: Array, v: Array) -> float:
    """Of the linkage, balanced, and of the beam's horizontal motion, by finite differences.

    M11 and M22 hold what the beam's points move in the linkage's own plane.
    """
    h = 1e-6
    (ahead, reach_ahead), (behind, reach_behind) = (points(q + k * v, STATIONS) for k in (h, -h))
    across = ((ahead - behind)[:, :2] ** 2).sum(1) - (reach_ahead - reach_behind) ** 2
    beam = LINKS.rho * SHARES @ across / (2 * h) ** 2
    waist = LINKS.J0 + LINKS.J1 * np.cos(q[0]) ** 2
    return float(LINKS.M11 * v[0] ** 2 + LINKS.M22 * v[1] ** 2 + waist * v[2] ** 2 + beam) / 2


@pytest.mark.parametrize("modes", [1, 3, 6])
def test_mass_matrix_is_that_of_the_moving_points(modes: int) -> None:
    mass = robot(modes).function("mass")
    units = np.eye(RIGID + modes)
    for seed in SEEDS:
        q, v = poses(seed, modes)
        single = np.array([kinetic_energy(q, e) for e in units])
        sums = units[:, None] + units
        pairs = np.array([[kinetic_energy(q, both) for both in row] for row in sums])
        expected = pairs - single - single[:, None]
        np.fill_diagonal(expected, 2 * single)
        found = mass(q, v, numbers()).full()
        assert np.array_equal(found, found.T) and np.linalg.eigvalsh(found)[0] > 1e-3
        assert np.abs(found - expected).max() < 1e-7


def test_energy_is_kinetic_and_that_of_bending() -> None:
    energy, modes = robot().function("energy"), beam_modes(3, LINKS.beam)
    stiffness = rigidity(LINKS.frequency, LINKS.beam, LINKS.rho)
    for seed in SEEDS:
        q, v = poses(seed)
        h = 1e-4
        bent = modes.shapes(STATIONS + h) - 2 * modes.shapes(STATIONS) + modes.shapes(STATIONS - h)
        bending = stiffness / 2 * SHARES @ (bent @ q[RIGID:] / h**2) ** 2
        assert float(energy(q, 0 * v, numbers())) == pytest.approx(bending, rel=1e-5)
        assert float(energy(q, v, numbers())) == pytest.approx(
            bending + kinetic_energy(q, v), rel=1e-5
        )


@pytest.mark.parametrize("modes", [1, 3, 6])
def test_bias_is_lagrange_s(modes: int) -> None:
    s = robot(modes)
    value = dict(zip(s.parameter_names, ca.vertsplit(s.parameters), strict=True))
    potential = ca.substitute(s.energy, s.v, ca.SX.zeros(s.n))
    overtones = ca.DM(beam_modes(modes, LINKS.beam).overtones)
    damping = 2 * value["zeta"] * value["rho"] * value["omega1"] * overtones
    friction = ca.vertcat(value["b1"], value["b2"], value["b3"], damping) * s.v
    derived = lagrange_bias(s.q, s.v, s.energy - potential, potential, friction)
    both = ca.Function("both", [s.q, s.v, s.parameters], [derived, s.bias])
    for seed in SEEDS:
        expected, found = (part.full() for part in both(*poses(seed, modes), numbers()))
        assert np.abs(found - expected).max() < 1e-10 * np.abs(expected).max()


@pytest.mark.parametrize("plant", PLANTS)
@pytest.mark.parametrize("modes", [1, 3, 6])
def test_acceleration_solves_the_equation_of_motion(plant: str, modes: int) -> None:
    s = robot(modes, plant)
    acceleration = ca.Function("a", [s.q, s.v, s.tau, s.parameters], [s.acceleration])
    parts = s.function("mass", "bias", "drift", "input_gain")
    for seed in SEEDS:
        q, v = poses(seed, modes)
        tau = np.random.default_rng(seed).normal(size=s.n)
        mass, bias, drift, gain = parts(q, v, numbers())
        a = acceleration(q, v, tau, numbers())
        scale = np.abs(bias.full()).max()
        assert np.abs((mass @ a + bias - tau).full()).max() < 1e-12 * (1 + scale)
        u = np.concatenate([tau[:RIGID], np.zeros(modes)])
        by_parts = drift + gain @ tau[:RIGID] - acceleration(q, v, u, numbers())
        assert np.abs(by_parts.full()).max() < 1e-9 * (1 + scale)


# Equations (20)-(21) in the normalisations of the modes -------------------------------------------

FRICTIONLESS = {"b1": 0.0, "b2": 0.0, "b3": 0.0}  # (20) has no friction in the joints


def printed(q: Array, v: Array, rho: float, norm: float) -> tuple[Array, Array]:
    """f_v and g_v letter for letter, with shapes scaled so that the integral of phi_j^2 is `norm`.

    q and v have the modal coordinates of the integral 1, and so have the results. Psi and J are
    quadratures, Omega is the beam's elastic and damping force.
    """
    modes, scale = beam_modes(3, LINKS.beam), np.sqrt(norm)
    omega = 2 * np.pi * LINKS.frequency * modes.overtones
    f, f_rate, reach = q[RIGID:] / scale, v[RIGID:] / scale, points(q, STATIONS)[1]
    psi = scale * (SHARES * reach) @ modes.shapes(STATIONS)
    force = rho * (omega**2 * f + 2 * LINKS.zeta * omega * f_rate)
    inertia = LINKS.J0 + LINKS.J1 * np.cos(q[0]) ** 2 + rho * SHARES @ reach**2
    waist = inertia - (rho * psi) @ (rho * psi) / (rho * norm)  # over the modal mass
    drift = np.concatenate([[0, 0, psi @ force / waist], -force / rho])
    drift[RIGID:] -= rho * psi * (psi @ force) / waist
    gain = np.zeros((RIGID + 3, RIGID))
    gain[0, 0], gain[1, 1], gain[2, 2] = 1 / LINKS.M11, 1 / LINKS.M22, 1 / waist
    gain[RIGID:, 2] = -rho * psi / waist
    back = np.concatenate([np.ones(RIGID), np.full(3, scale)])
    return back * drift, back[:, None] * gain


@pytest.mark.parametrize("rho", [0.2, 0.4])
def test_read_with_unit_modes_the_printed_equations_are_that_plant(rho: float) -> None:
    parts = robot(3, "unit_modes").function("drift", "input_gain")
    for seed in SEEDS:
        q, v = poses(seed)
        drift, gain = (part.full() for part in parts(q, v, numbers(rho=rho)))
        expected, expected_gain = printed(q, v, rho, norm=1.0)
        assert drift.ravel() == pytest.approx(expected, rel=1e-9, abs=1e-9)
        assert gain == pytest.approx(expected_gain, rel=1e-9, abs=1e-12)


def to_first_order(rho: float, seed: int, norm: float | None) -> tuple[Array, Array]:
    """d f_v / d(f, f') and g_v at a pose of the joints at rest, about the straight beam.

    Args:
        norm: of `printed`; None: those of the Lagrangian plant.
    """
    parts = robot().function("drift", "input_gain")
    joints, step = poses(seed)[0][:RIGID], 1e-6

    def both(bent: Array) -> tuple[Array, Array]:
        q, v = np.concatenate([joints, bent[:3]]), np.concatenate([np.zeros(RIGID), bent[3:]])
        if norm is not None:
            return printed(q, v, rho, norm)
        drift, gain = (part.full() for part in parts(q, v, numbers(rho=rho, **FRICTIONLESS)))
        return drift.ravel(), gain

    ways = step * np.eye(6)
    slopes = [(both(way)[0] - both(-way)[0]) / (2 * step) for way in ways]
    return np.array(slopes), both(np.zeros(6))[1]


@pytest.mark.parametrize("rho", [0.05, 0.2, 1.0])
def test_read_with_mass_normalised_modes_they_are_the_lagrangian_plant(rho: float) -> None:
    """To first order in the deflection, the joints at rest: (20) has cancelled what motion adds."""
    for seed in SEEDS:
        slopes, gain = to_first_order(rho, seed, norm=1 / rho)
        expected, expected_gain = to_first_order(rho, seed, norm=None)
        assert np.abs(slopes - expected).max() < 1e-8 * np.abs(expected).max()
        assert np.abs(gain - expected_gain).max() < 1e-12 * np.abs(expected_gain).max()


@pytest.mark.parametrize("norm", [1.0, LINKS.beam / 4, 2 / LINKS.rho])
def test_in_another_normalisation_the_modes_feel_the_waist_too_little_or_too_much(
    norm: float,
) -> None:
    """By the modal mass rho norm; l / 4 is the integral of phi^2 where phi(l) = 1."""
    assert np.sqrt(LINKS.beam / 4) * np.abs(BEAM.tip) == pytest.approx(1.0)
    for seed in SEEDS:
        column = to_first_order(LINKS.rho, seed, norm)[1][:, 2]
        expected = to_first_order(LINKS.rho, seed, None)[1][:, 2]
        felt = (column / column[2])[RIGID:] / (expected / expected[2])[RIGID:]
        assert felt == pytest.approx(LINKS.rho * norm, rel=1e-9)


def test_output_is_the_last_point_of_the_beam() -> None:
    s, h = robot(), 1e-6
    with_rate = s.with_rate(s.output)
    for seed in SEEDS:
        q, v = poses(seed)
        tip, ahead, behind = (points(q + k * v, np.array([LINKS.beam]))[0][0] for k in (0.0, h, -h))
        y, rate = (np.array(part).ravel() for part in with_rate(q, v, numbers()))
        assert y == pytest.approx(tip - [0, 0, LINKS.link1], abs=1e-12)
        assert flexible_five_bar_robot().endpoint(q) == pytest.approx(y, abs=1e-12)
        assert rate == pytest.approx((ahead - behind) / (2 * h), abs=1e-6)


def test_controlled_output_lies_between_the_tip_and_the_straight_link() -> None:
    q, v = poses(1)
    both = robot().function("output", "controlled_output")
    straight = np.concatenate([q[:RIGID], np.zeros(3)])
    tip, rigid = (flexible_five_bar_robot().endpoint(x) for x in (q, straight))
    assert np.linalg.norm(tip - rigid) > 1e-3
    for alpha in (1.0, 0.5, 0.0, -1.0):
        output, controlled = (np.array(part).ravel() for part in both(q, v, numbers(alpha)))
        assert output == pytest.approx(tip)
        assert controlled == pytest.approx(alpha * tip + (1 - alpha) * rigid, abs=1e-12)


@pytest.mark.parametrize("alpha", [0.0, 0.5])
def test_rank_test_fails_where_the_parallelogram_collapses(alpha: float) -> None:
    gain = decoupling_matrix(robot())
    home = conditioning(gain(np.concatenate([HOME, np.zeros(3)]), numbers(alpha)).full())
    for seed in SEEDS:
        q, _ = poses(seed)
        q[1] = q[0] + np.pi * (seed % 2)
        assert conditioning(gain(q, numbers(alpha)).full()) < 1e-9 * home


# Motion -------------------------------------------------------------------------------------------


def simulate(
    system: MechanicalSystem, start: Array, u: Array, dt: float, ticks: int, parameters: Array
) -> Array:
    """RK4 with constant generalized forces u, (n,): (q, v) at every step, (ticks + 1, 2n)."""
    q, v, x = system.q, system.v, ca.MX.sym("x", 2 * system.n)
    slope = ca.Function(
        "slope",
        [ca.vertcat(q, v), system.tau, system.parameters],
        [ca.vertcat(v, system.acceleration)],
    )
    force, p = ca.MX.sym("force", system.n), ca.MX.sym("p", parameters.size)
    k1 = slope(x, force, p)
    k2 = slope(x + dt / 2 * k1, force, p)
    k3 = slope(x + dt / 2 * k2, force, p)
    k4 = slope(x + dt * k3, force, p)
    step: Any = ca.Function("step", [x, force, p], [x + dt / 6 * (k1 + 2 * (k2 + k3) + k4)])
    states = step.mapaccum(ticks)(start, u, parameters)
    return np.vstack([start, np.array(states).T])


def thrown(modes: int = 3) -> Array:
    """Bent and moving in every joint."""
    q = HOME + np.array([0.1, -0.2, 0.0])
    bent = 0.01 / np.arange(1, modes + 1) ** 2
    return np.concatenate([q, bent, [0.8, -1.0, 1.5], np.zeros(modes)])


def energies(system: MechanicalSystem, states: Array, parameters: Array) -> Array:
    n, count = system.n, len(states)
    energy = system.function("energy").map(count)
    return np.array(energy(states[:, :n].T, states[:, n:].T, np.tile(parameters, (count, 1)).T))[0]


def test_free_motion_without_damping_keeps_its_energy() -> None:
    parameters = numbers(**LOSSLESS)
    states = simulate(robot(), thrown(), np.zeros(6), 1e-4, 20_000, parameters)
    energy = energies(robot(), states, parameters)
    bent = states[:, RIGID]
    assert np.ptp(states[:, 6:9], axis=0).min() > 0.1 and np.ptp(bent) > 0.01
    assert np.ptp(energy) < 1e-6 * energy[0]


def test_damping_takes_energy_away() -> None:
    states = simulate(robot(), thrown(), np.zeros(6), 5e-4, 2000, numbers())
    energy = energies(robot(), states, numbers())
    assert np.all(np.diff(energy) < 0) and energy[-1] < 0.9 * energy[0]


def rigid_arm(start: Array, u: Array, dt: float, ticks: int) -> Array:
    """Joints at the end, (3,), of the same arm with a link 4 that does not bend."""
    q, v, u_symbol = ca.SX.sym("q", 3), ca.SX.sym("v", 3), ca.SX.sym("u", 3)
    c1, c2, l1, beam = ca.cos(q[0]), ca.cos(q[1]), LINKS.link1, LINKS.beam
    reach2 = l1**2 * c1**2 * beam - l1 * c1 * c2 * beam**2 + c2**2 * beam**3 / 3
    waist = LINKS.J0 + LINKS.J1 * c1**2 + LINKS.rho * reach2
    mass = ca.diag(ca.vertcat(LINKS.M11, LINKS.M22, waist))
    bias = lagrange_bias(q, v, ca.dot(v, mass @ v) / 2, ca.SX(0), ca.SX.zeros(3))
    slope = ca.vertcat(v, ca.solve(mass, u_symbol - bias))
    rate = ca.Function("rate", [ca.vertcat(q, v), u_symbol], [slope])
    x = start
    for _ in range(ticks):
        middle = x + dt / 2 * np.array(rate(x, u)).ravel()
        x = x + dt * np.array(rate(middle, u)).ravel()
    return x[:3]


def test_a_stiffer_beam_comes_ever_closer_to_a_rigid_link() -> None:
    u, dt, ticks = np.array([0.3, -0.2, 0.4]), 5e-5, 4000
    joints, rates = HOME + np.array([0.1, -0.2, 0.0]), np.array([0.8, -1.0, 1.5])
    rigid = rigid_arm(np.concatenate([joints, rates]), u, dt, ticks)
    start = np.concatenate([joints, np.zeros(2), rates, np.zeros(2)])
    gaps: list[float] = []
    for frequency in (20.0, 40.0, 80.0):
        parameters = numbers(**LOSSLESS | {"zeta": 0.05, "omega1": 2 * np.pi * frequency})
        forces = np.concatenate([u, np.zeros(2)])
        end = simulate(robot(2), start, forces, dt, ticks, parameters)[-1]
        gaps.append(float(np.abs(end[:RIGID] - rigid).max()))
    assert gaps[0] < 0.01
    assert gaps[1] < 0.5 * gaps[0] and gaps[2] < 0.5 * gaps[1]


def finite_elements() -> tuple[Array, Array]:
    """M and K of the arm at home, linearized: hub and beam of finite elements."""
    stiffness = rigidity(LINKS.frequency, LINKS.beam, LINKS.rho)
    return beam_of_elements(20, LINKS.beam, stiffness, LINKS.rho).on_hub(LINKS.J0)


def test_on_the_hub_frequencies_are_those_of_finite_elements() -> None:
    mass, stiffness = finite_elements()
    expected = np.sqrt(eigh(stiffness, mass, eigvals_only=True)[1:4])
    home, own = np.concatenate([HOME, np.zeros(3)]), np.zeros((4, 4))
    own[1:, 1:] = np.diag(LINKS.rho * (2 * np.pi * LINKS.frequency * BEAM.overtones) ** 2)
    whole = robot().function("mass")(home, 0 * home, numbers()).full()[2:, 2:]
    assert np.sqrt(eigh(own, whole, eigvals_only=True)[1:]) == pytest.approx(expected, rel=0.02)


def test_tip_answers_a_torque_step_as_a_beam_of_finite_elements_does() -> None:
    torque, dt, ticks = 0.002, 1e-4, 6000
    squared, shapes = eigh(*finite_elements()[::-1])
    t = dt * np.arange(ticks + 1.0)[:, None]
    waves = np.sqrt(np.abs(squared[1:]))
    answer = np.hstack([t**2 / 2, (1 - np.cos(waves * t)) / waves**2])
    tip = answer @ (torque * shapes[0] * (LINKS.beam * shapes[0] + shapes[-2]))

    forces = np.array([0, 0, torque, 0, 0, 0])
    start = np.concatenate([HOME, np.zeros(9)])
    states = simulate(robot(), start, forces, dt, ticks, numbers(**LOSSLESS))
    y = flexible_five_bar_robot().endpoint(states[:, :6])
    swing = LINKS.beam * torque / (LINKS.J0 + LINKS.rho * LINKS.beam**3 / 3) * t[:, 0] ** 2 / 2
    assert np.abs(tip - swing).max() > 5e-5  # the beam does bend
    assert np.abs(y[:, 1] - tip).max() < 0.02 * np.abs(tip - swing).max()


@pytest.mark.parametrize("plant, modes", [("newtonian", 3), ("lagrangian", 0), ("lagrangian", 7)])
def test_a_robot_that_does_not_exist_is_refused(plant: str, modes: int) -> None:
    with pytest.raises(ValueError, match=r"expected|between"):
        flexible_five_bar(modes, plant)
