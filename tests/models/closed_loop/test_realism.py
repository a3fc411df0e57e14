"""What a real robot does and the ideal one does not: friction, delay, torque steps, noise."""

from __future__ import annotations

import dataclasses
from functools import cache
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.delay import LONGEST
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.sensing import read
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    primed,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.poles import channels
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters, time_step

CURVE = circle(0.05)
EVERYTHING = {
    "stiction": 0.05,
    "coulomb": 0.03,
    "torque_step": 0.01,
    "delay": 1.35,
    "sensor_noise": 5e-5,
    "seed": 7,
}
PARTS = ("stiction", "coulomb"), ("torque_step",), ("delay",), ("sensor_noise", "seed"), ()
Log = dict[str, Array]


def kernel_for(robot: str, parameters: Parameters, law: str = "path_following") -> Kernel:
    made = ROBOTS[robot].make(parameters)
    return kernel_of(made, kind_of(law, parameters, CURVE, FREE))


@cache
def loop_of(kernel: Kernel):
    return translate_loop(kernel)


def start(robot: str, parameters: Parameters, kernel: Kernel, offset: float = 0.0) -> Array:
    made = ROBOTS[robot].make(parameters)
    place = made.frame.lift(np.array([0.05 + offset, 0.0]))
    return first_state(made, kernel, CURVE, made.rest(place))


def ran(
    seconds: float,
    robot: str = "five_bar",
    offset: float = 0.0,
    viscous: bool = True,
    **values: Any,
) -> Log:
    """The log of a run from the right-hand end of the circle, at rest."""
    parameters = dataclasses.replace(ROBOTS[robot].parameters(), **values)
    kernel = kernel_for(robot, parameters)
    made = ROBOTS[robot].make(parameters)
    settings = settings_vector(made, kernel, parameters, CURVE, FREE)
    if not viscous:
        for vector in ("plant", "model"):
            first = kernel.settings.slices[vector].start
            for name in ("b1", "b2"):
                settings[first + made.system.parameter_names.index(name)] = 0.0
    state = start(robot, parameters, kernel, offset)
    ticks = round(seconds / time_step(parameters))
    rows = loop_of(kernel).run(state, settings, CURVE.table(), ticks)[1]
    return kernel.log.unpack(rows)


# Both tiers


@pytest.mark.thorough
@settings(max_examples=10)
@given(name=st.sampled_from(list(ROBOTS)), names=st.sampled_from(PARTS))
def test_both_tiers_agree_to_the_last_bit(name: str, names: tuple[str, ...]) -> None:
    values: dict[str, Any] = {each: EVERYTHING[each] for each in names or EVERYTHING}
    if hasattr(ROBOTS[name].parameters(), "strain_noise") and "seed" in values:
        values["strain_noise"] = 3e-4
    if not names:
        values |= {"control_rate": 500, "encoder_counts": 20000.0}
    parameters = dataclasses.replace(ROBOTS[name].parameters(), **values)
    kernel = kernel_for(name, parameters)
    made = ROBOTS[name].make(parameters)
    settings = settings_vector(made, kernel, parameters, CURVE, FREE)
    state = start(name, parameters, kernel, 0.002)
    given = state, settings, CURVE.table(), 200
    results = InterpretedLoop(kernel).run(*given), loop_of(kernel).run(*given)
    for one, other in zip(*results, strict=True):
        assert np.array_equal(one, other) and np.isfinite(one).all()


@pytest.mark.thorough
@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_the_ideal_loop_has_no_part_in_it(name: str) -> None:
    """Neither its instructions nor what it leaves alone at the end of the state."""
    parameters = ROBOTS[name].parameters()
    kernel = kernel_for(name, parameters)
    parts = kernel.state.slices
    assert kernel.advance.size_in(0)[0] == parts["ticks"].start
    state = start(name, parameters, kernel)
    state[parts["ticks"].start :] = 0.25
    settings = settings_vector(ROBOTS[name].make(parameters), kernel, parameters, CURVE, FREE)
    for loop in (InterpretedLoop(kernel), loop_of(kernel)):
        after = loop.run(state, settings, CURVE.table(), 20)[0]
        assert (after[parts["ticks"].start :] == 0.25).all() and after[0] != state[0]


@pytest.mark.parametrize("name", ["stiction", "torque_step", "delay", "sensor_noise"])
def test_the_less_of_it_the_nearer_to_the_run_without_it(name: str) -> None:
    """With noise, the velocities are filtered, however small it is."""
    none: dict[str, Any] = {name: 1e-12} if name == "sensor_noise" else {}
    ideal = ran(0.5, control_rate=500, **none)["y"]
    far = [
        np.abs(ran(0.5, control_rate=500, **{name: EVERYTHING[name] * part})["y"] - ideal).max()
        for part in (1.0, 0.1, 1e-6)
    ]
    assert far[0] > far[1] >= far[2] and far[2] < 1e-6


# Static friction


def stuck(robot: str, torque: Array, **values: Any) -> Log:
    """0.3 s under a constant torque besides gravity: the law is off, the joints begin at rest."""
    parameters = dataclasses.replace(
        ROBOTS[robot].parameters(),
        K1=0.0,
        K2=0.0,
        K3=0.0,
        K5=0.0,
        delay=1.0,
        control_rate=50,
        **values,
    )
    kernel = kernel_for(robot, parameters)
    made = ROBOTS[robot].make(parameters)
    settings = settings_vector(made, kernel, parameters, CURVE, FREE)
    state, parts = start(robot, parameters, kernel), kernel.state.slices
    q = kernel.state.unpack(state)["q"]
    function = made.system.function("bias")
    gravity = function(q, 0 * q, made.plant(parameters)).full().ravel()
    state[parts["u"]] = gravity[: made.system.m] + torque
    state = primed(kernel, state)
    settings[kernel.settings.slices["delay_ticks"]] = LONGEST * 20  # what was asked for goes on
    return kernel.log.unpack(loop_of(kernel).run(state, settings, CURVE.table(), 150)[1])


@pytest.mark.parametrize("robot", ["five_bar", "two_link_arm"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_joint_rests_below_the_static_level_and_moves_above_it(robot: str, sign: float) -> None:
    levels = {"stiction": 0.08, "coulomb": 0.05}
    below = stuck(robot, sign * np.array([0.0799, 0.0799]), **levels)
    assert (below["v"] == 0).all() and (below["q"] == below["q"][0]).all()
    above = stuck(robot, sign * np.array([0.0801, 0.0]), **levels)
    moved = above["q"][:, 0] - above["q"][0, 0]
    assert sign * moved[-1] > 0.01 and (sign * np.diff(moved)[1:] > 0).all()
    slides = stuck(robot, sign * np.array([0.0799, 0.0]), stiction=0.02, coulomb=0.05)
    assert sign * (slides["q"][-1, 0] - slides["q"][0, 0]) > 0.005  # the larger one holds


def test_a_sliding_joint_feels_the_coulomb_level() -> None:
    made = ROBOTS["five_bar"].make(ROBOTS["five_bar"].parameters())
    inertia = dict(
        zip(made.system.parameter_names, made.plant(ROBOTS["five_bar"].parameters()), strict=True)
    )
    log = stuck("five_bar", np.array([0.1, 0.0]), stiction=0.08, coulomb=0.05)
    gained = log["v"][20, 0]  # viscous friction is small still
    assert gained == pytest.approx(0.05 * 0.02 / inertia["M11"], rel=0.05)


def test_a_joint_that_is_pulled_along_needs_the_coupling_torque_to_rest() -> None:
    """On the arm, a torque at the elbow would swing the upper arm, too."""
    log = stuck("two_link_arm", np.array([0.0, -0.2]), stiction=0.08, coulomb=0.05)
    assert abs(log["q"][-1, 1] - log["q"][0, 1]) > 0.05
    held = stuck("two_link_arm", np.array([0.0, -0.2]), stiction=0.3, coulomb=0.05)
    assert (held["v"] == 0).all()


def test_with_an_integral_it_hunts_and_without_it_stays_off() -> None:
    """A position task: the classical limit cycle of PID and static friction."""
    task = {"task": "position", "target": 0.0, "stiction": 0.06, "coulomb": 0.03}
    without = ran(12.0, offset=0.003, K3=0.0, **task)
    late = without["xi"][6000:, 0]
    assert np.ptp(late) == 0.0 and 5e-5 < abs(late[0]) < 2e-3
    hunting = ran(12.0, offset=0.003, K3=3000.0, **task)
    late = hunting["xi"][6000:, 0]
    assert np.count_nonzero(np.diff(np.sign(late))) >= 3  # it passes the path again and again
    moves = (hunting["v"][6000:] != 0).any(axis=1)
    assert 0.0 < moves.mean() < 0.5 and np.count_nonzero(np.diff(moves.astype(int)) > 0) >= 3
    smooth = ran(12.0, offset=0.003, K3=3000.0, task="position", target=0.0, coulomb=0.03)
    assert np.abs(smooth["xi"][-1000:]).max() < 0.01 * np.abs(late).max()


# Delay


@pytest.mark.parametrize("delay", [0.25, 1.0, 2.5, LONGEST])
@pytest.mark.parametrize("rate", [250, 1000, 2000])
def test_a_torque_takes_effect_after_the_delay(delay: float, rate: int) -> None:
    """The torque of the first evaluation, which is the first one that is not zero."""
    log = ran(0.06, offset=0.01, speed=0.0, delay=delay, control_rate=rate)
    dt = time_step(dataclasses.replace(ROBOTS["five_bar"].parameters(), control_rate=rate))
    ticks = delay / rate / dt
    whole, part = int(ticks + 1e-9), ticks % 1
    u, at_once = log["u"], ran(0.01, offset=0.01, speed=0.0, control_rate=rate)["u"][0]
    assert (u[:whole] == 0).all()
    np.testing.assert_allclose(u[whole], (1 - part) * at_once, rtol=1e-9)
    assert np.abs(u[whole]).max() > 0.1


@pytest.mark.parametrize("delay", [0.4, 1.0, 1.75, 3.0])
def test_error_across_moves_as_the_poles_with_delay_say(delay: float) -> None:
    """The slow part of the error: what the first milliseconds excite has died out."""
    values: dict[str, Any] = {"K1": 400.0, "K2": 30.0, "speed": 0.0, "control_rate": 200}
    values |= {"K3": 0.0, "delay": delay}
    pair = channels(dataclasses.replace(ROBOTS["five_bar"].parameters(), **values))[0].poles
    assert len(pair) == 2 and abs(pair[0].imag) > 1
    xi = ran(0.5, offset=1e-5, **values)["xi"][:, 0]
    times, late = 1e-3 * np.arange(len(xi)), slice(100, None)
    basis: Array = np.exp(np.outer(times[late], [pair[0]]))
    columns = np.hstack([basis.real, basis.imag])
    fit, *_ = np.linalg.lstsq(columns, xi[late])
    assert np.abs(columns @ fit - xi[late]).max() < 0.05 * np.abs(xi[late]).max()


@pytest.mark.parametrize(("k1", "k2", "rate"), [(400, 40, 50), (400, 40, 100), (2500, 200, 1000)])
def test_the_loop_becomes_unstable_where_the_poles_say(k1: float, k2: float, rate: int) -> None:
    """Without viscous friction, which the delayed torque does not cancel exactly."""
    values: dict[str, Any] = {"K1": float(k1), "K2": float(k2), "K3": 0.0, "control_rate": rate}

    def stable(delay: float) -> bool:
        return channels(
            dataclasses.replace(ROBOTS["five_bar"].parameters(), delay=delay, **values)
        )[0].stable

    low, high = 0.0, float(LONGEST)
    assert stable(low) and not stable(high)
    while high - low > 0.02:
        middle = (low + high) / 2
        low, high = (middle, high) if stable(middle) else (low, middle)
    for delay in (0.9 * low, 1.1 * high):
        own = dataclasses.replace(ROBOTS["five_bar"].parameters(), delay=delay, **values)
        growth = channels(own)[0].poles.real.max()
        offset = 1e-9 if growth > 0 else 1e-6  # neither nonlinear nor rounding
        log = ran(1.6, offset=offset, viscous=False, speed=0.0, delay=delay, **values)
        xi = np.abs(log["xi"][:, 0])
        early, late = xi[600:1000].max(), xi[1200:1600].max()
        assert np.log(late / early) == pytest.approx(0.6 * growth, rel=0.1, abs=0.1)
        assert (growth > 0) == (delay > low) and abs(growth) > 0.5


def test_a_delay_that_is_switched_on_continues_with_the_same_torque() -> None:
    parameters = dataclasses.replace(ROBOTS["two_link_arm"].parameters(), speed=1.0)
    slow = dataclasses.replace(parameters, delay=3.0)
    kernel, other = (kernel_for("two_link_arm", p) for p in (parameters, slow))
    made, table = ROBOTS["two_link_arm"].make(parameters), CURVE.table()
    settings = [
        settings_vector(made, k, p, CURVE, FREE) for k, p in ((kernel, parameters), (other, slow))
    ]
    state = loop_of(kernel).run(start("two_link_arm", parameters, kernel), settings[0], table, 700)
    rows = loop_of(other).run(primed(other, state[0]), settings[1], table, 300)[1]
    u = other.log.unpack(rows)["u"]
    assert np.abs(np.diff(u, axis=0)).max() < 0.02 and np.abs(u).min() > 0.05


# Torque steps


@pytest.mark.parametrize("limit", [0.0, 0.105])
def test_the_torque_is_a_multiple_of_the_step_within_the_limit(limit: float) -> None:
    log = ran(1.0, torque_step=0.02, torque_limit=limit, K1=900.0, offset=0.002)
    multiples = log["u"] / 0.02
    assert np.abs(multiples - np.rint(multiples)).max() < 1e-9 and np.ptp(multiples) > 3
    assert limit == 0 or np.abs(log["u"]).max() == pytest.approx(0.1)


# Noise


def sensed(seed: float, seconds: float = 20.0, **values: Any) -> tuple[Array, Array]:
    """Errors of the measured joint angles, and the angles; the robot is held in its place."""
    parameters = dataclasses.replace(
        ROBOTS["five_bar"].parameters(),
        sensor_noise=1e-4,
        seed=seed,
        speed=0.0,
        K1=1.0,
        K2=1.0,
        **values,
    )
    kernel, made = kernel_for("five_bar", parameters), ROBOTS["five_bar"].make(parameters)
    settings = settings_vector(made, kernel, parameters, CURVE, FREE)
    state, loop = start("five_bar", parameters, kernel), loop_of(kernel)
    parts, errors, angles = kernel.state.slices, list[Array](), list[Array]()
    for _ in range(round(seconds * 1000)):
        after = loop.run(state, settings, CURVE.table(), 1)[0]
        errors.append(after[parts["encoder"]] - state[parts["q"]])
        angles.append(state[parts["q"]])
        state = after
    return np.array(errors), np.array(angles)


def test_noise_has_the_mean_and_the_deviation_that_were_asked_for() -> None:
    errors, _ = sensed(3)
    n = len(errors)
    z: Array = errors / 1e-4
    assert np.abs(z.mean(axis=0)).max() < 4 / np.sqrt(n)
    assert np.abs(z.var(axis=0) - 1).max() < 4 * np.sqrt(2 / n)
    assert np.abs((z**4).mean(axis=0) - 3).max() < 4 * np.sqrt(96 / n)  # as of a normal one
    assert abs((z[:, 0] * z[:, 1]).mean()) < 4 / np.sqrt(n)
    for lag in (1, 2, 7):
        products: Array = z[lag:] * z[: n - lag]
        assert np.abs(products.mean(axis=0)).max() < 4 / np.sqrt(n)


def test_the_same_seed_gives_the_same_run_and_another_one_another() -> None:
    one, again, other = (ran(0.5, sensor_noise=1e-4, seed=s) for s in (5, 5, 6))
    for name in one:
        assert np.array_equal(one[name], again[name])
    assert np.abs(one["u"] - other["u"]).max() > 1e-3


def test_noise_reaches_the_torque_through_the_gains() -> None:
    """Twice the noise, twice the shaking."""
    ideal = ran(1.0, sensor_noise=1e-12)["u"]
    one, two = (np.std(ran(1.0, sensor_noise=s)["u"] - ideal) for s in (1e-5, 2e-5))
    assert two / one == pytest.approx(2.0, rel=0.02)


@pytest.mark.thorough
def test_strain_gauges_err_by_the_deflection_that_was_asked_for() -> None:
    """At rest, composite control takes the gauges' errors for a bent beam."""
    values = {"speed": 0.0, "strain_noise": 1e-4, "seed": 1}
    log = ran(4.0, "flexible", **values)
    parameters = dataclasses.replace(ROBOTS["flexible"].parameters(), **values)
    robot = ROBOTS["flexible"].make(parameters)
    kernel = kernel_for("flexible", parameters)
    state_symbol, state = kernel.state.symbols("state")
    settings_symbol, settings = kernel.settings.symbols("settings")
    q = read(robot.system, kind_of("path_following", parameters, CURVE, FREE), state, settings)
    measured = ca.Function("measured", [state_symbol, settings_symbol], [q])
    given = settings_vector(robot, kernel, parameters, CURVE, FREE)
    now = start("flexible", parameters, kernel)
    found = list[Array]()
    for tick in range(4000):
        now[kernel.state.slices["ticks"]] = tick
        q = measured(now, given).full().ravel()
        found.append(robot.measured(q, 0 * q, parameters)["deflection"])
    errors: Array = np.array(found) / 1e-4
    assert abs(errors.mean()) < 4 / np.sqrt(4000) and abs(errors.var() - 1) < 4 * np.sqrt(2 / 4000)
    assert 1e-6 < np.abs(log["q"][:, 3:]).max() < 0.02  # the loop shakes the beam, and stays stable
