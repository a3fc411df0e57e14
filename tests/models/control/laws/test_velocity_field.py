"""Passive velocity field control: its flywheel pays for what it gives, at all sliders."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import casadi as ca
import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    first_state,
    kernel_of,
    kind_of,
    pushed,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.control.laws.velocity_field import FLYWHEEL
from onpath.models.control.settable import with_values
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

CIRCLE = circle(0.05)
SUITED = ("five_bar", "two_link_arm", "spatial_arm")
BOOKED = 1e-9  # [J], rounding of the ledger
EMPTY = -1e-6  # [J]
REACH = 0.03  # [m], how far from the path a hand pulls
SPEED, ENERGY = (-20.0, 20.0), (0.02, 2.0)  # ranges of the sliders, [rad/s], [J]


@dataclass(frozen=True, slots=True)
class Account:
    """What a run did with energy.

    Attributes:
        rise: of ½ vᵀ M v + E_f less the work of the hand, over its least value so far, [J].
        least: of E_f, [J].
        fault: why it was stopped, or None.
    """

    rise: float
    least: float
    fault: Any


@cache
def made(name: str) -> tuple[Robot, Kernel, Loop]:
    entry = ROBOTS[name]
    robot = entry.make(entry.parameters())
    kind = dataclasses.replace(kind_of("velocity_field", entry.parameters(), CIRCLE), free=False)
    kernel = kernel_of(robot, kind)
    return robot, kernel, translate_loop(kernel)


@cache
def energy_and_work(name: str) -> ca.Function:
    """(q, v, parameters, force, displacement of q) -> ½ vᵀ M v and the work of the force, [J]."""
    system = made(name)[0].system
    force, moved = ca.SX.sym("force", system.p), ca.SX.sym("moved", system.n)
    inputs = [system.q, system.v, system.parameters, force, moved]
    kinetic = ca.dot(system.v, system.mass @ system.v) / 2
    work = ca.dot(ca.jtimes(system.output, system.q, force, True), moved)
    return ca.Function("energy_and_work", inputs, [kinetic, work])


def some_push(robot: Robot, random: np.random.Generator) -> Push:
    """Nothing, or a hand at a random place near the path."""
    if random.random() < 0.4:
        return FREE
    beside = REACH * np.sqrt(random.random()) * direction(random)
    return Push(hand=robot.frame.lift(0.05 * direction(random) + beside))


def direction(random: np.random.Generator) -> Array:
    angle = random.uniform(-np.pi, np.pi)
    return np.array([np.cos(angle), np.sin(angle)])


def accounts(
    name: str, sliders: Sequence[Parameters], seconds: float, seed: int, hands: bool
) -> list[Account]:
    """Runs side by side from rest on the path; a hand comes and goes in two thirds of them."""
    random = np.random.default_rng(seed)
    robot, kernel, loop = made(name)
    state = first_state(robot, kernel, CIRCLE, robot.rest(robot.frame.lift(CIRCLE.at(np.array(0)))))
    states, table = np.array([state] * len(sliders)), CIRCLE.table()
    free = [settings_vector(robot, kernel, own, CIRCLE, FREE) for own in sliders]
    settings, touched = list(free), hands * (random.random(len(sliders)) < 2 / 3)
    changes = np.zeros(len(sliders))
    rows, wheels = list[Array](), list[Array]()
    for tick in range(round(seconds * 1000)):
        for i in np.flatnonzero((changes == tick) * touched):
            changes[i] += random.integers(50, 1000)
            settings[i] = pushed(kernel, free[i], some_push(robot, random))
        states, log = loop.run_many(states, settings, [table] * len(sliders), 1)
        rows.append(log[:, 0])
        wheels.append(states[:, kernel.state.slices[FLYWHEEL]][:, 0])
    logs, stored = np.array(rows), np.array(wheels)
    return [account(name, own, logs[:, i], stored[:, i]) for i, own in enumerate(sliders)]


def account(name: str, own: Parameters, rows: Array, stored: Array) -> Account:
    """Of one run.

    Args:
        rows: log, (ticks, ...).
        stored: E_f, paid up to the beginning of each tick in which the law is evaluated, (ticks,).
    """
    robot, kernel, _ = made(name)
    log = kernel.log.unpack(rows)
    fault = robot.fault(log["q"], log["v"], own)
    end = len(rows) - 1 if fault is None else fault[0] - 1
    moved = np.diff(log["q"], axis=0)[:end]
    inputs = [log[each][:end].T for each in ("q", "v")], log["force"][:end].T, moved.T
    plant = np.tile(robot.plant(own)[:, None], end)
    found = energy_and_work(name).map(end)(*inputs[0], plant, *inputs[1:])
    kinetic, work = (np.array(each)[0] for each in found)
    ledger = kinetic + stored[:end] - np.cumsum(work) + work
    booked = ledger[:: round(1000 / own.control_rate)]
    rise = booked - np.minimum.accumulate(booked)
    return Account(float(rise.max()), float(stored[:end].min()), fault and fault[1])


def some_sliders(
    name: str, count: int, seed: int, **ranges: tuple[float, float]
) -> list[Parameters]:
    """Parameters at random; of the energy as many small ones as large ones."""
    random, own = np.random.default_rng(seed), ROBOTS[name].parameters()

    def drawn() -> dict[str, float]:
        energy = float(np.exp(random.uniform(*np.log(ENERGY))))
        values = {each: random.uniform(*ranges[each]) for each in ranges}
        return {"speed": random.uniform(*SPEED), "field_energy": energy, **values}

    return [with_values(own, drawn()) for _ in range(count)]


def check(name: str, count: int, seconds: float, seed: int) -> None:
    """Over all speeds and energies: no energy from nowhere, no debt, and nothing flies apart."""
    for hands in (False, True):
        for found in accounts(name, some_sliders(name, count, seed), seconds, seed, hands):
            assert found.rise < BOOKED and found.least > EMPTY and found.fault is None, found


@pytest.mark.parametrize("name", SUITED)
def test_it_makes_no_energy_and_is_never_in_debt(name: str) -> None:
    check(name, 10, 2.0, 1)


@pytest.mark.thorough
@pytest.mark.parametrize("name", SUITED)
def test_it_makes_no_energy_and_is_never_in_debt_in_many_runs(name: str) -> None:
    check(name, 60, 6.0, 100)


@pytest.mark.thorough
@pytest.mark.parametrize("rate", [1000, 250, 50])
@pytest.mark.parametrize("name", SUITED)
def test_nor_with_other_gains_and_at_lower_control_rates(name: str, rate: int) -> None:
    """Paid at each evaluation. A field that hardly leads back may end at a singular pose."""
    ranges = {"field_gain": (0.0, 40.0), "field_circulation": (0.0, 100.0)}
    sliders = [
        dataclasses.replace(own, control_rate=rate)
        for own in some_sliders(name, 10, rate, **ranges)
    ]
    for found in accounts(name, sliders, 2.0, rate, True):
        assert found.rise < BOOKED and found.least > EMPTY, found
