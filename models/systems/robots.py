"""Robots: the definition of a robot, and everything that follows from it.

A module of this folder that defines a `ROBOT`, a `RobotEntry`, is found by the catalogue.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache

import casadi as ca
import numpy as np

from onpath.models.arrays import Array
from onpath.models.errors import Message
from onpath.models.paths.frames import Frame, Plane
from onpath.models.paths.path_design import USUAL_RADIUS
from onpath.models.robot_files.chain import Chain
from onpath.models.robot_files.guesses import Guess
from onpath.models.systems.drawing import Drawing
from onpath.models.systems.forces import Grip
from onpath.models.systems.guessed_numbers import guess_sentences
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.rigid_chain import ChainSource
from onpath.models.systems.robot_sketch import described, sketch
from onpath.models.systems.rows import Rows
from onpath.models.systems.system import MechanicalSystem

FASTEST_JOINT = 100.0  # [rad/s]; a run with faster joints counts as diverged
TOO_FAST = Message("stop.fast", {"limit": f"{FASTEST_JOINT:.0f}"})
NOT_FINITE = Message("stop.range")
SINGULAR, AT_A_LIMIT = Message("stop.singular"), Message("stop.limit")
LEAST_REGULARITY = 0.02
"""Regularity relative to home below which a run is stopped, unless a robot has its own stops."""
FARTHEST = 1e3  # [m], beyond the reach of every robot, also of one that slides without limits
CELLS = 41
"""Of a sketch, in each direction."""
_FINITE = float(np.finfo(float).max)
_PLANE, _DRAWING, _GRIP = Plane(), Drawing(), Grip()  # shared, because they are keys of caches


@dataclass(frozen=True, slots=True, eq=False)
class StopCondition:
    """A state in which a run of a robot counts as diverged.

    Attributes:
        when: an expression in the system's q and v, nonzero in such a state, (1, 1).
        reason: the reason. It may depend on the configuration, (n,), and the parameters; with None
            for the configuration, it must be true in every one.
    """

    when: ca.SX
    reason: Message | Callable[[Array | None, Parameters], Message]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True, weakref_slot=True)
class Robot:
    """A robot: expressions in the symbols of its equations of motion, and a few numbers.

    Everything else is computed from these expressions, here with arrays of numbers, and in exported
    pages. `faults_of` in `contract.py` describes the faults of a robot. The robot's frame
    has x to the right, y away from the viewer, z up, and its origin where the robot is mounted.

    Attributes:
        system: the equations of motion, made by `mechanical_system`: M(q), B(q), h(q), potential
            energy and friction; c(q, v) follows from them, so that nobody derives it by hand. With
            n > m = p, some coordinates have no motor; with m > p, the robot is redundant. The
            numbers in h(q) are not among those that a user can change.
        plant: numbers of `system.parameters` for a user's parameters, shape (k,).
        model: the numbers that the controller assumes; equal to `plant` if it knows its robot.
        inverse: y -> a configuration at rest with h(q) = y, (p, 1) -> (n, 1), continuous where the
            regularity is positive; for a redundant robot, one of many. NaN means that y is out of
            reach; functions such as `ca.acos` and `ca.sqrt` give it automatically.
        skeleton: (q, exaggeration) -> ends of the bars, (3, 2 k), begin and end as columns, and
            joints, (3, j), in the robot's frame, [m]. The last bar ends at the end-point.
            Deflections are multiplied by the exaggeration.
        home: the point y = 0 in the robot's frame, [m].
        reach: no end-point is farther than this from the origin of the robot's frame, [m]. Maps of
            the workspace extend so far, and a hand pulls no farther than this from home.
        regularity: an expression in q that is positive for a configuration of `inverse`, and 0
            where it is singular or at a limit, (1, 1). None: |det(J B)| with J = dh/dq, and
            sqrt(det(J B Bᵀ Jᵀ)) for m > p: how far the motors' joints move the end-point.
        stops: states in which a run counts as diverged, besides joints that are too fast and
            numbers that are not finite. None: where the regularity is less than
            `LEAST_REGULARITY` times that at home.
        extras: quantities to plot besides those of every robot, in q, v and the system's
            parameters, (size, 1) each.
        frame: how the plane of the path lies in the output space.
        drawing: details of the drawing that do not follow from bars and joints.
        substeps: Runge-Kutta steps per tick.
        grip: the springs by which a hand, a brake and a wall act on its end-point.
        shared: the robot whose loops it shares, because they differ in `frame.numbers` only.
        chain: the bodies that it is made of, which are drawn; None: its bars are drawn.
        radius: of the circle among its predefined paths, which are smaller for a small robot, [m].
    """

    system: MechanicalSystem
    plant: Callable[[Parameters], Array]
    model: Callable[[Parameters], Array]
    inverse: Callable[[ca.SX], ca.SX]
    skeleton: Callable[[ca.SX, ca.SX], tuple[ca.SX, ca.SX]]
    home: tuple[float, float, float]
    reach: float
    regularity: ca.SX | None = None
    stops: tuple[StopCondition, ...] | None = None
    extras: Mapping[str, ca.SX] = field(default_factory=dict[str, ca.SX])
    frame: Frame = _PLANE
    drawing: Drawing = _DRAWING
    substeps: int = 1
    grip: Grip = _GRIP
    shared: Robot | None = None
    chain: Chain | None = None
    radius: float = USUAL_RADIUS

    @property
    def name(self) -> str:
        """The name on the command line and in files."""
        return self.system.name

    @property
    def core(self) -> Robot:
        """The robot whose loops it shares; itself if it shares none."""
        return self.shared or self

    def endpoint(self, q: Array) -> Array:
        """The actual end-point, shape (..., n) -> (..., p), [m]."""
        return self.output_at(_tip(self.core)(q))

    def rest(self, y: Array) -> Array:
        """Configurations at rest with the end-point at y, shape (..., p) -> (..., n).

        Raises:
            ValueError: a point is out of reach.
        """
        near = np.where(np.abs(y) <= FARTHEST, y, np.nan)
        q = _inverse(self.core)(near)
        if not np.isfinite(q).all():
            bad = y[~np.isfinite(q).all(-1)].reshape(-1, self.system.p)[0]
            where = ", ".join(f"{value:.4g}" for value in bad)
            raise ValueError(f"end-point out of reach of the robot: y = ({where}) m")
        return q

    def margin_at(self, y: Array) -> Array:
        """Regularity at rest with the end-point at y, relative to that at home, (..., p) -> (...).

        It is 0 where the robot is singular or y is out of reach.
        """
        return _margin(self.core)(y)[..., 0]

    def margin(self, z: Array) -> Array:
        """`margin_at` points z of the path's plane, shape (..., 2) -> (...).

        If `frame.space` is a frame, also at points (z, ζ) above the plane, (..., 3) -> (...).
        """
        return self.margin_at(self.frame.lift(z))

    def fault(self, q: Array, v: Array, parameters: Parameters) -> tuple[int, Message] | None:
        """The first row in which a run has diverged, and the reason; None if it has not diverged.

        Whether a row has diverged depends on that row alone, so that the rows of several robots can
        be searched together; the reason may depend on the parameters.

        Args:
            q, v: shape (rows, n).
        """
        quiet = np.abs(v).max(initial=0.0) <= FASTEST_JOINT and np.isfinite(q).all()  # no NaN in v
        if quiet and not _stopped(self.core)(q, v).any():
            return None  # the cheaper function suffices in every frame of a sound run
        codes = _stop_code(self.core)(q, v)[:, 0]
        if not codes.any():
            return None
        first = int(np.flatnonzero(codes)[0])
        where = q[first] if np.isfinite(q[first]).all() else None
        return first, self.reasons(where, parameters)[int(codes[first]) - 1]

    def reasons(self, q: Array | None, parameters: Parameters) -> tuple[Message, ...]:
        """The reasons why a run may stop, in the order of the numbers of `stop_code`.

        Args:
            q: the configuration, shape (n,). None: the reasons are true in every configuration.
        """
        reasons = (stop.reason for stop in stops_of(self))
        messages = [each if isinstance(each, Message) else each(q, parameters) for each in reasons]
        return TOO_FAST, *messages, NOT_FINITE

    def measured(self, q: Array, v: Array, parameters: Parameters) -> dict[str, Array]:
        """The values of `extras`, shape (..., size) each; q and v: (..., n)."""
        if not self.extras:
            return {}
        values = _extras(self.core)(q, v, self.plant(parameters))
        ends = np.cumsum([each.numel() for each in self.extras.values()])[:-1]
        return dict(zip(self.extras, np.split(values, ends, axis=-1), strict=True))

    def position(self, y: Array) -> Array:
        """Points of the output space in the robot's frame, (..., p) -> (..., 3), [m]."""
        return y @ self.axes + np.array(self.home)

    def output_at(self, point: Array) -> Array:
        """The inverse of `position`, (..., 3) -> (..., p), [m]."""
        return (point - np.array(self.home)) @ self.axes.T

    @property
    def axes(self) -> Array:
        """Directions of the outputs in the robot's frame, shape (p, 3)."""
        return np.array(self.drawing.axes or AXES[self.system.p], dtype=float)

    @property
    def seen(self) -> Array:
        """The projection from the robot's frame to a picture, right and up, shape (2, 3).

        A robot that moves in the vertical plane is seen at right angles to it, from far away.
        """
        flat = self.system.p == 2
        up, turn = (0.0, 0.0) if flat else (self.drawing.elevation, self.drawing.azimuth)
        right = [np.cos(turn), np.sin(turn), 0.0]
        above = [-np.sin(turn) * np.sin(up), np.cos(turn) * np.sin(up), np.cos(up)]
        return np.array([right, above])

    def sketched(self) -> str:
        """A drawing at home, with the points of the path's plane that it can reach, as SVG."""
        q, home = self.system.q, self.rest(self.frame.lift(np.zeros(2)))
        picture = ca.Function("picture", [q], [*self.skeleton(q, ca.SX(1))])
        bars, joints = (self.seen @ np.array(part) for part in picture(home))
        line = np.linspace(-self.reach, self.reach, CELLS)
        z = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
        inside = z[self.margin(z) > LEAST_REGULARITY]
        cells = self.position(self.frame.lift(inside)) @ self.seen.T
        return sketch(bars.T, joints.T, cells, 2 * self.reach / (CELLS - 1))


AXES = {2: ((1, 0, 0), (0, 0, 1)), 3: ((1, 0, 0), (0, 1, 0), (0, 0, 1))}
"""Number of outputs -> axes: in the vertical plane y = 0 of the robot's frame, or in space."""


def margin_of(robot: Robot, y: ca.SX) -> ca.SX:
    """`Robot.margin_at` as an expression in y, (p, 1) -> (1, 1)."""
    q = robot.inverse(y)
    margin, within = _relative(robot.core)(q), ca.fabs(ca.sum1(q)) <= _FINITE
    return ca.if_else(ca.logic_and(within, margin > 0), margin, 0)


def stop_code(robot: Robot) -> ca.SX:
    """The reason why a run has diverged, as an expression in the system's q and v, (1, 1).

    It is 0 for a sound state, or the position in `Robot.reasons`, counted from 1: too fast, the
    first of the robot's stops that applies, or not finite.
    """
    q, v = robot.system.q, robot.system.v
    fast, total = ca.fabs(v[0]), ca.sum1(q) + ca.sum1(v)
    for rate in ca.vertsplit(v)[1:]:
        fast = ca.fmax(fast, ca.fabs(rate))
    finite = ca.fabs(total) <= _FINITE
    checks = [fast > FASTEST_JOINT, *(stop.when for stop in stops_of(robot)), ca.logic_not(finite)]
    code = ca.SX(0)
    for number, bad in reversed([*enumerate(checks, 1)]):
        code = ca.if_else(bad, number, code)
    return code


def stops_of(robot: Robot) -> tuple[StopCondition, ...]:
    """`Robot.stops`, with the usual stops for None."""
    return _usual_stops(robot.core) if robot.stops is None else robot.stops


@lru_cache(maxsize=64)
def _usual_stops(robot: Robot) -> tuple[StopCondition, ...]:
    return (StopCondition(_relative(robot)(robot.system.q) < LEAST_REGULARITY, AT_A_LIMIT),)


@lru_cache(maxsize=64)
def _relative(robot: Robot) -> ca.Function:
    """The function q -> regularity relative to that at home."""
    system = robot.system
    regularity = _reach_of_motors(robot) if robot.regularity is None else robot.regularity
    home = robot.inverse(ca.SX(ca.DM(robot.frame.lift(np.zeros(2)))))
    absolute = ca.Function("regularity", [system.q], [regularity])
    return ca.Function("relative", [system.q], [regularity / float(ca.evalf(absolute(home)))])


def _reach_of_motors(robot: Robot) -> ca.SX:
    """The default regularity, by the end-point of the skeleton, which has no parameters."""
    system, tip = robot.system, robot.skeleton(robot.system.q, ca.SX(1))[0][:, -1]
    jacobian = ca.jacobian(ca.DM(robot.axes) @ tip, system.q)
    moved = ca.densify(jacobian @ system.actuation)
    if system.m == system.p:
        return ca.fabs(ca.det(moved))
    return ca.sqrt(ca.fmax(ca.det(moved @ moved.T), 0))


@lru_cache(maxsize=64)
def _tip(robot: Robot) -> Rows:
    q = robot.system.q
    return Rows([q], robot.skeleton(q, ca.SX(1))[0][:, -1])


@lru_cache(maxsize=64)
def _inverse(robot: Robot) -> Rows:
    y = ca.SX.sym("y", robot.system.p)
    return Rows([y], robot.inverse(y))


@lru_cache(maxsize=64)
def _margin(robot: Robot) -> Rows:
    y = ca.SX.sym("y", robot.system.p)
    return Rows([y], margin_of(robot, y))


@lru_cache(maxsize=64)
def _stopped(robot: Robot) -> Rows:
    """Whether one of the stops holds."""
    bad = ca.SX(0)
    for stop in stops_of(robot):
        bad = ca.fmax(bad, stop.when)
    return Rows([robot.system.q, robot.system.v], bad)


@lru_cache(maxsize=64)
def _stop_code(robot: Robot) -> Rows:
    return Rows([robot.system.q, robot.system.v], stop_code(robot))


@lru_cache(maxsize=64)
def _extras(robot: Robot) -> Rows:
    system = robot.system
    return Rows([system.q, system.v, system.parameters], ca.vertcat(*robot.extras.values()))


@dataclass(frozen=True, slots=True, eq=False)
class BalancedLinkage:
    """Data of a balanced five-bar for the identification.

    Attributes:
        l1, l4: lengths of links 1 and 4, [m].
        built: true values of M11, M22, b1 and b2 (SI).
    """

    l1: float
    l4: float
    built: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class FlexibleLink:
    """Data of a robot whose last link bends.

    Attributes:
        joints: number of joint angles, which come before the link's coordinates in q.
        beam: names of the parameters that describe the link.
        composite: names of the gains of composite control.
        critical_alpha: α up to 1 from which the internal dynamics are unstable, at rest at joint
            angles, shape (joints,), with the link straight; infinity if there is none. It depends
            on the parameters in `beam` only.
    """

    joints: int
    beam: tuple[str, ...]
    composite: tuple[str, ...]
    critical_alpha: Callable[[Parameters, Array], float]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class RobotEntry:
    """An entry of the catalogue.

    Two entries are equal if they have the same name and, if they come from files, the same bodies,
    joints, end-point, home and outputs. It is pickled by its name, or with its bodies, so that
    where it is read its file is not needed.

    Attributes:
        name: as on the command line and in files, the name of its equations of motion.
        label: as shown.
        text: what the robot is, with the torque limits that its file states.
        parameters: the type of its parameters; its defaults are those of the robot everywhere.
        make: the robot for given parameters, the same object for the same structural parameters.
        picture: name of an asset; if empty, the bars are sketched.
        goes_on: parameters that may select another robot with the same states and kinematics, so
            that a run goes on from the present state.
        caution: the reason why the robot would not even run undisturbed with these parameters, if
            any.
        flexible_link: for a robot with parameters `law` and `alpha` and an extra "deflection"; None
            if all links are rigid.
        linkage: data for identification from a record of its motion, or None.
        source: what it is made from if it is a chain of bodies, such as one from a file, or None.
    """

    name: str
    label: str
    text: str
    parameters: type[Parameters]
    make: Callable[[Parameters], Robot]
    picture: str = ""
    flexible_link: FlexibleLink | None = None
    goes_on: tuple[str, ...] = ()
    caution: Callable[[Parameters], Message | None] = lambda _: None
    linkage: BalancedLinkage | None = None
    source: ChainSource | None = None

    @property
    def guesses(self) -> tuple[Guess, ...]:
        """What is guessed where the robot's file says nothing."""
        return () if self.source is None else self.source.guesses

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, RobotEntry):
            return NotImplemented
        if self is other or self.name != other.name or self.source is other.source:
            return self.name == other.name
        sources = self.source, other.source
        return sources[0] is not None and sources[1] is not None and sources[0].is_as(sources[1])

    def __hash__(self) -> int:
        return hash(self.name)

    def __repr__(self) -> str:
        return f"<robot {self.name}: {self.label}. {self._text}>"

    def _repr_html_(self) -> str:
        robot = self.make(self.parameters())
        joints = robot.chain.joints if robot.chain else ()
        return described(self.label, self.name, self._text, robot.sketched(), joints)

    @property
    def _text(self) -> str:
        """What the robot is, and what is guessed about it."""
        return " ".join([self.text, *guess_sentences(self.guesses)])

    @property
    def radius(self) -> float:
        """See `Robot.radius`."""
        return self.make(self.parameters()).radius

    def keeps_states(self, before: Parameters, now: Parameters) -> bool:
        """Whether two sets of parameters give the same robot apart from those in `goes_on`."""
        same = {name: getattr(before, name) for name in self.goes_on}
        return self.make(replace(now, **same)) is self.make(before)
