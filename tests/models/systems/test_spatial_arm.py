"""Laws of the spatial arm: equations against moving points, poses, experiments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.control.rank_test import rank_number
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import circle
from onpath.models.paths.path_design import presets
from onpath.models.paths.space_curves import saddle
from onpath.models.studies.experiments import experiments, run
from onpath.models.systems.spatial_arm import (
    LINKS,
    MIDDLE,
    SINGULAR,
    SPATIAL_ARM,
    SpatialParameters,
)
from onpath.models.systems.system import GRAVITY
from tests.support.drawing import drawn

ARM = SPATIAL_ARM
SYSTEM, DEFAULTS = ARM.system, SpatialParameters()
PLANT = ARM.plant(DEFAULTS)
STEP = 1e-4
angles, rates = st.floats(-3.1, 3.1), st.floats(-4, 4)
triples = st.tuples(angles, angles, angles).map(np.array)
velocities = st.tuples(rates, rates, rates).map(np.array)


def numbers(name: str, q: Array, v: Array, parameters: Array = PLANT) -> Array:
    return SYSTEM.function(name)(q, v, parameters).full()


# The equations against moving points --------------------------------------------------------------


def points(q: Array, payload: float) -> list[tuple[float, Array]]:
    """(mass, place) of points that have the links' masses, centres and inertias.

    Two points of half a link's mass at sqrt(I / m) to both sides of its centre have its inertia.
    """
    ahead = np.array([np.cos(q[0]), np.sin(q[0]), 0.0])
    upper, fore = (np.cos(a) * ahead + np.array([0.0, 0.0, np.sin(a)]) for a in (q[1], q[1] + q[2]))
    elbow = LINKS.l2 * upper
    found = [(LINKS.motor, elbow), (payload, elbow + LINKS.l3 * fore), (LINKS.I1, ahead)]
    links = (
        (LINKS.m2, LINKS.r2, LINKS.I2, 0 * elbow, upper),
        (LINKS.m3, LINKS.r3, LINKS.I3, elbow, fore),
    )
    for m, r, inertia, begin, way in links:
        gyration = np.sqrt(inertia / m)
        found += [(m / 2, begin + (r + side * gyration) * way) for side in (-1, 1)]
    return found


def lagrangian(q: Array, v: Array, payload: float) -> float:
    """Of the points, whose velocities are differences of their places."""
    later, before = points(q + STEP * v, payload), points(q - STEP * v, payload)
    speeds = [(b - a) / (2 * STEP) for (_, a), (_, b) in zip(before, later, strict=True)]
    now = points(q, payload)
    kinetic = sum(m / 2 * s @ s for (m, _), s in zip(now, speeds, strict=True))
    return float(kinetic - GRAVITY * sum(m * place[2] for m, place in now))


@pytest.mark.parametrize("payload", [0.0, 0.2])
@given(q=triples, v=velocities)
def test_energy_is_that_of_points_that_move_as_the_links_do(q: Array, v: Array, payload: float):
    plant = ARM.plant(replace(DEFAULTS, payload=payload))
    kinetic = v @ numbers("mass", q, v, plant) @ v / 2
    potential = float(numbers("energy", q, 0 * v, plant)[0, 0])
    assert kinetic - potential == pytest.approx(lagrangian(q, v, payload), abs=2e-6, rel=1e-6)


@given(q=triples, v=velocities, a=velocities)
def test_equations_are_lagrange_s_for_those_points(q: Array, v: Array, a: Array) -> None:
    """d/dt dL/dv - dL/dq by differences along q(t) = q + v t + a t^2 / 2."""
    h, own = 1e-3, np.eye(3)

    def momentum(t: float) -> Array:
        there, rate = q + v * t + a * t**2 / 2, v + a * t
        ends = [
            lagrangian(there, rate + h * e, 0) - lagrangian(there, rate - h * e, 0) for e in own
        ]
        return np.array(ends) / (2 * h)

    turning = (momentum(h) - momentum(-h)) / (2 * h)
    slope = [(lagrangian(q + h * e, v, 0.0) - lagrangian(q - h * e, v, 0.0)) / (2 * h) for e in own]
    friction = np.array([LINKS.b1, LINKS.b2, LINKS.b3]) * v
    tau = numbers("mass", q, v) @ a + numbers("bias", q, v)[:, 0]
    np.testing.assert_allclose(tau, turning - slope + friction, atol=3e-4, rtol=3e-4)


@given(q=triples)
def test_mass_matrix_is_symmetric_and_positive_definite(q: Array) -> None:
    mass = numbers("mass", q, np.zeros(3))
    assert np.array_equal(mass, mass.T)
    assert np.linalg.eigvalsh(mass).min() > 1e-4


# Where it is --------------------------------------------------------------------------------------


@given(y=st.tuples(*[st.floats(-0.08, 0.08)] * 3).map(np.array))
def test_rest_is_the_inverse_of_the_end_point_with_the_elbow_up(y: Array) -> None:
    q = ARM.rest(y)
    np.testing.assert_allclose(ARM.endpoint(q), y, atol=1e-12)
    assert -np.pi < q[2] < 0
    assert numbers("output", q, 0 * q)[:, 0] == pytest.approx(y, abs=1e-12)


def test_beyond_its_reach_there_is_no_pose() -> None:
    least, most = abs(LINKS.l2 - LINKS.l3), ARM.reach
    base, rng = -np.array(MIDDLE), np.random.default_rng(0)
    for way in rng.normal(size=(20, 3)):
        way /= np.linalg.norm(way)
        for inside, outside in ((most - 1e-6, most + 1e-6), (least + 1e-6, least - 1e-6)):
            ARM.rest(base + inside * way)
            assert ARM.margin((base + outside * way)[None])[0] == 0
            with pytest.raises(ValueError, match="out of reach"):
                ARM.rest(base + outside * way)


@given(q=triples)
def test_margin_is_the_jacobian_s_determinant_in_parts_of_that_at_home(q: Array) -> None:
    h, home = 1e-6, ARM.rest(np.zeros(3))

    def determinant(at: Array) -> float:
        ends = [(ARM.endpoint(at + h * e) - ARM.endpoint(at - h * e)) / (2 * h) for e in np.eye(3)]
        return abs(float(np.linalg.det(np.column_stack(ends))))

    assume(determinant(q) > 1e-4)
    expected = determinant(q) / determinant(home)
    assert ARM.margin(ARM.endpoint(q)[None])[0] == pytest.approx(expected, abs=1e-4)


def test_the_rank_test_fails_where_it_is_stretched_folded_or_above_its_base() -> None:
    def across(q2: float, q3: float) -> float:
        return LINKS.l2 * np.cos(q2) + LINKS.l3 * np.cos(q2 + q3)

    above = -2 * np.arctan(LINKS.l2 / LINKS.l3)  # q3 with q2 such that the end-point is on the axis
    q2 = np.arctan2(LINKS.l2 + LINKS.l3 * np.cos(above), LINKS.l3 * np.sin(above)) % np.pi
    assert across(q2, above) == pytest.approx(0.0, abs=1e-12)
    for singular in ([0.3, 0.5, 0.0], [0.3, 0.5, np.pi], [0.3, q2, above]):
        q = np.array(singular)
        assert rank_number(ARM, DEFAULTS, q) < 1e-9
        assert rank_number(ARM, DEFAULTS, q + [0.0, 0.2, -0.3]) > 1e-3
        assert ARM.fault(q[None], np.zeros((1, 3)), DEFAULTS) == (0, SINGULAR)


@given(q=triples)
def test_bars_join_at_the_elbow_and_end_at_the_end_point(q: Array) -> None:
    bars, joints = drawn(ARM.skeleton, q, 1.0)
    np.testing.assert_allclose(bars[0, 1], bars[1, 0])
    np.testing.assert_allclose(joints, [bars[0, 0], bars[1, 0]])
    lengths = np.linalg.norm(bars[:, 1] - bars[:, 0], axis=1)
    np.testing.assert_allclose(lengths, [LINKS.l2, LINKS.l3])
    np.testing.assert_allclose(bars[-1, 1], ARM.position(ARM.endpoint(q)), atol=1e-12)
    np.testing.assert_allclose(ARM.output_at(bars[-1, 1]), ARM.endpoint(q), atol=1e-12)


def test_presets_can_be_followed_also_as_saddles() -> None:
    for name, design in presets().items():
        assert curve_faults(ARM.margin, design.curve) == [], name
        assert curve_faults(ARM.margin, saddle(design.curve, 0.02)) == [], name
    assert any("workspace" in str(fault.reason) for fault in curve_faults(ARM.margin, circle(0.3)))


def test_a_wrong_model_is_the_controller_s_alone() -> None:
    wrong = replace(DEFAULTS, error_weights=10.0, error_inertias=-20.0, payload=0.1)
    believed = dict(zip(SYSTEM.parameter_names, ARM.model(wrong), strict=True))
    true = dict(zip(SYSTEM.parameter_names, PLANT, strict=True))
    assert believed["g2"] == pytest.approx(1.1 * true["g2"])
    assert believed["k"] == pytest.approx(0.8 * true["k"])
    assert (ARM.model(replace(DEFAULTS, payload=0.1)) == PLANT).all()
    assert ARM.plant(wrong)[1] > PLANT[1]


# Under control ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["obstruction", "saddle"])
def test_held_from_3_to_5_s_only_the_tracker_leaves_the_path(name: str) -> None:
    chosen = experiments("spatial_arm")[name]
    off = {}
    for law in ("path_following", "trajectory_tracking"):
        log = run(chosen, law)
        assert log.stopped_at is None
        off[law] = log.distance[log.held].max()
        assert log.distance[(log.t > 1.0) & (log.t < 3.0)].max() < 1e-5
        height = np.ptp(log.fields["y"][log.t < 3.0, 2])
        assert height == pytest.approx(0.06 if name == "saddle" else 0.0, abs=2e-4)
    assert off["path_following"] < 5e-3
    assert 0.045 < off["trajectory_tracking"] < 0.052


def test_a_rise_is_set_by_its_name_and_begins_on_the_path() -> None:
    chosen = experiments("spatial_arm")["obstruction"].with_values(
        {"rise": "0.02", "duration": 0.2}
    )
    log = run(chosen, "path_following")
    assert log.fields["y"][0] == pytest.approx([0.05, 0.0, 0.02])
    assert chosen.curve().dimension == 3
    with pytest.raises(ValueError, match="rise"):
        chosen.with_values({"rise": "0.2"})
