"""Static friction acts in the motors, wherever B puts them."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import settings_layout
from onpath.models.closed_loop.plant_tick import move
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.forces import Grip
from onpath.models.systems.robots import RobotEntry
from onpath.models.systems.system import MechanicalSystem, mechanical_system
from tests.support.general_systems import belted_arm, thrusters

STATIC, COULOMB = 0.08, 0.05  # [N m]
Step = Callable[[Array, Array, Array], tuple[Array, Array]]


def of(entry: RobotEntry) -> tuple[MechanicalSystem, Array]:
    robot = entry.make(entry.parameters())
    return robot.system, robot.plant(entry.parameters())


SYSTEMS = {
    **{name: of(ROBOTS[name]) for name in ("five_bar", "two_link_arm", "rod_gantry")},
    "belted_arm": (belted_arm(), np.zeros(0)),
    "thrusters": (thrusters(3), np.zeros(0)),
    "two thrusters": (thrusters(2), np.zeros(0)),
}


def in_coordinates(system: MechanicalSystem, matrix: Array) -> MechanicalSystem:
    """The same robot in coordinates z, q = A z: M_z = Aᵀ M A, c_z = Aᵀ c and B_z = Aᵀ B."""
    z, w, a = ca.SX.sym("z", system.n), ca.SX.sym("w", system.n), ca.DM(matrix)
    names = "mass", "bias", "actuation", "output"
    mass, bias, actuation, output = system.function(*names)(a @ z, a @ w, system.parameters)
    return mechanical_system(
        name="same",
        q=z,
        v=w,
        parameters=system.parameters,
        parameter_names=system.parameter_names,
        mass=a.T @ mass @ a,
        bias=a.T @ bias,
        inputs=system.m,
        actuation=a.T @ actuation,
        output=output,
        potential_energy=ca.SX(0),
        ends=a.T @ system.end_forces(a @ z, a @ w),
    )


def stepper(system: MechanicalSystem, plant: Array) -> Step:
    """(q, v, u) -> (q, v) a millisecond later, with the torques u and static friction."""
    q, v, u = ca.SX.sym("q", system.n), ca.SX.sym("v", system.n), ca.SX.sym("u", system.m)
    layout = settings_layout(system, Kind("path_following"))
    symbol, settings = layout.symbols("settings")
    parts, kind = ((u, ca.SX(1)),), Kind("path_following", stiction=True)
    after = move(system, kind, {"q": q, "v": v}, settings, parts, (1, Grip()))[2]
    function = ca.Function("step", [q, v, u, symbol], [after["q"], after["v"]])
    values = {name: np.zeros(size) for name, size in layout.fields}
    values |= {"dt": np.array([1e-3]), "plant": plant}
    values |= {"stiction": np.array([STATIC]), "coulomb": np.array([COULOMB])}
    given = layout.pack(values)

    def step(q: Array, v: Array, u: Array) -> tuple[Array, Array]:
        after_q, after_v = function(q, v, u, given)
        return after_q.full()[:, 0], after_v.full()[:, 0]

    return step


def random_coordinates(system: MechanicalSystem, rng: np.random.Generator) -> Array:
    """A in q = A z: any matrix, or with fewer motors than coordinates another order and signs."""
    n = system.n
    if n == system.m:
        return np.eye(n) + rng.uniform(-0.4, 0.4, (n, n))
    return np.eye(n)[rng.permutation(n)] * rng.choice([-1.0, 1.0], n)


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_motion_is_the_same_in_all_coordinates(name: str) -> None:
    """The motors and what they drive do not depend on the choice of q, so neither does B^T v."""
    system, plant = SYSTEMS[name]
    rng = np.random.default_rng(len(name))
    moved = 0
    for _ in range(3):
        matrix = random_coordinates(system, rng)
        steps = stepper(system, plant), stepper(in_coordinates(system, matrix), plant)
        q, v = rng.uniform(-0.4, 0.4, system.n), rng.uniform(-0.2, 0.2, system.n)
        z, w = np.linalg.solve(matrix, q), np.linalg.solve(matrix, v)
        for _ in range(6):
            u = rng.uniform(-0.15, 0.15, system.m)
            for _ in range(50):
                (q, v), (z, w) = steps[0](q, v, u), steps[1](z, w, u)
            assert np.abs(q - matrix @ z).max() < 1e-9
            assert np.abs(v - matrix @ w).max() < 1e-9
            rates = system.input_rates(ca.DM(q), ca.DM(v), ca.DM(plant)).full()
            moved += int((np.abs(rates) > 1e-3).sum())
    assert moved > 5


@pytest.mark.parametrize("name", ["thrusters", "two thrusters"])
def test_motors_whose_direction_turns_stick_and_slide(name: str) -> None:
    system, plant = SYSTEMS[name]
    step, q = stepper(system, plant), np.array([0.02, -0.01, 0.6])
    at, v = q, np.zeros(3)
    u = np.array([0.99, -0.99, 0.0])[: system.m] * STATIC
    for _ in range(200):
        at, v = step(at, v, u)
    assert np.abs(at - q).max() < 1e-12 and np.abs(v).max() < 1e-12
    for _ in range(200):
        at, v = step(at, v, 1.2 * u)
    assert np.abs(at - q).max() > 1e-4
