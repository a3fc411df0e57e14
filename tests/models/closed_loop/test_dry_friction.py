"""Smooth dry friction, held over a tick: at rest it does not chatter."""

from __future__ import annotations

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.stiction import _holding
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.registry import NAMES
from onpath.models.control.settable import specs
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS

CIRCLE = circle(0.05)


@pytest.mark.thorough
@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_at_rest_no_joint_chatters_with_any_dry_friction(name: str) -> None:
    """Position task, after 4 s: no joint that still moves reverses from tick to tick."""
    entry = ROBOTS[name]
    parameters = entry.parameters(task="position", coulomb=0.1, K3=0.0)
    robot = entry.make(parameters)
    spec = specs(parameters)["coulomb"]
    levels = np.append(np.arange(0.02, 0.27, 0.04), spec.high)
    start = robot.rest(robot.frame.lift(CIRCLE.at(np.array(0.5))))
    for law in NAMES:
        kernel = kernel_of(robot, kind_of(law, parameters, CIRCLE))
        states = np.array([first_state(robot, kernel, CIRCLE, start)] * len(levels))
        settings = [
            settings_vector(
                robot, kernel, entry.parameters(task="position", coulomb=c, K3=0.0), CIRCLE, FREE
            )
            for c in levels
        ]
        logs = translate_loop(kernel).run_many(
            states, settings, [CIRCLE.table()] * len(levels), 4000
        )
        for level, rows in zip(levels, logs[1], strict=True):
            v = kernel.log.unpack(rows[-300:])["v"][:, : robot.system.m]
            moving = np.abs(v[1:]).max(0) > 1e-6
            reversals = (v[1:] * v[:-1] < 0).sum(0) * moving
            assert reversals.max() < 30, (law, level, reversals, np.abs(v).max(0))


def test_the_friction_that_holds_seven_motors_is_exact_and_small_to_compute() -> None:
    """Some of the motors slide; the compliances of the others differ by a factor of 1e4."""
    rng, m = np.random.default_rng(0), 7
    symbols = ca.SX.sym("C", m, m), ca.SX.sym("rests", m), ca.SX.sym("a", m)
    holding = ca.Function("holding", symbols, [_holding(*symbols)])
    for _ in range(50):
        basis, _ = np.linalg.qr(rng.normal(size=(m, m)))
        compliance = basis @ np.diag(10.0 ** rng.uniform(-2, 2, m)) @ basis.T
        rests, acceleration = rng.random(m) < 0.7, rng.normal(size=m)
        found = np.array(holding(compliance, rests, acceleration))[:, 0]
        assert (found[~rests] == 0).all()
        held = np.ix_(rests, rests)
        expected = -np.linalg.solve(compliance[held], acceleration[rests])
        assert found[rests] == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())
    assert holding.n_instructions() < 1000
