"""Redundant arms keep their joints off the ends of their travel, without moving their tip."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.linearization import linearization
from onpath.models.control.settable import specs, with_values
from onpath.models.paths.curves import circle
from onpath.models.robot_files.file_chain import Options
from onpath.models.studies.arena import run_under
from onpath.models.studies.experiments import on_path
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.robots import RobotEntry
from tests.support.robot_files import SEVEN, urdf
from tests.support.some_chains import random_arm

NARROW = [replace(link, limit=0.7 if i == 5 else link.limit) for i, link in enumerate(SEVEN)]
"""An arm of which a joint of the wrist turns by 40° to either side."""


def entry_of(folder: Path, text: str) -> RobotEntry:
    file = folder / "arm.urdf"
    file.write_text(text, "utf-8")
    return read_robot(file, Options()).entry


class Torques:
    """u(q, v, y'') of an arm under a gain, and the matrix D = J M⁻¹."""

    def __init__(self, entry: RobotEntry) -> None:
        self.entry, self.robot = entry, entry.make(entry.parameters())
        system = self.robot.system
        wanted = ca.SX.sym("wanted", system.p)
        inputs = [system.q, system.v, system.parameters, wanted]
        u = linearization(system, *inputs)
        jacobian = ca.jacobian(system.output, system.q)
        self._function = ca.Function("u", inputs, [u, ca.densify(jacobian @ system.input_gain)])

    def __call__(self, q: Array, v: Array, wanted: Array, gain: float) -> tuple[Array, Array]:
        chosen = with_values(self.entry.parameters(), {"limit_avoidance": gain})
        u, decoupling = self._function(q, v, self.robot.plant(chosen), wanted)
        return np.array(u)[:, 0], np.array(decoupling)


@pytest.fixture(scope="module", params=["narrow", 4, 7])
def torques(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Torques:
    """Of an arm, and of random ones with a joint that slides."""
    text = urdf("narrow", NARROW) if request.param == "narrow" else random_arm(request.param)
    return Torques(entry_of(tmp_path_factory.mktemp("arm"), text))


@pytest.mark.thorough
@given(seed=st.integers(0, 10**6), gain=st.floats(0, 10))
def test_it_acts_in_the_null_space_only(torques: Torques, seed: int, gain: float) -> None:
    """D (u_g - u_0) = 0 to rounding, anywhere within the limits."""
    rng = np.random.default_rng(seed)
    chain = torques.robot.chain
    assert chain is not None
    low, high = (ends.clip(-3, 3) for ends in chain.limits)
    q, v = low + (high - low) * rng.random(chain.n), rng.normal(size=chain.n)
    wanted = 5 * rng.normal(size=torques.robot.system.p)
    (with_gain, decoupling), (without, _) = (torques(q, v, wanted, g) for g in (gain, 0.0))
    moved, terms = decoupling @ (with_gain - without), np.abs(decoupling) @ np.abs(with_gain)
    assert np.abs(moved).max() <= 1e-9 * max(1.0, float(terms.max()))


def test_with_a_gain_of_0_it_is_not_there(torques: Torques) -> None:
    """u is that of u0 = c + D v - M (k_d v + k_p (q - q_home))."""
    entry, system = torques.entry, torques.robot.system
    assert entry.source is not None
    chosen = with_values(entry.parameters(), {"limit_avoidance": 0.0})
    stiffness, damping = (getattr(chosen, f"posture_{name}") for name in ("stiffness", "damping"))
    away = damping * system.v + stiffness * (system.q - ca.DM(entry.source.home))
    plain = replace(system, posture=system.bias - system.mass @ away)
    inputs = [system.q, system.v, system.parameters, ca.SX.sym("wanted", system.p)]
    expected = ca.Function("u", inputs, [linearization(plain, *inputs)])
    rng = np.random.default_rng(0)
    for _ in range(20):
        q = np.array(entry.source.home) + 0.2 * rng.normal(size=system.n)
        v, wanted = rng.normal(size=system.n), rng.normal(size=system.p)
        u, _ = torques(q, v, wanted, 0.0)
        known = np.array(expected(q, v, torques.robot.plant(chosen), wanted))[:, 0]
        assert u == pytest.approx(known, rel=1e-7, abs=1e-7 * float(np.abs(known).max()))


def lap(entry: RobotEntry, law: str, **values: float) -> Trajectory:
    wanted = {"duration": 5.0, "hold_from": 2.0, "hold_to": 4.0, "speed": 2.0, **values}
    return run_under(on_path(entry, entry.parameters(), circle(0.08)).with_values(wanted), law)


@pytest.mark.thorough
def test_no_joint_comes_to_a_stop_that_others_can_keep_it_from(tmp_path: Path) -> None:
    """Without the gain the wrist ends at its stop; with it, it keeps a quarter of its travel, and
    the tip is where it was."""
    entry = entry_of(tmp_path, urdf("narrow", NARROW))
    fallen = lap(entry, "path_following", limit_avoidance=0.0)
    assert fallen.stopped_at is not None and "joint6" in str(fallen.reason)
    for law in ("path_following", "trajectory_tracking"):
        moved = lap(entry, law)
        assert moved.stopped_at is None
        wrist = 0.5 - np.abs(moved.fields["q"][:, 5]) / 1.4
        assert wrist.min() > 0.25
    same = len(fallen.fields["y"])
    moved = lap(entry, "path_following")
    assert np.abs(moved.fields["y"][:same] - fallen.fields["y"]).max() < 1e-5


def test_joints_without_limits_need_none_of_it(tmp_path: Path) -> None:
    """They have no such gain, and robots of the catalogue move as before, to the digit."""
    free = re.sub('lower="[^"]*" upper="[^"]*"', "", urdf("free", SEVEN))
    entries = entry_of(tmp_path, free.replace('"revolute"', '"continuous"')), ROBOTS["seven_axes"]
    for entry in entries:
        assert "limit_avoidance" not in specs(entry.parameters())
        assert "posture_stiffness" in specs(entry.parameters())
