"""The closed loop as one function: one control tick of one robot under one controller.

A tick is: measure, look half a tick ahead, project, control, saturate, push, integrate, log.
State, settings and curve are inputs, so that nothing a user turns ever rebuilds the function. Time
passes in steps of dt (1 ms; 0.5 ms at 2 kHz); the controller acts at every `hold_ticks`-th tick
and its torque is held between.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import GAINS, log_layout, settings_layout, state_layout
from onpath.models.closed_loop.plant_tick import held_torque, integrate, push
from onpath.models.closed_loop.sensing import logged, look_ahead, measure, remembered
from onpath.models.control import composite_control as composite
from onpath.models.control import laws as controllers
from onpath.models.control.laws import Gains, PathReference
from onpath.models.control.virtual_output import LevelSet, VirtualOutput, virtual_output
from onpath.models.layout import Fields, Layout
from onpath.models.paths.curves import TABLE_SHAPE
from onpath.models.paths.frames import Frame
from onpath.models.paths.projection import LocalCurve, basis
from onpath.models.systems import forces
from onpath.models.systems.system import MechanicalSystem

DEFAULT_GRIP = forces.Grip()


@dataclass(frozen=True, slots=True)
class Kernel:
    """One tick of one closed loop, and what its flat vectors hold.

    Attributes:
        basis: (state, settings) -> basis functions of the curve where the tick needs them.
        turn: (state, settings, table @ basis) -> (state, log row, basis of the next tick).
    """

    basis: ca.Function
    turn: ca.Function
    state: Layout
    settings: Layout
    log: Layout

    def block(self, ticks: int) -> ca.Function:
        """(state, settings, curve table) -> (state, log rows as columns).

        The curve enters by one dense product a tick, outside the scalar graphs: an interpreter
        runs that at compiled speed.
        """
        state = ca.MX.sym("state", self.state.size)
        settings = ca.MX.sym("settings", self.settings.size)
        table = ca.MX.sym("curve", *TABLE_SHAPE)
        after, basis, rows = state, self.basis(state, settings), list[ca.MX]()
        for _ in range(ticks):
            after, row, basis = self.turn(after, settings, table @ basis)
            rows.append(row)
        return ca.Function("block", [state, settings, table], [after, ca.horzcat(*rows)])

    def tick(self) -> ca.Function:
        """(state, settings, curve table) -> (state, log row), one scalar graph for a compiler."""
        state = ca.SX.sym("state", self.state.size)
        settings = ca.SX.sym("settings", self.settings.size)
        table = ca.SX.sym("curve", *TABLE_SHAPE)
        after, row, _ = self.turn(state, settings, table @ self.basis(state, settings))
        return ca.Function("onpath_tick", [state, settings, table], [after, row])


def build_kernel(
    system: MechanicalSystem,
    frame: Frame,
    kind: Kind,
    substeps: int = 1,
    grip: forces.Grip = DEFAULT_GRIP,
) -> Kernel:
    """Assemble the tick.

    Args:
        substeps: Runge-Kutta steps per tick; the fastest mode times dt / substeps must stay
            below 2.8.
        grip: how a hand and a brake take hold of the end-point.

    Raises:
        ValueError: an unknown controller.
    """
    if kind.controller not in controllers.NAMES:
        raise ValueError(f"controller {kind.controller!r}: expected one of {controllers.NAMES}")
    layouts = state_layout(system), settings_layout(system), log_layout(system)
    bases = _bases(system, kind)
    return Kernel(bases, _turn(system, frame, kind, (substeps, grip), bases), *layouts)


def _tracks(kind: Kind) -> bool:
    return kind.controller == "trajectory_tracking"


def _predicted(state: Fields, settings: Fields) -> ca.SX:
    return state["theta"] + settings["dt"] * state["theta_rate"]


def _bases(system: MechanicalSystem, kind: Kind) -> ca.Function:
    """(state, settings) -> basis at the predicted closest point and, tracking, the reference."""
    state_symbol, state = state_layout(system).symbols("state")
    settings_symbol, settings = settings_layout(system).symbols("settings")
    columns = basis(_predicted(state, settings), kind.closed)
    if _tracks(kind):
        reference, _ = _reference(kind, state, settings)
        columns = ca.horzcat(columns, basis(reference, kind.closed))
    return ca.Function("bases", [state_symbol, settings_symbol], [ca.densify(columns)])


def _turn(
    system: MechanicalSystem,
    frame: Frame,
    kind: Kind,
    world: tuple[int, forces.Grip],
    bases: ca.Function,
) -> ca.Function:
    """All scalar operations of a tick; see `Kernel.turn`. `world`: substeps and grip."""
    state_symbol, state = state_layout(system).symbols("state")
    settings_symbol, settings = settings_layout(system).symbols("settings")
    values = ca.SX.sym("values", TABLE_SHAPE[0], 2 if _tracks(kind) else 1)
    measured_q, measured_v, reading = measure(system, kind, state, settings)
    q, v = look_ahead(system, state, settings, measured_q, measured_v)
    beam = _beam(system, state, settings, q, v) if kind.law == "composite" else None
    y, y_rate = _controlled(system, settings, q, v) if beam is None else (beam.y, beam.y_rate)
    output = _coordinates(frame, kind, state, settings, values[:, 0], y, y_rate)
    command, error = _command(frame, kind, state, settings, values, output, (y, y_rate), beam)
    wanted, memory = _wanted(system, state, settings, q, v, command, beam)
    u, acts, saturated = held_torque(kind, state, settings, wanted)
    tip, force, effort = push(system, kind, state, settings, u, world[1])

    after = {
        **integrate(system, state, settings, effort, world[0]),
        "theta": output.theta,
        "theta_rate": output.theta_rate,
        "theta_ref": state["theta_ref"] + settings["dt"] * _reference(kind, state, settings)[1],
        "integral": _integral(kind, state, settings, acts, saturated, error),
        **remembered(kind, state, acts, reading, measured_v[: system.m]),
        **memory,
        "u": u,
        "phase": ca.SX(0) if kind.free else _next_phase(state, settings),
    }
    seen = output
    if beam is None:  # the log's speed is from velocities as they are measured
        own = _controlled(system, settings, q, measured_v)
        seen = _coordinates(frame, kind, state, settings, values[:, 0], *own)
    row = state | {"y": tip, "u": u, "force": force} | logged(output, seen.theta_rate, settings)
    later = state_layout(system).join(after)
    outputs = [later, log_layout(system).join(row), bases(later, settings_symbol)]
    return ca.Function("turn", [state_symbol, settings_symbol, values], ca.cse(outputs))


def _controlled(
    system: MechanicalSystem, settings: Fields, q: ca.SX, v: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """The controlled output and its rate, as the controller believes them."""
    return system.with_rate(system.controlled_output)(q, v, settings["model"])


def _beam(
    system: MechanicalSystem, state: Fields, settings: Fields, q: ca.SX, v: ca.SX
) -> composite.Compensation:
    """What composite control makes of the flexible link, half a tick ahead."""
    memory = {name: state[name] for name, _ in composite.MEMORY.fields}
    gains = composite.CompositeGains(*[settings[name] for name in composite.GAINS])
    later = composite.ahead(memory, settings["dt"] / 2)
    return composite.compensation(system, q, v, settings["model"], later, gains)


def _wanted(
    system: MechanicalSystem,
    state: Fields,
    settings: Fields,
    q: ca.SX,
    v: ca.SX,
    command: ca.SX,
    beam: composite.Compensation | None,
) -> tuple[ca.SX, Fields]:
    """Torque for the commanded y'', and the memory of composite control a tick later."""
    memory = {name: state[name] for name, _ in composite.MEMORY.fields if name in state}
    if beam is None:
        return controllers.linearization(system, q, v, settings["model"], command), memory
    rate = composite.rates(beam, settings["speed"], command)
    after = {name: x + settings["dt"] * rate[name] for name, x in memory.items()}
    return composite.torques(beam, rate, command), after


def _next_phase(state: Fields, settings: Fields) -> ca.SX:
    phase = state["phase"] + 1
    return phase * (phase < settings["hold_ticks"] - 0.5)


def _integral(
    kind: Kind, state: Fields, settings: Fields, acts: ca.SX, saturated: ca.SX, error: ca.SX
) -> ca.SX:
    """What K3 multiplies; empty without K3, and still while its error cannot be acted on."""
    interval = settings["dt"]
    if not kind.free:
        counts = acts * (1 - saturated) * (1 - settings["hold_active"])
        interval = counts * interval * settings["hold_ticks"]
    return (settings["K3"] != 0) * (state["integral"] + interval * error)


def _coordinates(
    frame: Frame,
    kind: Kind,
    state: Fields,
    settings: Fields,
    values: ca.SX,
    y: ca.SX,
    y_rate: ca.SX,
) -> VirtualOutput:
    names = ("level_centre", "level_weights", "level_constant")
    level = LevelSet(*[settings[name] for name in names]) if kind.level_set else None
    start = LocalCurve.from_values(_predicted(state, settings), kind.closed, values)
    return virtual_output(start.project(frame.split(y)[0]), frame, level, y, y_rate)


def _reference(kind: Kind, state: Fields, settings: Fields) -> tuple[ca.SX, ca.SX]:
    """The tracker's reference point half a tick ahead, and its speed."""
    speed = state["speed_chain"][0] if kind.law == "composite" else settings["speed"]
    task = PathReference(settings["position"], settings["target"], speed)
    theta_ref, dt = state["theta_ref"], settings["dt"]
    rate = controllers.reference_rate(theta_ref, kind.closed, task, dt)
    return theta_ref + dt / 2 * rate, rate


def _command(
    frame: Frame,
    kind: Kind,
    state: Fields,
    settings: Fields,
    values: ca.SX,
    output: VirtualOutput,
    measured: tuple[ca.SX, ca.SX],
    beam: composite.Compensation | None,
) -> tuple[ca.SX, ca.SX]:
    """Commanded y'' and the error to integrate, both (p, 1)."""
    gains = Gains(*[settings[name] for name in GAINS])
    k5, speed = settings["K5"], settings["speed"]
    speed = speed if beam is None else composite.wanted_speed(beam, output, k5)
    task = PathReference(settings["position"], settings["target"], speed)
    integral = state["integral"]
    if not _tracks(kind):
        across = integral[: frame.p - 1]
        command = controllers.path_following(output, kind.closed, gains, task, across)
        return command, ca.vertcat(output.xi, 0)
    theta_ref, rate = _reference(kind, state, settings)
    reference = LocalCurve.from_values(theta_ref, kind.closed, values[:, 1])
    error, error_rate, feedforward = controllers.tracking_error(reference, frame, *measured, rate)
    command = controllers.trajectory_tracking(error, error_rate, feedforward, gains, integral)
    return command, error
