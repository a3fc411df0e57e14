"""Laws of the rigid five-bar: mechanics checked against the links themselves."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.systems.five_bar import (
    FiveBarLinks,
    skeleton,
)
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.system import GRAVITY, conditioning, decoupling_matrix, lagrange_bias
from tests.support.drawing import drawn
from tests.support.rig import Rig, end_point, jacobian

SEEDS = range(20)


def poses(seed: int) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-np.pi, np.pi, 2), rng.normal(size=2) * 4


def centres(links: FiveBarLinks, q: Array) -> tuple[Array, Array]:
    """Centres of mass of links 1 to 4, (4, 2), from where the joints are, and the links' angles."""
    lengths = links.link1.length, links.link2.length, links.link4.length
    bars, _ = drawn(skeleton, q, *lengths)
    feet, heads = bars[:, 0, ::2], bars[:, 1, ::2]
    feet[3] = bars[0, 1, ::2]  # link 4's centre is measured from its joint with link 1
    directions = (heads - feet) / np.linalg.norm(heads - feet, axis=1)[:, None]
    each = (links.link1, links.link2, links.link3, links.link4)
    return feet + directions * np.array([[link.centre_of_mass] for link in each]), directions


def energies(links: FiveBarLinks, q: Array, v: Array) -> tuple[float, float]:
    """Kinetic and potential energy of four bodies, velocities by finite differences."""
    h = 1e-6
    (ahead, turned), (behind, turned_back) = centres(links, q + h * v), centres(links, q - h * v)
    speed2 = (((ahead - behind) / (2 * h)) ** 2).sum(1)
    spin2 = (((turned - turned_back) / (2 * h)) ** 2).sum(1)
    each = (links.link1, links.link2, links.link3, links.link4)
    mass, inertia = np.array([(link.mass, link.inertia) for link in each]).T
    height = centres(links, q)[0][:, 1]
    return float((mass * speed2 + inertia * spin2).sum() / 2), float(mass @ height * GRAVITY)


@pytest.mark.parametrize("removed, payload", [(0.0, 0.0), (0.7, 0.0), (0.4, 0.25), (1.0, 0.5)])
def test_energy_is_that_of_four_moving_bodies(rig: Rig, removed: float, payload: float) -> None:
    links = rig.links.spoiled(removed, payload)
    parameters = rig.system.parameter_vector(links.lumped())
    energy = rig.system.function("energy")
    for seed in SEEDS:
        q, v = poses(seed)
        kinetic, potential = energies(links, q, v)
        assert float(energy(q, 0 * v, parameters)) == pytest.approx(potential, abs=1e-12)
        assert float(energy(q, v, parameters)) == pytest.approx(kinetic + potential, rel=1e-8)


def test_a_payload_adds_its_own_energy(rig: Rig) -> None:
    heavier = rig.links.spoiled(0.0, 0.3)
    for seed in SEEDS:
        q, v = poses(seed)
        speed = jacobian(q) @ v
        added = np.subtract(energies(heavier, q, v), energies(rig.links, q, v))
        height = end_point(q)[1] + 0.2
        expected = (0.15 * speed @ speed, 0.3 * GRAVITY * height)
        assert added == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_balanced_linkage_is_the_decoupled_robot_of_the_paper(rig: Rig) -> None:
    lumped = rig.links.lumped()
    assert [lumped[name] for name in ("M12", "G1", "G2")] == pytest.approx([0, 0, 0], abs=1e-15)
    assert [lumped["M11"], lumped["M22"]] == pytest.approx([0.0226, 0.0120], rel=1e-12)
    spoiled = rig.links.spoiled(0.5, 0.1).lumped()
    assert all(abs(spoiled[name]) > 1e-3 for name in ("M12", "G1", "G2"))


def test_mass_matrix_is_symmetric_and_positive_definite(rig: Rig) -> None:
    mass = rig.system.function("mass")
    for parameters in (rig.balanced, rig.spoiled):
        for seed in SEEDS:
            matrix = mass(*poses(seed), parameters).full()
            assert np.array_equal(matrix, matrix.T)
            assert np.linalg.eigvalsh(matrix)[0] > 1e-3


def test_bias_is_lagrange_s(rig: Rig) -> None:
    s = rig.system
    names = s.parameter_names
    potential = ca.substitute(s.energy, s.v, ca.SX.zeros(2))
    friction = ca.vertcat(
        *[s.parameters[names.index(b)] * s.v[i] for i, b in enumerate(("b1", "b2"))]
    )
    derived = lagrange_bias(s.q, s.v, s.energy - potential, potential, friction)
    difference = ca.Function("d", [s.q, s.v, s.parameters], [derived - s.bias])
    for seed in SEEDS:
        q, v = poses(seed)
        assert abs(difference(q, v, rig.spoiled).full()).max() < 1e-12
        assert abs(s.function("bias")(q, v, rig.spoiled).full()).max() > 1e-3


def test_acceleration_solves_the_equation_of_motion(rig: Rig) -> None:
    s = rig.system
    acceleration = ca.Function("a", [s.q, s.v, s.tau, s.parameters], [s.acceleration])
    for seed in SEEDS:
        q, v = poses(seed)
        tau = np.random.default_rng(seed).normal(size=2)
        mass, bias, drift, gain = s.function("mass", "bias", "drift", "input_gain")(
            q, v, rig.spoiled
        )
        a = acceleration(q, v, tau, rig.spoiled)
        assert abs((mass @ a + bias - tau).full()).max() < 1e-12
        assert abs((drift + gain @ tau - a).full()).max() < 1e-10


def test_output_rate_is_the_derivative_of_the_end_point(rig: Rig) -> None:
    with_rate = rig.system.with_rate(rig.system.output)
    h = 1e-6
    for seed in SEEDS:
        q, v = poses(seed)
        y, rate = with_rate(q, v, rig.balanced)
        slope = (end_point(q + h * v) - end_point(q - h * v)) / (2 * h)
        assert np.abs(y.full().ravel() - end_point(q)).max() < 1e-15
        assert np.abs(rate.full().ravel() - slope).max() < 1e-8
        assert np.abs(jacobian(q) @ v - slope).max() < 1e-8


def test_rank_test_fails_exactly_where_the_parallelogram_collapses(rig: Rig) -> None:
    gain = decoupling_matrix(rig.system)
    for seed in SEEDS:
        q, _ = poses(seed)
        number = conditioning(gain(q, rig.balanced).full())
        assert number > 0.05 * abs(np.sin(q[0] - q[1]))
        for k in (0, 1):
            collapsed = np.array([q[1] + k * np.pi, q[1]])
            assert conditioning(gain(collapsed, rig.balanced).full()) < 1e-12


# Motors off ---------------------------------------------------------------------------------------


def fall(rig: Rig, dt: float, seconds: float, **lumped: float) -> tuple[Array, Array]:
    """RK4 of the free linkage; energy and joint velocities at every step."""
    s = rig.system
    rate = ca.vertcat(s.v, ca.substitute(s.acceleration, s.tau, ca.SX.zeros(2)))
    slope = ca.Function("slope", [ca.vertcat(s.q, s.v), s.parameters], [rate])
    parameters = s.parameter_vector({**rig.links.spoiled(0.6, 0.1).lumped(), **lumped})
    x, p = ca.MX.sym("x", 4), ca.MX.sym("p", parameters.size)
    k1 = slope(x, p)
    k2 = slope(x + dt / 2 * k1, p)
    k3 = slope(x + dt / 2 * k2, p)
    k4 = slope(x + dt * k3, p)
    step = ca.Function("step", [x, p], [x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)])
    start = np.array([0.9, 2.6, 3.0, -2.0])
    count = round(seconds / dt)
    path = np.vstack([start, step.mapaccum(count)(start, parameters).full().T])
    energy = s.function("energy").map(count + 1)(path[:, :2].T, path[:, 2:].T, parameters)
    return energy.full().ravel(), path[:, 2:]


def test_free_linkage_without_friction_keeps_its_energy(rig: Rig) -> None:
    energy, v = fall(rig, 1e-3, 2.0, b1=0.0, b2=0.0)
    assert np.ptp(v, axis=0).min() > 1.0
    assert np.ptp(energy) < 1e-8 * np.ptp(0.5 * 0.01 * v**2)


def test_energy_lost_is_the_work_of_friction(rig: Rig) -> None:
    dt = 1e-3
    energy, v = fall(rig, dt, 2.0)
    lumped = rig.links.lumped()
    power = lumped["b1"] * v[:, 0] ** 2 + lumped["b2"] * v[:, 1] ** 2
    work = dt / 3 * (power[0] + 4 * power[1:-1:2].sum() + 2 * power[2:-1:2].sum() + power[-1])
    assert work > 0.1
    assert energy[0] - energy[-1] == pytest.approx(work, rel=1e-6)


def test_integration_converges_at_fourth_order(rig: Rig) -> None:
    drifts = [
        np.abs(np.diff(fall(rig, h, 1.0, b1=0.0, b2=0.0)[0][[0, -1]]))[0] for h in (0.02, 0.01)
    ]
    assert drifts[0] / drifts[1] > 2**3.5


# Inverse kinematics -------------------------------------------------------------------------------


@given(st.floats(0.03, 0.37), st.floats(-1.0, 1.0))
def test_inverse_kinematics_returns_to_the_point(reach: float, angle: float) -> None:
    bearing = np.pi / 4 + angle
    y = reach * np.array([np.cos(bearing), np.sin(bearing)]) - 0.2
    q = RIGID_FIVE_BAR.rest(y)
    assert np.abs(end_point(q) - y).max() < 1e-12
    assert np.abs(RIGID_FIVE_BAR.endpoint(q) - y).max() < 1e-12


def test_inverse_kinematics_keeps_the_pose_of_home() -> None:
    home = RIGID_FIVE_BAR.rest(np.zeros(2))
    assert home == pytest.approx([np.pi / 2, np.pi])
    turning = RIGID_FIVE_BAR.rest(0.05 * np.array([[1, 0], [0, 1], [-1, 0], [0, -1.0]]))
    assert np.abs(turning - home).max() < 0.5


@pytest.mark.parametrize("y", [(0.3, 0.0), (-0.2, -0.2), (0.2, 0.2), (0.0, -1.0)])
def test_a_point_out_of_reach_is_refused(y: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="out of reach"):
        RIGID_FIVE_BAR.rest(np.array(y))


def test_one_bad_point_among_good_ones_is_refused() -> None:
    with pytest.raises(ValueError, match="out of reach"):
        RIGID_FIVE_BAR.rest(np.array([[0.0, 0.0], [0.5, 0.5]]))


def test_links_of_the_drawing_are_joined_and_parallel() -> None:
    for seed in SEEDS:
        q, _ = poses(seed)
        bars, joints = drawn(skeleton, q, 0.2, 0.1, 0.2)
        link1, link2, link3, link4 = bars
        assert np.array_equal(joints[0], link1[0]) and np.array_equal(joints[0], link2[0])
        assert np.allclose(link2[1], link3[0]) and np.allclose(link3[1], link4[0])
        assert np.allclose(np.cross(link1[1] - link1[0], link3[1] - link3[0]), 0)
        assert np.allclose(np.cross(link2[1] - link2[0], link4[1] - link4[0]), 0)
        assert np.linalg.norm(np.cross(link4[1] - joints[1], link4[0] - joints[1])) < 1e-12
        tip = end_point(q) + 0.2
        assert np.allclose(link4[1], [tip[0], 0, tip[1]])
