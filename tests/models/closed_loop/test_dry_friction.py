"""Smooth dry friction, held over a tick: at rest it does not chatter."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.registry import NAMES
from onpath.models.control.settable import specs
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS

CIRCLE = circle(0.05)


@pytest.mark.parametrize("name", ROBOTS)
def test_at_rest_no_joint_chatters_with_any_dry_friction(name: str) -> None:
    """Position task, after 4 s: no joint that still moves reverses from tick to tick."""
    entry = ROBOTS[name]
    parameters = entry.parameters(task="position", coulomb=0.1, K3=0.0)
    robot = entry.make(parameters)
    spec = specs(parameters)["coulomb"]
    levels = np.arange(spec.low + 0.02, spec.high + 0.01, 0.04)
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
