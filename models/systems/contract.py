"""Describes the faults of a robot, for whoever adds one.

from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.contract import faults_of
print(*faults_of(ROBOTS["my_robot"]) or ["no faults"], sep="\\n")
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import CodedError
from onpath.models.paths.path_checks import LEAST_MARGIN
from onpath.models.systems.parameters import Parameters, declared
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.rows import Rows
from onpath.models.systems.system import MechanicalSystem, lagrange_bias

POINTS = 200
"""Number of random points of the path's plane at which the robot is checked."""
NEAR = 0.15  # [m], largest coordinate of these points, from home
LEAST_PATH = 0.05  # [m], distance from home that paths must be able to reach
CLOSE = 1e-7
"""Largest error, relative to the largest of the compared numbers."""


def faults_of(entry: RobotEntry) -> list[str]:
    """The faults of a robot, a sentence for each; an empty list if none is found.

    The equations, the kinematics, the limits and the drawing are checked at random points around
    home. A fault that would cause others is reported alone.
    """
    for check in (_entry_faults, _shape_faults, _symbol_faults, _kinematic_faults):
        if found := [*check(entry)]:
            return found
    return [*_dynamic_faults(entry), *_limit_faults(entry), *_drawing_faults(entry)]


def _robot(entry: RobotEntry) -> Robot:
    return entry.make(entry.parameters())


def _entry_faults(entry: RobotEntry) -> Iterator[str]:
    robot = _robot(entry)
    if robot.name != entry.name:
        yield f"the entry's name is {entry.name!r}, but its equations' name is {robot.name!r}"
    if robot is not _robot(entry):
        yield "make() returns another object for the same parameters: use a constant or a cache"


def _shape_faults(entry: RobotEntry) -> Iterator[str]:
    robot, parameters = _robot(entry), entry.parameters()
    system, frame = robot.system, robot.frame
    n, m, p, k = system.n, system.m, system.p, system.parameters.numel()
    if p not in (2, 3) or frame.p != p:
        yield f"h(q) has {p} entries: it must have 2 or 3, and its frame is for {frame.p}"
    expected = {
        "q": (system.q, (n, 1)),
        "v": (system.v, (n, 1)),
        "the mass matrix": (system.mass, (n, n)),
        "the bias": (system.bias, (n, 1)),
        "B": (system.actuation, (n, m)),
        "h(q)": (system.output, (p, 1)),
        "the controlled output": (system.controlled_output, (p, 1)),
        "the energy": (system.energy, (1, 1)),
        "the force of the buffers": (system.end_forces(system.q, system.v), (n, 1)),
        "inverse(y)": (robot.inverse(ca.SX.sym("y", p)), (n, 1)),
    }
    if robot.regularity is not None:
        expected["the regularity"] = robot.regularity, (1, 1)
    for name, (found, shape) in expected.items():
        if found.shape != shape:
            yield f"{name} has the shape {found.shape} instead of {shape}"
    if len(system.coordinate_names) != n:
        yield f"{len(system.coordinate_names)} coordinate_names for {n} coordinates"
    if len(system.parameter_names) != k:
        yield f"{len(system.parameter_names)} parameter_names for {k} parameters"
    for name, numbers in (("plant", robot.plant(parameters)), ("model", robot.model(parameters))):
        if np.shape(numbers) != (k,) or not np.isfinite(numbers).all():
            yield f"{name}() does not return {k} finite numbers, one for each parameter_names"
    bars, joints = robot.skeleton(system.q, ca.SX(1))
    if bars.shape[0] != 3 or bars.shape[1] % 2 or not bars.shape[1]:
        yield f"the skeleton's bars have the shape {bars.shape} instead of (3, an even number)"
    if joints.shape[0] != 3:
        yield f"the skeleton's joints have the shape {joints.shape} instead of (3, any number)"


def _symbol_faults(entry: RobotEntry) -> Iterator[str]:
    robot = _robot(entry)
    system, exaggeration = robot.system, ca.SX.sym("exaggeration")
    q, v, numbers = system.q, system.v, system.parameters
    bars, joints = robot.skeleton(q, exaggeration)
    may = {
        "the mass matrix": (system.mass, (q, numbers)),
        "B": (system.actuation, (q, numbers)),
        "h(q)": (system.output, (q, numbers)),
        "the controlled output": (system.controlled_output, (q, numbers)),
        "the bias": (system.bias, (q, v, numbers)),
        "the energy": (system.energy, (q, v, numbers)),
        "the force of the buffers": (ca.SX(0) if system.ends is None else system.ends, (q, v)),
        "the skeleton": (ca.horzcat(bars, joints), (q, exaggeration)),
        "the regularity": (ca.SX(0) if robot.regularity is None else robot.regularity, (q,)),
    }
    may |= {
        f"a condition of stops ({i})": (s.when, (q, v)) for i, s in enumerate(robot.stops or ())
    }
    may |= {f"extras[{name!r}]": (x, (q, v, numbers)) for name, x in robot.extras.items()}
    for name, (expression, symbols) in may.items():
        try:
            ca.Function("tried", list(symbols), [ca.SX(expression)])
        except RuntimeError as error:
            strange = re.findall(r"variables \[(.*?)\]", str(error))
            yield f"{name} depends on {', '.join(strange)}, and must not (or not on its own symbol)"
    if robot.regularity is None and ca.depends_on(ca.vec(ca.SX(system.actuation)), numbers):
        yield "B depends on the system's parameters: the robot needs a regularity of its own"


def _points(robot: Robot) -> tuple[Array, Array]:
    """Random points of the path's plane around home, in reach, and the output there."""
    z = np.random.default_rng(0).uniform(-NEAR, NEAR, (POINTS, 2))
    z[0] = 0.0
    y = robot.frame.lift(z)
    inside = robot.margin_at(y) > LEAST_MARGIN
    return z[inside], y[inside]


def _kinematic_faults(entry: RobotEntry) -> Iterator[str]:
    robot, parameters = _robot(entry), entry.parameters()
    home = robot.frame.lift(np.zeros((1, 2)))
    try:
        robot.rest(home)
    except ValueError:
        yield "inverse(y) is not finite at home, z = 0"
        return
    margin = float(robot.margin(np.zeros((1, 2)))[0])
    if not abs(margin - 1) < CLOSE:
        yield "the regularity is not positive and finite at home, z = 0"
        return
    turn = np.linspace(-np.pi, np.pi, 24)
    ring = LEAST_PATH * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    if (robot.margin(ring) < LEAST_MARGIN).any():
        yield (
            f"the margin, which is 1 at home, is less than {LEAST_MARGIN:g} within"
            f" {1e3 * LEAST_PATH:.0f} mm of home: hardly any path can be followed"
        )
        return
    _, y = _points(robot)
    q = robot.rest(y)
    system, plant = robot.system, robot.plant(parameters)
    reached = _at(system, system.output, q, 0 * q, plant)
    if not _agree(reached, y):
        off = np.abs(reached - y).max()
        yield f"h(inverse(y)) is not y: off by up to {off:.3g} m within {NEAR} m of home"
    axes = robot.axes
    if axes.shape != (system.p, 3) or not _agree(axes @ axes.T, np.eye(system.p)):
        yield "the drawing's axes are not orthonormal"
    if not _agree(robot.endpoint(q), reached):
        off = np.abs(robot.endpoint(q) - reached).max()
        yield f"the skeleton's last bar does not end at home + h(q): off by up to {off:.3g} m"
    far = np.linalg.norm(robot.position(_wide(robot)), axis=-1)
    if (far > robot.reach + CLOSE).any():
        farthest = f"{far.max():.3g} m"
        yield f"reach is {robot.reach:g} m, but an end-point {farthest} from the origin is in reach"


def _wide(robot: Robot) -> Array:
    """Points in reach, as far away as twice the reach."""
    wide = 2 * robot.reach
    z = np.random.default_rng(1).uniform(-wide, wide, (20 * POINTS, 2))
    y = robot.frame.lift(z)
    return y[robot.margin_at(y) > 0]


def _states(robot: Robot) -> tuple[Array, Array]:
    """Configurations around rest, and velocities."""
    rng = np.random.default_rng(2)
    q = robot.rest(_points(robot)[1])
    return q + 0.01 * rng.normal(size=q.shape), rng.normal(size=q.shape)


def _at(system: MechanicalSystem, x: ca.SX, q: Array, v: Array, numbers: Array) -> Array:
    """The values of an expression at states, flat, shape (states, entries)."""
    return Rows([system.q, system.v, system.parameters], ca.vec(ca.densify(ca.SX(x))))(
        q, v, numbers
    )


def _agree(found: Array, expected: Array) -> bool:
    scale = max(1.0, float(np.abs(expected).max(initial=0.0)))
    return bool(np.abs(found - expected).max(initial=0.0) < CLOSE * scale)  # False for NaN


def _dynamic_faults(entry: RobotEntry) -> Iterator[str]:
    robot, parameters = _robot(entry), entry.parameters()
    system, (q, v) = robot.system, _states(robot)
    n, m, plant = system.n, system.m, robot.plant(parameters)

    def value(x: ca.SX, rates: Array = v) -> Array:
        return _at(system, x, q, rates, plant)

    mass = value(system.mass).reshape(-1, n, n)
    if not _agree(mass, mass.transpose(0, 2, 1)):
        yield "the mass matrix is not symmetric"
    elif not np.linalg.eigvalsh(mass).min() > 0:
        yield "the mass matrix is not positive definite"
    if (np.linalg.matrix_rank(value(system.actuation).reshape(-1, m, n)) < m).any():
        yield f"B does not have the rank {m} everywhere"
    kinetic = ca.dot(system.v, system.mass @ system.v) / 2
    lagrangian = lagrange_bias(system.q, system.v, kinetic, system.energy - kinetic, ca.SX(n, 1))
    friction = system.bias - lagrangian
    if not _agree(value(friction, 0 * v), np.zeros((1, n))):
        yield "the bias at rest is not the gradient of the potential energy"
    elif not _agree(value(friction), -value(friction, -v)):
        yield "the bias less friction is not Lagrange's for the mass matrix: leave it out"
    elif (np.einsum("ij,ij->i", v, value(friction)) < -CLOSE).any():
        yield "friction adds energy: the energy grows without torques"
    tau = system.tau - system.bias
    solved = system.mass @ ca.substitute(system.acceleration, system.tau, ca.SX.ones(n)) - (
        ca.substitute(tau, system.tau, ca.SX.ones(n))
    )
    gains = system.mass @ ca.horzcat(system.drift, system.input_gain)
    expected = ca.horzcat(-system.bias, system.actuation)
    if not _agree(value(solved), np.zeros((1, n))) or not _agree(value(gains), value(expected)):
        yield "solve(M, R) does not return the solution X of M X = R"


def _limit_faults(entry: RobotEntry) -> Iterator[str]:
    robot, parameters = _robot(entry), entry.parameters()
    _, y = _points(robot)
    q = robot.rest(y)
    if (found := robot.fault(q, 0 * q, parameters)) is not None:
        yield (
            f"a run stops at rest where a path may be, at y = {np.round(y[found[0]], 4)}:"
            f" {found[1]}"
        )
    yield from _continuity_faults(robot, y)
    yield from _parameter_faults(entry)


def _continuity_faults(robot: Robot, y: Array) -> Iterator[str]:
    """Jumps of q on a straight line from home along which the margin stays positive."""
    steps = np.linspace(0.0, 1.0, 400)[:, None]
    for target in y[:20]:
        line = y[0] + steps * (target - y[0])
        if (robot.margin_at(line) < LEAST_MARGIN).any():
            continue
        jump = np.abs(np.diff(robot.rest(line), axis=0)).max()
        if jump > 0.1:
            yield f"inverse(y) jumps by {jump:.2g} on the way from home to y = {target.round(3)}"
            return


def _parameter_faults(entry: RobotEntry) -> Iterator[str]:
    """Faults at the ends of the range of each parameter that a user may set."""
    usual = entry.parameters()
    before = _robot(entry).plant(usual)
    names = declared(entry.parameters).keys() - declared(Parameters).keys()
    for name in sorted(names):
        spec = declared(entry.parameters)[name]
        for value in spec.options or (spec.low, spec.high):
            try:
                changed = replace(usual, **{name: value})
                robot = entry.make(changed)
                plant, model = robot.plant(changed), robot.model(changed)
            except (ValueError, TypeError, CodedError) as error:
                yield f"{name} = {value}: {error}"
                continue
            if not np.isfinite([plant, model]).all():
                yield f"{name} = {value}: plant() or model() is not finite"
            elif plant.shape == before.shape:
                moved = _moved(robot, plant != before)
                if moved:
                    yield f"{name} changes {', '.join(moved)}, on which h(q) depends"


def _moved(robot: Robot, changed: Array) -> Iterable[str]:
    """The changed parameters of the system on which h(q) depends."""
    system = robot.system
    names = zip(system.parameter_names, ca.vertsplit(system.parameters), changed, strict=True)
    return [name for name, symbol, moved in names if moved and ca.depends_on(system.output, symbol)]


def _drawing_faults(entry: RobotEntry) -> Iterator[str]:
    robot = _robot(entry)
    drawing = robot.drawing
    bars, joints = robot.skeleton(robot.system.q, ca.SX(1))
    count = bars.shape[1] // 2
    if any(not 0 <= joint < joints.shape[1] for joint in drawing.motors):
        yield f"the drawing's motors {drawing.motors} are not all among {joints.shape[1]} joints"
    named = [each.bar for each in drawing.angles]
    named += [each.after for each in drawing.angles if each.after is not None]
    if any(not 0 <= bar < count for bar in named):
        yield f"the drawing's angles name a bar that is not among {count}"
    ends = [end for each in drawing.lengths for end in (each.begin, each.end)]
    if any(not -2 * count <= end < 2 * count for end in ends):
        yield f"the drawing's lengths name an end that is not among {2 * count}"
    if not 0 <= drawing.strip < count + 1:
        yield f"the drawing's strip has {drawing.strip} of {count} bars"
