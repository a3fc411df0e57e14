"""Laws of the zero dynamics: theory where it is closed, and the growth seen in simulation."""

from __future__ import annotations

import math
import time
from typing import Any

import casadi as ca
import numpy as np
import pytest
from scipy.linalg import expm

from onpath.app.exports.zero_dynamics import SETTABLE, as_json, study
from onpath.models.arrays import Array
from onpath.models.control.settable import changed, specs, value_of
from onpath.models.systems.beam import MOST_MODES, beam_modes
from onpath.models.systems.five_bar import five_bar
from onpath.models.systems.flexible_five_bar import HOME
from onpath.models.systems.flexible_links import load_links
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.system import MechanicalSystem
from onpath.models.systems.zero_dynamics import flexible_zero_dynamics, natural_rate, zero_dynamics

LINKS = load_links()
MODES = range(1, MOST_MODES + 1)
BENT_BACK = np.array([1.2, 2.6, 0.4])


def lumped(alpha: float, **changes: float) -> dict[str, float]:
    return LINKS.lumped(alpha) | changes


def straight(joints: Array, modes: int) -> Array:
    return np.concatenate([joints, np.zeros(modes)])


def exponents(alpha: float, modes: int = 3, plant: str = "lagrangian", **changes: float) -> Any:
    """At home, rightmost first, shape (2 modes,), complex."""
    zero = flexible_zero_dynamics(modes, plant)
    parameters = zero.system.parameter_vector(lumped(alpha, **changes))
    return zero.exponents(straight(HOME, modes), parameters)[0]


def critical(joints: Array, modes: int = 3, plant: str = "lagrangian", **changes: Any) -> float:
    zero = flexible_zero_dynamics(modes, plant)
    parameters = zero.system.parameter_vector(lumped(0.0, **changes))
    return zero.critical_alpha(straight(joints, modes), parameters, highest=8.0)


@pytest.mark.thorough
def test_the_command_takes_just_the_settings_that_change_its_table() -> None:
    def told(parameters: Any) -> Any:
        return as_json(study(parameters, (0.02, 0.01), alphas=np.array([0.5])))

    usual, matters = FlexibleParameters(), set[str]()
    table = told(usual)
    for name, spec in specs(FlexibleParameters).items():
        other = [option for option in spec.options if option != value_of(usual, name)]
        value = other[-1] if other else spec.low + 0.37 * (spec.high - spec.low)
        if told(changed(usual, name, value)) != table:
            matters.add(name)
    assert matters == set(SETTABLE)


@pytest.mark.parametrize("modes", MODES)
def test_with_the_rigid_link_held_the_modes_are_those_of_the_clamped_beam(modes: int) -> None:
    omega = 2 * np.pi * LINKS.frequency * beam_modes(modes, LINKS.beam).overtones
    expected = np.sqrt(1 - LINKS.zeta**2) * omega
    found = exponents(0.0, modes)
    assert np.sort(found.imag)[modes:] == pytest.approx(expected, rel=1e-9)
    assert np.sort(-found.real) == pytest.approx(np.repeat(LINKS.zeta * omega, 2), rel=1e-9)


@pytest.mark.parametrize("modes", MODES)
@pytest.mark.parametrize("alpha", [1.0, 0.7, -1.0])
def test_at_home_they_are_those_of_a_pencil_of_matrices(modes: int, alpha: float) -> None:
    """With q3'' = -alpha w'' / R held, (I - alpha Psi phi^T / R) f'' = -omega^2 f, R = l."""
    beam = beam_modes(modes, LINKS.beam)
    inertia = np.eye(modes) - alpha * np.outer(beam.moment, beam.tip) / LINKS.beam
    stiffness = np.diag((2 * np.pi * LINKS.frequency * beam.overtones) ** 2)
    squares = np.linalg.eigvals(-np.linalg.solve(inertia, stiffness)).astype(complex)
    roots = np.sqrt(squares)
    expected = np.sort_complex(np.concatenate([roots, -roots]))
    found = np.sort_complex(exponents(alpha, modes, zeta=0.0))
    gaps = np.abs(found[:, None] - expected).min(axis=1)
    assert gaps.max() < 1e-5 * np.abs(expected).max()


def test_figures_of_the_tip_at_home() -> None:
    unit = natural_rate(lumped(1.0), float(beam_modes(1, LINKS.beam).roots[0]))
    assert 2 * np.pi * LINKS.frequency / unit == pytest.approx(3.516, rel=1e-4)
    fastest = [exponents(1.0, modes)[0].real / unit for modes in MODES]
    assert fastest[2] == pytest.approx(49, rel=0.02)
    assert min(fastest) > 5 and np.all(np.diff(fastest) > 0)
    assert all(exponents(alpha)[0].real > 0 for alpha in (1.0, 0.9, 0.8))
    assert all(exponents(alpha)[0].real < 0 for alpha in (0.7, 0.6, 0.5, 0.0, -1.0))


def test_one_mode_loses_its_inertia_at_the_critical_alpha() -> None:
    beam = beam_modes(1, LINKS.beam)
    expected = LINKS.beam / float(beam.moment[0] * beam.tip[0])
    assert critical(HOME, 1) == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize("joints", [HOME, BENT_BACK])
def test_critical_alpha_parts_stable_from_unstable(joints: Array) -> None:
    for modes in MODES:
        limit, zero = critical(joints, modes), flexible_zero_dynamics(modes)
        q = straight(joints, modes)
        for alpha, sign in ((limit - 1e-3, -1), (limit + 1e-3, 1)):
            parameters = zero.system.parameter_vector(lumped(alpha))
            assert np.sign(zero.exponents(q, parameters)[0, 0].real) == sign


def test_critical_alpha_depends_on_the_shape_of_the_arm_but_not_on_mass_or_stiffness() -> None:
    assert abs(critical(BENT_BACK) - critical(HOME)) > 0.02
    others: list[dict[str, Any]] = [{"rho": 0.05}, {"rho": 1.0}, {"omega1": 60.0}, {"J0": 0.5}]
    for changes in others:
        assert critical(HOME, **changes) == pytest.approx(critical(HOME), abs=1e-4)


def test_between_two_limits_it_is_damping_that_destabilises() -> None:
    assert critical(HOME) == pytest.approx(0.7227, abs=1e-4)
    assert critical(HOME, zeta=0.0) == pytest.approx(0.7585, abs=1e-4)


@pytest.mark.parametrize("rho", [0.2, 0.4, 1.0])
def test_unit_modes_act_like_alpha_times_rho(rho: float) -> None:
    limit = critical(HOME, plant="unit_modes", rho=rho)
    assert rho * limit == pytest.approx(critical(HOME), abs=1e-3)
    for alpha in (1.0, 0.5):
        same = exponents(alpha, plant="unit_modes", rho=rho)
        assert np.abs(same - exponents(alpha * rho)).max() < 1e-6 * np.abs(same).max()


def test_where_nothing_is_unstable_there_is_no_critical_alpha() -> None:
    zero = flexible_zero_dynamics(3, "unit_modes")
    parameters = zero.system.parameter_vector(lumped(0.0))
    assert zero.critical_alpha(straight(HOME, 3), parameters, highest=1.0) == math.inf


def test_it_is_quick_enough_to_follow_a_slider() -> None:
    critical(HOME)
    times: list[float] = []
    for _ in range(7):
        start = time.thread_time()
        critical(HOME)
        times.append(time.thread_time() - start)
    assert min(times) < 0.02


def test_a_robot_with_a_motor_on_every_joint_has_none() -> None:
    with pytest.raises(ValueError, match="no zero dynamics"):
        zero_dynamics(five_bar())


# Simulation ---------------------------------------------------------------------------------------

DT = 1e-4


class Held:
    """The plant whose controlled output is made to follow the ellipse (23) at a speed.

    The feedback acts within a Runge-Kutta step too: no sampling.
    """

    def __init__(self, system: MechanicalSystem, speed: float, alpha: float) -> None:
        self.system, t = system, ca.SX.sym("t")
        self.parameters = system.parameter_vector(lumped(alpha))
        c, s = 0.05 * ca.cos(speed * t), 0.05 * ca.sin(speed * t)
        path = ca.vertcat(0.5 + 0.1 * c, c, s)
        rate, inputs = ca.jacobian(path, t), [system.q, system.parameters]
        jacobian = ca.jacobian(system.controlled_output, system.q)
        self.path = ca.Function("path", [t], [path, rate, ca.jacobian(rate, t)])
        self.output = ca.Function("h", inputs, [system.controlled_output, jacobian])
        error_rate = jacobian @ system.v - rate
        wanted = ca.jacobian(rate, t) - 400 * (system.controlled_output - path) - 40 * error_rate
        free = jacobian @ system.drift + ca.jtimes(jacobian @ system.v, system.q, system.v)
        u = ca.solve(ca.densify(jacobian @ system.input_gain), wanted - free)
        slope = ca.vertcat(system.v, system.drift + system.input_gain @ u)
        x = ca.vertcat(system.q, system.v)
        self.slope = ca.Function("slope", [x, t, system.parameters], [ca.cse(slope)])

    def start(self, f: Array) -> Array:
        """(q, v) with the output and its rate on the path, the modes at f and at rest."""
        target, rate, _ = (np.array(value).ravel() for value in self.path(0.0))
        q, jacobian = np.concatenate([HOME, f]), np.eye(3)
        for _ in range(20):
            y, full = (np.array(value) for value in self.output(q, self.parameters))
            jacobian = full[:, :3]
            q[:3] -= np.linalg.solve(jacobian, y.ravel() - target)
        v = np.linalg.solve(jacobian, rate)
        return np.concatenate([q, v, np.zeros(f.size)]).astype(np.float64)

    def run(self, start: Array, ticks: int) -> Array:
        """(q, v) at every step, (ticks + 1, 2n)."""
        x, p = ca.MX.sym("x", start.size), ca.MX.sym("p", self.parameters.size)
        t: Any = ca.MX.sym("t")
        k1 = self.slope(x, t, p)
        k2 = self.slope(x + DT / 2 * k1, t + DT / 2, p)
        k3 = self.slope(x + DT / 2 * k2, t + DT / 2, p)
        k4 = self.slope(x + DT * k3, t + DT, p)
        step: Any = ca.Function("step", [x, t, p], [x + DT / 6 * (k1 + 2 * (k2 + k3) + k4)])
        clock = DT * np.arange(float(ticks))[None]
        states = step.mapaccum(ticks)(start, clock, self.parameters)
        return np.vstack([start, np.array(states).T])

    def modal(self, states: Array) -> Array:
        """eta_1 = (f, f'), shape (..., 2n) -> (..., 2 (n - 3))."""
        n = self.system.n
        return np.concatenate([states[..., 3:n], states[..., n + 3 :]], axis=-1)


@pytest.mark.parametrize("alpha, seconds", [(1.0, 0.05), (0.9, 0.25), (0.8, 0.6)])
def test_exponents_are_the_growth_seen_in_simulation(alpha: float, seconds: float) -> None:
    zero = flexible_zero_dynamics(3)
    plant = Held(zero.system, 0.0, alpha)
    start = plant.start(np.full(3, 1e-12))
    rightmost = zero.exponents(straight(start[:3], 3), plant.parameters)[0, 0]
    assert rightmost.real > 0 and rightmost.imag != 0
    size = np.linalg.norm(plant.modal(plant.run(start, round(seconds / DT))), axis=1)
    half_turn = round(np.pi / abs(rightmost.imag) / DT)
    growth = np.log(size[-1] / size[-1 - half_turn]) / (half_turn * DT)
    assert size[-1] > 1e4 * size[0]
    assert growth == pytest.approx(rightmost.real, rel=0.05)


@pytest.mark.parametrize("alpha", [1.0, 0.8, 0.5])
@pytest.mark.parametrize("speed", [0.0, 2.0])
def test_a_small_change_inside_develops_as_the_linearization_says(
    alpha: float, speed: float
) -> None:
    """In motion too, where the terms that motion adds come to 1e-4 over this short time."""
    zero, ticks = flexible_zero_dynamics(3), 20
    plant = Held(zero.system, speed, alpha)
    _, rate, acceleration = (np.array(value).ravel() for value in plant.path(0.0))
    still = plant.start(np.zeros(3))
    matrix = zero.function(still[:6], rate, acceleration, plant.parameters).full()
    reference = plant.modal(plant.run(still, ticks)[-1])
    predicted = expm(matrix * ticks * DT)
    for mode in range(3):
        f = 1e-7 * np.eye(3)[mode]
        change = plant.modal(plant.run(plant.start(f), ticks)[-1]) - reference
        expected = predicted[:, mode] * 1e-7
        scale = np.repeat([np.abs(expected[:3]).max(), np.abs(expected[3:]).max()], 3)
        assert np.abs((change - expected) / scale).max() < 1e-5
