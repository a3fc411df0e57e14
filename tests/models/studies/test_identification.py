"""Least squares finds the robot: exactly, with honest errors, or it says why not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.identification.identify import MOST_TICKS, last_record
from onpath.app.lab.lab import Lab
from onpath.models.arrays import Array
from onpath.models.paths.curves import Curve, circle
from onpath.models.studies.identification import (
    ALL,
    BALANCE,
    DRY,
    INERTIA,
    JointRecord,
    identify,
    joint_torques,
    simplest,
    smooth_velocities,
)
from tests.support.lab import FOLLOWER, do, new_lab, replayed, run
from tests.support.rig import FOLLOWING, Rig, jacobian

COULOMB = 0.04


def recorded(rig: Rig, curve: Curve, seconds: float = 4.0, **changes: Any) -> JointRecord:
    """The follower starts at rest off the path and changes its speed halfway."""
    log, ticks = list[dict[str, Array]](), round(seconds * 500)
    state = rig.state(FOLLOWING, curve.at(np.array(0.3)) + 0.01, theta=0.3, theta_ref=0.3)
    for speed in (4.0, 8.0):
        settings = rig.settings(FOLLOWING, speed=speed, **changes)
        state, rows = rig.loop(FOLLOWING).run(state, settings, curve.table(), ticks)
        log.append(rig.kernel(FOLLOWING).log.unpack(rows))
    q, v, u, force = [np.concatenate([part[f] for part in log]) for f in ("q", "v", "u", "force")]
    return JointRecord(1e-3, q, v, u + joint_torques(q, force, 0.2, 0.2))


def true_values(rig: Rig, plant: Array) -> dict[str, float]:
    return dict(zip(rig.system.parameter_names, plant.tolist(), strict=True))


def noisy(record: JointRecord, seed: int) -> JointRecord:
    """Angles and torques with white noise of some size."""
    rng = np.random.default_rng(seed)
    q = record.q + 1e-3 * rng.normal(size=record.q.shape)
    torque = record.torque + 0.02 * rng.normal(size=q.shape)
    return JointRecord(record.dt, q, smooth_velocities(q, record.dt), torque)


def wave(amplitude: float, torque_noise: float = 0.0) -> JointRecord:
    """Both joints of a balanced linkage oscillate at one frequency about home."""
    t, omega = 1e-3 * np.arange(4001), 2 * np.pi
    q = [np.pi / 2, np.pi] + amplitude * np.stack([np.sin(omega * t), np.cos(omega * t)], axis=1)
    v = amplitude * omega * np.stack([np.cos(omega * t), -np.sin(omega * t)], axis=1)
    gained, turned = np.diff(v, axis=0) / 1e-3, np.diff(q, axis=0) / 1e-3  # means over a step
    noise = torque_noise * np.random.default_rng(1).normal(size=gained.shape)
    torque = [0.0226, 0.012] * gained + [0.05, 0.03] * turned + noise
    return JointRecord(1e-3, q[:-1], v[:-1], torque)


@pytest.mark.parametrize("seed", range(4))
def test_exact_data_give_the_exact_model(
    rig: Rig, random_curve: Callable[[int], Curve], seed: int
) -> None:
    wrong = rig.balanced * np.random.default_rng(seed).uniform(0.7, 1.3, rig.balanced.size)
    wrong[-2:] = rig.balanced[-2:]  # the lengths are known
    found = identify(recorded(rig, random_curve(seed), model=wrong))
    true = true_values(rig, rig.balanced)
    assert set(found.values) == set(INERTIA)
    for name in INERTIA:
        assert found.values[name] == pytest.approx(true[name], rel=1e-8)
    assert found.unexplained < 1e-8


@pytest.mark.parametrize("seed", range(4))
def test_so_they_do_out_of_balance_and_with_dry_friction(
    rig: Rig, random_curve: Callable[[int], Curve], seed: int
) -> None:
    record = recorded(rig, random_curve(seed), plant=rig.spoiled, coulomb=COULOMB, K5=40)
    found = identify(record, ALL)
    true = true_values(rig, rig.spoiled) | dict.fromkeys(DRY, COULOMB)
    for name in ALL:
        assert found.values[name] == pytest.approx(true[name], rel=2e-4)


def test_force_at_the_end_point_enters_as_the_jacobian_says() -> None:
    rng = np.random.default_rng(0)
    q, force = rng.uniform(0, 3, (20, 2)), rng.normal(size=(20, 2))
    expected = [jacobian(a).T @ f for a, f in zip(q, force, strict=True)]
    np.testing.assert_allclose(joint_torques(q, force, 0.2, 0.2), expected, atol=1e-15)


@pytest.mark.parametrize(
    "push",
    [
        {"hold_active": 1, "hold_anchor": (0.045, 0.02), "hold_tangent": (-0.4, 0.9)},
        {"hand_active": 1, "hand_target": (0.03, -0.04)},
    ],
)
def test_known_forces_leave_no_bias(rig: Rig, push: dict[str, Any]) -> None:
    pushed, true = recorded(rig, circle(0.05), **push), true_values(rig, rig.balanced)
    found = identify(pushed)
    for name in INERTIA:
        assert found.values[name] == pytest.approx(true[name], rel=1e-5)


@pytest.mark.parametrize("names", [INERTIA, ALL])
def test_standard_errors_cover_the_truth(rig: Rig, names: tuple[str, ...]) -> None:
    record = recorded(rig, circle(0.06), coulomb=COULOMB if names == ALL else 0.0)
    true = true_values(rig, rig.balanced) | dict.fromkeys(DRY, COULOMB)
    results = [identify(noisy(record, seed), names) for seed in range(60)]
    for name in names:
        z = [(r.values[name] - true[name]) / r.errors[name] for r in results]
        assert 0.7 < np.sqrt(np.mean(np.square(z))) < 1.4, name


def test_four_times_the_data_halve_the_error(rig: Rig) -> None:
    def spread(seconds: float) -> Array:
        record = recorded(rig, circle(0.06), seconds)
        found = [identify(noisy(record, seed)) for seed in range(40)]
        return np.std([[r.values[name] for name in INERTIA] for r in found], axis=0)

    ratio = spread(12.0) / spread(3.0)
    assert np.all((ratio > 0.3) & (ratio < 0.75)), ratio


def test_poor_excitation_is_refused(rig: Rig) -> None:
    still = replace(wave(0.0), torque=np.full((4000, 2), 0.3))
    for record in (still, noisy(still, 1)):
        with pytest.raises(ValueError, match="hardly moved"):
            identify(record)
    with pytest.raises(ValueError, match="cannot be told"):
        identify(wave(0.011, torque_noise=2.0))
    with pytest.raises(ValueError, match=r"only 0\.9 s"):
        identify(recorded(rig, circle(0.05), 0.9))
    with pytest.raises(ValueError, match="apart"):
        identify(replace(wave(0.1), dt=0.1))


def test_one_small_wave_cannot_tell_gravity_from_inertia() -> None:
    regular = wave(0.011)
    with pytest.raises(ValueError, match="too regular"):
        identify(regular, ALL)
    within_a_step = (2 * np.pi * regular.dt) ** 2 / 12  # this torque is not held over a step
    assert identify(regular).values["M11"] == pytest.approx(0.0226, rel=1.1 * within_a_step)


def test_it_uses_no_more_terms_than_the_data_need(rig: Rig) -> None:
    def chosen(**changes: Any) -> set[str]:
        return set(simplest(recorded(rig, circle(0.05), K5=40, **changes)).values)

    heavy = rig.system.parameter_vector(rig.links.spoiled(0.5, 0.0).lumped())
    assert chosen() == set(INERTIA)
    assert chosen(coulomb=COULOMB) == {*INERTIA, *DRY}
    assert chosen(plant=heavy) == {*INERTIA, *BALANCE}
    assert chosen(plant=heavy, coulomb=COULOMB) == set(ALL)
    noise = noisy(recorded(rig, circle(0.05)), 3)
    assert set(simplest(noise).values) == set(INERTIA)


# In the lab


def made_lab(seconds: float = 5.0, **parameters: Any) -> Lab:
    """A lab that has run with some parameters and changed its speed on the way."""
    lab = new_lab()
    do(lab, *[c.Set(name, value) for name, value in parameters.items()])
    run(lab, seconds * 0.6)
    do(lab, c.Set("speed", 9.0))
    run(lab, seconds * 0.4)
    return lab


def errors(lab: Lab) -> Array:
    return np.array([getattr(lab.simulation.parameters, f"error_{name}") for name in INERTIA])


def worst(lab: Lab) -> float:
    """Largest distance of the follower from the same start, held back and sent back, [m]."""
    do(lab, c.Reset(), c.Set("speed", 6.0))
    run(lab, 2)
    do(lab, c.Hold(True))
    run(lab, 0.5)
    do(lab, c.Hold(False), c.Set("speed", -6.0))
    run(lab, 2)
    return lab.simulation.runs[FOLLOWER].max_distance


@pytest.mark.thorough
@pytest.mark.parametrize("encoder", [0, 2000])
def test_lab_finds_its_robot_and_follows_better(encoder: int) -> None:
    lab = made_lab(error_M11=30, error_b1=-50, encoder_counts=encoder)
    do(lab, c.Identify())
    assert lab.message_level == "info" and "M11 = 0.0226" in lab.message
    assert np.abs(errors(lab)).max() < 1.0
    after = worst(lab)
    do(lab, c.Set("error_M11", 30), c.Set("error_b1", -50))
    assert after < 0.8 * worst(lab)


def test_lab_takes_what_was_pushed_into_account() -> None:
    lab = new_lab()
    do(lab, c.Set("error_M22", 40))
    run(lab, 1)
    do(lab, c.Hold(True))
    run(lab, 0.7)
    do(lab, c.Hold(False), c.MoveHand(0.05, 0.0))
    run(lab, 1)
    do(lab, c.Release())
    run(lab, 1)
    do(lab, c.Identify())
    assert np.abs(errors(lab)).max() < 0.1


def test_lab_says_what_the_model_has_no_place_for() -> None:
    lab = made_lab(payload=0.1, coulomb=0.05)
    do(lab, c.Identify())
    plant = dict(
        zip(
            lab.simulation.robot.system.parameter_names,
            lab.simulation.robot.plant(lab.simulation.parameters),
            strict=True,
        )
    )
    model = lab.simulation.robot.model(lab.simulation.parameters)
    assert model[0] == pytest.approx(plant["M11"], rel=1e-3)
    assert "c1 = 0.05" in lab.message and "G1 = 0.19" in lab.message
    heavier = made_lab(payload=0.3)
    do(heavier, c.Identify())
    assert errors(heavier).max() == 50 and "limited by the range" in heavier.message


def test_lab_learns_from_the_robot_as_it_is_now() -> None:
    lab = made_lab(error_M11=30)
    do(lab, c.Set("payload", 0.05), c.Set("speed", 5.0))
    run(lab, 0.5)
    before = errors(lab)
    do(lab, c.Identify())
    assert lab.message_level == "warning" and "only 0.5 s" in lab.message
    np.testing.assert_array_equal(errors(lab), before)
    do(lab, c.Reset(), c.Identify())
    assert lab.message_level == "warning" and "let it run" in lab.message


def test_lab_looks_at_a_bounded_past_and_that_of_the_right_robot() -> None:
    lab = made_lab(8.0)
    history = lab.simulation.history.all()
    record = last_record(lab.simulation.robot, history)
    n = len(record.q)
    assert MOST_TICKS - 20 < n <= MOST_TICKS
    fields = replayed(lab.simulation)[FOLLOWER].fields
    for name, values in (("q", record.q), ("v", record.v), ("u", record.torque)):
        np.testing.assert_allclose(values, fields[name][-n:], atol=1e-12)


def test_flexible_robot_is_not_identified() -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot("flexible"), c.Identify())
    assert lab.message_level == "warning" and "five-bar linkage" in lab.message
