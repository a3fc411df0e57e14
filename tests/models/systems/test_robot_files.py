"""Robots from files: against MuJoCo, their limits, and what is refused."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.loops import CompiledLoop, InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.settable import with_values
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.curves import circle
from onpath.models.robot_files.file_chain import Options
from onpath.models.studies.experiments import on_path, run
from onpath.models.systems.contract import faults_of
from onpath.models.systems.robot_file import read_robot
from onpath.models.systems.robots import RobotEntry
from tests.support.mujoco_peer import MuJoCo, equation_errors, loop_error
from tests.support.robot_files import PLANAR, SEVEN, urdf
from tests.support.some_chains import random_arm

RADIUS = 0.05  # [m]
POSES = {
    "planar": {f"joint{i + 1}": x for i, x in enumerate((2.0, -1.3, -0.9))},
    "seven": {f"joint{i + 1}": x for i, x in enumerate((0, 0.35, 0, 1.45, 0, 1.34, 0))},
}


def written(folder: Path, text: str, name: str = "arm.urdf") -> Path:
    file = folder / name
    file.write_text(text, "utf-8")
    return file


TEXTS = {
    "planar": urdf("planar", PLANAR),
    "seven": urdf("seven", SEVEN),
    "random": random_arm(4),
}
"""A planar arm, a spatial one, and one with rotated frames and inertias and a sliding joint."""
MORE = (1, 2, 3, 5, 6, 8, 9)  # seeds of others like the last one: ten in all


@pytest.fixture(scope="module", params=TEXTS)
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Arm:
    file = written(tmp_path_factory.mktemp("arm"), TEXTS[request.param])
    read = read_robot(file, Options(pose=POSES.get(request.param, {})))
    assert read.remarks == ()
    return Arm(file, read.entry)


@dataclass(frozen=True)
class Arm:
    """A robot and its file."""

    file: Path
    entry: RobotEntry


def states(entry: RobotEntry, count: int = 50) -> list[tuple[Array, Array]]:
    rng = np.random.default_rng(0)
    n = entry.make(entry.parameters()).system.n
    return [(rng.uniform(-2, 2, n), 2 * rng.normal(size=n)) for _ in range(count)]


def test_the_contract_of_every_robot_holds(arm: Arm) -> None:
    assert faults_of(arm.entry) == []


def test_equations_are_those_of_mujoco(arm: Arm) -> None:
    """M, c and the tip to 1e-9, at random states."""
    assert max(equation_errors(arm.entry, MuJoCo(arm.file), states(arm.entry))) < 1e-9


@pytest.mark.thorough
@pytest.mark.parametrize("law", ["path_following", "trajectory_tracking"])
def test_a_closed_loop_runs_as_with_mujoco_as_the_plant(arm: Arm, law: str) -> None:
    """The joints agree to 1e-8 rad over 2 s; the tip starts on the path at rest."""
    assert loop_error(arm.entry, MuJoCo(arm.file), law, RADIUS) < 1e-8


@pytest.mark.thorough
@pytest.mark.parametrize("seed", MORE)
def test_other_arms_are_and_run_as_with_mujoco(tmp_path: Path, seed: int) -> None:
    file = written(tmp_path, random_arm(seed))
    other = Arm(file, read_robot(file, Options()).entry)
    test_equations_are_those_of_mujoco(other)
    test_a_closed_loop_runs_as_with_mujoco_as_the_plant(other, "path_following")


@pytest.mark.thorough
def test_compiled_and_interpreted_loops_agree_bit_by_bit(arm: Arm) -> None:
    parameters = with_values(arm.entry.parameters(), {"torque_limit": 30.0, "coulomb": 0.1})
    robot, curve = arm.entry.make(parameters), circle(RADIUS)
    kernel = kernel_of(robot, kind_of("path_following", parameters, curve))
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    state = first_state(robot, kernel, curve, robot.rest(robot.frame.lift(curve.at(np.array(0.0)))))
    loops = translate_loop(kernel), InterpretedLoop(kernel)
    (one, rows), (other, expected) = (x.run(state, settings, curve.table(), 40) for x in loops)
    assert np.array_equal(one, other) and np.array_equal(rows, expected)


@pytest.mark.parametrize("seed", [4, 7])
def test_an_mjcf_file_gives_mujocos_own_equations(tmp_path: Path, seed: int) -> None:
    """A random tree saved by MuJoCo, with armatures, a keyframe and a motor of limited torque."""
    api: Any = pytest.importorskip("mujoco")
    spec = api.MjSpec.from_file(str(written(tmp_path, random_arm(seed))))
    spec.compiler.fusestatic = False
    for i, joint in enumerate(spec.joints):
        joint.armature = 0.01 * (i + 1)
    spec.add_key(name="home", qpos=[0.3, -0.4, 0.1, 0.5, -0.6])
    spec.compile()
    file = written(tmp_path, spec.to_xml(), "arm.xml")
    entry = read_robot(file, Options(tip="tip")).entry
    assert entry.source is not None
    assert entry.source.home == pytest.approx((0.3, -0.4, 0.1, 0.5, -0.6))
    assert [joint.effort for joint in entry.source.chain.joints] == [50.0] * 5
    test_equations_are_those_of_mujoco(Arm(file, entry))


@pytest.mark.parametrize("name", ["planar", "seven"])
def test_its_text_says_which_circles_are_possible(tmp_path: Path, name: str) -> None:
    read = read_robot(written(tmp_path, TEXTS[name]), Options(pose=POSES[name]))
    assert f"circles of up to {1e3 * read.circle:.0f} mm" in read.entry.text
    margin = read.entry.make(read.entry.parameters()).margin
    assert curve_faults(margin, circle(read.circle)) == []
    assert curve_faults(margin, circle(1.2 * read.circle))


def seconds(work: Callable[[], object], repeats: int) -> float:
    """The least processor time of some repetitions, [s]."""
    times = list[float]()
    for _ in range(repeats):
        begun = time.process_time()
        work()
        times.append(time.process_time() - begun)
    return min(times)


@pytest.mark.thorough
def test_seven_joints_cost_little(tmp_path: Path) -> None:
    """At most 4 µs a tick and 5 s of processor time to compile; measured: 2.2 µs and 0.6 s."""
    entry = read_robot(written(tmp_path, TEXTS["seven"]), Options(pose=POSES["seven"])).entry
    parameters, curve = entry.parameters(), circle(RADIUS)
    robot = entry.make(parameters)
    kernel = kernel_of(robot, kind_of("path_following", parameters, curve))
    loops = list[CompiledLoop]()
    assert seconds(lambda: loops.append(translate_loop(kernel)), 1) < 5.0
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    at = robot.rest(robot.frame.lift(curve.at(np.array(0.0))))
    state, table = first_state(robot, kernel, curve, at), curve.table()
    assert seconds(lambda: loops[0].run(state, settings, table, 1000), 20) < 1000 * 4e-6


def test_each_motor_gives_no_more_than_the_share_of_its_own_limit(tmp_path: Path) -> None:
    """A share of 6 % of 12, 6 and 2 N m; without a limit, more is given."""
    file = written(tmp_path, urdf("planar", PLANAR))
    entry = read_robot(file, Options(pose=POSES["planar"])).entry
    efforts, most = np.array([link.effort for link in PLANAR]), list[Array]()
    for limit in (0.0, 6.0):
        parameters = with_values(entry.parameters(), {"torque_limit": limit, "at_limit": "cut"})
        robot, curve = entry.make(parameters), circle(RADIUS)
        kernel = kernel_of(robot, kind_of("trajectory_tracking", parameters, curve))
        settings = settings_vector(robot, kernel, parameters, curve, FREE)
        at = robot.rest(robot.frame.lift(curve.at(np.array(0.0))))
        state = first_state(robot, kernel, curve, at)
        _, rows = translate_loop(kernel).run(state, settings, curve.table(), 500)
        most.append(np.abs(kernel.log.unpack(rows)["u"]).max(axis=0))
    assert (most[0] > 0.06 * efforts).any()
    assert (most[1] <= 0.06 * efforts * (1 + 1e-12)).all()
    assert most[1] == pytest.approx(np.minimum(most[1], 0.06 * efforts)) and most[1].max() > 0.5


@pytest.mark.thorough
@pytest.mark.thorough
def test_a_heavy_arm_is_held_as_a_light_one(tmp_path: Path) -> None:
    """Twice the masses, rotors and friction: the same motion, held back by twice the force."""
    moved = list[Trajectory]()
    for factor in (5.0, 10.0):
        links = [
            replace(
                each,
                mass=factor * each.mass,
                rotor=factor * each.rotor,
                damping=factor * each.damping,
                effort=factor * each.effort,
            )
            for each in SEVEN
        ]
        entry = read_robot(written(tmp_path, urdf("arm", links)), Options()).entry
        experiment = on_path(entry, entry.parameters(), circle(RADIUS))
        times = {"duration": 3.0, "hold_from": 1.0, "hold_to": 2.0}
        moved.append(run(experiment.with_values(times), "trajectory_tracking"))
    one, other = moved
    assert one.held.any() and one.distance[one.held].max() > 0.02
    assert np.abs(one.fields["q"] - other.fields["q"]).max() < 1e-3


@pytest.mark.thorough
def test_without_a_posture_the_arm_falls_to_a_limit_while_its_tip_stays(tmp_path: Path) -> None:
    """η1 of (5): with gains no joint does; without them one does; the tip stays on its path."""
    file = written(tmp_path, urdf("seven", SEVEN))
    entry = read_robot(file, Options(pose=POSES["seven"])).entry
    for gain in (0.0, 1.0):
        gains = {"posture_stiffness": 100.0 * gain, "posture_damping": 20.0 * gain}
        parameters = with_values(entry.parameters(), gains)
        robot, curve = entry.make(parameters), circle(RADIUS)
        kernel = kernel_of(robot, kind_of("path_following", parameters, curve))
        settings = settings_vector(robot, kernel, parameters, curve, FREE)
        at = robot.rest(robot.frame.lift(curve.at(np.array(0.0))))
        state = first_state(robot, kernel, curve, at)
        _, rows = translate_loop(kernel).run(state, settings, curve.table(), 8000)
        log = kernel.log.unpack(rows)
        fault = robot.fault(log["q"], log["v"], parameters)
        assert (fault is None) == (gain > 0)
        if fault is not None:
            assert fault[1].code == "stop.joint"
        sound = slice(0, None if fault is None else fault[0])
        off = np.linalg.norm(robot.frame.planar(log["y"][sound]), axis=1) - RADIUS
        assert np.abs(off[200:]).max() < 1e-4
