"""The controller's part of a tick: from what is measured to the torque, and what it keeps.

The lab's tick (kernel.py) puts a plant behind it; a controller that is exported has only this.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import casadi as ca

from onpath.models.closed_loop.delay import DelayedTorque, driven
from onpath.models.closed_loop.law_view import (
    beam_estimate,
    clock_at,
    commanded,
    interval,
    law_view,
)
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.plant_tick import held_torque
from onpath.models.closed_loop.reference_speed import next_speed, wanted_speed
from onpath.models.closed_loop.sensing import look_ahead, remembered
from onpath.models.control import composite_control as composite
from onpath.models.control.laws.law import Along, ControlAction, Law, View
from onpath.models.control.laws.references import clock_rate
from onpath.models.control.linearization import admissible_along, linearization
from onpath.models.layout import Fields
from onpath.models.paths.frames import PlaneCoordinates
from onpath.models.systems.system import MechanicalSystem

INTEGRAL_REACH = 0.01  # largest ρ, [m]
STRAIGHT = 1e-9  # turn per radian of θ, below which a path does not bend


@dataclass(frozen=True, slots=True)
class Decision:
    """What the controller decides in a tick.

    Attributes:
        view: what the law is given.
        command: of the law.
        torque: computed in this tick, or held, (m, 1), [N m].
        drive: the motors' torques, which follow it after the computing delay.
        after: all of the next state but q and v of the plant and the observer's estimate.
    """

    view: View
    command: ControlAction
    torque: ca.SX
    drive: DelayedTorque
    after: Fields


def decide(
    system: MechanicalSystem,
    plane: PlaneCoordinates,
    kind: Kind,
    law: Law,
    state: Fields,
    settings: Fields,
    values: ca.SX,
    measured: tuple[ca.SX, ca.SX],
    reading: ca.SX,
) -> Decision:
    """Look ahead, project, evaluate the law and limit its torque.

    Args:
        state: its q and v are not used.
        values: σ, σ', σ'' and σ''' at the parameters of the tick, a column each.
        measured: q and v, each (n, 1).
        reading: of the encoders, (joints, 1), [rad].
    """
    h = settings["look_ahead"]
    q, v = look_ahead(system, state, settings, *measured, h)
    beam = beam_estimate(system, state, settings, q, v, h) if kind.output == "composite" else None
    view = law_view(system, plane, kind, law, state, settings, values, measured, (q, v), beam)
    command = commanded(law, view)
    wanted, memory = wanted_torque(kind, state, settings, view, command, beam)
    torque, acts, saturated = held_torque(system, kind, state, settings, wanted)
    drive = driven(kind, state, settings, torque, acts)
    summed = _integral(kind, law, state, settings, acts, saturated, command)
    after = {
        **_next_places(kind, law, state, settings, view, command),
        "integral": bounded(summed, settings, view, command),
        **remembered(kind, state, acts, reading, measured[1][: system.joints]),
        **memory,
        **{n: ca.if_else(acts, command.memory[n], state[n]) for n, _ in law.memory},
        **drive.memory,
        "phase": ca.SX(0) if kind.free else _next_phase(state, settings),
    }
    return Decision(view=view, command=command, torque=torque, drive=drive, after=after)


def wanted_torque(
    kind: Kind,
    state: Fields,
    settings: Fields,
    view: View,
    command: ControlAction,
    beam: composite.Compensation | None,
) -> tuple[ca.SX, Fields]:
    """Torque for the command, (m, 1), and the memory of composite control after this tick."""
    memory = {name: state[name] for name, _ in composite.MEMORY.fields if name in state}
    if command.torque is not None:
        return command.torque, memory
    assert command.acceleration is not None
    if beam is not None:
        speed = wanted_speed(state, settings)[0]
        rate = composite.rates(beam, speed, command.acceleration)
        after = {name: x + settings["dt"] * rate[name] for name, x in memory.items()}
        return composite.torques(beam, rate, command.acceleration), after
    acceleration = command.acceleration
    torque = partial(linearization, view.system, view.q, view.v, view.model)
    if kind.across_first:
        part = command.along or _along(view, acceleration)
        along, direction = part.command, part.direction
        base = torque(acceleration - direction * along)
        slope = torque(acceleration - direction * (along - 1)) - base
        limits = view.system.torque_limits(settings["torque_limit"])
        reduced = admissible_along(base, slope, along, limits)
        acceleration = acceleration + direction * (reduced - along)
    return torque(acceleration), memory


def _along(view: View, acceleration: ca.SX) -> Along:
    """The part of y'' along the path where the robot is, for a law that does not name it."""
    direction = view.output.acceleration_per_along
    return Along(ca.dot(direction, acceleration) / ca.dot(direction, direction), direction)


def _next_phase(state: Fields, settings: Fields) -> ca.SX:
    """Ticks since the last evaluation of the control law, modulo `hold_ticks`."""
    phase = state["phase"] + 1
    return phase * (phase < settings["hold_ticks"] - 0.5)


def _integral(
    kind: Kind,
    law: Law,
    state: Fields,
    settings: Fields,
    acts: ca.SX,
    saturated: ca.SX,
    command: ControlAction,
) -> ca.SX:
    """The next value of the integral; 0 while it is switched off.

        I⁺ = I + hold_ticks dt e  in ticks in which the control law is evaluated.

    It pauses only while a torque saturates (anti-windup). K3 = 0 switches it off, unless the law
    always integrates; a law whose reference point runs by the clock also needs `tracker_integral`.

    Source: eq. (18).
    """
    if command.error is None:
        return ca.SX.zeros(*state["integral"].shape)
    weight, on = interval(kind, settings), settings["K3"] != 0
    if not kind.free:
        weight = acts * (1 - saturated) * weight
    if law.always_integrates:
        on = ca.SX(1)
    elif law.by_clock:
        on = on * settings["tracker_integral"]
    return on * (state["integral"] + weight * command.error)


def bounded(integral: ca.SX, settings: Fields, view: View, command: ControlAction) -> ca.SX:
    """The integral, shortened so that |K3 ∫e dt| <= K1 ρ: it moves the balance by ρ at most.

    Otherwise a robot that a hand holds off its path would learn to push with the hand's force,
    which would throw it to the other side when the hand lets go. ρ is 10 mm, or half the radius of
    curvature at the closest point if that is less; with more, the arm would stay inside of a bend.
    """
    size, most = _size_of_integral(integral, settings), _most_of_integral(settings, view, command)
    return integral * ca.if_else(size > most, most / size, 1)


def integral_used(state: Fields, settings: Fields, view: View, command: ControlAction) -> ca.SX:
    """The share of its bound that the integral takes, from 0 to 1; see `bounded`."""
    size = _size_of_integral(state["integral"], settings)
    most = _most_of_integral(settings, view, command)
    return ca.if_else(most > 0, ca.fmin(size / most, 1), 0)


def _size_of_integral(integral: ca.SX, settings: Fields) -> ca.SX:
    """|K3 ∫e dt|, (1, 1), in units of e per s²."""
    return settings["K3"] * ca.sqrt(ca.dot(integral, integral))


def _most_of_integral(settings: Fields, view: View, command: ControlAction) -> ca.SX:
    """K1 ρ, (1, 1), in units of e per s²."""
    closest = view.closest
    half = ca.norm_2(closest.first) / (2 * ca.fmax(closest.turning, STRAIGHT))
    return settings["K1"] * ca.fmin(INTEGRAL_REACH, half) * command.error_per_metre


def _next_places(
    kind: Kind, law: Law, state: Fields, settings: Fields, view: View, command: ControlAction
) -> Fields:
    """After the tick: the closest point, θ_r by the law or else by the clock, and ω_ref."""
    clock = clock_at(kind, law, state, settings, settings["dt"] / 2)
    by_clock = clock.theta + settings["dt"] * clock_rate(clock)
    return {
        "theta": view.output.theta,
        "theta_rate": view.output.theta_rate,
        "theta_ref": by_clock if command.theta_ref is None else command.theta_ref,
        "speed_ref": next_speed(state, settings),
    }
