"""A controller without a plant gives the lab's torques, and refuses what cannot be."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.notebook.controller import Controller
from onpath.assets import asset_path
from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import fastest_loop
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import with_values
from onpath.models.controller.functions import AT_FAULT, REFUSALS
from onpath.models.errors import CodedError
from onpath.models.paths.distance import path_distance
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab_log import lab_log, replayed

RUN = {"duration": 0.3, "hold": (0.1, 0.2)}
ENCODERS = {"encoder_counts": 2000}
CODE = {name: number for number, name in enumerate(REFUSALS, 1)}
ARM: dict[str, Any] = {"robot": "two_link_arm", "path": "circle"}


class Sliding:
    """A custom law in CasADi, with a memory."""

    memory = (("kept", 2),)

    def command(self, view: Any) -> Any:
        xi, rate = view.output.xi, view.output.xi_rate
        action = onpath.followed(view, onpath.tangential(view), -400 * xi - 40 * ca.tanh(rate))
        return replace(action, memory={"kept": ca.vertcat(xi, ca.SX.zeros(2 - xi.numel(), 1))})


RUNS: list[tuple[Any, Any, Any, dict[str, Any]]] = [
    ("five_bar", "circle", "path_following", {}),
    ("five_bar", "ellipse 0.06 0.04", "trajectory_tracking", {"control_rate": 250, "K3": 500}),
    ("two_link_arm", "clover", "waiting_clock", {"control_rate": 100, "torque_limit": 2}),
    ("five_bar", "circle", "path_following", {"across": "level_set", "control_rate": 2000}),
    ("two_link_arm", "segment -0.05 0 0.05 0.02", "path_following", {"torque_step": 0.01}),
    ("five_bar", "circle", "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)", {}),
    ("five_bar", "circle", Sliding, {"observer_time": 0}),
    ("spatial_arm", "circle", "path_following", {"rise": 0.02}),
    ("cart_pendulum", "circle", "path_following", {"control_rate": 500}),
]


@pytest.mark.parametrize(("robot", "path", "law", "given"), RUNS)
def test_it_gives_the_lab_s_torques_to_the_last_bit(
    robot: Any, path: Any, law: Any, given: dict[str, Any]
) -> None:
    """Also from what encoders read in the ticks of the law alone: the model counts the others."""
    log = lab_log(robot, path, law, **RUN, **given)
    assert np.array_equal(
        replayed(onpath.controller(robot, path, law, **given), log, True), log.torque
    )
    if given.get("observer_time") == 0 and given.get("control_rate", 1000) < 1000:
        return  # the lab's filter reads encoders in every tick
    read = lab_log(robot, path, law, **RUN, **given, **ENCODERS)
    controller = onpath.controller(robot, path, law, **given)
    assert np.array_equal(replayed(controller, read, False), read.torque)


@pytest.mark.thorough
@pytest.mark.parametrize("robot", list(ROBOTS))
@pytest.mark.parametrize("law", list(LAWS))
def test_every_law_on_every_robot_does(robot: str, law: str) -> None:
    entry = ROBOTS[robot]
    if not LAWS[law].suits(entry.make(entry.parameters()).system):
        pytest.skip("the law does not suit the robot")
    log = lab_log(robot, "circle", law, duration=0.05)
    controller = onpath.controller(robot, "circle", law)
    assert np.array_equal(replayed(controller, log, True), log.torque)


@pytest.mark.parametrize("exact", [True, False])
def test_a_delayed_torque_is_given_at_once_and_known_to_the_observer(exact: bool) -> None:
    """The lab's acts 2 intervals of 4 ticks later."""
    given = {"control_rate": 250, "delay": 2.0, **({} if exact else ENCODERS)}
    log = lab_log(**ARM, law="path_following", **RUN, **given)
    torque = replayed(onpath.controller(**ARM, **given), log, exact)
    assert np.array_equal(torque[:-8], log.torque[8:])


def test_drawings_go_too(tmp_path: Any) -> None:
    pytest.importorskip("svgpathtools")
    path = f"@{asset_path('examples/leaf.svg')} fit=0.08"
    log = lab_log("two_link_arm", path, "path_following", **RUN)
    controller = onpath.controller("two_link_arm", path)
    assert np.array_equal(replayed(controller, log, True), log.torque)


@pytest.mark.thorough
@settings(max_examples=10)
@given(
    changes=st.dictionaries(
        st.sampled_from(["K1", "K2", "K3", "speed", "ramp", "torque_limit"]),
        st.floats(0.5, 1.5),
        min_size=1,
    ),
    at=st.integers(1, 80),
)
def test_changed_settings_act_as_in_the_lab(changes: dict[str, float], at: int) -> None:
    """So its torque makes no step that the law itself does not ask for."""
    entry = ROBOTS["two_link_arm"]
    usual = replace(entry.parameters(), torque_limit=3.0)
    shares = {name: share * getattr(usual, name) or share for name, share in changes.items()}
    controller = onpath.controller(**ARM, torque_limit=3.0)
    robot, curve = entry.make(usual), next(iter(controller.design.paths.values()))
    kernel = kernel_of(robot, kind_of("path_following", usual, curve))
    q = robot.rest(robot.frame.lift(curve.at(np.array(0.0))))
    loop, state = fastest_loop(kernel), first_state(robot, kernel, curve, q)
    for tick in range(120):
        if tick == at:
            controller.set(**shares)
        now = with_values(usual, shares) if tick >= at else usual
        inputs = settings_vector(robot, kernel, now, curve, FREE)
        fields = kernel.state.unpack(state)
        torque = controller.step(1e-3 * tick, fields["q"], fields["v"])
        state, rows = loop.run(state, inputs, curve.table(), 1)
        assert np.array_equal(torque, kernel.log.unpack(rows)["u"][0])


@pytest.mark.thorough
@settings(max_examples=10)
@given(rates=st.lists(st.sampled_from([50, 100, 250, 500, 1000]), min_size=2, max_size=4))
def test_a_changed_rate_holds_each_torque_for_its_own_interval(rates: list[int]) -> None:
    log = lab_log(**ARM, law="path_following", duration=0.3)
    controller, since, torque = onpath.controller(**ARM), 0, np.zeros(2)
    for k, t in enumerate(log.t):
        rate = rates[k * len(rates) // len(log.t)]
        controller.set(control_rate=rate)
        now = controller.step(t, log.q[k], log.v[k])
        if since and since < 1000 // rate:
            assert np.array_equal(now, torque)
            since += 1
        else:
            since = 1
        torque = now
    assert controller.code == 0


def test_the_same_path_again_makes_no_step_of_torque() -> None:
    """The closest point is searched for anew, half a tick behind where the law last found it."""
    log = lab_log(**ARM, law="path_following", duration=0.2)
    other = onpath.controller("two_link_arm", ["circle", onpath.circle(0.05)])
    usual = onpath.controller(**ARM)
    for k, t in enumerate(log.t):
        if k == 150:
            other.follow("path 2")
        torques = [each.step(t, log.q[k], log.v[k]) for each in (other, usual)]
        assert np.abs(torques[0] - torques[1]).max() < 1e-6  # of 0.5 N m
    assert other.code == 0


def test_another_path_is_reached() -> None:
    """From a circle to an ellipse 10 mm away; the law leads there, and the lab is the plant."""
    paths = ["circle", onpath.ellipse(0.06, 0.04)]
    controller = onpath.controller("two_link_arm", paths)
    plant = Plant("two_link_arm")
    for k in range(1500):
        if k == 500:
            controller.follow("path 2")
        plant.move(controller.step(1e-3 * k, plant.q, plant.v))
    y = plant.robot.endpoint(plant.q)
    assert path_distance(plant.robot.frame, paths[1], y[None])[0] < 1e-4


class Plant:
    """A robot at rest on the circle, moved by torques for a millisecond each."""

    def __init__(self, name: str) -> None:
        entry = ROBOTS[name]
        self.robot = entry.make(entry.parameters())
        system, self._numbers = self.robot.system, self.robot.plant(entry.parameters())
        self._parts = Buffered(system.function("mass", "bias"))
        self.q = self.robot.rest(self.robot.frame.lift(np.array([0.05, 0.0])))
        self.v = 0 * self.q

    def move(self, torque: Array, steps: int = 4) -> None:
        for _ in range(steps):
            mass, bias = self._parts(self.q, self.v, self._numbers)
            square = mass.reshape(len(bias), -1)
            self.v = self.v + 1e-3 / steps * np.linalg.solve(square, torque - bias)
            self.q = self.q + 1e-3 / steps * self.v


def started(**given: Any) -> tuple[Controller, Array, Array]:
    """A controller that has made 50 steps, its last measurement and torque."""
    controller = onpath.controller(**ARM, **given)
    log = lab_log(**ARM, law="path_following", duration=0.1)
    torque = np.zeros(2)
    for k in range(50):
        torque = controller.step(log.t[k], log.q[k], log.v[k])
    return controller, log.q[49], torque


BAD: dict[str, tuple[float, list[float], list[float] | None]] = {
    "time": (0.03, [0, 0], None),
    "late": (0.2, [0, 0], [0, 0]),
    "not_finite": (0.05, [math.nan, 0], [0, 0]),
    "jump": (0.05, [0.2, 0], [0, 0]),
}


@pytest.mark.parametrize("kind", BAD)
@pytest.mark.parametrize("at_fault", AT_FAULT)
def test_a_bad_measurement_is_refused_for_good_with_the_chosen_torque(
    kind: str, at_fault: str
) -> None:
    controller, q, last = started(at_fault=at_fault)
    t, moved, v = BAD[kind]
    given = controller.step(t, q + moved, v)
    assert controller.code == CODE[kind] and controller.reason
    expected = last if at_fault == "hold" else np.zeros(2)
    assert np.array_equal(given, expected)  # the last two are at rest, or cannot be used
    t = max(t, 0.05)
    later = controller.step(t + 0.001, q, [1.0, 0.0])  # sound again, and moving
    assert controller.code == CODE[kind]
    if at_fault == "damp":
        assert later[0] < 0
    else:
        assert np.array_equal(later, expected)
    controller.start(t + 0.002, q, [0.0, 0.0])
    assert controller.code == 0 and controller.step(t + 0.002, q, [0.0, 0.0]).any()


@pytest.mark.parametrize("at_fault", AT_FAULT)
def test_it_is_stopped_for_good_from_outside(at_fault: str) -> None:
    controller, q, last = started(at_fault=at_fault)
    controller.stop()
    controller.stop("late")  # the first reason stays
    given = controller.step(0.05, q, [1.0, 0.0])
    assert controller.code == CODE["stopped"] and controller.reason
    if at_fault == "damp":
        assert given[0] < 0
    else:
        assert np.array_equal(given, last if at_fault == "hold" else np.zeros(2))
    with pytest.raises(ValueError, match="started"):
        onpath.controller(**ARM).stop()
    with pytest.raises(ValueError, match="late"):
        controller.stop("lat")


def test_a_joint_that_jumps_farther_than_its_limit_allows_is_refused() -> None:
    """In 1 ms and 10 ms more, it moves 22 mrad at 2 rad/s; a measured velocity tells nothing."""
    for share, code in ((0.95, 0), (1.05, CODE["jump"])):
        controller, q, _ = started(fastest=2.0, speed=0.5)
        controller.step(0.05, q + share * 2.0 * 0.011, [0.0, 0.0])
        assert controller.code == code


def test_a_joint_that_is_faster_than_allowed_is_refused() -> None:
    """The observer's velocities count where none are measured."""
    log = lab_log(**ARM, law="path_following", **RUN)
    top = float(np.abs(log.v).max())
    for share, code in ((1.01, 0), (0.9, CODE["fast"])):
        for exact in (True, False):
            controller = onpath.controller(**ARM, fastest=share * top)
            controller.start(0.0, log.q[0])
            for k, t in enumerate(log.t):
                controller.step(t, log.q[k], log.v[k] if exact else None)
            assert controller.code == code


def test_damping_takes_no_jump_for_a_speed() -> None:
    controller, q, _ = started(at_fault="damp")
    controller.start(0.05, q)
    for k in range(10):
        torque = controller.step(0.05 + 1e-3 * k, q + 0.2 * (k % 2))
        assert not torque.any() or controller.code == 0
    assert controller.code == CODE["jump"]


@pytest.mark.thorough
def test_infinity_and_nan_anywhere_are_refused() -> None:
    for bad in (math.nan, math.inf, -math.inf, 1e301):
        for place in range(4):
            controller, q, _ = started()
            numbers = [*q, 0.0, 0.0]
            numbers[place] = bad
            torque = controller.step(0.05, numbers[:2], numbers[2:])
            assert controller.code == CODE["not_finite"] and not torque.any()
    controller, q, _ = started()
    controller.step(math.nan, q)
    assert controller.code == CODE["time"]


def test_limits_of_the_robot_are_those_at_which_the_lab_stops() -> None:
    controller, q, _ = started()
    controller.step(0.05, q, [101.0, 0.0])
    assert "100 rad/s" in controller.reason
    controller, q, _ = started()
    controller.start(1.0, [q[0], 0.0])  # stretched
    assert not controller.step(1.0, [q[0], 0.0], [0.0, 0.0]).any()
    assert "singular" in controller.reason


@pytest.mark.parametrize("exact", [True, False])
def test_damping_takes_speed_from_a_moving_arm(exact: bool) -> None:
    """Thrown, it loses nine tenths of its speed in half a second, while it sinks by its weight."""
    controller, plant = onpath.controller(**ARM, at_fault="damp"), Plant("two_link_arm")
    undamped = Plant("two_link_arm")
    controller.start(0.0, plant.q)
    plant.v = undamped.v = np.array([6.0, -4.0])
    controller.step(0.0, plant.q + 1.0)
    assert controller.code == CODE["jump"]
    for k in range(1, 500):
        v = plant.v if exact else None
        plant.move(controller.step(1e-3 * k, plant.q, v))
        undamped.move(np.zeros(2))
    assert np.linalg.norm(plant.v) < 0.5 * np.linalg.norm(undamped.v)


def test_a_second_measurement_in_a_tick_changes_nothing() -> None:
    controller, q, last = started()
    again = controller.step(0.0493, q + 1e-3, [0.1, 0.0])
    assert controller.code == 0 and np.array_equal(again, last)


def test_one_lost_measurement_is_bridged_and_two_are_not() -> None:
    for lost, code in ((1, 0), (2, 0), (3, CODE["late"])):
        controller, _, _ = started()
        log = lab_log(**ARM, law="path_following", duration=0.1)
        k = 50 + lost
        controller.step(log.t[k], log.q[k], log.v[k])
        assert controller.code == code


def test_what_cannot_be_a_controller_is_refused_in_a_sentence() -> None:
    def called(now: Any) -> Any:
        return 0.0, 0.0

    with pytest.raises(CodedError, match="is a Python function"):
        onpath.controller(**ARM, law=called)
    with pytest.raises(CodedError, match="no speed profile"):
        onpath.controller(**ARM, speed_profile="sine")
    with pytest.raises(CodedError, match="all closed or all open"):
        onpath.controller("two_link_arm", ["circle", "segment -0.05 0 0.05 0"])
    with pytest.raises(CodedError, match="compiled into this one"):
        onpath.controller(**ARM).follow("segment -0.05 0 0.05 0")
    with pytest.raises(ValueError, match="did you mean damp"):
        onpath.controller(**ARM, at_fault="dampen")
    with pytest.raises(ValueError, match="2 numbers"):
        onpath.controller(**ARM).step(0.0, [1.0])


def test_mujoco_is_driven_to_where_the_lab_ends() -> None:
    """With positions alone, too, which the observer turns into the same velocities."""
    mujoco: Any = pytest.importorskip("mujoco")
    file = asset_path("robots/planar_arm.urdf")
    lab = onpath.simulate(file, duration=1.0)
    model = mujoco.MjModel.from_xml_path(str(file))
    model.opt.timestep, model.opt.integrator = 1e-3, mujoco.mjtIntegrator.mjINT_RK4
    for exact in (True, False):
        controller, data = onpath.controller(file), mujoco.MjData(model)
        data.qpos[:] = lab.q[0]
        for _ in lab.t[1:]:
            v = data.qvel if exact else None
            data.qfrc_applied[:] = controller.step(data.time, data.qpos, v)
            mujoco.mj_step(model, data)
        assert np.abs(data.qpos - lab.q[-1]).max() < 1e-9
