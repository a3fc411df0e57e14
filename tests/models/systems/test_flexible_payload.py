"""A mass at the tip of the flexible link: its mechanics, and what controllers make of it."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.studies.experiments import experiments, run
from onpath.models.systems import flexible_robot, tip_load
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.flexible_five_bar import PLANTS, RIGID, flexible_five_bar
from onpath.models.systems.flexible_parameters import FlexibleParameters
from onpath.models.systems.flexible_robot import flexible_five_bar_robot, robot_for
from onpath.models.systems.system import lagrange_bias
from tests.models.systems.test_flexible_five_bar import (
    LINKS,
    LOSSLESS,
    SEEDS,
    energies,
    kinetic_energy,
    poses,
    simulate,
    thrown,
)

LOAD = 0.05  # [kg]
MODES = pytest.mark.parametrize("modes", [1, 3, 6])


def numbers(load: float = LOAD, **changes: float) -> Array:
    values = LINKS.lumped(1.0, load) | changes
    return flexible_five_bar(1, loaded=True).parameter_vector(values)


def energy_with_load(q: Array, v: Array) -> float:
    """Kinetic energy of the moving points, one of which, the last, is heavy."""
    h, tip = 1e-6, flexible_five_bar_robot(q.size - RIGID).endpoint
    rate = (tip(q + h * v) - tip(q - h * v)) / (2 * h)
    return kinetic_energy(q, v) + LOAD / 2 * float(rate @ rate)


@MODES
def test_mass_matrix_is_that_of_the_moving_points(modes: int) -> None:
    mass, units = flexible_five_bar(modes, loaded=True).function("mass"), np.eye(RIGID + modes)
    for seed in SEEDS:
        q, v = poses(seed, modes)
        single = np.array([energy_with_load(q, e) for e in units])
        pairs = [[energy_with_load(q, both) for both in row] for row in units[:, None] + units]
        expected = np.array(pairs) - single - single[:, None]
        np.fill_diagonal(expected, 2 * single)
        found = mass(q, v, numbers()).full()
        assert np.abs(found - expected).max() < 1e-7
        np.testing.assert_allclose(found, found.T, atol=1e-15)


@MODES
def test_bias_is_lagrange_s(modes: int) -> None:
    s = flexible_five_bar(modes, loaded=True)
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


@pytest.mark.thorough
@pytest.mark.parametrize("plant", PLANTS)
@MODES
def test_acceleration_solves_the_equation_of_motion(plant: str, modes: int) -> None:
    s = flexible_five_bar(modes, plant, loaded=True)
    acceleration = ca.Function("a", [s.q, s.v, s.tau, s.parameters], [s.acceleration])
    parts = s.function("mass", "bias", "drift", "input_gain")
    for seed in SEEDS:
        q, v = poses(seed, modes)
        tau = np.random.default_rng(seed).normal(size=s.n)
        mass, bias, drift, gain = parts(q, v, numbers())
        a = acceleration(q, v, tau, numbers())
        scale = np.abs(bias.full()).max()
        assert np.abs((mass @ a + bias - tau).full()).max() < 1e-11 * (1 + scale)
        u = np.concatenate([tau[:RIGID], np.zeros(modes)])
        by_parts = drift + gain @ tau[:RIGID] - acceleration(q, v, u, numbers())
        assert np.abs(by_parts.full()).max() < 1e-8 * (1 + scale)


def test_free_motion_without_damping_keeps_its_energy() -> None:
    robot, parameters = flexible_five_bar(loaded=True), numbers(**LOSSLESS)
    states = simulate(robot, thrown(), np.zeros(6), 1e-4, 15_000, parameters)
    energy = energies(robot, states, parameters)
    heights = flexible_five_bar_robot().endpoint(states[:, :6])[:, 2]
    assert np.ptp(heights) > 0.02  # its weight does work
    assert np.ptp(energy) < 1e-6 * np.abs(energy).max()


@pytest.mark.parametrize("plant", PLANTS)
def test_a_payload_of_nothing_changes_no_bit(plant: str) -> None:
    empty, loaded = flexible_five_bar(3, plant), flexible_five_bar(3, plant, loaded=True)
    names = ("drift", "input_gain", "bias", "mass", "output", "energy")
    plain = empty.parameter_vector(LINKS.lumped(0.5))
    for seed in SEEDS:
        q, v = poses(seed)
        for a, b in zip(
            empty.function(*names)(q, v, plain),
            loaded.function(*names)(q, v, np.append(plain, 0.0)),
            strict=True,
        ):
            np.testing.assert_array_equal(a.full(), b.full())


def test_only_a_robot_with_a_payload_has_its_equations_and_no_controller_knows() -> None:
    own = FlexibleParameters(payload=LOAD)
    robot = robot_for(own)
    assert (
        robot
        is flexible_five_bar_robot(3, "lagrangian", True)
        is not robot_for(replace(own, payload=0.0))
    )
    names = robot.system.parameter_names
    plant, model = (
        dict(zip(names, p.tolist(), strict=True)) for p in (robot.plant(own), robot.model(own))
    )
    assert plant["payload"] == LOAD and model == plant | {"payload": 0.0}
    assert "payload" not in robot_for(FlexibleParameters()).system.parameter_names


# Under control ------------------------------------------------------------------------------------


def ran(output: str, load: float) -> Trajectory:
    values = {"output": output, "alpha": 0.5, "payload": load}
    return run(experiments()["flexible"].with_values(values), "path_following")


def test_twenty_grams_destabilise_half_of_the_deflection_and_not_composite_control() -> None:
    """α = 0.5 is stable for the plant that the controller knows, and only for that."""
    assert ran("redefined", 0.0).stopped_at is None
    assert (ran("redefined", 0.02).stopped_at or np.inf) < 2.5
    assert ran("composite", 0.02).stopped_at is None


@pytest.fixture
def weightless(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tip_load, "GRAVITY", 0.0)
    monkeypatch.setattr(flexible_robot, "_robot", lru_cache(flexible_robot._made))


@pytest.mark.usefixtures("weightless")
@pytest.mark.parametrize(("load", "rms", "most"), [(0.02, 0.22, 0.35), (0.1, 1.19, 2.1)])
def test_its_inertia_disturbs_composite_control_as_on_a_chain(
    load: float, rms: float, most: float
) -> None:
    """Of twenty rigid segments with exact rotations, simulated apart from this project; mm."""
    trajectory = ran("composite", load)
    distance = trajectory.distance[trajectory.t > 2] * 1e3
    assert np.sqrt((distance**2).mean()) == pytest.approx(rms, rel=0.03)
    assert distance.max() == pytest.approx(most, rel=0.03)
