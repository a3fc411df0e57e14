"""Nothing stops the follower: pulled, braked or walled in at random, it comes back."""

from __future__ import annotations

from types import SimpleNamespace

import casadi as ca
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.controller_tick import INTEGRAL_REACH
from onpath.models.closed_loop.faults import explained, fault_in
from onpath.models.closed_loop.simulation import Push, kind_of
from onpath.models.control.laws.path_following import far_from_path
from onpath.models.control.virtual_output import virtual_output
from onpath.models.paths.curves import circle, ellipse
from onpath.models.paths.distance import path_distance
from onpath.models.paths.frames import Plane
from onpath.models.paths.path_design import presets
from onpath.models.paths.projection import LocalCurve
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import NOT_FINITE
from tests.support import pulls
from tests.support.drawings import random_drawing
from tests.support.pulls import parameters_of, runs_untouched, troubled, untouched

FOLLOWER = "path_following"
RATES, COUNTS, NOISES = (100, 250, 1000), (0.0, 2000.0), (0.0, 1e-4)
PATHS = ("circle", "circle", "ellipse", "segment")
PULLED = ("cart_pendulum", "five_bar", "flexible", "seven_axes", "spatial_arm", "two_link_arm")
"""Robots that no pull stops. A hand may whip a joint of the planar arm (the table in README.md), or
the gantry's rod at 100 Hz."""
WORD = {closed: random_drawing(5, closed=closed) for closed in (True, False)}
NEAR = 0.005  # [m], within which it must be 1.5 s after its release


def check(robot: str, parameters: Parameters, seed: int, pulls: int, path: str = "circle") -> None:
    for number, each in enumerate(troubled(robot, parameters, FOLLOWER, seed, pulls, path)):
        assert each.fault is None, (number, each.trouble, each.fault)
        assert each.late < NEAR, (number, each.trouble, each.late)


@settings(max_examples=3)
@given(
    st.sampled_from(PULLED),
    st.sampled_from(RATES),
    st.sampled_from(COUNTS),
    st.sampled_from(NOISES),
    st.integers(0, 2**32 - 1),
    st.sampled_from(PATHS),
)
def test_nothing_stops_the_follower(
    robot: str, rate: int, counts: float, noise: float, seed: int, path: str
) -> None:
    parameters = parameters_of(robot, control_rate=rate, encoder_counts=counts, sensor_noise=noise)
    assume(runs_untouched(robot, parameters, FOLLOWER, path))
    check(robot, parameters, seed, pulls=3, path=path)


@pytest.mark.thorough
@settings(max_examples=4)
@given(
    robot=st.sampled_from(PULLED),
    rate=st.sampled_from(RATES),
    counts=st.sampled_from(COUNTS),
    noise=st.sampled_from(NOISES),
)
def test_no_pull_of_many_stops_the_follower(
    robot: str, rate: int, counts: float, noise: float
) -> None:
    parameters = parameters_of(robot, control_rate=rate, encoder_counts=counts, sensor_noise=noise)
    if not runs_untouched(robot, parameters, FOLLOWER):
        assert ROBOTS[robot].caution(parameters) is not None  # said before the run
        return
    assert ROBOTS[robot].caution(parameters) is None
    check(robot, parameters, seed=2026, pulls=15 if ROBOTS[robot].flexible_link else 60)


def at_their_limits(robot: str, radius: float, **changes: float) -> list[pulls.Result]:
    """Pulls behind encoders and noise; untouched, the follower is within 1 mm."""
    parameters = parameters_of(robot, encoder_counts=2000.0, sensor_noise=1e-4, **changes)
    off = untouched(robot, parameters, FOLLOWER, circle(radius))
    assert off is not None and off < 1e-3
    return list(troubled(robot, parameters, FOLLOWER, 5, 24, circle(radius)))


@pytest.mark.thorough
def test_nor_at_a_great_speed() -> None:
    for each in at_their_limits("two_link_arm", 0.05, speed=20.0, control_rate=250):
        assert each.fault is None and each.late < 1e-3


@pytest.mark.thorough
def test_a_pull_over_the_edge_of_the_workspace_ends_with_that_as_its_cause() -> None:
    stopped = [each for each in at_their_limits("five_bar", 0.1, control_rate=1000) if each.fault]
    assert len(stopped) <= 2
    assert all("all links in one line" in each.fault[1] for each in stopped if each.fault)


def whipped(**changes: float) -> pulls.Result:
    """A hand that jumps about swings the arm along a figure of eight at 3 m/s."""
    parameters, curve = parameters_of("planar_arm", **changes), presets()["figure of eight"].curve
    return troubled("planar_arm", parameters, FOLLOWER, 2026, 8, curve)[2]


@pytest.mark.thorough
def test_a_hand_whips_the_planar_arm_only_beyond_the_torques_of_its_file() -> None:
    assert whipped().fault is not None  # with exact measurements
    held = whipped(torque_limit=100.0)
    assert held.fault is None and held.late < NEAR


def test_a_stop_beyond_the_torques_of_the_file_says_so() -> None:
    parameters = parameters_of("planar_arm")
    robot = ROBOTS["planar_arm"].make(parameters)
    log = pulls.loop_of(robot, kind_of(FOLLOWER, parameters, circle(0.05))).layouts.log
    row = {name: np.zeros(size) for name, size in log.fields}
    for torque, beyond in ((11.0, False), (25.0, True)):
        rows = log.pack(row | {"u": np.array([torque, 0.0, 0.0])})[None]
        reason = explained(NOT_FINITE, robot, log, FOLLOWER, rows, parameters, circle(0.05))
        assert ("more than the 12 N m that the robot's file states" in str(reason)) is beyond


@given(
    st.floats(0.05, 3),
    st.floats(-500, 500),
    st.floats(-20, 20),
    st.sampled_from([1e-3, 4e-3, 1e-2, 2.5e-2]),
    st.floats(0, 50),
)
def test_the_return_takes_over_far_from_the_path_and_nowhere_else(
    spread: float, rate: float, wanted: float, lag: float, turning: float
) -> None:
    output = SimpleNamespace(spread=ca.SX(spread), theta_rate=ca.SX(rate))
    clock, closest = SimpleNamespace(closed=True), SimpleNamespace(turning=ca.SX(turning))
    view = SimpleNamespace(
        output=output, clock=clock, closest=closest, lag=ca.SX(lag), drawing=False
    )
    share = float(far_from_path(view, ca.SX(abs(wanted))))  # type: ignore[arg-type]
    turn = (abs(rate) - abs(wanted)) * lag * max(1.0, turning)
    assert 0 <= share <= 1
    if spread >= 0.5 and turn <= 0.15:
        assert share == 0  # the law as printed, bit by bit
    if spread <= 0.2 or turn >= 0.3:
        assert share == pytest.approx(1, abs=1e-9)


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_beside_a_drawing_the_turn_is_that_of_a_steady_motion(seed: int, closed: bool) -> None:
    """By differences along the motion with a constant speed of σ(θ) and a constant λ'."""
    rng, curve, frame, h = np.random.default_rng(seed), WORD[closed], Plane(), 1e-5
    theta, side, speed, aside = rng.uniform(-3, 3), rng.uniform(-1, 1), *rng.normal(0, 0.1, 2)
    sigma, first, second, third = (each[0] for each in curve.all_orders(np.array([theta])))
    distance = 0.9 * side / max(abs(float(curve.curvature(np.array(theta)))), 10.0)
    rate = speed / np.linalg.norm(first)

    def place(t: float) -> Array:
        at = theta + rate * t - (rate * t) ** 2 / 2 * (first @ second) / (first @ first)
        z, along = (curve.at(np.array(at), order) for order in (0, 1))
        left = np.array([-along[1], along[0]]) / np.linalg.norm(along)
        return z + (distance + aside * t) * left

    y, y_rate = place(0.0), (place(h) - place(-h)) / (2 * h)
    turned = np.linalg.norm(place(h) - 2 * y + place(-h)) / h**2 / np.linalg.norm(y_rate)
    assume(turned > 0.01)
    closest = LocalCurve(ca.SX(theta), *(ca.SX(each) for each in (sigma, first, second, third)))
    output = virtual_output(closest, frame, None, ca.SX(y), ca.SX(y_rate))
    assume(float(output.spread) > 0.5)
    for turn, share in ((0.14, 0.0), (0.225, 0.5), (0.31, 1.0)):
        view = SimpleNamespace(
            output=output,
            closest=closest,
            clock=SimpleNamespace(closed=True),
            frame=frame,
            y_rate=ca.SX(y_rate),
            lag=ca.SX(turn / turned),
            drawing=True,
        )
        found = float(far_from_path(view, ca.SX(0)))  # type: ignore[arg-type]
        assert found == pytest.approx(share, abs=0.02)


@pytest.mark.thorough
@settings(max_examples=12)
@given(st.sampled_from(["circle", "clover", "ellipse"]), st.integers(0, 2**32 - 1))
def test_on_the_return_energy_never_rises_whichever_closest_point_is_taken(
    path: str, seed: int
) -> None:
    curve, rng, dt = presets()[path].curve, np.random.default_rng(seed), 3e-4
    y, rate = rng.uniform(-0.08, 0.08, 2), rng.uniform(-2, 2, 2)
    before = np.inf
    for _ in range(60):
        theta, distance = curve.nearest(y[None])
        energy = (400 * distance[0] ** 2 + rate @ rate) / 2
        assert energy <= before + 1e-4 * max(1.0, energy)  # explicit steps
        before = energy
        sigma = curve.at(theta)[0]
        acceleration = -400 * (y - sigma) - 40 * rate
        y, rate = y + dt * rate + dt**2 / 2 * acceleration, rate + dt * acceleration


@settings(max_examples=20)
@given(st.floats(0, 1), st.floats(-np.pi, np.pi), st.sampled_from(["five_bar", "two_link_arm"]))
@example(0.0, 0.0, "five_bar")  # ∇s = 0, and 1 - λκ = 0.67
def test_from_anywhere_inside_it_comes_back_by_the_level_set(
    share: float, angle: float, robot: str
) -> None:
    parameters = parameters_of(robot, across="level_set")
    made, curve = ROBOTS[robot].make(parameters), ellipse((0.07, 0.04))
    loop = pulls.loop_of(made, kind_of(FOLLOWER, parameters, curve))
    begin = made.rest(made.frame.lift(share * curve.at(np.array(angle))))
    state = pulls.first_state(made, loop.layouts, curve, begin)
    own = pulls.settings_vector(made, loop.layouts, parameters, curve, pulls.FREE)
    _, (rows,) = loop.run_many([state], [own], [curve.table()], 1500)
    assert fault_in(made, loop.layouts.log, FOLLOWER, rows, parameters) is None
    y = loop.layouts.log.unpack(rows)["y"]
    assert path_distance(made.frame, curve, y)[-1] < NEAR


@pytest.mark.parametrize("law", ["path_following", "trajectory_tracking", "waiting_clock"])
def test_no_integral_moves_the_balance_by_more_than_its_bound(law: str) -> None:
    parameters = parameters_of("five_bar", tracker_integral="on")
    robot, curve = ROBOTS["five_bar"].make(parameters), presets()["circle"].curve
    loop = pulls.loop_of(robot, kind_of(law, parameters, curve))
    rng, layouts = np.random.default_rng(5), loop.layouts
    begin = pulls.begin_at(robot, curve, 0.3)
    state = pulls.first_state(robot, layouts, curve, begin)
    own = pulls.settings_vector(robot, layouts, parameters, curve, pulls.FREE)
    full = False
    for _ in range(20):
        push = pulls.Push(rng.uniform(-0.2, 0.2, 2))
        given = [state], [pulls.pushed(layouts, own, push)], [curve.table()]
        (state,), (rows,) = loop.run_many(*given, 200)
        integral = np.linalg.norm(layouts.state.unpack(state)["integral"])
        assert parameters.K3 * integral <= parameters.K1 * INTEGRAL_REACH * (1 + 1e-9)
        used = layouts.log.unpack(rows)["integral_used"]
        assert used.min() >= 0 and used.max() <= 1
        full |= bool((used > 0.999).any())
    assert full


@pytest.mark.parametrize("radius", [1e-3, 2e-3])
def test_a_small_circle_is_followed_again_after_a_pull(radius: float) -> None:
    """The integral, bounded by half the radius, does not hold the arm inside of it."""
    parameters, curve = parameters_of("five_bar"), circle(radius)
    robot = ROBOTS["five_bar"].make(parameters)
    loop = pulls.loop_of(robot, kind_of(FOLLOWER, parameters, curve))
    state = pulls.first_state(robot, loop.layouts, curve, pulls.begin_at(robot, curve, 0.0))
    free = pulls.settings_vector(robot, loop.layouts, parameters, curve, pulls.FREE)
    hand = pulls.pushed(loop.layouts, free, Push(hand=np.array([0.02, 0.01])))
    for own, ticks in ((hand, 1000), (free, 1500), (free, 1000)):
        (state,), (rows,) = loop.run_many([state], [own], [curve.table()], ticks)
    log = loop.layouts.log.unpack(rows)
    assert path_distance(robot.frame, curve, log["y"]).max() < 0.1 * radius
    assert np.diff(log["theta"][[0, -1], 0])[0] == pytest.approx(parameters.speed, rel=0.05)
