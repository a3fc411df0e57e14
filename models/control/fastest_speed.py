"""The speed along a path that is as fast as the torque limits allow, as a function of the place."""

from __future__ import annotations

from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.control.speed_limit import path_torques
from onpath.models.paths.curves import Curve
from onpath.models.systems.robots import Robot

ORDER = 12  # of the polynomial
COEFFICIENTS = 2 * ORDER + 1
POINTS = 96  # of the path, at which the torques are bounded
SHARE = 0.9  # of the torque limit for the motion; the rest is left to the laws
LEAST, MOST = 0.05, 20.0  # speed, [rad/s]
ROUNDS = 8  # linear programmes, at most
SLACK = 1e-3  # relative change of the time that ends them, and excess of a torque over its share


@lru_cache(maxsize=64)
def fastest_speed(
    robot: Robot, model: tuple[float, ...], curve: Curve, torque: float, backwards: bool
) -> Array:
    """Coefficients c of the square x of the fastest speed, (COEFFICIENTS,), [rad²/s²].

    With x(θ) = θ'², and so θ'' = x' / 2 where x' = dx/dθ, the torques on the path are

        u = a(θ) x' / 2 + b(θ) x + c(θ) √x + g(θ),

    with c from viscous friction: because of it, programmes such as toppra, which take u to be
    linear in x and x', cannot be used as they are. x is a trigonometric polynomial on a closed
    path, and a polynomial that is 0 at both ends on an open one (`basis`). The time ∫ dθ / √x is
    made as short as possible with |u| <= `SHARE` · limit at `POINTS` places and `LEAST` <= √x <=
    `MOST`, by linear programmes, each linearized about the result of the one before. Three or four
    suffice and take some 45 ms together. Between the places a torque exceeds its share by up to
    4 % of the limit, on a clover, and by less than 1 % on a circle.

    Args:
        model: the plant's parameters as the controller assumes them, k numbers.
        curve: the path.
        torque: limit of the motors, the value of `torque_limit`.
        backwards: whether θ decreases.

    Returns:
        Zeros if there is no such motion, as where the robot cannot even rest.

    Raises:
        ValueError: the robot has more coordinates than motors and outputs.

    Source: Verscheure et al., Time-optimal path tracking for robots: a convex optimization
    approach, IEEE Transactions on Automatic Control 54 (2009), with friction added.
    """
    from scipy.optimize import linprog  # slow to import; see app/server/warm_up.py

    grid = np.linspace(-np.pi, np.pi, POINTS, endpoint=not curve.closed)
    theta = grid if curve.closed else np.pi * np.sin(grid / 2)  # denser near the ends
    weight = np.ones(POINTS) if curve.closed else np.cos(grid / 2)
    value, slope = basis(theta, curve.closed)
    inside = np.ones(POINTS, bool) if curve.closed else weight > 1e-9  # at the ends x is 0
    low = LEAST**2 * (np.ones(POINTS) if curve.closed else value[:, 0])[inside]
    high = np.full(len(low), MOST**2)
    a, b, c, g = _terms(robot, model, curve, theta, -1.0 if backwards else 1.0)
    bound = np.broadcast_to(SHARE * torque * np.array(robot.system.strength)[:, None], g.shape)
    x, best, least = np.ones(POINTS), np.zeros(COEFFICIENTS), np.inf
    for _ in range(ROUNDS):
        root = np.where(inside, np.sqrt(np.maximum(x, 0)), 0)
        per_x = b + c / (2 * np.where(inside, root, 1))  # √x is at most root / 2 + x / (2 root)
        rows = (a[..., None] * slope / 2 + per_x[..., None] * value).reshape(-1, COEFFICIENTS)
        rest = (g + c * root / 2).ravel()
        sooner = (weight[inside, None] * value[inside] / root[inside, None] ** 3).sum(0)
        found = linprog(
            -sooner,
            A_ub=np.concatenate([rows, -rows, value[inside], -value[inside]]),
            b_ub=np.concatenate([bound.ravel() - rest, bound.ravel() + rest, high, -low]),
            bounds=(None, None),
        )
        if found.x is None:
            break
        x = value @ found.x
        u = a * (slope @ found.x) / 2 + b * x + c * np.sqrt(np.maximum(x, 0)) + g
        time = float((weight[inside] / np.sqrt(x[inside])).sum())
        done = time > (1 - SLACK) * least
        if (np.abs(u) < (1 + SLACK) * bound).all() and time < least:
            best, least = found.x, time
        if done:
            break
    return best


def _terms(
    robot: Robot, model: tuple[float, ...], curve: Curve, theta: Array, sign: float
) -> tuple[Array, Array, Array, Array]:
    """a, b, c and g at some places, each (m, l); `sign` is that of θ'."""
    rest, one = np.zeros(len(theta)), np.ones(len(theta))
    g = path_torques(robot, model, curve, theta, rest, rest)
    a = path_torques(robot, model, curve, theta, rest, one) - g
    ahead, back = (
        path_torques(robot, model, curve, theta, way * one, rest) - g for way in (sign, -sign)
    )
    return a, (ahead + back) / 2, (ahead - back) / 2, g


def basis(theta: Array, closed: bool) -> tuple[Array, Array]:
    """The functions of θ of which x is a sum, and their slopes, each (n, COEFFICIENTS).

    Closed: 1, cos kθ and sin kθ for k = 1 to `ORDER`. Open: (1 - τ²) T_k(τ) with τ = θ / π.
    """
    place, numbers = ca.SX.sym("place"), ca.SX.sym("numbers", COEFFICIENTS)
    both = ca.vertcat(*square_of_speed(numbers, place, closed))
    value, slope = ca.Function("basis", [place], ca.vertsplit(ca.jacobian(both, numbers))).map(
        len(theta)
    )(theta)
    shape = len(theta), COEFFICIENTS
    return np.array(ca.densify(value)).reshape(shape), np.array(ca.densify(slope)).reshape(shape)


def square_of_speed(numbers: ca.SX, theta: ca.SX, closed: bool) -> tuple[ca.SX, ca.SX]:
    """x and dx/dθ at one θ from the coefficients, with few operations."""
    c = ca.vertsplit(numbers)
    if closed:
        cosine, sine = ca.cos(theta), ca.sin(theta)
        x, slope, now = c[0], ca.SX(0), (cosine, sine)
        for k in range(1, ORDER + 1):
            x += c[2 * k - 1] * now[0] + c[2 * k] * now[1]
            slope += k * (c[2 * k] * now[0] - c[2 * k - 1] * now[1])
            now = now[0] * cosine - now[1] * sine, now[1] * cosine + now[0] * sine
        return x, slope
    tau = theta / np.pi
    total, bent, double = c[0] + c[1] * tau, c[1], 2 * tau
    before, now, slow, fast = ca.SX(1), tau, ca.SX(0), ca.SX(1)
    for number in c[2:]:
        slow, fast = fast, 2 * now + double * fast - slow
        before, now = now, double * now - before
        total, bent = total + number * now, bent + number * fast
    inside = 1 - tau**2
    return inside * total, (inside * bent - double * total) / np.pi
