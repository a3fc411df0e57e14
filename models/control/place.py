"""Quantities along a path on which the poles of some laws depend: its turning, and the inertia."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.bend_limit import speed_on
from onpath.models.paths.curves import PERIOD, Curve
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

STEP = 0.01  # [rad], of the differences below; on a drawing at most PART of a piece
PART = 0.1
EVEN = 1e-3  # [1/rad], largest deviation of the turning of a path that turns evenly
SAMPLES = 64


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """A place on the path, and the path and the robot near it.

    Attributes:
        theta: θ, [rad].
        rate: θ' of the end-point, [rad/s].
        speed: wanted speed of θ, [rad/s]; 0 if a position is wanted.
        turn: Ω per radian of θ, skew: the axes A = (T, N) or (T, n1, n2) of the path turn as
            dA/dθ = A Ω, (2, 2) or (3, 3).
        turns_evenly: whether Ω is the same at all places of the path.
        slope, bend: g = m' / (2 m) [1/rad] and dg/dθ [1/rad²], with m(θ) = M dq/dθ · dq/dθ the
            robot's inertia along the path; 0 unless there are as many outputs and motors as
            coordinates.
    """

    theta: float
    rate: float
    speed: float
    turn: Array
    turns_evenly: bool
    slope: float = 0.0
    bend: float = 0.0


def place_at(
    robot: Robot, parameters: Parameters, curve: Curve, theta: float, rate: float
) -> Place:
    """A place on a path, with the robot of the controller's model.

    Args:
        theta, rate: [rad], [rad/s].
    """
    system, at = robot.system, np.array([theta])
    step = _step(curve)
    if not curve.closed:
        at = at.clip(-np.pi + 2 * step, np.pi - 2 * step)
    slope = bend = 0.0
    if system.n == system.m == system.p:
        near = at + step * np.array([-1.0, 0.0, 1.0])
        before, here, after = (np.log(_inertia(robot, parameters, curve, near)) / 2).tolist()
        slope, bend = (after - before) / (2 * step), (after - 2 * here + before) / step**2
    return Place(
        theta=theta,
        rate=rate,
        speed=speed_on(parameters, curve) if parameters.task == "speed" else 0.0,
        turn=_turn(curve, at)[0],
        turns_evenly=_turns_evenly(curve),
        slope=slope,
        bend=bend,
    )


def _step(curve: Curve) -> float:
    """Half the distance over which differences are taken, [rad]."""
    return min(STEP, PART * PERIOD / curve.pieces) if isinstance(curve, SplineCurve) else STEP


def _turn(curve: Curve, theta: Array) -> Array:
    """Ω per radian at some places, (n, d, d)."""
    axes: Array = _axes(curve, theta)
    step = _step(curve)
    slope: Array = (_axes(curve, theta + step) - _axes(curve, theta - step)) / (2 * step)
    turn = axes.transpose(0, 2, 1) @ slope
    return (turn - turn.transpose(0, 2, 1)) / 2


def _axes(curve: Curve, theta: Array) -> Array:
    """(T, N), or (T, n1, n2) of models/control/space_output.py, as columns, (n, d, d)."""
    first = curve.at(theta, 1)
    tangent = first / np.linalg.norm(first, axis=1, keepdims=True)
    plan = first[:, :2] / np.linalg.norm(first[:, :2], axis=1, keepdims=True)
    left = np.stack([-plan[:, 1], plan[:, 0]], axis=1)
    if curve.dimension == 2:
        return np.stack([tangent, left], axis=2)
    left = np.column_stack([left, np.zeros(len(left))])
    up: Array = np.asarray(np.cross(tangent, left), dtype=float)
    return np.stack([tangent, left, up], axis=2)


@lru_cache(maxsize=64)
def _turns_evenly(curve: Curve) -> bool:
    turn = _turn(curve, curve.sample(curve.grid if isinstance(curve, SplineCurve) else SAMPLES))
    return bool(np.abs(turn - turn[0]).max() < EVEN)


def _inertia(robot: Robot, parameters: Parameters, curve: Curve, theta: Array) -> Array:
    """m(θ) at some places, (n,), [kg m²/rad² or the like]."""
    frame, model = robot.frame, robot.model(parameters)
    y, first = curve.at(theta), curve.at(theta, 1)
    rates = frame.lift(first) - frame.lift(np.zeros_like(first))
    found = list[float]()
    for q, rate in zip(robot.rest(frame.lift(y)), rates, strict=True):
        jacobian, mass = (np.asarray(each, dtype=float) for each in _matrices(robot)(q, model))
        joints: Array = np.asarray(np.linalg.solve(jacobian, rate), dtype=float)
        found.append(float(joints @ mass @ joints))
    return np.array(found)


@lru_cache(maxsize=16)
def _matrices(robot: Robot) -> ca.Function:
    """The function (q, parameters) -> dh/dq (p, n) and M (n, n)."""
    system = robot.system
    outputs = [ca.densify(ca.jacobian(system.output, system.q)), ca.densify(system.mass)]
    return ca.Function("matrices", [system.q, system.parameters], outputs)
