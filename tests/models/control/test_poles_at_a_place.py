"""Poles at a place are eigenvalues of the simulated loop, linearized by finite differences.

The loop is a map from tick to tick. Its derivative at a motion on the path is taken by differences
in coordinates that move with the path: errors in the axes (T, N) at the reference point, or (θ, ξ).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.start import velocity_at
from onpath.models.control.bend_limit import speed_on
from onpath.models.control.law_poles import channels_of
from onpath.models.control.place import place_at
from onpath.models.control.poles import Channel, Complex
from onpath.models.control.settable import with_values
from onpath.models.paths.curves import Curve, circle, ellipse
from onpath.models.paths.distance import closest_parameter
from onpath.models.paths.space_curves import saddle
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS, RobotEntry
from onpath.models.systems.parameters import Parameters, rise_of
from tests.support.drawings import star

DT, SMALL = 1e-3, 1e-6
CIRCLE, ELLIPSE, STAR = circle(0.05), ellipse((0.07, 0.045)), star()
Coordinates = Callable[[Array], Array]


@dataclass(frozen=True)
class Linearized:
    """The loop of a law about a motion along a curve that is at θ after some ticks."""

    law: str
    curve: Curve
    theta: float
    parameters: Parameters
    rate: float
    entry: RobotEntry = FIVE_BAR

    @cached_property
    def kernel(self) -> Kernel:
        return kernel_of(self.robot, kind_of(self.law, self.parameters, self.curve, FREE))

    @property
    def robot(self) -> Any:
        return self.entry.make(self.parameters)

    @cached_property
    def loop(self) -> InterpretedLoop:
        return InterpretedLoop(self.kernel)

    def tick(self, state: Array, count: int = 1) -> Array:
        kernel = self.kernel
        settings = settings_vector(self.robot, kernel, self.parameters, self.curve, FREE)
        return self.loop.run(state, settings, self.curve.table(), count)[0]

    def begin(self, ticks: int = 30) -> Array:
        """The state on the path with the velocity along it, after the torque has settled."""
        theta = self.theta - self.rate * ticks * DT
        robot, curve = self.robot, self.curve
        q = robot.rest(robot.frame.lift(curve.at(np.array(theta))))
        along = self.rate * np.linalg.norm(curve.at(np.array(theta), 1))
        v = velocity_at(robot, self.parameters, curve, q, float(along), 0.0)
        state = self.kernel.state.unpack(first_state(robot, self.kernel, curve, q, v))
        state |= {"theta": theta, "theta_ref": theta, "theta_rate": self.rate}
        return self.tick(self.kernel.state.pack(state), ticks)

    def roots(self, coordinates: Coordinates, sums: int) -> Complex:
        """Eigenvalues s = ln(z)/T of the map from tick to tick in the given coordinates.

        Args:
            sums: components of the integral that there are.
        """
        here = self.begin()
        there, slices = self.tick(here), self.kernel.state.slices
        free = np.concatenate([np.r_[slices[name]] for name in ("q", "v", "u", "integral")])
        free = free[: free.size - len(here[slices["integral"]]) + sums]

        def slope(of: Coordinates, state: Array) -> Array:
            columns = list[Array]()
            for i in free:
                step = np.zeros_like(state)
                step[i] = SMALL
                columns.append((of(state + step) - of(state - step)) / (2 * SMALL))
            return np.stack(columns, axis=1)

        moved = slope(lambda state: self.tick(state)[free], here)
        before, after = (
            slope(coordinates, here)[: free.size],
            slope(coordinates, there)[: free.size],
        )
        z = np.linalg.eigvals(after @ moved @ np.linalg.inv(before))
        slow: Complex = z[np.abs(z) > 0.3].astype(np.complex128)  # without the held torques
        found: Complex = np.asarray(np.log(slow) / DT, dtype=np.complex128)
        return found

    def in_axes(self, state: Array) -> Array:
        """The tracking error, its first two rates and last the integral, in the axes at θ_r."""
        fields, (y, rate, acceleration) = self._motion(state)
        theta = float(fields["theta_ref"][0])
        sigma, first, second = (self.curve.at(np.array(theta), order) for order in range(3))
        axes, turn = axes_of(first), self.rate * turn_of(first, second)
        error, slope = axes.T @ (y - sigma), axes.T @ (rate - self.rate * first)
        bend = axes.T @ (acceleration - self.rate**2 * second)
        return np.concatenate([error, slope - turn @ error, bend, axes.T @ fields["integral"]])

    def along_and_across(self, state: Array) -> Array:
        """θ and ξ, their first rates, the acceleration in the axes at θ, and the integral."""
        fields, (y, rate, acceleration) = self._motion(state)
        theta = closest_parameter(self.robot.frame, self.curve, y)
        sigma, first, second = (self.curve.at(np.array(theta), order) for order in range(3))
        gap, axes = y - sigma, axes_of(first)
        speed = (first @ rate) / (first @ first - gap @ second)
        states = [theta, axes[:, 1] @ gap, speed, axes[:, 1] @ rate]
        return np.concatenate([states, axes.T @ acceleration, fields["integral"]])

    def _motion(self, state: Array) -> tuple[dict[str, Array], tuple[Array, Array, Array]]:
        """The fields of a state; the end-point, its velocity and its acceleration."""
        fields, system = self.kernel.state.unpack(state), self.robot.system
        plant = self.robot.plant(self.parameters)
        drift, gain = system.function("drift", "input_gain")(fields["q"], fields["v"], plant)
        v_rate = drift.full()[:, 0] + gain.full() @ fields["u"]
        rate_of = system.with_rate(system.output)

        def motion(h: float) -> tuple[Array, Array]:
            q = fields["q"] + h * fields["v"]
            y, rate = rate_of(q, fields["v"] + h * v_rate, plant)
            return y.full()[:, 0], rate.full()[:, 0]

        y, rate = motion(0.0)
        return fields, (y, rate, (motion(1e-5)[1] - motion(-1e-5)[1]) / 2e-5)


def axes_of(first: Array) -> Array:
    """(T, N) as columns."""
    tangent = first / np.linalg.norm(first)
    return np.stack([tangent, np.array([-tangent[1], tangent[0]])], axis=1)


def turn_of(first: Array, second: Array) -> Array:
    """Ω per radian, with dA/dθ = A Ω."""
    per_theta = (first[0] * second[1] - first[1] * second[0]) / (first @ first)
    return per_theta * np.array([[0.0, -1.0], [1.0, 0.0]])


def sorted_poles(poles: Complex) -> Complex:
    return poles[np.lexsort((poles.imag.round(3), poles.real.round(3)))]


def channels_there(loop: Linearized) -> tuple[Channel, Channel]:
    here = loop.begin()
    theta, _, rate, *_ = (loop.along_and_across(here) + loop.along_and_across(loop.tick(here))) / 2
    place = place_at(loop.robot, loop.parameters, loop.curve, float(theta), float(rate))
    found = channels_of(loop.law, loop.parameters, place)
    assert isinstance(found, tuple)
    return found


GAINS: list[dict[str, Any]] = [
    {"K1": 400.0, "K2": 60.0, "K3": 0.0},
    {"K1": 400.0, "K2": 60.0, "K3": 1000.0},
    {"K1": 900.0, "K2": 30.0, "K3": 3000.0, "contour_ratio": 0.3},
]


@pytest.mark.parametrize("gains", GAINS)
@pytest.mark.parametrize("integral", ["off", "on"])
@pytest.mark.parametrize(
    ("curve", "theta"), [(CIRCLE, 0.3), (ELLIPSE, 0.3), (ELLIPSE, 1.2), (STAR, 0.55)]
)
def test_contouring(curve: Curve, theta: float, integral: str, gains: dict[str, Any]) -> None:
    values = with_values(
        FIVE_BAR.parameters(), {"tracker_integral": integral, "speed": 5.0, **gains}
    )
    loop = Linearized("contouring", curve, theta, values, speed_on(values, curve))
    sums = 2 if integral == "on" and gains["K3"] else 0
    across, along = channels_there(loop)
    expected = sorted_poles(np.concatenate([across.poles, along.poles]))
    assert sorted_poles(loop.roots(loop.in_axes, sums)) == pytest.approx(expected, rel=2e-3)
    varies = bool(sums) and curve is not CIRCLE
    assert across.at == (pytest.approx(theta + loop.rate * DT / 2, abs=1e-4) if varies else None)


@pytest.mark.parametrize("k3", [0.0, 1000.0])
@pytest.mark.parametrize(("curve", "theta"), [(CIRCLE, 1.2), (ELLIPSE, 0.3), (ELLIPSE, -2.0)])
@pytest.mark.parametrize("robot", ["five_bar", "two_link_arm"])
def test_virtual_constraint(robot: str, curve: Curve, theta: float, k3: float) -> None:
    entry = ROBOTS[robot]
    values = replace(entry.parameters(), K2=60.0, K3=k3)
    loop = Linearized("virtual_constraint", curve, theta, values, 6.0, entry)
    across, along = channels_there(loop)
    expected = sorted_poles(np.concatenate([across.poles, along.poles]))
    found = sorted_poles(loop.roots(loop.along_and_across, int(k3 > 0)))
    assert found == pytest.approx(expected, abs=0.06)
    assert across.at is None and along.at == pytest.approx(theta, abs=0.03)


def test_a_bead_at_rest_stays_where_it_is_put() -> None:
    loop = Linearized("virtual_constraint", ELLIPSE, 0.3, FIVE_BAR.parameters(), 0.0)
    _, along = channels_there(loop)
    assert np.abs(along.poles).max() < 1e-9 and not along.stable


def test_what_the_poles_of_the_bead_say_of_a_lap() -> None:
    """The sum of the poles is that of a motion whose energy is kept: over a lap, 0."""
    robot, values = FIVE_BAR.make(FIVE_BAR.parameters()), FIVE_BAR.parameters()
    slopes = [place_at(robot, values, ELLIPSE, at, 1.0).slope for at in ELLIPSE.sample(128)]
    assert np.mean(slopes) == pytest.approx(0.0, abs=1e-4) and np.ptp(slopes) > 0.5


def test_in_space_the_integral_mixes_both_directions_across() -> None:
    entry = ROBOTS["spatial_arm"]
    values = replace(entry.parameters(), tracker_integral="on", rise=0.03, speed=3.0)
    curve = saddle(circle(0.05), rise_of(values))
    place = place_at(entry.make(values), values, curve, 0.7, 3.0)
    found = channels_of("contouring", values, place)
    assert isinstance(found, tuple) and found[0].at == 0.7
    flat = replace(values, tracker_integral="off")
    without = channels_of("contouring", flat, place)
    assert isinstance(without, tuple)
    assert len(found[0].poles) == 7 and len(without[0].poles) == 2
