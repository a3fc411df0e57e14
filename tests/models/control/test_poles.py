"""The poles shown beside the gains are those with which the simulated robot moves."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.control import poles
from onpath.models.control.laws.registry import NAMES
from onpath.models.control.poles import Complex, channels
from onpath.models.control.settable import specs
from onpath.models.paths.curves import circle
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.five_bar_robot import RIGID_FIVE_BAR
from onpath.models.systems.parameters import time_step

RADIUS = 0.05
PD = FiveBarParameters(K3=0.0)


def simulated(seconds: float, offset: float, name: str = "path_following", **values: Any):
    """(time of a tick, log of a run that begins `offset` [m] outside the circle, at rest)."""
    robot, curve = RIGID_FIVE_BAR, circle(RADIUS)
    parameters = dataclasses.replace(PD, tracker_integral="on", **values)
    kernel = kernel_of(robot, kind_of(name, parameters, curve))
    state = first_state(robot, kernel, curve, robot.rest(np.array([RADIUS + offset, 0.0])))
    settings = settings_vector(robot, kernel, parameters, curve, FREE)
    dt = time_step(parameters)
    rows = InterpretedLoop(kernel).run(state, settings, curve.table(), round(seconds / dt))[1]
    return dt, kernel.log.unpack(rows)


def slowest(poles: Complex) -> complex:
    return complex(poles[poles.real.argmax()])


@pytest.mark.parametrize("rate", [200, 1000, 2000])
@pytest.mark.parametrize("gains", [(400, 40, 0), (100, 60, 0), (100, 25, 150), (900, 30, 0)])
def test_error_across_moves_as_the_poles_say(gains: tuple[float, ...], rate: int) -> None:
    values = dict(zip(("K1", "K2", "K3"), gains, strict=True)) | {
        "control_rate": rate,
        "speed": 0.0,
    }
    poles = channels(dataclasses.replace(PD, **values))[0].poles
    offset = 1e-5
    dt, log = simulated(0.4, offset, "path_following", **values)
    xi, times = log["xi"][:, 0] * np.sign(log["xi"][0, 0]), dt * np.arange(len(log["xi"]))
    # the solution of the linear channel through xi(0) = offset, at rest, integral empty
    acceleration = -gains[0] * offset
    start = [offset, 0.0, acceleration][: len(poles)]
    modes = np.linalg.solve(np.vander(poles, increasing=True).T, np.array(start, dtype=complex))
    expected = (np.exp(np.outer(times, poles)) @ modes).real
    assert np.abs(xi - expected).max() < 0.03 * offset * max(1.0, 1000 / rate)
    assert xi[-1] < 0.7 * offset  # it did move


@pytest.mark.parametrize("rate", [200, 500, 1000])
def test_undamped_swing_grows_or_stays_as_the_poles_say(rate: int) -> None:
    values = {"K1": 2500.0, "K2": 0.0, "control_rate": rate}
    pole = slowest(channels(dataclasses.replace(PD, **values))[0].poles)
    dt, log = simulated(1.5, 1e-6, "path_following", speed=0.0, **values)
    xi, period = np.abs(log["xi"][:, 0]), round(2 * np.pi / abs(pole.imag) / dt)
    grown = np.log(xi[-period:].max() / xi[:period].max())
    assert grown == pytest.approx(pole.real * dt * (len(xi) - period), rel=0.05, abs=0.1)
    assert rate > 200 or grown > 2


@pytest.mark.parametrize("rate", [100, 500, 1000])
def test_half_an_interval_ahead_the_error_is_of_second_order(rate: int) -> None:
    """At half the interval the distance from the circle is a quarter, and not half."""

    def largest(rate: int, look_ahead: str) -> float:
        log = simulated(2.0, 0.0, control_rate=rate, look_ahead=look_ahead)[1]
        return float(np.abs(log["xi"][1000:, 0]).max())

    near, far = (largest(r, "half_interval") for r in (2 * rate, rate))
    assert 3 < far / near < 5
    assert far < largest(rate, "half_tick") or rate == 1000


@pytest.mark.parametrize("gain", [2.0, 10.0, 40.0])
def test_speed_settles_as_the_pole_says(gain: float) -> None:
    along = channels(dataclasses.replace(PD, K5=gain))[1]
    dt, log = simulated(min(0.3, 5 / gain), 0.0, K5=gain, speed=1.0)
    error = 1.0 - log["theta_rate"][:, 0]
    rate = -np.log(error[-1] / error[20]) / (dt * (len(error) - 21))
    assert rate == pytest.approx(-slowest(along.poles).real, rel=0.02)
    assert along.stable


def test_position_settles_as_the_poles_say() -> None:
    values = {"task": "position", "target": 0.02, "K4": 25.0, "K5": 3.0}
    pole = slowest(channels(dataclasses.replace(PD, **values))[1].poles)
    dt, log = simulated(2.5, 0.0, **values)
    theta = log["theta"][:, 0]
    turns = np.flatnonzero(np.diff(np.sign(np.diff(theta)))) + 1
    assert np.diff(turns).mean() * dt == pytest.approx(np.pi / abs(pole.imag), rel=0.02)
    overshoot = (theta[turns[0]] - 0.02) / 0.02
    assert overshoot == pytest.approx(np.exp(np.pi * pole.real / abs(pole.imag)), rel=0.03)


UNSTABLE = [
    {"control_rate": 50, "K1": 400.0, "K2": 110.0},
    {"control_rate": 50, "K1": 2500.0, "K2": 10.0},
    {"control_rate": 1000, "K1": 100.0, "K2": 10.0, "K3": 1500.0},
    {"control_rate": 100, "K1": 2500.0, "K2": 0.0},
    {"control_rate": 50, "K1": 400.0, "K2": 60.0, "look_ahead": "half_interval"},
]
STABLE = [
    {"control_rate": 50, "K1": 400.0, "K2": 70.0},
    {"control_rate": 50, "K1": 400.0, "K2": 20.0},
    {"control_rate": 1000, "K1": 100.0, "K2": 10.0, "K3": 700.0},
    {"control_rate": 1000, "K1": 2500.0, "K2": 200.0},
    {"control_rate": 50, "K1": 400.0, "K2": 40.0, "look_ahead": "half_interval"},
    {"control_rate": 50, "K1": 2500.0, "K2": 10.0, "look_ahead": "half_interval"},
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(
    ("values", "stable"), [(v, True) for v in STABLE] + [(v, False) for v in UNSTABLE], ids=repr
)
def test_predicted_instability_is_what_happens(
    name: str, values: dict[str, Any], stable: bool
) -> None:
    across = channels(dataclasses.replace(PD, **values))[0]
    assert across.stable is stable
    offset = 1e-6
    _, log = simulated(3.0, offset, name, speed=0.0, **values)
    error = (
        np.linalg.norm(log["y"] - [RADIUS, 0.0], axis=1) if name == NAMES[0] else log["xi"][:, 0]
    )
    late = np.abs(error)[len(error) // 2 :].max()
    assert np.isnan(late) or late > 2 * offset if not stable else late < offset / 2
    assert ("unstable" in str(across.behaviour())) is not stable


@pytest.mark.thorough
@pytest.mark.parametrize(
    ("look_ahead", "least", "most"), [("half_tick", 1, 3), ("half_interval", 3, 7)]
)
def test_how_far_above_the_poles_the_true_limit_of_the_damping_is(
    look_ahead: str, least: int, most: int
) -> None:
    """Torque is held, not acceleration: as the module says, and the help on the control rate."""
    told = f"{least} to {most} %"
    texts = poles.__doc__, specs(FiveBarParameters)["control_rate"].help
    assert told.replace(" %", "") in " ".join((texts[0] or "").split())
    assert look_ahead != "half_tick" or told in texts[1]
    place: dict[str, Any] = {"look_ahead": look_ahead, "K1": 400.0, "speed": 0.0}

    def grows(damping: float, rate: int) -> bool:
        dt, log = simulated(12.0, 1e-4, K2=damping, control_rate=rate, **place)
        across, second = np.abs(log["xi"][:, 0]), round(1 / dt)
        last = across[-2 * second :].max()
        return not np.isfinite(last) or bool(last > across[2 * second : 4 * second].max())

    for rate in (50, 100):
        dampings = np.arange(30.0, 220.0, 0.25)
        stable = [
            channels(dataclasses.replace(PD, K2=damping, control_rate=rate, **place))[0].stable
            for damping in dampings
        ]
        limit = float(dampings[int(np.argmin(stable))])
        assert not grows(limit * (1 + (least - 0.5) / 100), rate), rate
        assert grows(limit * (1 + most / 100), rate), rate


def test_the_integral_adds_a_third_pole() -> None:
    across = channels(FiveBarParameters())[0]
    assert across.pole_words() == "-26.2, -9.95, -3.83"
    assert np.roots([1, 40, 400, 1000]) == pytest.approx(across.poles.real, rel=0.02)
    assert "settles in 1 s" in str(across.behaviour())


def test_with_an_integral_real_poles_are_no_promise_of_no_overshoot() -> None:
    """An initial error changes its sign once, and does not swing."""
    across = channels(FiveBarParameters())[0]
    assert "no oscillation" in str(across.behaviour())
    _, log = simulated(3.0, 1e-4, speed=0.0, K3=1000.0)
    xi = log["xi"][:, 0] / log["xi"][0, 0]
    assert -0.2 < xi.min() < -0.1
    assert np.count_nonzero(np.diff(np.sign(xi[np.abs(xi) > 1e-3]))) == 1


def test_the_least_damped_poles_are_told_even_if_another_one_is_slower() -> None:
    across = channels(FiveBarParameters(K2=8.0))[0]
    assert across.poles[across.poles.real.argmax()].imag == 0
    assert "±" in across.pole_words() and "damping 0." in str(across.behaviour())


@pytest.mark.parametrize("rate", [1000, 2000])
def test_without_damping_it_swings_for_ever(rate: int) -> None:
    values = {"K1": 400.0, "K2": 0.0, "control_rate": rate}
    across = channels(dataclasses.replace(PD, **values))[0]
    assert "swings for ever" in str(across.behaviour()) and not across.stable
    _, log = simulated(10.0, 1e-3, speed=0.0, **values)
    xi = np.abs(log["xi"][:, 0])
    assert xi[-len(xi) // 5 :].max() == pytest.approx(1e-3, rel=0.02)


def test_words_name_damping_and_time() -> None:
    damped, swinging = (channels(dataclasses.replace(PD, K1=400.0, K2=k2))[0] for k2 in (40.0, 8.0))
    assert "no overshoot" in str(damped.behaviour())
    assert "damping 0.2" in str(swinging.behaviour()) and "settles in 1 s" in str(
        swinging.behaviour()
    )


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({}, "-20, -20"),
        ({"K1": 1600.0, "K2": 80.0}, "-39.9, -39.9"),
        ({"K2": 8.0}, "-4 ± 19.6i"),
        ({"K2": 200.0}, "-194, -2.02"),
    ],
)
def test_poles_are_told_as_the_words_have_it(values: dict[str, float], told: str) -> None:
    across = channels(dataclasses.replace(PD, **values))[0]
    assert across.pole_words() == told
    assert ("±" in told) is ("no overshoot" not in str(across.behaviour()))


@pytest.mark.parametrize("values", [{"K1": 0.0}, {"K2": 0.0}, {"K1": 0.0, "K2": 0.0}])
def test_an_error_that_stays_is_not_called_stable(values: dict[str, float]) -> None:
    across = channels(dataclasses.replace(PD, **values))[0]
    assert not across.stable and "stable" in str(across.behaviour())


def test_free_position_is_not_stable_but_free_speed_loop_is() -> None:
    free = dataclasses.replace(PD, K4=0.0, task="position")
    assert not channels(free)[1].stable
    assert channels(dataclasses.replace(free, task="speed"))[1].stable
    assert not channels(dataclasses.replace(free, task="speed", K5=0.0))[1].stable
