"""A planar chain of links on a fixed pivot, of which some joints have no motor."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.system import MechanicalSystem, mechanical_system

LINK, MASS, FRICTION = 0.1, 0.2, 0.02  # [m], [kg], [N m s]
STEPS = 12  # of Newton's method


@dataclass(frozen=True, slots=True)
class Shape:
    """What a chain is like.

    Attributes:
        joints: their numbers from the pivot on, those with a motor first.
        motors: m.
        gravity: in the chain's plane, [m/s²].
        start: angles of the joints from which the search for an equilibrium begins, in the order of
            `joints`, [rad].
    """

    joints: tuple[int, ...]
    motors: int
    gravity: float
    start: tuple[float, ...]


def passive_chain(shape: Shape) -> Robot:
    """A chain whose end-point is y = 0 where it rests at home.

    Raises:
        ValueError: no equilibrium is found.
    """
    q, end, undriven = _statics(shape)
    given = ca.SX.sym("given", 0)
    at_home = _root(ca.Function("undriven", [q, given], [undriven]), shape.start, np.zeros(0))
    offset = ca.DM(ca.Function("end", [q], [end])(at_home))

    def inverse(y: ca.SX) -> ca.SX:
        """By Newton's method with least norms from home, in a fixed number of steps."""
        wanted = ca.vertcat(end - offset - y, undriven)
        step = ca.Function("step", [q, y], [q + _least_norm(ca.jacobian(wanted, q), -wanted)])
        found = ca.SX(ca.DM(at_home))
        for _ in range(STEPS):
            found = step(found, y)
        return found

    def skeleton(q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        points = _points(shape, q)
        points = [ca.vertcat(p[0] - offset[0], 0, p[1] - offset[1]) for p in points]
        return ca.horzcat(*(each for pair in pairwise(points) for each in pair)), points[0]

    return Robot(
        system=_equations(shape, offset),
        plant=lambda _: np.zeros(0),
        model=lambda _: np.zeros(0),
        inverse=inverse,
        skeleton=skeleton,
        home=(0.0, 0.0, 0.0),
        reach=1.0,
        regularity=ca.SX(1),
        stops=(),
    )


def entry_of(chain: Robot) -> RobotEntry:
    """A catalogue entry that makes this chain."""
    return RobotEntry(
        name=chain.name,
        label="Chain with passive joints",
        text="A chain.",
        parameters=Parameters,
        make=lambda _: chain,
    )


def _root(function: ca.Function, start: tuple[float, ...], given: Array) -> Array:
    """A root of a function (q, given), by Newton's method with least norms.

    Raises:
        ValueError: none is found near the start.
    """
    q, symbol = np.array(start, dtype=float), ca.SX.sym("q", len(start))
    other = ca.SX.sym("given", len(given))
    value = function(symbol, other)
    both = ca.Function("both", [symbol, other], [value, ca.jacobian(value, symbol)])
    for _ in range(50):
        gap, slope = (np.array(part) for part in both(q, given))
        if np.abs(gap).max() < 1e-12:
            return q
        step = np.linalg.lstsq(slope, -gap[:, 0], rcond=None)[0]
        q = q + np.clip(step, -0.3, 0.3)
    raise ValueError("the chain cannot rest there")


def _least_norm(matrix: ca.SX, right: ca.SX) -> ca.SX:
    return matrix.T @ ca.solve(matrix @ matrix.T, right)


def _points(shape: Shape, q: ca.SX) -> list[ca.SX]:
    """Ends of the links, (2, 1) each, from the pivot on, [m]."""
    angle, point, points = ca.SX(0), ca.SX.zeros(2, 1), [ca.SX.zeros(2, 1)]
    for joint in range(len(shape.joints)):
        angle += q[shape.joints.index(joint)]
        point += LINK * ca.vertcat(ca.sin(angle), -ca.cos(angle))
        points.append(point + 0)
    return points


def _potential(shape: Shape, q: ca.SX) -> ca.SX:
    points = _points(shape, q)
    pairs = pairwise(points)
    return sum((MASS * shape.gravity * (a[1] + b[1]) / 2 for a, b in pairs), ca.SX(0))


def _statics(shape: Shape) -> tuple[ca.SX, ca.SX, ca.SX]:
    """q, the end-point, and the undriven rows of dV/dq."""
    q = ca.SX.sym("q", len(shape.joints))
    undriven = ca.gradient(_potential(shape, q), q)[shape.motors :]
    return q, _points(shape, q)[-1], ca.densify(undriven)


def _equations(shape: Shape, offset: ca.DM) -> MechanicalSystem:
    n = len(shape.joints)
    q, v = ca.SX.sym("q", n), ca.SX.sym("v", n)
    points, kinetic, angle = _points(shape, q), ca.SX(0), ca.SX(0)
    for joint in range(n):
        angle += v[shape.joints.index(joint)]
        rate = ca.jtimes((points[joint] + points[joint + 1]) / 2, q, v)
        kinetic += MASS / 2 * (ca.dot(rate, rate) + LINK**2 / 12 * angle**2)
    potential = _potential(shape, q)
    return mechanical_system(
        name="passive_chain",
        q=q,
        v=v,
        parameters=ca.SX(0, 1),
        parameter_names=(),
        mass=ca.jacobian(ca.gradient(kinetic, v), v),
        friction=FRICTION * v,
        inputs=shape.motors,
        output=points[-1] - offset,
        potential_energy=potential,
        coordinate_names=tuple(f"q{joint + 1}_rad" for joint in shape.joints),
    )
