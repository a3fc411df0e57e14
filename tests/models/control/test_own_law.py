"""A typed law: what its names mean, what it commands, and that bad numbers stop the run."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop
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
from onpath.models.control.laws import own
from onpath.models.control.laws.own import PATH_FOLLOWING, own_law, tidy
from onpath.models.control.laws.registry import LAWS, law_named
from onpath.models.errors import CodedError
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import experiments, run
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE, ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot, RobotEntry

CIRCLE, CLOVER, SEGMENT = (presets()[name].curve for name in ("circle", "clover", "segment"))

LIMITED = -1.0
"""Stands for a torque limit that the robot reaches, but with which it stays on the path."""
SETTINGS: dict[str, tuple[Curve, dict[str, Any]]] = {
    "PD": (CIRCLE, {"K3": 0.0}),
    "PID": (CLOVER, {"K3": 500.0}),
    "limit": (CIRCLE, {"K3": 500.0, "torque_limit": LIMITED}),
    "level set": (CIRCLE, {"across": "level_set", "control_rate": 100}),
    "open": (SEGMENT, {"encoder_counts": 2000.0}),
}


def robot_of(entry: RobotEntry, **changes: Any) -> tuple[Robot, Parameters]:
    if changes.get("torque_limit") == LIMITED:
        changes["torque_limit"] = 3.0 if entry is FLEXIBLE else 0.3
    parameters = replace(entry.parameters(), **changes)
    return entry.make(parameters), parameters


def begin(robot: Robot, kernel: Kernel, curve: Curve) -> Array:
    """At rest, 10 % outside the path."""
    start = robot.frame.lift(1.1 * curve.at(np.array(0.3)))
    return first_state(robot, kernel, curve, robot.rest(start))


def logs(
    entry: RobotEntry, law: str, curve: Curve = CIRCLE, ticks: int = 400, **changes: Any
) -> tuple[Kernel, Array, Array]:
    """Rows of a run's log, interpreted and compiled; the brake acts in the second half."""
    robot, parameters = robot_of(entry, **changes)
    kernel = kernel_of(robot, kind_of(law, parameters, curve))
    found = list[Array]()
    for loop in (InterpretedLoop(kernel), translate_loop(kernel)):
        state, rows = begin(robot, kernel, curve), list[Array]()
        for held in (False, True):
            y = robot.endpoint(kernel.state.unpack(state)["q"])
            theta = float(kernel.state.unpack(state)["theta"][0])
            push = Push(None, brake_at(robot, curve, y, theta)) if held else FREE
            settings = settings_vector(robot, kernel, parameters, curve, push)
            state, more = loop.run(state, settings, curve.table(), ticks // 2)
            rows.append(more)
        found.append(np.concatenate(rows))
    return kernel, found[0], found[1]


def motion(kernel: Kernel, rows: Array) -> Array:
    """The rows without the share of its bound that the integral takes, which K3 scales."""
    return np.delete(rows, kernel.log.slices["integral_used"].start, axis=1)


MOVING = np.array([0.4, -0.3])


def torques(text: str, entry: RobotEntry, v: Array, curve: Curve = CIRCLE, **changes: Any) -> Array:
    """The torques in the first tick, moving and with something in the memory."""
    robot, parameters = robot_of(entry, **changes)
    kernel = kernel_of(robot, kind_of(text, parameters, curve))
    state = begin(robot, kernel, curve)
    kernel.state.unpack(state)["v"][:] = v
    kernel.state.unpack(state)["theta_ref"][:] = 0.5
    kernel.state.unpack(state)["integral"][0] = 0.02
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    _, rows = InterpretedLoop(kernel).run(state, settings, curve.table(), 1)
    return kernel.log.unpack(rows[0])["u"]


# The law that a user begins with is path following.


@pytest.mark.thorough
@settings(max_examples=10)
@given(robot=st.sampled_from(list(ROBOTS)), setting=st.sampled_from(list(SETTINGS)))
def test_the_first_text_is_path_following_bit_by_bit(robot: str, setting: str) -> None:
    entry, (curve, changes) = ROBOTS[robot], SETTINGS[setting]
    _, wanted, _ = logs(entry, "path_following", curve, **changes)
    _, typed, compiled = logs(entry, PATH_FOLLOWING, curve, **changes)
    assert np.isfinite(wanted).all()
    assert np.array_equal(typed, wanted)
    assert np.array_equal(typed, compiled)


def test_without_the_integral_it_is_path_following_with_k3_zero() -> None:
    text = "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)"
    kernel, wanted, _ = logs(FIVE_BAR, "path_following", K3=0.0)
    _, typed, _ = logs(FIVE_BAR, text, K3=700.0)
    assert np.array_equal(motion(kernel, typed), motion(kernel, wanted))


def test_the_integral_runs_although_k3_is_zero_and_stops_while_a_torque_saturates() -> None:
    for limit in (0.0, 0.3):
        kernel, wanted, _ = logs(FIVE_BAR, "path_following", K3=900.0, torque_limit=limit)
        text = PATH_FOLLOWING.replace("K3", "900")
        _, typed, _ = logs(FIVE_BAR, text, K3=0.0, torque_limit=limit)
        assert np.array_equal(motion(kernel, typed), motion(kernel, wanted))


@pytest.mark.thorough
@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_a_law_with_everything_in_it_is_compiled_to_the_same_bits(robot: str) -> None:
    text = (
        "across = -K1*xi - 9*sign(dxi)*sqrt(abs(dxi)) if xi**2 < 1 and not t > 9 else min(y1, v1)\n"
        "along = tanh(e1 + de2)*max(sin(theta), cos(theta_r), 0.1) / (1 + int_xi**4)"
    )
    kernel, interpreted, compiled = logs(ROBOTS[robot], text, ticks=100)
    assert np.isfinite(interpreted).all() and kernel.log.unpack(interpreted)["u"].any()
    assert np.array_equal(interpreted, compiled)


# What the names mean: torques are logged, so that u1 = xi shows xi.


def near(robot: Robot, curve: Curve, v: Array) -> dict[str, float]:
    """The names, computed from the paper's definitions, half a tick ahead of the start."""
    q, system = robot.rest(robot.frame.lift(1.1 * curve.at(np.array(0.3)))), robot.system
    inputs = [system.q, system.v, system.tau, system.parameters]
    plant = robot.plant(FIVE_BAR.parameters())
    a = ca.Function("a", inputs, [system.acceleration])(q, v, 0, plant).full().ravel()
    half, step = 0.5e-3, 1e-5

    def y(time: float) -> Array:
        return robot.endpoint(q + v * time + a * time**2 / 2)

    def place(time: float) -> float:
        theta = curve.nearest(robot.frame.planar(y(time))[None])[0]
        for _ in range(4):  # Newton's method, since the search is not exact to the last digits
            s, first, second = (curve.at(theta, order)[0] for order in range(3))
            gap = robot.frame.planar(y(time)) - s
            theta = theta + gap @ first / (first @ first - gap @ second)
        return float(theta[0])

    def across(time: float) -> float:
        first = curve.at(np.array(place(time)), 1)
        normal = np.array([-first[1], first[0]]) / np.linalg.norm(first)
        return float(normal @ (robot.frame.planar(y(time)) - curve.at(np.array(place(time)))))

    def error(time: float) -> Array:
        theta_r = 0.5 + 2 * np.pi * time
        return y(time) - robot.frame.lift(curve.at(np.array(theta_r)))

    def rate(of: Any) -> Any:
        return (of(half + step) - of(half - step)) / (2 * step)

    values = {"xi": across(half), "dxi": rate(across), "theta": place(half), "dtheta": rate(place)}
    values |= {"theta_r": 0.5 + 2 * np.pi * half, "speed": 2 * np.pi, "t": half, "int_xi": 0.02}
    vectors = {"y": y(half), "v": rate(y), "e": error(half), "de": rate(error)}
    return values | {f"{n}{i + 1}": float(x) for n, w in vectors.items() for i, x in enumerate(w)}


@pytest.mark.parametrize("curve", [CIRCLE, CLOVER], ids=["circle", "clover"])
def test_every_name_means_what_the_page_of_help_says(curve: Curve) -> None:
    robot, parameters = robot_of(FIVE_BAR)
    wanted = near(robot, curve, MOVING)
    wanted |= {name: getattr(parameters, name) for name in ("K1", "K2", "K3", "K4", "K5")}
    assert wanted.keys() == set(own.VIEW)
    for name, value in wanted.items():
        first, second = torques(f"u2 = {name}; u1 = -{name}", FIVE_BAR, MOVING, curve)
        assert second == pytest.approx(value, rel=1e-5, abs=1e-7) and first == -second, name


def test_in_space_the_further_components_are_numbered() -> None:
    """The third component is across the path's plane, and so is the second distance."""
    robot, _ = robot_of(FLEXIBLE)
    v = np.zeros(robot.system.n)
    v[:3] = 0.2, -0.1, 0.3

    def value(name: str) -> float:
        text = f"u1 = 0; u2 = 0; u3 = {name}"
        return float(torques(text, FLEXIBLE, v, output="redefined")[2])

    assert value("y3") == pytest.approx(robot.endpoint(robot.rest(np.zeros(3)))[2], abs=0.2)
    plane: Any = robot.frame
    y = [value(f"y{i + 1}") for i in range(3)]
    assert value("xi2") == pytest.approx(y[0] - plane.b * y[1] - plane.d, abs=1e-12)
    for name in ("dxi2", "v3", "e3", "de3", "int_xi2"):
        assert np.isfinite(value(name))


def test_the_second_normal_has_the_law_18_unless_a_line_says_otherwise() -> None:
    same = PATH_FOLLOWING + "; across2 = -K1*xi2 - K2*dxi2 - K3*int_xi2"
    other = PATH_FOLLOWING + "; across2 = 0.3"
    wanted, again, changed = (
        logs(FLEXIBLE, text, ticks=60)[1] for text in (PATH_FOLLOWING, same, other)
    )
    assert np.array_equal(wanted, again) and not np.allclose(wanted, changed)


def test_time_begins_with_the_law_and_goes_by_the_clock_at_every_control_rate() -> None:
    for rate, ticks in ((1000, 1), (100, 10), (2000, 1)):
        kernel, rows, _ = logs(FIVE_BAR, "u1 = t; u2 = 0", ticks=80, control_rate=rate)
        u, interval = kernel.log.unpack(rows)["u"][:, 0], 1 / rate
        shown = u[::ticks]
        assert np.diff(shown) == pytest.approx(interval, rel=1e-9)
        assert 0 < shown[0] <= interval


# A number that is none stops the run.


@pytest.mark.parametrize(
    "text",
    [
        "across = 1/max(theta - 9, 0); along = 0",
        "across = 0; along = sqrt(-1 - xi**2)",
        "u1 = 1/(t - t*(1 + 0*xi)); u2 = 0".replace("t*(1 + 0*xi)", "min(t, 9)"),
        "across = (1e9 + xi)**4; along = 0",
        "u2 = 1/min(abs(dxi), 0); u1 = 0",
    ],
)
@pytest.mark.parametrize("limit", [0.0, 0.3])
def test_a_law_without_finite_numbers_leaves_no_finite_state_and_no_torque(
    text: str, limit: float
) -> None:
    """A torque limit would otherwise hide it: the least of NaN and a limit is the limit."""
    robot, parameters = robot_of(FIVE_BAR, torque_limit=limit)
    kernel = kernel_of(robot, kind_of(text, parameters, CIRCLE))
    settings = settings_vector(robot, kernel, parameters, CIRCLE, FREE)
    for loop in (InterpretedLoop(kernel), translate_loop(kernel)):
        state, rows = loop.run(begin(robot, kernel, CIRCLE), settings, CIRCLE.table(), 20)
        log = kernel.log.unpack(rows)
        assert np.isnan(kernel.state.unpack(state)["theta_ref"]).all()
        assert np.isfinite(log["theta_ref"][0]).all() and np.isnan(log["theta_ref"][1:]).all()
        assert np.abs(log["u"]).max() < 0.3 and np.abs(log["v"]).max() < 1


def test_a_law_may_divide_by_zero_where_it_is_not_used() -> None:
    text = "across = -K1*xi - K2*dxi + (1/max(theta - 9, 0) if theta > 9 else 0); along = 1"
    _, rows, compiled = logs(FIVE_BAR, text)
    assert np.isfinite(rows).all() and np.array_equal(rows, compiled)


# What is not a law.


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("across = xi", "error.law_without_line"),
        ("along = xi", "error.law_without_line"),
        ("across = xi; across2 = 0", "error.law_without_line"),
        ("u2 = 0", "error.law_without_line"),
        ("u1 = 0; u3 = 0", "error.law_without_line"),
        ("u1 = 0; u2 = 0; along = 1", "error.law_mixed"),
        ("= ;", "error.law"),
        (";=", "error.law"),
        ("a = b", "error.law"),
        ("across = xii; along = 0", "error.law"),
        ("=" * 600, "error.law_too_long"),
        ("path_followin", "error.unknown_name"),
        ("", "error.unknown_name"),
        ("__class__", "error.unknown_name"),
    ],
)
def test_text_that_is_not_a_law_is_refused(text: str, code: str) -> None:
    with pytest.raises(CodedError) as refused:
        law_named(text)
    assert refused.value.message.code == code and str(refused.value)


def test_a_law_needs_the_motors_and_the_space_that_it_names() -> None:
    flat, space = robot_of(FIVE_BAR)[0].system, robot_of(FLEXIBLE)[0].system
    for text, suits_flat, suits_space in (
        (PATH_FOLLOWING, True, True),
        ("u1 = 0; u2 = 0", True, False),
        ("u1 = 0; u2 = 0; u3 = 0", False, True),
        ("across = xi2; along = 0", False, True),
        ("across = e3 + y3; along = 0", False, True),
        ("across = 0; along = 0; across2 = 0", False, True),
    ):
        law = law_named(text)
        assert (law.suits(flat), law.suits(space)) == (suits_flat, suits_space), text
    robot, parameters = robot_of(FIVE_BAR)
    with pytest.raises(CodedError):
        kernel_of(robot, kind_of("across = xi2; along = 0", parameters, CIRCLE))


def test_a_law_says_what_it_aims_at_and_which_gains_it_has() -> None:
    assert own_law(PATH_FOLLOWING).aim == "theta" == LAWS["path_following"].aim
    assert own_law(PATH_FOLLOWING).reference is None
    assert own_law(PATH_FOLLOWING).gains == ("K1", "K2", "K3", "K5")
    chasing = own_law("u1 = -K4*e1; u2 = -K4*de2")
    assert chasing.aim == "theta_ref" and chasing.reference is not None
    assert chasing.gains == ("K4",)


# Laws are kept for a while.


def test_the_same_text_is_the_same_law_and_few_are_kept() -> None:
    assert own_law(PATH_FOLLOWING) is law_named(PATH_FOLLOWING)
    for number in range(3 * own.MOST_KEPT):
        own_law(f"across = {number}; along = 0")
    assert own_law.cache_info().currsize == own.MOST_KEPT


def test_a_tidy_text_is_the_same_law_on_one_line() -> None:
    text = tidy("\n across = -K1*xi \r\n\n along = 1;; ")
    assert text == "across = -K1*xi; along = 1" == tidy(text)
    assert tidy(PATH_FOLLOWING) == PATH_FOLLOWING


# In an experiment.


def test_an_experiment_under_typed_path_following_is_that_of_path_following() -> None:
    chosen = experiments()["obstruction"].with_values(
        {"duration": "1.5", "hold_from": "0.5", "hold_to": "1", "K3": "0"}
    )
    wanted = run(chosen, "path_following")
    typed = run(chosen, "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)")
    assert wanted.held.any() and np.array_equal(typed.t, wanted.t)
    for name, values in wanted.fields.items():
        assert np.array_equal(typed.fields[name], values), name


@pytest.mark.parametrize(
    ("text", "seconds"),
    [
        ("across = 1/max(theta - 99, 0); along = 0", 0.001),
        ("across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed) + sqrt(0.3 - t)", 0.301),
    ],
)
def test_an_experiment_stops_where_the_typed_law_has_no_finite_number(
    text: str, seconds: float
) -> None:
    stopped = run(experiments()["obstruction"], text)
    assert "the typed law" in stopped.reason
    assert stopped.stopped_at == pytest.approx(seconds, abs=1e-9)
    assert all(np.isfinite(values).all() for values in stopped.fields.values())


def test_a_law_that_tears_the_robot_apart_stops_for_that_reason() -> None:
    stopped = run(experiments()["obstruction"], "u1 = 900; u2 = 900")
    assert stopped.stopped_at is not None and "the typed law" not in stopped.reason
