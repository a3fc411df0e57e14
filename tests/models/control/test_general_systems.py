"""Laws of eqs. (1)-(3) with an input matrix B(q) and with more inputs than outputs."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable

import casadi as ca
import numpy as np
import pytest
from numpy.typing import ArrayLike

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import build_kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.control.linearization import linearization
from onpath.models.paths.curves import circle
from onpath.models.paths.distance import path_distance
from onpath.models.paths.frames import Plane
from onpath.models.systems.system import (
    MechanicalSystem,
    conditioning,
    decoupling_matrix,
    mechanical_system,
)
from tests.support.general_systems import belted_arm, redundant_arm, standing, thrusters

SYSTEMS = [redundant_arm(), thrusters(3), thrusters(2), belted_arm(), standing(redundant_arm())]
POSED = [standing(redundant_arm()), standing(thrusters(3))]
EACH = pytest.mark.parametrize("system", SYSTEMS, ids=lambda s: f"{s.name}-{s.m}")
WIDE = pytest.mark.parametrize("system", SYSTEMS[:2], ids=lambda s: f"{s.name}-{s.m}")
Numbers = dict[str, ArrayLike]
NO_PARAMETERS = np.zeros(0)
H = 1e-4


def inputs_for(system: MechanicalSystem) -> ca.Function:
    """(q, v, wanted y'') -> u."""
    symbols = [system.q, system.v, ca.SX.sym("wanted", system.p)]
    u = linearization(system, symbols[0], symbols[1], ca.SX(0, 1), symbols[2])
    return ca.Function("inputs", symbols, [u])


def states(system: MechanicalSystem, count: int = 40) -> list[tuple[Array, Array, Array]]:
    """Random (q, v, wanted y'') away from singular configurations."""
    rng, matrix = np.random.default_rng(7), decoupling_matrix(system)
    found = list[tuple[Array, Array, Array]]()
    while len(found) < count:
        q = rng.uniform(-3, 3, system.n)
        if conditioning(np.array(matrix(q, NO_PARAMETERS))) > 0.05:
            found.append((q, 2 * rng.normal(size=system.n), 5 * rng.normal(size=system.p)))
    return found


def numbers(system: MechanicalSystem, *names: str) -> ca.Function:
    return system.function(*names)


@EACH
def test_the_output_has_the_wanted_acceleration(system: MechanicalSystem) -> None:
    """y'' by differences along the motion that M v' + c = B u gives."""
    law, parts = inputs_for(system), numbers(system, "mass", "bias", "actuation")
    output = system.function("output")
    for q, v, wanted in states(system):
        mass, bias, actuation = (np.array(x) for x in parts(q, v, NO_PARAMETERS))
        u = np.array(law(q, v, wanted))
        acceleration = np.linalg.solve(mass, actuation @ u - bias)[:, 0]

        def y(t: float, q: Array = q, v: Array = v, a: Array = acceleration) -> Array:
            return np.array(output(q + v * t + a * t**2 / 2, v, NO_PARAMETERS))[:, 0]

        scale = 1 + np.abs(wanted).max() + v @ v
        second = (y(H) - 2 * y(0.0) + y(-H)) / H**2
        assert second == pytest.approx(wanted, abs=2e-5 * scale)


@WIDE
def test_of_all_solutions_that_of_the_least_weighted_norm_is_taken(
    system: MechanicalSystem,
) -> None:
    """τ^T M⁻¹ τ of τ = B u grows for every other u with the same D u."""
    law, matrix = inputs_for(system), decoupling_matrix(system)
    parts, rng = numbers(system, "mass", "actuation"), np.random.default_rng(3)
    for q, v, wanted in states(system):
        mass, actuation = (np.array(x) for x in parts(q, v, NO_PARAMETERS))
        wide = np.array(matrix(q, NO_PARAMETERS))
        u = np.array(law(q, v, wanted))[:, 0]
        free = np.linalg.svd(wide)[2][system.p :]  # D free^T = 0
        assert len(free) == system.m - system.p > 0
        weight = actuation.T @ np.linalg.solve(mass, actuation)
        own = u @ weight @ u
        assert np.abs(free @ weight @ u).max() < 1e-9 * (1 + np.abs(weight @ u).max())
        for size in (1e-3, 1.0):
            other = u + size * free.T @ rng.normal(size=len(free))
            assert other @ weight @ other > own


def test_with_a_motor_at_every_joint_it_is_the_operational_space_law() -> None:
    """The torques are those of a force at the tip: u = J^T F."""
    system = redundant_arm()
    law, output = inputs_for(system), system.function("output")
    for q, v, wanted in states(system, 10):
        u = np.array(law(q, v, wanted))[:, 0]
        columns = [
            (np.array(output(q + H * e, v, [])) - np.array(output(q - H * e, v, []))) / (2 * H)
            for e in np.eye(3)
        ]
        jacobian = np.hstack(columns)
        force = np.linalg.lstsq(jacobian.T, u, rcond=None)[0]
        assert jacobian.T @ force == pytest.approx(u, abs=1e-5 * np.abs(u).max())


@pytest.mark.parametrize("posed", POSED, ids=lambda s: s.name)
def test_a_posture_only_adds_what_does_not_move_the_end_point(posed: MechanicalSystem) -> None:
    """u - u_least is the part of u0 in the null space of D that is W-orthogonal to the rest."""
    assert posed.posture is not None
    plain = dataclasses.replace(posed, posture=None)
    wanted_posture = ca.Function("posture", [posed.q, posed.v], [posed.posture])
    with_posture, without = inputs_for(posed), inputs_for(plain)
    parts, matrix = numbers(posed, "mass", "actuation"), decoupling_matrix(posed)
    for q, v, wanted in states(posed):
        mass, actuation = (np.array(x) for x in parts(q, v, NO_PARAMETERS))
        weight = actuation.T @ np.linalg.solve(mass, actuation)
        added = (np.array(with_posture(q, v, wanted)) - np.array(without(q, v, wanted)))[:, 0]
        wide = np.array(matrix(q, NO_PARAMETERS))
        scale = np.abs(added).max()
        assert scale > 1e-3 and np.abs(wide @ added).max() < 1e-8 * np.abs(wide).max() * scale
        free = np.linalg.svd(wide)[2][posed.p :].T
        u0 = np.array(wanted_posture(q, v))[:, 0]
        best = free @ np.linalg.solve(free.T @ weight @ free, free.T @ weight @ u0)
        assert added == pytest.approx(best, abs=1e-8 * (1 + np.abs(u0).max()))


@EACH
def test_the_inputs_do_the_work_of_their_generalized_forces(system: MechanicalSystem) -> None:
    n, none = system.n, ca.SX(0, 1)
    q, v, u = (ca.SX.sym(name, size) for name, size in (("q", n), ("v", n), ("u", system.m)))
    effort, rates = system.effort(q, u, none), system.input_rates(q, v, none)
    power = ca.Function("power", [q, v, u], [ca.dot(effort, v), ca.dot(u, rates)])
    rng = np.random.default_rng(1)
    for _ in range(20):
        mechanical, motors = power(*(rng.normal(size=x.numel()) for x in (q, v, u)))
        assert float(mechanical) == pytest.approx(float(motors), abs=1e-12)


@EACH
@pytest.mark.parametrize("free", [False, True])
def test_on_the_circle_with_the_velocity_along_it_it_stays_there(
    system: MechanicalSystem, free: bool
) -> None:
    """The whole loop: the error is that of the sampling, and falls with the square of the tick."""
    kernel = build_kernel(system, Plane(), Kind("path_following", free=free))
    curve, worst = circle(0.03), list[float]()
    for dt in (1e-3, 5e-4):
        settings = kernel.settings.pack(rest_of_settings(system, dt))
        state = kernel.state.pack(on_the_circle(system, kernel.state.fields, 0.03))
        _, rows = InterpretedLoop(kernel).run(state, settings, curve.table(), round(0.6 / dt))
        log = kernel.log.unpack(rows)
        worst.append(float(path_distance(Plane(), curve, log["y"]).max()))
        assert np.ptp(log["theta"]) > 3.0
    assert worst[0] < 3e-5
    assert worst[1] < 0.4 * worst[0]


def rest_of_settings(system: MechanicalSystem, dt: float) -> Numbers:
    kernel_fields = build_kernel(system, Plane(), Kind("path_following")).settings.fields
    values: Numbers = {name: np.zeros(size) for name, size in kernel_fields}
    gains: Numbers = {"K1": 400.0, "K2": 40.0, "K5": 10.0, "speed": 6.0}
    other: Numbers = {
        "torque_limit": 1e3,
        "speed_limit": 1e3,
        "hold_ticks": 1.0,
        "dt": dt,
        "look_ahead": dt / 2,
        "encoder_step": 1.0,
    }
    conic: Numbers = {"level_weights": np.array([1.0, 1.0, 0.0]), "level_constant": 1.0}
    return values | gains | other | conic


def on_the_circle(
    system: MechanicalSystem, fields: Iterable[tuple[str, int]], radius: float
) -> Numbers:
    """The state at θ = 0 with θ' = 6 rad/s, by Newton's method for h(q) = (r, 0)."""
    output, wanted = system.function("output"), np.array([radius, 0.0])
    poses = {"redundant_arm": [0.3, 0.9, -1.2], "belted_arm": [1.6, -1.6]}
    poses["standing_redundant_arm"] = poses["redundant_arm"]
    q, still = np.array(poses.get(system.name, [0.0] * 3)), np.zeros(system.n)
    jacobian = ca.Function("jacobian", [system.q], [ca.jacobian(system.output, system.q)])
    for _ in range(50):
        gap = wanted - np.array(output(q, still, NO_PARAMETERS))[:, 0]
        q = q + np.linalg.lstsq(np.array(jacobian(q)), gap, rcond=None)[0]
    v = np.linalg.lstsq(np.array(jacobian(q)), np.array([0.0, 6.0 * radius]), rcond=None)[0]
    start: Numbers = {"q": q, "v": v, "theta_rate": 6.0, "speed_ref": 6.0}
    return {name: np.zeros(size) for name, size in fields} | start


@pytest.mark.parametrize("inputs", [1, 4])
def test_too_few_or_too_many_inputs_are_refused(inputs: int) -> None:
    with pytest.raises(ValueError, match="2 to 3 columns"):
        _with(inputs, None)


def test_an_input_matrix_of_another_shape_is_refused() -> None:
    with pytest.raises(ValueError, match="3 rows"):
        _with(2, ca.SX.eye(3))


def _with(inputs: int, actuation: ca.SX | None) -> MechanicalSystem:
    q, v = ca.SX.sym("q", 3), ca.SX.sym("v", 3)
    return mechanical_system(
        name="body",
        q=q,
        v=v,
        parameters=ca.SX(0, 1),
        parameter_names=(),
        mass=ca.SX.eye(3),
        bias=0 * v,
        inputs=inputs,
        actuation=actuation,
        output=q[:2],
        potential_energy=ca.SX(0),
    )
