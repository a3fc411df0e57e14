"""A robot from a file in MuJoCo: an independent simulation, whose results must agree."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.paths.curves import circle
from onpath.models.systems.robots import RobotEntry
from onpath.models.systems.system import GRAVITY


class MuJoCo:
    """The same file in MuJoCo, without contacts, limits and dry friction.

    Args:
        file: it moves the joints of the robot and no others, in their order.
        tip: name of its body.
        step: of its integrator, RK4, [s].
    """

    def __init__(self, file: Path, tip: str = "tip", step: float = 1e-3) -> None:
        self.api: Any = pytest.importorskip("mujoco")
        spec = self.api.MjSpec.from_file(str(file))
        spec.compiler.fusestatic = False
        spec.compiler.discardvisual = True
        self.model = spec.compile()
        self.model.opt.gravity = (0, 0, -GRAVITY)
        flags = self.api.mjtDisableBit
        self.model.opt.disableflags |= flags.mjDSBL_CONTACT | flags.mjDSBL_LIMIT
        self.model.opt.integrator = self.api.mjtIntegrator.mjINT_RK4
        self.model.dof_frictionloss[:] = 0
        self.model.opt.timestep, self._steps = step, round(1e-3 / step)
        self.data = self.api.MjData(self.model)
        self._tip = tip

    def at(self, q: Array, v: Array) -> tuple[Array, Array, Array]:
        """M, c less friction, and the tip."""
        self.data.qpos[:], self.data.qvel[:] = q, v
        self.api.mj_forward(self.model, self.data)
        mass = np.zeros((self.model.nv, self.model.nv))
        self.api.mj_fullM(self.model, self.data, mass)
        bias = self.data.qfrc_bias - self.data.qfrc_passive
        return mass, bias.copy(), self.data.body(self._tip).xpos.copy()

    def step(self, torque: Array) -> tuple[Array, Array]:
        """q and v a millisecond later."""
        self.data.qfrc_applied[:] = torque
        for _ in range(self._steps):
            self.api.mj_step(self.model, self.data)
        return self.data.qpos.copy(), self.data.qvel.copy()


def equation_errors(
    entry: RobotEntry, peer: MuJoCo, states: Sequence[tuple[Array, Array]]
) -> tuple[float, float, float]:
    """The largest differences of M, of c as a share of its largest entry or 1, and of the tip."""
    parameters = entry.parameters()
    robot = entry.make(parameters)
    parts, plant = robot.system.function("mass", "bias", "output"), robot.plant(parameters)
    worst = np.zeros(3)
    for q, v in states:
        mass, bias, y = (np.array(x) for x in parts(q, v, plant))
        expected_mass, expected_bias, tip = peer.at(q, v)
        scale = max(1.0, float(np.abs(expected_bias).max()))
        place = robot.output_at(tip)
        off = max(np.abs(y[:, 0] - place).max(), np.abs(robot.endpoint(q) - place).max())
        here = np.abs(mass - expected_mass).max(), np.abs(bias[:, 0] - expected_bias).max() / scale
        worst = np.maximum(worst, [*here, off])
    return float(worst[0]), float(worst[1]), float(worst[2])


def loop_error(entry: RobotEntry, peer: MuJoCo, law: str, radius: float) -> float:
    """How far the joints are apart within 2 s of a circle, at most, [rad] or [m].

    MuJoCo takes the torques that our law gives for our states, one millisecond at a time. The tip
    starts on the path at rest.
    """
    parameters = entry.parameters()
    robot, curve = entry.make(parameters), circle(radius)
    kernel = kernel_of(robot, kind_of(law, parameters, curve))
    loop = translate_loop(kernel)
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    state = first_state(robot, kernel, curve, robot.rest(robot.frame.lift(curve.at(np.array(0.0)))))
    fields = kernel.state.slices
    peer.data.qpos[:] = state[fields["q"]]
    own, table = state.copy(), curve.table()
    worst = 0.0
    for _ in range(2000):
        own, _ = loop.run(own, settings, table, 1)
        state, rows = loop.run(state, settings, table, 1)
        q, v = peer.step(kernel.log.unpack(rows)["u"][0])
        state[fields["q"]], state[fields["v"]] = q, v
        worst = max(worst, float(np.abs(q - own[fields["q"]]).max()))
    return worst
