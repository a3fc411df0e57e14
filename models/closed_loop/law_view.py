"""The arguments of a control law in a tick: the output, its path coordinates, the reference."""

from __future__ import annotations

from dataclasses import replace

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import GAINS
from onpath.models.closed_loop.reference_speed import task_at
from onpath.models.control import composite_control as composite
from onpath.models.control.laws.expressions import LARGEST_NUMBER
from onpath.models.control.laws.law import (
    Along,
    Clock,
    ControlAction,
    Gains,
    Law,
    PathReference,
    View,
)
from onpath.models.control.laws.references import clock_rate
from onpath.models.control.space_output import space_output
from onpath.models.control.virtual_output import LevelSet, VirtualOutput, virtual_output
from onpath.models.layout import Fields
from onpath.models.paths.curves import PERIOD
from onpath.models.paths.frames import PlaneCoordinates
from onpath.models.paths.projection import LARGEST_STEP, LocalCurve
from onpath.models.systems.system import MechanicalSystem


def predicted(state: Fields, settings: Fields) -> ca.SX:
    """The parameter at which the curve is evaluated, θ_0 = θ + dt θ', [rad].

    It is at most two pieces away from θ, so that no other part of a drawing is taken.
    """
    turn = settings["dt"] * state["theta_rate"]
    if "pieces" in settings:
        most = ca.fmin(LARGEST_STEP, 2 * PERIOD / settings["pieces"])
        turn = ca.fmin(ca.fmax(turn, -most), most)
    return state["theta"] + turn


def controlled(
    system: MechanicalSystem, settings: Fields, q: ca.SX, v: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """The controlled output and its rate, by the controller's model, each (p, 1), [m], [m/s]."""
    return system.with_rate(system.controlled_output)(q, v, settings["model"])


def coordinates(
    frame: PlaneCoordinates,
    kind: Kind,
    state: Fields,
    settings: Fields,
    values: ca.SX,
    y: ca.SX,
    y_rate: ca.SX,
) -> tuple[VirtualOutput, LocalCurve]:
    """The virtual output at y and the closest point, from `values` at the predicted θ."""
    names = ("level_centre", "level_weights", "level_constant")
    conic = LevelSet(*[settings[name] for name in names])
    level = (kind.level or conic) if kind.level_set else None
    start = LocalCurve.from_values(predicted(state, settings), kind.closed, values)
    if kind.spline:  # farther away, the polynomial is another curve
        reach = ca.fmin(LARGEST_STEP, 1.5 * PERIOD / settings["pieces"])
        start = replace(start, reach=reach)
    closest = start.project(frame.split(y)[0])
    if kind.space:
        return space_output(closest, frame, y, y_rate), closest
    return virtual_output(closest, frame, level, y, y_rate), closest


def beam_estimate(
    system: MechanicalSystem, state: Fields, settings: Fields, q: ca.SX, v: ca.SX, h: ca.SX
) -> composite.Compensation:
    """Composite control's estimate of the flexible link at q and v, the time h [s] ahead."""
    memory = {name: state[name] for name, _ in composite.MEMORY.fields}
    gains = composite.CompositeGains(*[settings[name] for name in composite.GAINS])
    later = composite.ahead(memory, h)
    return composite.compensation(system, q, v, settings["model"], later, gains)


def measured_output(
    system: MechanicalSystem,
    frame: PlaneCoordinates,
    kind: Kind,
    state: Fields,
    settings: Fields,
    values: ca.SX,
    measured: tuple[ca.SX, ca.SX],
) -> VirtualOutput:
    """The virtual output of the measured (q, v), at the beginning of the tick."""
    q, v = measured
    y, y_rate = controlled(system, settings, q, v)
    if kind.output == "composite":
        beam = beam_estimate(system, state, settings, q, v, ca.SX(0))
        y, y_rate = beam.y, beam.y_rate
    return coordinates(frame, kind, state, settings, values, y, y_rate)[0]


def interval(kind: Kind, settings: Fields) -> ca.SX:
    """The time between two evaluations of the control law, T, [s]."""
    return settings["dt"] if kind.free else settings["dt"] * settings["hold_ticks"]


def lag(system: MechanicalSystem, kind: Kind, settings: Fields) -> ca.SX:
    """Greatest age of the controller's information when its torque ends, [s]: `View.lag`."""
    age = interval(kind, settings)
    if kind.encoder or kind.noise:
        age += settings["observer_time" if kind.observer else "encoder_filter"]
    if kind.delay:
        age += settings["delay_ticks"] * settings["dt"]
    if kind.output == "composite":
        omega1 = settings["model"][system.parameter_names.index("omega1")]
        age += 1 / (settings["tip_prediction"] * omega1)
    return age


def clock_at(kind: Kind, law: Law, state: Fields, settings: Fields, ahead: ca.SX) -> Clock:
    """The reference point at the beginning of the tick; its rate is that `ahead` [s] later."""
    task = task_at(state, settings, ahead)
    if kind.output == "composite":
        task = replace(task, speed=state["speed_chain"][0], acceleration=ca.SX(0))
    return Clock(
        theta=state["theta_ref"],
        task=task,
        closed=kind.closed,
        dt=settings["dt"],
        interval=interval(kind, settings),
        ahead=ahead,
        memory={name: state[name] for name, _ in law.memory},
        plan=settings["plan"],
    )


def _task(
    state: Fields, settings: Fields, output: VirtualOutput, beam: composite.Compensation | None
) -> PathReference:
    """The wanted motion at the instant to which the controller looks."""
    task = task_at(state, settings, settings["look_ahead"])
    if beam is None:
        return task
    speed = composite.wanted_speed(beam, output, settings["K5"])
    return replace(task, speed=speed, acceleration=ca.SX(0))


def law_view(
    system: MechanicalSystem,
    frame: PlaneCoordinates,
    kind: Kind,
    law: Law,
    state: Fields,
    settings: Fields,
    values: ca.SX,
    measured: tuple[ca.SX, ca.SX],
    ahead: tuple[ca.SX, ca.SX],
    beam: composite.Compensation | None,
) -> View:
    """The view of the law.

    Args:
        measured: q and v at the beginning of the tick.
        ahead: q and v at the instant to which the controller looks.
    """
    (q, v), h = ahead, settings["look_ahead"]
    y, y_rate = controlled(system, settings, q, v) if beam is None else (beam.y, beam.y_rate)
    output, closest = coordinates(frame, kind, state, settings, values[:, 0], y, y_rate)
    task = _task(state, settings, output, beam)
    clock, reference = clock_at(kind, law, state, settings, h), None
    if law.reference is not None:
        reference = LocalCurve.from_values(law.reference(clock), kind.closed, values[:, 1])
    return View(
        system=system,
        q=q,
        v=v,
        model=settings["model"],
        frame=frame,
        y=y,
        y_rate=y_rate,
        output=output,
        closest=closest,
        drawing=kind.spline,
        reference=reference,
        task=task,
        clock=clock,
        gains=Gains(*[settings[name] for name in GAINS]),
        own_gains={gain.name: settings[gain.name] for gain in law.own_gains},
        integral=state["integral"],
        lag=lag(system, kind, settings),
        measured=measured,
        held=state["u"],
    )


def commanded(law: Law, view: View) -> ControlAction:
    """What the law commands.

    Raises:
        ValueError: a command or a memory of another size than the loop has.
    """
    action = law.command(view)
    sizes = {name: (action.memory.get(name), size) for name, size in law.memory}
    if law.commands_acceleration:
        sizes["acceleration"] = action.acceleration, view.frame.p
    else:
        sizes["torque"] = action.torque, view.system.m
    for name, (given, size) in sizes.items():
        numbers = 0 if given is None else ca.SX(given).numel()
        if numbers != size:
            raise ValueError(f"its command has {numbers} numbers as {name}, not {size}")
    if odd := sorted(action.memory.keys() - sizes.keys()):
        raise ValueError(f"its command has {', '.join(odd)}, not in Law.memory")
    return action if law.origin is None else _checked(view.clock, action)


def _checked(clock: Clock, action: ControlAction) -> ControlAction:
    """The command; none in a tick in which a number is not finite or is huge.

    After such a tick the reference point is NaN, so that the run stops; see `fault_in`.
    """
    along = action.along
    vectors = [action.acceleration, action.torque, action.error, action.theta_ref, action.far]
    vectors += [] if along is None else [along.command, along.direction]
    numbers = ca.vertcat(
        *[ca.vec(ca.SX(v)) for v in (*vectors, *action.memory.values()) if v is not None]
    )
    valid = ca.mmax(ca.if_else(ca.fabs(numbers) < LARGEST_NUMBER, 0, 1)) < 0.5

    def safe(vector: ca.SX) -> ca.SX:
        return ca.if_else(valid, vector, 0)

    by_clock = clock.theta + clock.dt * clock_rate(clock)
    theta_ref = by_clock if action.theta_ref is None else action.theta_ref
    return replace(
        action,
        acceleration=None if action.acceleration is None else safe(action.acceleration),
        torque=None if action.torque is None else safe(action.torque),
        error=None if action.error is None else safe(action.error),
        far=safe(action.far),
        theta_ref=ca.if_else(valid, theta_ref, ca.SX(float("nan"))),
        along=None if along is None else Along(safe(along.command), safe(along.direction)),
        memory={name: safe(value) for name, value in action.memory.items()},
    )
