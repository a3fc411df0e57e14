"""The poles of a typed law are those with which the simulated robot moves, or there are none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.control.law_poles import channels_of
from onpath.models.control.laws.own import PATH_FOLLOWING
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.place import place_at
from onpath.models.control.poles import Channel, channels
from onpath.models.errors import Message
from onpath.models.paths.curves import circle
from onpath.models.systems.catalogue import FIVE_BAR
from onpath.models.systems.parameters import Parameters

CURVE = circle(0.05)
HERE = place_at(FIVE_BAR.make(FIVE_BAR.parameters()), FIVE_BAR.parameters(), CURVE, 1.0, 5.0)
ALONG = "along = -K5*(dtheta - speed)"


def poles_of(law: str, parameters: Parameters | None = None) -> tuple[Channel, ...]:
    found = channels_of(law, parameters or FIVE_BAR.parameters())
    assert not isinstance(found, Message), found
    return found


def moved(law: str, offset: float, ticks: int, speed: float) -> dict[str, Array]:
    """The log of a run that begins `offset` [m] outside the circle, at rest."""
    parameters = replace(FIVE_BAR.parameters(), speed=speed)
    robot = FIVE_BAR.make(parameters)
    kernel = kernel_of(robot, kind_of(law, parameters, CURVE))
    state = first_state(robot, kernel, CURVE, robot.rest(np.array([0.05 + offset, 0.0])))
    settings = settings_vector(robot, kernel, parameters, CURVE, FREE)
    rows = InterpretedLoop(kernel).run(state, settings, CURVE.table(), ticks)[1]
    return kernel.log.unpack(rows)


@pytest.mark.parametrize("task", ["speed", "position"])
@pytest.mark.parametrize("k3", [0.0, 1000.0])
def test_typed_path_following_has_the_poles_of_path_following(task: str, k3: float) -> None:
    parameters = replace(FIVE_BAR.parameters(), task=task, K3=k3)
    for typed, known in zip(
        poles_of(PATH_FOLLOWING, parameters), channels(parameters), strict=True
    ):
        assert typed.poles == pytest.approx(known.poles) and typed.behaviour() == known.behaviour()


@pytest.mark.parametrize(
    "across", ["-100*xi - 12*dxi", "-50*tanh(8*xi) - 25*dxi", "-(300 + K3)*xi - 9*dxi + 0*dtheta"]
)
def test_the_distance_moves_as_the_poles_say(across: str) -> None:
    law = f"across = {across}; along = -3*(dtheta - speed)"
    poles, offset = poles_of(law)[0].poles, 1e-5
    xi = moved(law, offset, 400, 0.0)["xi"][:, 0]
    modes = np.linalg.solve(np.vander(poles, increasing=True).T, np.array([offset, 0.0]))
    wanted = np.real(np.exp(np.outer(1e-3 * np.arange(400), poles)) @ modes)
    assert xi * np.sign(xi[0]) == pytest.approx(wanted, abs=0.01 * offset)


def test_the_rate_moves_as_the_poles_say() -> None:
    law = "across = -K1*xi - K2*dxi; along = -3*(dtheta - speed/2) + 40*dxi"
    (pole,) = poles_of(law)[1].poles
    rate = moved(law, 0.0, 400, FIVE_BAR.parameters().speed)["theta_rate"][:, 0]
    wanted = FIVE_BAR.parameters().speed / 2 * (1 - np.exp(1e-3 * np.arange(400) * pole.real))
    assert pole.imag == 0 and rate == pytest.approx(wanted, abs=0.01)


@pytest.mark.parametrize(
    ("law", "code"),
    [
        ("waiting_clock", "behaviour.no_poles"),
        ("u1 = -xi; u2 = 0", "behaviour.not_constant"),
        (f"across = -K1*xi*(1 + t); {ALONG}", "behaviour.not_constant"),
        (f"across = -K1*xi*cos(theta) - K2*dxi; {ALONG}", "behaviour.not_constant"),
        (f"across = -K1*e1; {ALONG}", "behaviour.not_constant"),
        (f"across = -9*sign(xi) - K2*dxi; {ALONG}", "behaviour.not_smooth"),
        (f"across = -9*abs(xi) - K2*dxi; {ALONG}", "behaviour.not_smooth"),
        (f"across = sqrt(xi); {ALONG}", "behaviour.not_smooth"),
        ("across = -K1*xi - K2*dxi*dtheta; along = 1", "behaviour.not_smooth"),
        ("across = -K1*xi - K2*dxi - dtheta; along = -dtheta + xi", "behaviour.coupled"),
    ],
)
def test_a_law_without_constant_poles_says_why(law: str, code: str) -> None:
    found = channels_of(law, FIVE_BAR.parameters())
    assert isinstance(found, Message) and found.code == code and str(found)


def test_every_law_of_the_registry_has_poles_or_says_why_not() -> None:
    for name, law in LAWS.items():
        assert isinstance(channels_of(name, FIVE_BAR.parameters()), tuple) == law.linear
        there = channels_of(name, FIVE_BAR.parameters(), HERE)
        assert isinstance(there, tuple) == (law.linear or law.channels is not None)
