"""Control laws: functions from the view of a robot and its path to a command.

A law sees a `View` and returns a `ControlAction`: an acceleration y'' of the output, which
`models/control/linearization.py` turns into torques, or the torques themselves. Everything is
symbolic; `models/closed_loop/kernel.py` makes one function of it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Literal

import casadi as ca

from onpath.models.arrays import Array
from onpath.models.control.place import Place
from onpath.models.control.poles import Channel
from onpath.models.control.virtual_output import VirtualOutput
from onpath.models.layout import Fields
from onpath.models.paths.curves import Curve
from onpath.models.paths.frames import PlaneCoordinates
from onpath.models.paths.projection import LocalCurve
from onpath.models.systems.parameter_specs import Spec
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot
from onpath.models.systems.system import MechanicalSystem

ZERO, ONE = ca.SX(0), ca.SX(1)

PLAN = 40
"""The most numbers of a plan."""

Memory = tuple[tuple[str, int], ...]
"""Names and sizes of the fields that a law keeps from tick to tick, the same for all robots."""


@dataclass(frozen=True, slots=True)
class OwnGain:
    """A gain that one law has besides K1 to K5. Make it with `own_gain`.

    Attributes:
        name: as in files, on the command line and in `View.own_gains`.
        default: its value in a new lab.
        spec: its unit, range and words.
    """

    name: str
    default: float
    spec: Spec

    def of(self, parameters: Parameters) -> float:
        """The value of the gain."""
        return dict(parameters.own_gains).get(self.name, self.default)


def own_gain(
    name: str,
    default: float,
    unit: str,
    bounds: tuple[float, float, float],
    text: str,
    *,
    label: str,
) -> OwnGain:
    """Declare a gain of a single law.

    Args:
        name, default: see `OwnGain`.
        unit: "" for none.
        bounds: (low, high, step).
        text: one line on what it does.
        label: its name on a slider.
    """
    low, high, step = bounds
    spec = Spec(
        group="gains",
        label=label,
        unit=unit,
        low=low,
        high=high,
        step=step,
        options=(),
        help=text,
    )
    return OwnGain(name, default, spec)


@dataclass(frozen=True, slots=True)
class Gains:
    """The gains that most laws share.

    Attributes:
        k1, k2, k3: proportional [1/s²], derivative [1/s] and integral [1/s³] gain: of the
            transversal law (18), and of the tracking error.
        k4, k5: position [1/s²] and speed gain [1/s] of the tangential law (19).
    """

    k1: ca.SX
    k2: ca.SX
    k3: ca.SX
    k4: ca.SX
    k5: ca.SX


@dataclass(frozen=True, slots=True)
class PathReference:
    """The wanted motion along the path.

    Attributes:
        position: 1 to hold the position θ_ref, 0 to hold the speed ω_ref.
        target: θ_ref, [rad].
        speed: ω_ref, [rad/s].
        limit: largest |ω_ref| for laws without a clock, [rad/s].
        acceleration: ω_ref', [rad/s²].
    """

    position: ca.SX
    target: ca.SX
    speed: ca.SX
    limit: ca.SX
    acceleration: ca.SX


@dataclass(frozen=True, slots=True)
class Clock:
    """The reference point that a law keeps, at the beginning of a tick.

    Attributes:
        theta: θ_r, [rad].
        task: the wanted motion along the path.
        closed: whether the path is a closed curve.
        dt: length of a tick, [s].
        interval: between two evaluations of the law, [s]; what a law integrates grows by its rate
            times this.
        ahead: time by which the controller looks ahead, [s].
        memory: the law's own memory, as its last evaluation left it.
        plan: the numbers of `Law.plan`, (PLAN, 1); 0 where there are none.
    """

    theta: ca.SX
    task: PathReference
    closed: bool
    dt: ca.SX
    interval: ca.SX
    ahead: ca.SX
    memory: Fields
    plan: ca.SX


@dataclass(frozen=True, slots=True)
class View:
    """The arguments of a law in a tick, predicted to the middle of the interval of its command.

    Attributes:
        system: the equations of motion, and `q`, `v`, `model` their arguments: configuration and
            velocity, (n, 1), and the plant's parameters as the controller assumes them, (k, 1).
        frame: how the plane of the path lies in the output space.
        y, y_rate: the controlled output and its rate, (p, 1), [m], [m/s].
        output: coordinates along and across the path.
        closest: the path about the point closest to y.
        drawing: whether the path is one of many pieces.
        reference: the path about the point that `Law.reference` asks for; None if it asks for none.
        task: the wanted motion along the path.
        clock: the reference point.
        gains: K1 to K5.
        own_gains: those of `Law.own_gains`, by name.
        integral: integral of `ControlAction.error`, (p, 1).
        lag: the greatest age of the controller's information when its torque ends, [s]: the control
            interval plus, where they exist, the time constant of the observer or the velocity
            filter, the computing delay and the time constant with which composite control predicts
            bending.
        measured: configuration and velocity as measured, not predicted, each (n, 1).
        held: torque that the motors have given since the law's last evaluation, (m, 1), [N m].
    """

    system: MechanicalSystem
    q: ca.SX
    v: ca.SX
    model: ca.SX
    frame: PlaneCoordinates
    y: ca.SX
    y_rate: ca.SX
    output: VirtualOutput
    closest: LocalCurve
    drawing: bool
    reference: LocalCurve | None
    task: PathReference
    clock: Clock
    gains: Gains
    own_gains: Fields
    integral: ca.SX
    lag: ca.SX
    measured: tuple[ca.SX, ca.SX]
    held: ca.SX


@dataclass(frozen=True, slots=True)
class Along:
    """The part of a commanded acceleration along the path, which a torque limit may reduce.

    Attributes:
        command: v_par, (1, 1), [rad/s²].
        direction: dy''/dv_par, (p, 1), [m/rad].
    """

    command: ca.SX
    direction: ca.SX


@dataclass(frozen=True, slots=True)
class ControlAction:
    """The command of a law.

    Attributes:
        acceleration: y'', (p, 1), [m/s²]; None if the law commands torques.
        torque: u, (m, 1), [N m]; None if it commands an acceleration.
        error: the quantity that K3 integrates, (p, 1), [m]; None: nothing.
        error_per_metre: units of `error` per metre; 1 except for a level set.
        far: share of the command, from 0 to 1, that returns to the path from far away instead of
            following the law's formula; see `path_following.far_from_path`.
        theta_ref: θ_r after the tick, [rad]; None: it runs by the clock, `references.clock_rate`.
        along: the part of `acceleration` along the path, which a torque limit may reduce; None:
            its component along the path where the robot is.
        memory: the law's own memory after this evaluation; it stays so until the next one.
    """

    acceleration: ca.SX | None = None
    torque: ca.SX | None = None
    error: ca.SX | None = None
    error_per_metre: ca.SX = ONE
    far: ca.SX = ZERO
    theta_ref: ca.SX | None = None
    along: Along | None = None
    memory: Fields = field(default_factory=dict[str, ca.SX])


@dataclass(frozen=True, slots=True)
class Law:
    """An entry of the registry.

    Attributes:
        name: as on the command line and in files.
        label: as shown, in English.
        text: what it does, in a sentence.
        source: where it comes from.
        good: its strength, in a sentence that a run confirms.
        limits: its weakness, in a sentence that a run confirms.
        objection: what its authors would object to here, in a sentence.
        command: the law.
        reference: clock -> parameter θ of a further point at which the law needs the path; None if
            it needs the closest point only.
        aim: log field of the point that it aims at: "theta" or "theta_ref".
        gains: names of the gains that it uses among K1 to K5.
        own_gains: its other gains.
        by_clock: whether its reference point runs by the clock, whatever the robot does.
        memory: what it keeps from tick to tick; all of it is 0 at the start.
        plan: (robot, parameters, curve) -> at most `PLAN` numbers, computed whenever one of these
            changes, which may take some 50 ms; None if it needs none.
        square: whether it needs as many motors and outputs as coordinates, n = m = p.
        commands_acceleration: whether it commands y'' rather than torques.
        pace: what determines its speed along the path: "wanted", the wanted speed; "energy", its
            energy; "free", whatever pushes it; "none", it does not move along the path.
        linear: whether its error has the poles of its gains; see `models/control/poles.py`.
        channels: the motion across and along the path near a place, for a law that is not `linear`;
            None if that motion has no poles either.
        motors: number of motors that it is made for; None: any.
        spatial: whether it is made for outputs in space, p = 3.
        robots: names of the systems that it is made for; none: any.
        stabilizes: whether it also controls coordinates that have no motor, so that nothing can be
            foreseen of them by the zero dynamics.
        small_errors: whether it is meant for errors that are small against the radius of curvature.
        always_integrates: whether it uses the integral even if K3 = 0.
        origin: file and line of a custom law, see `python_law`; None for others. A number of
            its command that is not finite stops the run, and the message names them.
        called: makes, for each run, the function that is called between ticks and whose results are
            the law's memory; None for a law that is compiled.
    """

    name: str
    label: str
    text: str
    source: str
    command: Callable[[View], ControlAction]
    reference: Callable[[Clock], ca.SX] | None = None
    aim: str = "theta_ref"
    gains: tuple[str, ...] = ("K1", "K2", "K3")
    own_gains: tuple[OwnGain, ...] = ()
    by_clock: bool = False
    memory: Memory = ()
    plan: Callable[[Robot, Parameters, Curve], Array] | None = None
    square: bool = False
    commands_acceleration: bool = True
    pace: Literal["wanted", "energy", "free", "none"] = "wanted"
    linear: bool = False
    channels: Callable[[Parameters, Place], tuple[Channel, Channel]] | None = None
    motors: int | None = None
    spatial: bool = False
    robots: tuple[str, ...] = ()
    stabilizes: bool = False
    small_errors: bool = False
    always_integrates: bool = False
    good: str = ""
    limits: str = ""
    origin: tuple[str, int] | None = None
    called: Callable[[], Callable[..., Any]] | None = None
    objection: str = ""

    @property
    def gain_names(self) -> tuple[str, ...]:
        """Names of all its gains."""
        return (*self.gains, *(gain.name for gain in self.own_gains))

    @property
    def travels(self) -> bool:
        """Whether it moves along the path, by itself or pushed."""
        return self.pace != "none"

    def suits(self, system: MechanicalSystem) -> bool:
        """Whether the law can be used with a robot."""
        if self.robots and system.name not in self.robots:
            return False
        if (self.spatial and system.p != 3) or self.motors not in (None, system.m):
            return False
        return not self.square or system.n == system.m == system.p
