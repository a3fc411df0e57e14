"""Laws of the two-link arm: equations against moving points, poses, and when it is stopped."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.control.rank_test import rank_number
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import circle
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import experiments, run
from onpath.models.systems.system import GRAVITY
from onpath.models.systems.two_link_arm import LINKS, SINGULAR, TWO_LINK_ARM, TwoLinkParameters
from tests.support.drawing import drawn

ARM = TWO_LINK_ARM
SYSTEM, DEFAULTS = ARM.system, TwoLinkParameters()
PLANT = ARM.plant(DEFAULTS)
STEP = 1e-4
angles, rates = st.floats(-3.1, 3.1), st.floats(-5, 5)
pairs = st.tuples(angles, angles).map(np.array)
velocities = st.tuples(rates, rates).map(np.array)


def numbers(name: str, q: Array, v: Array, parameters: Array = PLANT) -> Array:
    return SYSTEM.function(name)(q, v, parameters).full()


# The equations against moving points --------------------------------------------------------------


def points(q: Array, payload: float) -> list[tuple[float, Array]]:
    """(mass, place) of points that have the links' masses, centres and inertias.

    Two points of half a link's mass at sqrt(I / m) to both sides of its centre have its inertia.
    """
    along = [np.array([np.cos(a), np.sin(a)]) for a in (q[0], q[0] + q[1])]
    elbow = LINKS.l1 * along[0]
    found = [(LINKS.motor, elbow), (payload, elbow + LINKS.l2 * along[1])]
    links = ((LINKS.m1, LINKS.r1, LINKS.I1, 0 * elbow), (LINKS.m2, LINKS.r2, LINKS.I2, elbow))
    for (m, r, inertia, begin), way in zip(links, along, strict=True):
        gyration = np.sqrt(inertia / m)
        found += [(m / 2, begin + (r + side * gyration) * way) for side in (-1, 1)]
    return found


def lagrangian(q: Array, v: Array, payload: float) -> float:
    """Of the points, whose velocities are differences of their places."""
    later, before = points(q + STEP * v, payload), points(q - STEP * v, payload)
    speeds = [(b - a) / (2 * STEP) for (_, a), (_, b) in zip(before, later, strict=True)]
    now = points(q, payload)
    kinetic = sum(m / 2 * s @ s for (m, _), s in zip(now, speeds, strict=True))
    return float(kinetic - GRAVITY * sum(m * place[1] for m, place in now))


@pytest.mark.parametrize("payload", [0.0, 0.2])
@given(q=pairs, v=velocities)
def test_energy_is_that_of_points_that_move_as_the_links_do(q: Array, v: Array, payload: float):
    plant = ARM.plant(replace(DEFAULTS, payload=payload))
    kinetic = v @ numbers("mass", q, v, plant) @ v / 2
    potential = float(numbers("energy", q, 0 * v, plant)[0, 0])
    assert kinetic - potential == pytest.approx(lagrangian(q, v, payload), abs=2e-6, rel=1e-6)


@given(q=pairs, v=velocities, a=velocities)
def test_equations_are_lagrange_s_for_those_points(q: Array, v: Array, a: Array) -> None:
    """d/dt dL/dv - dL/dq by differences along q(t) = q + v t + a t^2 / 2."""
    h = 1e-3
    own = np.eye(2)

    def momentum(t: float) -> Array:
        there, rate = q + v * t + a * t**2 / 2, v + a * t
        ends = [(lagrangian(there, rate + s * h * e, 0.0)) for e in own for s in (-1, 1)]
        return np.array([(ends[1] - ends[0]), (ends[3] - ends[2])]) / (2 * h)

    turning = (momentum(h) - momentum(-h)) / (2 * h)
    slope = [(lagrangian(q + h * e, v, 0.0) - lagrangian(q - h * e, v, 0.0)) / (2 * h) for e in own]
    friction = np.array([LINKS.b1, LINKS.b2]) * v
    expected = turning - slope + friction
    tau = numbers("mass", q, v) @ a + numbers("bias", q, v)[:, 0]
    np.testing.assert_allclose(tau, expected, atol=2e-4, rtol=2e-4)


@given(q=pairs)
def test_mass_matrix_is_symmetric_and_positive_definite(q: Array) -> None:
    mass = numbers("mass", q, np.zeros(2))
    assert mass[0, 1] == mass[1, 0]
    assert np.linalg.eigvalsh(mass).min() > 1e-4


@given(q=pairs, v=velocities, x=velocities)
def test_rate_of_the_mass_matrix_less_twice_christoffel_s_is_skew(q: Array, v: Array, x: Array):
    """x^T (M' - 2 C) x = 0, with C from Christoffel's symbols; C v is in the bias."""

    def mass(at: Array) -> Array:
        return numbers("mass", at, np.zeros(2))

    h = 1e-5
    slopes = [(mass(q + h * e) - mass(q - h * e)) / (2 * h) for e in np.eye(2)]  # dM/dq_k
    christoffel = np.zeros((2, 2))
    for i in range(2):
        for j in range(2):
            for k in range(2):
                both = slopes[k][i, j] + slopes[j][i, k] - slopes[i][j, k]
                christoffel[i, j] += both * v[k] / 2
    rate = slopes[0] * v[0] + slopes[1] * v[1]
    assert x @ (rate - 2 * christoffel) @ x == pytest.approx(0.0, abs=1e-7)
    weights = numbers("bias", q, np.zeros(2))[:, 0]
    friction = np.array([LINKS.b1, LINKS.b2]) * v
    turning = numbers("bias", q, v)[:, 0] - weights - friction
    np.testing.assert_allclose(turning, christoffel @ v, atol=1e-7)


def test_energy_is_kept_but_for_friction_and_torque() -> None:
    """Integrated finely, without friction and torque, from a fall."""
    values = LINKS.lumped() | {"b1": 0.0, "b2": 0.0}
    plant = SYSTEM.parameter_vector(values)
    drift = SYSTEM.function("drift")
    energy = SYSTEM.function("energy")

    def rate(x: Array) -> Array:
        return np.concatenate([x[2:], drift(x[:2], x[2:], plant).full()[:, 0]])

    x, dt = np.array([1.2, -1.0, 0.5, -1.5]), 1e-3
    energies = [float(energy(x[:2], x[2:], plant))]
    for _ in range(1000):
        k1 = rate(x)
        k2 = rate(x + dt / 2 * k1)
        k3 = rate(x + dt / 2 * k2)
        k4 = rate(x + dt * k3)
        x = x + dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        energies.append(float(energy(x[:2], x[2:], plant)))
    assert np.ptp(energies) < 1e-8
    assert np.abs(x[2:]).max() > 1.0  # it did fall


# Where it is --------------------------------------------------------------------------------------


@given(z=st.tuples(st.floats(-0.08, 0.08), st.floats(-0.08, 0.08)).map(np.array))
def test_rest_is_the_inverse_of_the_end_point_with_the_elbow_up(z: Array) -> None:
    q = ARM.rest(z)
    np.testing.assert_allclose(ARM.endpoint(q), z, atol=1e-12)
    assert -np.pi < q[1] < 0
    assert np.array(SYSTEM.function("output")(q, 0 * q, PLANT))[:, 0] == pytest.approx(z, abs=1e-12)


@given(q=st.tuples(angles, st.floats(-3.1, -0.05)).map(np.array))
def test_every_pose_with_the_elbow_up_is_found_again(q: Array) -> None:
    back = ARM.rest(ARM.endpoint(q))
    assert np.exp(1j * back) == pytest.approx(np.exp(1j * q), abs=1e-6)


def test_beyond_its_reach_there_is_no_pose() -> None:
    least, most = abs(LINKS.l1 - LINKS.l2), ARM.reach
    base = -np.array([LINKS.l2, LINKS.l1])
    for angle in np.linspace(-3, 3, 13):
        way = np.array([np.cos(angle), np.sin(angle)])
        for inside, outside in ((most - 1e-6, most + 1e-6), (least + 1e-6, least - 1e-6)):
            ARM.rest(base + inside * way)
            assert ARM.margin((base + outside * way)[None])[0] == 0
            with pytest.raises(ValueError, match="out of reach"):
                ARM.rest(base + outside * way)


@given(q=pairs)
def test_margin_is_the_jacobian_s_determinant_in_parts_of_its_largest(q: Array) -> None:
    h = 1e-6
    columns = [(ARM.endpoint(q + h * e) - ARM.endpoint(q - h * e)) / (2 * h) for e in np.eye(2)]
    determinant = abs(np.linalg.det(np.column_stack(columns))) / (LINKS.l1 * LINKS.l2)
    assume(determinant > 1e-3)
    assert ARM.margin(ARM.endpoint(q)[None])[0] == pytest.approx(determinant, abs=1e-5)


@pytest.mark.parametrize("q2", [0.0, np.pi, -np.pi])
def test_the_rank_test_fails_only_where_the_arm_is_stretched_or_folded(q2: float) -> None:
    for q1 in np.linspace(-3, 3, 7):
        assert rank_number(ARM, DEFAULTS, np.array([q1, q2])) < 1e-12
        assert rank_number(ARM, DEFAULTS, np.array([q1, q2 + 0.3])) > 1e-3


@given(q=pairs)
def test_bars_join_at_the_elbow_and_end_at_the_end_point(q: Array) -> None:
    bars, joints = drawn(ARM.skeleton, q, 1.0)
    np.testing.assert_allclose(bars[0, 1], bars[1, 0])
    np.testing.assert_allclose(joints, [bars[0, 0], bars[1, 0]])
    lengths = np.linalg.norm(bars[:, 1] - bars[:, 0], axis=1)
    np.testing.assert_allclose(lengths, [LINKS.l1, LINKS.l2])
    np.testing.assert_allclose(bars[-1, 1], ARM.position(ARM.endpoint(q)), atol=1e-12)
    np.testing.assert_allclose(ARM.output_at(bars[-1, 1]), ARM.endpoint(q), atol=1e-12)


def test_presets_can_be_followed_and_a_path_beyond_its_reach_is_refused_in_words() -> None:
    for name, design in presets().items():
        assert curve_faults(ARM.margin, design.curve) == [], name
    far = circle(0.3)
    assert any("workspace" in str(fault.reason) for fault in curve_faults(ARM.margin, far))


# Under control ------------------------------------------------------------------------------------


def test_on_the_circle_held_from_3_to_5_s_only_the_tracker_leaves_the_path() -> None:
    """Experiment 2: r = 50 mm about the middle, 6.28 rad/s, the brake where the robot is at 3 s."""
    chosen = experiments("two_link_arm")["obstruction"]
    off = {}
    for name in ("path_following", "trajectory_tracking"):
        log = run(chosen, name)
        assert log.stopped_at is None
        off[name] = np.abs(log.distance[log.held]).max()
        free = np.abs(log.distance[(log.t > 1.0) & (log.t < 3.0)]).max()
        assert free < 1e-5
    assert off["path_following"] == pytest.approx(2.7e-3, abs=0.05e-3)
    assert off["trajectory_tracking"] == pytest.approx(48.5e-3, abs=0.2e-3)


@pytest.mark.parametrize("pulled", [True, False])
@pytest.mark.parametrize("name", ["path_following", "trajectory_tracking"])
def test_it_is_stopped_before_it_is_stretched_and_says_why(name: str, pulled: bool) -> None:
    """A hand pulls it out of its reach, or its path leads there; the motors give 3 N m at most."""
    limited = replace(DEFAULTS, torque_limit=3.0, speed=1.0)
    parameters, curve, push = limited, circle(0.2), FREE
    if pulled:
        parameters = replace(limited, task="position", target=0.0, K1=50.0, K2=5.0, K4=5.0, K5=2.0)
        curve, push = circle(0.05), Push(hand=np.array([0.3, 0.3]))
    kernel = kernel_of(ARM, kind_of(name, parameters, curve, push))
    settings = settings_vector(ARM, kernel, parameters, curve, push)
    state = first_state(ARM, kernel, curve, ARM.rest(curve.at(np.array(-np.pi / 2))))
    _, rows = InterpretedLoop(kernel).run(state, settings, curve.table(), 4000)
    fields = kernel.log.unpack(rows)
    found = ARM.fault(fields["q"], fields["v"], parameters)
    assert found is not None and found[1] == SINGULAR
    before = slice(0, found[0])
    assert np.isfinite(rows[before]).all()
    assert (np.sin(fields["q"][before, 1]) <= -0.02).all()


def test_faults_are_those_of_every_robot_too() -> None:
    q, v = np.tile(ARM.rest(np.zeros(2)), (3, 1)), np.zeros((3, 2))
    assert ARM.fault(q, v, DEFAULTS) is None
    v[1, 0] = 200.0
    found = ARM.fault(q, v, DEFAULTS)
    assert found is not None and found[0] == 1 and "faster" in str(found[1])
    q[2] = np.nan
    found = ARM.fault(q, 0 * v, DEFAULTS)
    assert found is not None and found[0] == 2 and "range" in str(found[1])


def test_a_wrong_model_is_the_controller_s_alone() -> None:
    wrong = replace(DEFAULTS, error_gravity=10.0, error_inertia=-20.0, payload=0.1)
    believed = dict(zip(SYSTEM.parameter_names, ARM.model(wrong), strict=True))
    true = dict(zip(SYSTEM.parameter_names, PLANT, strict=True))
    assert believed["g1"] == pytest.approx(1.1 * true["g1"])
    assert believed["a3"] == pytest.approx(0.8 * true["a3"])
    assert (ARM.model(replace(DEFAULTS, payload=0.1)) == PLANT).all()
    assert ARM.plant(wrong)[0] > PLANT[0]
