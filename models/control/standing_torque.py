"""The torque that standing still takes: gravity's, and what the errors of the sensors ask for.

A law that commands y'' and measures y and y' with errors asks for the torques

    u = u0 + G (K1 δy + K2 δy'),   D u0 = r0,   G = D⁻¹,

on the path at rest, see models/control/linearization.py; u0 holds the robot against gravity, and in
the posture of a redundant robot. An error e of a joint angle enters by δy = a J e and δy' = b J e.
Where an observer gives the velocities, a = 1 - ρ² and b = (1 - ρ)² / T; behind a filter a = 1 and
b = 1 / (encoder_filter + T); see models/closed_loop/observer.py and sensing.py. The errors of an
encoder with the step s have the variance s² / 12, to which that of the noise is added.
"""

from __future__ import annotations

from functools import lru_cache
from math import exp, pi

import casadi as ca
import numpy as np

from onpath.models.control.linearization import linearization
from onpath.models.paths.curves import Curve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import MechanicalSystem

PLACES = 32  # of the path
SPREAD = 2.0  # standard deviations of the sensors' errors


def standing_torque(robot: Robot, parameters: Parameters, path: Curve) -> float:
    """The `torque_limit` that standing still takes at the worst place of a path.

    0 if it is not defined: a place is out of reach, or the decoupling matrix is singular there.

    Args:
        path: with the rise of the parameters.
    """
    frame, system = robot.frame, robot.core.system
    theta = np.linspace(-np.pi, np.pi, PLACES, endpoint=not path.closed)
    try:
        q = robot.rest(frame.lift(path.at(theta)))
    except ValueError:
        return 0.0
    plant = np.repeat(robot.plant(parameters)[:, None], PLACES, axis=1)
    held, gain = (np.array(each) for each in _standing(system)(q.T, plant))
    gain = gain.reshape(system.m, PLACES, system.joints)
    errors = _error(parameters) * _amplification(parameters) * np.linalg.norm(gain, axis=2)
    share = (np.abs(held) + SPREAD * errors) / np.array(system.strength)[:, None]
    return float(share.max()) if np.isfinite(share).all() else 0.0


def prepare_standing_torque(robot: Robot) -> None:
    """Build the function of `standing_torque` in advance; it takes up to tens of milliseconds."""
    _standing(robot.core.system)


def _error(parameters: Parameters) -> float:
    """The standard deviation of a measured joint angle, [rad]."""
    counts = parameters.encoder_counts
    step = 2 * pi / counts if counts else 0.0
    return float(np.hypot(step / 12**0.5, parameters.sensor_noise))


def _amplification(parameters: Parameters) -> float:
    """a K1 + b K2, [1/s²]."""
    interval = 1 / parameters.control_rate
    if parameters.observer_time == 0:
        return parameters.K1 + parameters.K2 / (parameters.encoder_filter + interval)
    rho = exp(-interval / parameters.observer_time)
    return parameters.K1 * (1 - rho**2) + parameters.K2 * (1 - rho) ** 2 / interval


@lru_cache(maxsize=8)
def _standing(system: MechanicalSystem) -> ca.Function:
    """(q, plant) at some places -> u0, (m, PLACES), and G J of the joints, (m, PLACES joints)."""
    wanted = ca.SX.sym("wanted", system.p)
    u = linearization(system, system.q, ca.SX.zeros(system.n), system.parameters, wanted)
    gain = ca.jacobian(u, wanted) @ ca.jacobian(system.controlled_output, system.q)
    held = ca.substitute(u, wanted, ca.SX.zeros(system.p))
    outputs = [held, ca.densify(gain[:, : system.joints])]
    return ca.Function("standing", [system.q, system.parameters], outputs).map(PLACES)
