"""A planar chain of links on a fixed pivot, of which some joints have no motor."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.rigid_robots import PlanarRobot
from onpath.models.systems.robots import RobotEntry, first_fault
from onpath.models.systems.system import MechanicalSystem, lagrange_bias, mechanical_system

LINK, MASS, FRICTION = 0.1, 0.2, 0.02  # [m], [kg], [N m s]


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


@dataclass(frozen=True, slots=True, eq=False)
class PassiveChain(PlanarRobot):
    """A chain whose end-point is y = 0 where it rests at home.

    Raises:
        ValueError: no equilibrium is found.
    """

    shape: Shape
    system: MechanicalSystem = field(init=False, repr=False)
    at_home: Array = field(init=False, repr=False)
    offset: Array = field(init=False, repr=False)
    name: str = "passive_chain"
    label: str = "Chain with passive joints"
    reach: tuple[float, float] = (0.0, 1.0)

    def __post_init__(self) -> None:
        place, statics = _statics(self.shape)
        offset = ca.SX.sym("offset", 2)
        q, _, undriven = statics
        q0 = _root(ca.Function("undriven", [q, offset], [undriven]), self.shape.start, np.zeros(2))
        object.__setattr__(self, "at_home", q0)
        object.__setattr__(self, "offset", np.array(place(q0))[:, 0])
        object.__setattr__(self, "system", _equations(self.shape, self.offset))

    @property
    def home(self) -> tuple[float, float]:
        return 0.0, 0.0

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        return tuple(f"q{joint + 1}_rad" for joint in self.shape.joints)

    def plant(self, parameters: Parameters) -> Array:
        return np.zeros(0)

    def model(self, parameters: Parameters) -> Array:
        return np.zeros(0)

    def rest(self, y: Array) -> Array:
        _, (q, end, undriven) = _statics(self.shape)
        goal = ca.SX.sym("goal", 2)
        wanted = ca.vertcat(end - ca.DM(self.offset) - goal, undriven)
        return _root(ca.Function("wanted", [q, goal], [wanted]), self.at_home, y)

    def endpoint(self, q: Array) -> Array:
        place, _ = _statics(self.shape)
        rows = np.atleast_2d(q)
        found = np.array(place.map(len(rows))(rows.T)).T - self.offset
        return found.reshape(*q.shape[:-1], 2)

    def margin(self, z: Array) -> Array:
        return np.ones(z.shape[:-1])

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
        return first_fault(q, v)

    def skeleton(self, q: ca.SX, exaggeration: ca.SX) -> tuple[ca.SX, ca.SX]:
        raise NotImplementedError


def entry_of(chain: PassiveChain) -> RobotEntry:
    """A catalogue entry that makes this chain."""
    return RobotEntry(
        name=chain.name,
        label=chain.label,
        text="A chain.",
        parameters=Parameters,
        make=lambda _: chain,
    )


def _root(function: ca.Function, start: Array | tuple[float, ...], given: Array) -> Array:
    """A root of a function (q, given), by Newton's method with least norms.

    Raises:
        ValueError: none is found near the start.
    """
    q, symbol = np.array(start, dtype=float), ca.SX.sym("q", len(start))
    other = ca.SX.sym("given", 2)
    value = function(symbol, other)
    both = ca.Function("both", [symbol, other], [value, ca.jacobian(value, symbol)])
    for _ in range(50):
        gap, slope = (np.array(part) for part in both(q, given))
        if np.abs(gap).max() < 1e-12:
            return q
        step = np.linalg.lstsq(slope, -gap[:, 0], rcond=None)[0]
        q = q + np.clip(step, -0.3, 0.3)
    raise ValueError("the chain cannot rest there")


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


def _statics(shape: Shape) -> tuple[ca.Function, tuple[ca.SX, ca.SX, ca.SX]]:
    """The end-point as a function of q; and q, the end-point, and the undriven rows of dV/dq."""
    q = ca.SX.sym("q", len(shape.joints))
    end = _points(shape, q)[-1]
    undriven = ca.gradient(_potential(shape, q), q)[shape.motors :]
    return ca.Function("end", [q], [end]), (q, end, ca.densify(undriven))


def _equations(shape: Shape, offset: Array) -> MechanicalSystem:
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
        bias=lagrange_bias(q, v, kinetic, potential, FRICTION * v),
        inputs=shape.motors,
        output=points[-1] - ca.DM(offset),
        potential_energy=potential,
    )
