"""A forecast, before a run: for coordinates without a motor, torque limits, observers and drawings.

Laws that command y'' find the torques by D = J g_v. If D loses rank at the start, there are no such
torques: this is the rank test (11). If D has full rank, the output moves as commanded, and the zero
dynamics tell what the other coordinates do meanwhile.

All of this is for the robot at rest, by the controller's model. A torque limit may leave too little
for the motion; see `exhausted`. The velocities that an observer derives from the model are wrong
where the robot is not what the model says; see `unmodelled`.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from itertools import combinations

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.laws.planned_speed import speed_plan
from onpath.models.control.laws.registry import law_named
from onpath.models.control.rank_test import rank_number
from onpath.models.control.speed_limit import SHARE
from onpath.models.control.standing_torque import standing_torque
from onpath.models.errors import CodedError, Message
from onpath.models.paths.curves import Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import MechanicalSystem, conditioning
from onpath.models.systems.zero_dynamics import ZeroDynamics, zero_dynamics

SINGULAR = Message("forecast.singular")
NO_REST = Message("forecast.no_rest")
UNMODELLED = Message("forecast.unmodelled")
UNPLANNED = Message("forecast.unplanned")
FOLLOWER = "path_following"
LEAST_RANK = 1e-6
"""σ_min / σ_max of D up to which it counts as singular."""
AT_REST = 1e-3
"""Acceleration of the internal motion, SI, up to which a configuration is an equilibrium."""
SLOWEST = 0.01
"""Smallest growth rate that is reported, [1/s]: a smaller one cannot be seen in a run."""
NEUTRAL = 1e-7
"""Rounding error of undamped motion, relative to the largest exponent."""


def forecast(robot: Robot, law: str, parameters: Parameters, q: Array) -> Message | None:
    """The problem under a law if the robot starts at rest at q; None if none is foreseen.

    Args:
        law: name of the control law. Nothing is foreseen of laws that command torques, and nothing
            but a singularity of those that stabilize the coordinates without motors.
        q: configuration at the start, shape (n,).

    Returns:
        `SINGULAR`, with which no run is possible; `NO_REST`; or "forecast.unstable", with the
        growth rate [1/s] and the time [s] in which the internal motion grows tenfold.

    Source: eqs. (10), (11).
    """
    system = robot.core.system
    composite = getattr(parameters, "output", "redefined") == "composite"
    if system.n == system.m or composite or not law_named(law).commands_acceleration:
        return None
    if not rank_number(robot, parameters, q, by_model=True) > LEAST_RANK:
        return SINGULAR
    if system.m != system.p or law_named(law).stabilizes:
        return None
    rate = growth_rate(robot, parameters, q)
    if rate is None:
        return NO_REST
    if rate < SLOWEST:
        return None
    time = np.log(10) / rate
    return Message("forecast.unstable", {"rate": f"{rate:.2g}", "time": f"{time:.2g}"})


def growth_rate(robot: Robot, parameters: Parameters, q: Array) -> float | None:
    """Largest real part of the exponents of the zero dynamics at rest at q, [1/s]; 0 if neutral.

    None if the robot is not in equilibrium there, whatever its motors do.

    Args:
        q: shape (n,), where the decoupling matrix has full rank.
    """
    system, model = robot.core.system, robot.model(parameters)
    zero, still = zero_dynamics_at(robot, parameters, q), np.zeros(system.p)
    if np.abs(np.array(zero.acceleration(q, still, still, model))).max() > AT_REST:
        return None
    exponents = zero.exponents(q, model)[0]
    rate = float(exponents[0].real)
    return rate if rate > NEUTRAL * np.abs(exponents).max() else min(rate, 0.0)


def zero_dynamics_at(robot: Robot, parameters: Parameters, q: Array) -> ZeroDynamics:
    """The zero dynamics of a robot, with coordinates that can follow the output at q, (n,)."""
    system = robot.core.system
    return _zero_dynamics(system, _following(system, q, robot.model(parameters)))


def forecasts(
    robot: Robot, laws: Iterable[str], parameters: Parameters, q: Array, path: Curve
) -> list[Message]:
    """The forecasts under several laws, each once, those of one path last."""
    messages = list[Message]()
    for law in laws:
        message = forecast(robot, law, parameters, q)
        if message is not None and message not in messages:
            messages.append(message)
    return messages + doubts(robot, laws, parameters, path)


def doubts(robot: Robot, laws: Iterable[str], parameters: Parameters, path: Curve) -> list[Message]:
    """What may go wrong on a path, with the rise of the parameters, although rank test and zero
    dynamics do not foresee it; the worst first."""
    found = (
        exhausted(robot, parameters, path),
        unmodelled(robot, laws, parameters),
        unplanned(laws, parameters, path),
    )
    return [each for each in found if each is not None]


def exhausted(robot: Robot, parameters: Parameters, path: Curve) -> Message | None:
    """Says that standing still takes most of the torque limit somewhere on a path; None if not.

    "Most" is more than the share that `slow_down` leaves to the motion. With less, untouched on the
    predefined paths at 100, 250 and 1000 Hz, with encoders of 2000 steps and noise of 1e-4 rad, no
    rigid robot stopped under path following. The spatial arm on the ellipse, for which gravity
    takes 95 % of 0.8 N m, stops under path following and under the tracker, as it does with exact
    measurements.
    """
    limit = parameters.torque_limit
    share = standing_torque(robot, parameters, path) / limit if limit > 0 else 0.0
    return Message("forecast.exhausted", {"share": f"{100 * share:.0f}"}) if share > SHARE else None


def unmodelled(robot: Robot, laws: Iterable[str], parameters: Parameters) -> Message | None:
    """Says that path following may be worse than the tracker, behind an observer; None if not.

    Untouched, on the predefined paths, at 100, 250 and 1000 Hz with encoders of 2000 steps and
    noise of 1e-4 rad, path following was farther from its path than the tracker with these alone:
    a wrong model (inertias 30 % too large: up to 3.3 times as far, at 100 Hz), a payload (100 g on
    the flexible link: 1.7 times), dry friction (0.02 N m: 1.3 times), a delay (3 ms: 1.4 times, at
    100 Hz) or a torque limit.
    """
    measured = parameters.encoder_counts > 0 or parameters.sensor_noise > 0
    if not (measured and parameters.observer_time > 0 and FOLLOWER in laws):
        return None
    wrong = not np.array_equal(robot.plant(parameters), robot.model(parameters))
    friction = parameters.coulomb > 0 or parameters.stiction > 0
    if wrong or friction or parameters.delay > 0 or parameters.torque_limit > 0:
        return UNMODELLED
    return None


def unplanned(laws: Iterable[str], parameters: Parameters, path: Curve) -> Message | None:
    """Says that a law which plans the fastest speed keeps to the wanted one; None if it plans."""
    plans = any(law_named(law).plan is speed_plan for law in laws)
    drawn = plans and parameters.torque_limit > 0 and isinstance(path, SplineCurve)
    return UNPLANNED if drawn else None


def check_possible(robot: Robot, law: str, parameters: Parameters, q: Array) -> None:
    """Refuse a start from which no run is possible.

    Raises:
        CodedError: the decoupling matrix is singular there.
    """
    if forecast(robot, law, parameters, q) == SINGULAR:
        raise CodedError("forecast.singular")


_zero_dynamics = lru_cache(maxsize=16)(zero_dynamics)


@lru_cache(maxsize=16)
def _jacobian(system: MechanicalSystem) -> ca.Function:
    """(q, parameters) -> dh/dq of the controlled output, (p, n)."""
    jacobian = ca.densify(ca.jacobian(system.controlled_output, system.q))
    return ca.Function("jacobian", [system.q, system.parameters], [jacobian])


def _following(system: MechanicalSystem, q: Array, model: Array) -> tuple[int, ...]:
    """The coordinates that follow the output at q: the first m, or the best conditioned ones."""
    jacobian = np.array(_jacobian(system)(q, model))
    first = tuple(range(system.m))
    if conditioning(jacobian[:, first]) > LEAST_RANK:
        return first
    every = combinations(range(system.n), system.m)
    return max(every, key=lambda some: float(conditioning(jacobian[:, some])))
