"""What the authors of each law claim of it, seen in runs of the rigid five-bar."""

from __future__ import annotations

import dataclasses
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import build_kernel
from onpath.models.closed_loop.loops import InterpretedLoop, Loop
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    brake_at,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.registry import LAWS, SHARED_GAINS
from onpath.models.control.laws.velocity_field import FLYWHEEL
from onpath.models.control.settable import value_of, with_values
from onpath.models.errors import CodedError
from onpath.models.layout import Layout
from onpath.models.paths.curves import Curve, circle, ellipse, segment
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import coriolis
from tests.support.rig import jacobian
from tests.support.suitable_laws import laws_for

CIRCLE = circle(0.05)
PATHS = (CIRCLE, ellipse((0.06, 0.035)))
NEAR = 1e-5  # [m], what sampling leaves of the invariance of a path


class Side:
    """The rigid five-bar under a law, at rest on the path at first."""

    def __init__(self, law: str, curve: Curve = CIRCLE, theta: float = 0.0, **values: Any) -> None:
        values = {"K3": 0.0, **values}
        self.parameters: Parameters = with_values(FIVE_BAR.parameters(), values)
        self.robot: Robot = FIVE_BAR.make(self.parameters)
        self.law, self.curve = law, curve
        kind = kind_of(law, self.parameters, curve)
        self.kernel = kernel_of(self.robot, kind)
        self.loop = compiled(law, curve.closed, kind.level_set, kind.across_first)
        start = self.robot.rest(curve.at(np.array(theta)))
        self.state = first_state(self.robot, self.kernel, curve, start)

    @property
    def fields(self) -> dict[str, Array]:
        return self.kernel.state.unpack(self.state)

    @property
    def log(self) -> Layout:
        return self.kernel.log

    def run(self, seconds: float, push: Push = FREE) -> dict[str, Array]:
        """The log of a run."""
        settings = settings_vector(self.robot, self.kernel, self.parameters, self.curve, push)
        ticks = round(seconds * 1000)
        self.state, rows = self.loop.run(self.state, settings, self.curve.table(), ticks)
        return self.log.unpack(rows)

    def brake(self) -> Push:
        y = self.robot.endpoint(self.fields["q"])
        return Push(hold=brake_at(self.robot, self.curve, y, float(self.fields["theta"][0])))

    def distance(self, log: dict[str, Array]) -> Array:
        """Distance to the curve, by a global search, [m]."""
        return np.abs(self.curve.nearest(log["y"])[1])

    def put(self, **fields: Any) -> None:
        """Replace fields of the state."""
        self.state = self.kernel.state.pack({**self.fields, **fields})


@lru_cache
def compiled(law: str, closed: bool, level_set: bool, across_first: bool) -> Loop:
    kind = kind_of(law, FIVE_BAR.parameters(), CIRCLE)
    kind = dataclasses.replace(kind, closed=closed, level_set=level_set, across_first=across_first)
    return translate_loop(kernel_of(FIVE_BAR.make(FIVE_BAR.parameters()), kind))


def moving(side: Side, theta: float, rate: float) -> Side:
    """The side on its path, with the velocity along it."""
    y, first = side.curve.at(np.array(theta)), side.curve.at(np.array(theta), 1)
    q = side.robot.rest(y)
    v = np.linalg.solve(jacobian(q), rate * first)
    side.put(q=q, v=v, theta=theta, theta_rate=rate, theta_ref=theta, encoder=q, encoder_rate=v)
    return side


def kinetic_energy(side: Side, log: dict[str, Array]) -> Array:
    """½ vᵀ M v of a run, [J]."""
    mass, plant = side.robot.system.function("mass"), side.robot.plant(side.parameters)
    pairs = zip(log["q"], log["v"], strict=True)
    return np.array([0.5 * float(v @ np.array(mass(q, v, plant)) @ v) for q, v in pairs])


@pytest.mark.parametrize("law", LAWS.values(), ids=lambda law: law.name)
def test_every_law_says_what_it_is_and_where_it_comes_from(law: Any) -> None:
    assert law.text.endswith(".") and law.source and law.label
    assert law.aim in ("theta", "theta_ref")
    assert set(law.gains) <= {*SHARED_GAINS}


@pytest.mark.parametrize("curve", PATHS, ids=("circle", "ellipse"))
@pytest.mark.parametrize("law", [n for n in laws_for() if LAWS[n].pace in ("wanted", "energy")])
def test_undisturbed_every_law_ends_up_on_the_path_at_the_wanted_speed(
    law: str, curve: Curve
) -> None:
    side = Side(law, curve)
    side.run(4.0)
    log = side.run(1.0)
    assert side.distance(log).max() < NEAR
    if LAWS[law].pace == "wanted":
        assert log["theta_rate"].mean() == pytest.approx(side.parameters.speed, rel=5e-3)


@pytest.mark.parametrize("law", laws_for())
def test_the_compiled_loop_is_the_interpreted_one_bit_by_bit(law: str) -> None:
    side = Side(law, torque_limit=1.0)
    for push in (FREE, side.brake(), Push(hand=np.array([0.03, 0.02]))):
        settings = settings_vector(side.robot, side.kernel, side.parameters, CIRCLE, push)
        arguments = side.state, settings, CIRCLE.table(), 48
        for one, other in zip(
            side.loop.run(*arguments), InterpretedLoop(side.kernel).run(*arguments), strict=True
        ):
            assert np.array_equal(one, other)


@pytest.mark.thorough
@settings(max_examples=20)
@given(law=st.sampled_from(list(LAWS)), name=st.sampled_from(list(ROBOTS)))
def test_every_law_moves_every_robot_that_it_suits(law: str, name: str) -> None:
    entry = ROBOTS[name]
    parameters = entry.parameters()
    robot, kind = entry.make(parameters), kind_of(law, parameters, CIRCLE)
    if not LAWS[law].suits(robot.system):
        with pytest.raises(CodedError, match="not possible with this robot"):
            kernel_of(robot, kind)
        return
    kernel = kernel_of(robot, kind)
    q = robot.rest(robot.frame.lift(CIRCLE.at(np.array(0.0))))
    state = first_state(robot, kernel, CIRCLE, q)
    settings = settings_vector(robot, kernel, parameters, CIRCLE, FREE)
    log = kernel.log.unpack(InterpretedLoop(kernel).run(state, settings, CIRCLE.table(), 640)[1])
    assert robot.fault(log["q"], log["v"], parameters) is None
    moved = np.abs(log["theta"] - log["theta"][0]).max()
    assert moved < 1e-3 if LAWS[law].pace == "free" else moved > 0.2


def test_laws_that_command_torques_refuse_composite_control() -> None:
    parameters = dataclasses.replace(FLEXIBLE.parameters(), output="composite")  # type: ignore[call-arg]
    with pytest.raises(CodedError, match="not possible"):
        kernel_of(FLEXIBLE.make(parameters), kind_of("velocity_field", parameters, CIRCLE))


@pytest.mark.thorough
def test_a_set_point_regulator_cuts_across_the_circle_and_path_following_does_not() -> None:
    """Experiment 1: from θ = 0 to the opposite side."""
    values = {"task": "position", "target": 3.0}
    straight, along = Side("set_point", **values), Side("path_following", **values)
    for side, least, most in ((straight, 0.04, 0.05), (along, 0.0, NEAR)):
        log = side.run(4.0)
        assert least <= side.distance(log).max() <= most
        assert np.linalg.norm(log["y"][-1] - CIRCLE.at(np.array(3.0))) < 1e-4


@pytest.mark.thorough
@pytest.mark.parametrize("theta", np.arange(4) * np.pi / 2)
def test_a_waiting_clock_waits_while_the_robot_is_held(theta: float) -> None:
    advances = list[float]()
    for gain in (0.0, 50.0):
        side = Side("waiting_clock", theta=theta, clock_gain=gain)
        side.run(1.0)
        log = side.run(2.0, side.brake())
        advances.append(float(log["theta_ref"][-1, 0] - log["theta_ref"][0, 0]))
        worst = side.distance(log).max()
        assert worst > 0.04 if gain == 0 else worst < 0.006
    assert advances[0] == pytest.approx(4 * np.pi, abs=0.01)  # two seconds of an ordinary clock
    assert abs(advances[1]) < 0.5


def test_a_waiting_clock_does_not_leave_the_path_invariant() -> None:
    """On the path with the velocity along it, a wrong speed takes the clock off, and path following
    not: that is what the clock lacks, whatever it waits for."""
    distances = dict[str, float]()
    for law in ("path_following", "waiting_clock"):
        side = moving(Side(law, speed=2.0), 0.0, 8.0)
        distances[law] = float(side.distance(side.run(1.0)).max())
    assert distances["path_following"] < NEAR
    assert distances["waiting_clock"] > 3e-4


def test_the_function_of_maneuvering_falls_as_its_authors_say() -> None:
    """V = P11 |e|² + 2 P12 e · ε + P22 |ε|² and V' <= -K1 K2 |e|² - K2 |ε|², without a force."""
    k1, k2, speed = 400.0, 40.0, 2 * np.pi
    for begin in (0.0, 2.0, 4.5):
        side = moving(Side("maneuvering"), begin, -3.0)
        side.put(theta_ref=begin + 0.4)
        log = side.run(0.5)
        y, theta = log["y"], log["theta_ref"][:, 0]
        rate = np.gradient(y, 1e-3, axis=0)
        e = (y - CIRCLE.at(theta))[2:-2]
        eps = (rate - speed * CIRCLE.at(theta, 1))[2:-2]
        squares = np.sum(e**2, 1), np.sum(e * eps, 1), np.sum(eps**2, 1)
        value = (k1 + k2**2 / 2) * squares[0] + k2 * squares[1] + squares[2]
        loss = k1 * k2 * squares[0] + k2 * squares[2]
        change = np.gradient(value, 1e-3)
        assert value[0] > 0.1 and value[-1] < 1e-3 * value[0]
        assert (change <= -loss + 0.02 * value.max() / 0.05).all()


def test_within_its_bound_the_disturbance_observer_is_18_with_other_gains() -> None:
    """With a payload that no model knows, and no far return: the same motion."""
    k1, k2, rate = 400.0, 40.0, 20.0
    gains: dict[str, Any] = {"K1": k1 + rate * k2, "K2": k2 + rate, "K3": rate * k1}
    one = Side("disturbance_observer", K1=k1, K2=k2, observer_rate=rate, payload=0.1)
    other = Side("path_following", **gains, payload=0.1)
    one_log, other_log = (moving(side, 0.0, 2 * np.pi).run(1.0) for side in (one, other))
    assert np.abs(other_log["xi"]).max() > 5e-5
    assert np.abs(one_log["xi"] - other_log["xi"]).max() < 0.03 * np.abs(other_log["xi"]).max()


def test_the_event_based_reference_is_the_closest_point() -> None:
    side = Side("event_based")
    for log in (side.run(0.5), side.run(0.5, side.brake())):
        later, now = log["theta_ref"][1:, 0], log["theta"][1:, 0]
        assert np.abs(later - now).max() < 0.02


def test_on_a_straight_path_contouring_with_equal_gains_is_tracking() -> None:
    """The frame at the reference point does not turn there."""
    line = segment((-0.05, -0.01), (0.05, 0.02))
    one = Side("contouring", line, theta=-2.0, contour_ratio=1.0, speed=1.5)
    other = Side("trajectory_tracking", line, theta=-2.0, speed=1.5)
    for push in (FREE, one.brake()):
        assert np.abs(one.run(0.5, push)["y"] - other.run(0.5, push)["y"]).max() < 1e-9


@pytest.mark.parametrize("axis", (0, 1), ids=("along", "across"))
def test_contouring_decays_along_and_across_as_its_gains_say(axis: int) -> None:
    side = moving(Side("contouring", contour_ratio=0.1), 0.0, 2 * np.pi)
    turn, size = np.array([[0.0, 1.0], [-1.0, 0.0]]), 5e-4
    offset = size * np.array([[0.0, 1.0], [-1.0, 0.0]][axis])  # T and N at θ = 0
    q = side.robot.rest(CIRCLE.at(np.array(0.0)) + offset)
    rate = 2 * np.pi * (CIRCLE.at(np.array(0.0), 1) - turn @ offset)  # turns with the frame
    v = np.linalg.solve(jacobian(q), rate)
    side.put(q=q, v=v, encoder=q, encoder_rate=v)
    log = side.run(0.4)
    angle = log["theta_ref"][:, 0]
    gap = log["y"] - CIRCLE.at(angle)
    axes = np.stack([[-np.sin(angle), np.cos(angle)], [-np.cos(angle), -np.sin(angle)]])
    errors = np.einsum("kin,ni->kn", axes, gap)
    ratio = (0.1, 1.0)[axis]
    pole = 20 * np.sqrt(ratio)  # double: K1 = 400, K2 = 40
    t = np.arange(len(angle)) * 1e-3
    expected = size * (1 + pole * t) * np.exp(-pole * t)
    assert np.abs(errors[axis] - expected).max() < 0.02 * size
    assert np.abs(errors[1 - axis]).max() < 0.02 * size


def test_the_velocity_field_keeps_the_energy_of_robot_and_flywheel() -> None:
    side = Side("velocity_field")
    side.run(0.001)
    stored = list[float]()
    for _ in range(5):
        log = side.run(0.5)
        stored.append(kinetic_energy(side, log)[-1] + float(side.fields[FLYWHEEL][0]))
    assert stored == pytest.approx([value_of(side.parameters, "field_energy")] * 5, rel=0.01)


@pytest.mark.parametrize("place", [(0.09, 0.0), (0.0, 0.09), (-0.08, -0.05), (0.0, 0.0)])
def test_a_hand_gets_no_more_energy_from_the_velocity_field_than_it_stores(
    place: tuple[float, float],
) -> None:
    """Passivity: the work on the hand, at every instant, is at most the energy stored before."""
    side = Side("velocity_field")
    side.run(1.0)
    log = side.run(2.0, Push(hand=np.array(place)))
    velocity = np.diff(log["y"], axis=0)  # times dt
    work = -np.cumsum(np.einsum("ni,ni->n", log["force"][:-1], velocity))  # on the hand
    assert work.max() < value_of(side.parameters, "field_energy")
    assert work.min() < 0  # the hand has worked, too


@pytest.mark.thorough
def test_a_bead_slides_on_the_virtual_constraint() -> None:
    """With a speed along the path it stays on it, and its kinetic energy is constant."""
    for curve in PATHS:
        side = moving(Side("virtual_constraint", curve), 0.5, 4.0)
        log = side.run(3.0)
        energy = kinetic_energy(side, log)
        assert side.distance(log).max() < NEAR
        assert energy == pytest.approx(energy[0], rel=2e-3)
        speeds = log["theta_rate"][:, 0]
        assert speeds.min() > 0 and np.ptp(speeds) > 0.2  # the inertia varies along the path


def test_a_bead_that_is_pulled_along_moves_and_one_that_is_left_alone_does_not() -> None:
    side = Side("virtual_constraint")
    assert np.abs(side.run(0.5)["v"]).max() < 1e-9
    log = side.run(0.3, Push(hand=CIRCLE.at(np.array(0.5))))
    assert log["theta"][-1, 0] > 0.3
    assert side.distance(log).max() < 0.005


@pytest.mark.thorough
def test_across_comes_before_along_under_a_torque_limit() -> None:
    """12 rad/s under 0.5 N m, after the first second, on the circle from θ = 0."""
    worst = dict[tuple[str, str], float]()
    for law in ("path_following", "trajectory_tracking"):
        for way in ("cut", "across_first", "slow_down"):
            side = Side(law, K3=1000.0, torque_limit=0.5, speed=12.0, at_limit=way)
            side.run(1.0)
            log = side.run(7.0)
            assert np.abs(log["u"]).max() <= 0.5
            worst[law, way] = 1000 * float(side.distance(log).max())
    assert worst["path_following", "across_first"] < 11
    assert worst["path_following", "slow_down"] < 9
    assert worst["path_following", "cut"] > 25
    tracking = [worst["trajectory_tracking", way] for way in ("cut", "across_first", "slow_down")]
    assert tracking[0] != tracking[1] == tracking[2] and min(tracking) > 25  # it does not help


def test_what_a_law_does_not_name_as_along_the_path_is_its_component_there() -> None:
    """Path following names it; without the name its torques under a limit are the same."""
    law = LAWS["path_following"]
    side = Side(law.name, ellipse((0.06, 0.035)), torque_limit=0.3, speed=12.0)
    kind = kind_of(law.name, side.parameters, side.curve)
    unnamed = dataclasses.replace(
        law, command=lambda view: dataclasses.replace(law.command(view), along=None)
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("onpath.models.closed_loop.kernel.law_named", lambda _: unnamed)
        kernel = build_kernel(side.robot.system, side.robot.frame, kind)
    settings = settings_vector(side.robot, kernel, side.parameters, side.curve, FREE)
    arguments = side.state, settings, side.curve.table(), 300
    expected = side.log.unpack(side.loop.run(*arguments)[1])
    found = side.log.unpack(translate_loop(kernel).run(*arguments)[1])
    assert np.abs(expected["u"]).max() == 0.3
    for name in ("u", "y"):
        assert np.abs(found[name] - expected[name]).max() < 1e-6


def test_without_saturation_the_order_of_across_and_along_changes_nothing() -> None:
    one, other = (
        Side("path_following", torque_limit=3.0, at_limit=way) for way in ("cut", "across_first")
    )
    assert np.abs(one.run(1.0)["y"] - other.run(1.0)["y"]).max() < 1e-12


@pytest.mark.parametrize("name", ROBOTS)
def test_the_coriolis_matrix_is_that_of_the_equations_of_motion(name: str) -> None:
    """C v is the part of c that is quadratic in v, and M' - 2 C is skew."""
    entry = ROBOTS[name]
    robot = entry.make(entry.parameters())
    system, plant = robot.system, robot.plant(entry.parameters())
    rate = ca.reshape(ca.jtimes(ca.vec(ca.densify(system.mass)), system.q, system.v), system.n, -1)
    outputs = [coriolis(system), rate, system.bias]
    function = ca.Function("c", [system.q, system.v, system.parameters], outputs)
    rng = np.random.default_rng(2)
    home = robot.rest(robot.frame.lift(np.zeros(2)))
    for _ in range(10):
        q, v = home + 0.2 * rng.normal(size=system.n), rng.normal(size=system.n)
        matrix, mass_rate, bias = (np.array(x) for x in function(q, v, plant))
        back, still = (np.array(function(q, s * v, plant)[2]) for s in (-1, 0))
        skew = mass_rate - 2 * matrix
        assert np.abs(skew + skew.T).max() < 1e-9
        assert (matrix @ v)[:, None] == pytest.approx((bias + back) / 2 - still, abs=1e-9)
