"""The closed loop as one function: one tick of one robot under one control law.

A tick measures, predicts half a tick ahead, projects onto the path, evaluates the control law,
limits the torque, adds external forces, integrates the plant and writes a log row. State, settings
and curve are inputs of the function, so that no user action requires it to be rebuilt.

A tick lasts dt = 1 ms (0.5 ms at 2 kHz). The control law is evaluated in every `hold_ticks`-th
tick, and its torque is held in between.
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
    """One tick of a closed loop, and the layouts of its flat vectors.

    Attributes:
        basis: (state, settings) -> basis functions of the curve at the parameters that the tick
            needs, (TERMS, 1 or 2).
        advance: (state, settings, table @ basis) -> (next state, log row, basis for the next tick).
        state, settings, log: layouts of the vectors.
    """

    basis: ca.Function
    advance: ca.Function
    state: Layout
    settings: Layout
    log: Layout

    def block(self, ticks: int) -> ca.Function:
        """Many ticks, for an interpreter: (state, settings, curve table) -> (state, log columns).

        The curve enters by one dense matrix product per tick, outside the scalar graphs, because
        CasADi's virtual machine runs that product as compiled code.
        """
        state = ca.MX.sym("state", self.state.size)
        settings = ca.MX.sym("settings", self.settings.size)
        table = ca.MX.sym("curve", *TABLE_SHAPE)
        after, basis, rows = state, self.basis(state, settings), list[ca.MX]()
        for _ in range(ticks):
            after, row, basis = self.advance(after, settings, table @ basis)
            rows.append(row)
        return ca.Function("block", [state, settings, table], [after, ca.horzcat(*rows)])

    def tick(self) -> ca.Function:
        """One tick, for a compiler, as one scalar graph.

        (state, settings, curve table) -> (state, log row)
        """
        state = ca.SX.sym("state", self.state.size)
        settings = ca.SX.sym("settings", self.settings.size)
        table = ca.SX.sym("curve", *TABLE_SHAPE)
        after, row, _ = self.advance(state, settings, table @ self.basis(state, settings))
        return ca.Function("onpath_tick", [state, settings, table], [after, row])


def build_kernel(
    system: MechanicalSystem,
    frame: Frame,
    kind: Kind,
    substeps: int = 1,
    grip: forces.Grip = DEFAULT_GRIP,
) -> Kernel:
    """Build the tick function.

    Args:
        system: the robot's equations of motion.
        frame: how the plane of the path lies in the output space.
        kind: control law, kind of curve and sensing.
        substeps: Runge-Kutta steps per tick. The stability limit of the classical method requires
            ω_max dt / substeps < 2.8 for the fastest mode.
        grip: springs of the hand and the brake.

    Raises:
        ValueError: an unknown controller.
    """
    if kind.controller not in controllers.NAMES:
        raise ValueError(f"controller {kind.controller!r}: expected one of {controllers.NAMES}")
    layouts = state_layout(system), settings_layout(system), log_layout(system)
    bases = _bases(system, kind)
    return Kernel(bases, _advance(system, frame, kind, (substeps, grip), bases), *layouts)


def _tracks(kind: Kind) -> bool:
    return kind.controller == "trajectory_tracking"


def _predicted(state: Fields, settings: Fields) -> ca.SX:
    """The θ at which the curve is evaluated, θ_0 = θ + dt θ', [rad]."""
    return state["theta"] + settings["dt"] * state["theta_rate"]


def _bases(system: MechanicalSystem, kind: Kind) -> ca.Function:
    """(state, settings) -> basis at the predicted closest point and, if tracking, at θ_r."""
    state_symbol, state = state_layout(system).symbols("state")
    settings_symbol, settings = settings_layout(system).symbols("settings")
    columns = basis(_predicted(state, settings), kind.closed)
    if _tracks(kind):
        reference, _ = _reference(kind, state, settings)
        columns = ca.horzcat(columns, basis(reference, kind.closed))
    return ca.Function("bases", [state_symbol, settings_symbol], [ca.densify(columns)])


def _advance(
    system: MechanicalSystem,
    frame: Frame,
    kind: Kind,
    plant: tuple[int, forces.Grip],
    bases: ca.Function,
) -> ca.Function:
    """All scalar operations of a tick: see `Kernel.advance`.

    Args:
        plant: number of Runge-Kutta steps, and the springs of hand and brake.
        bases: from `_bases`.
    """
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
    tip, force, tau = push(system, kind, state, settings, u, plant[1])

    after = {
        **integrate(system, state, settings, tau, plant[0]),
        "theta": output.theta,
        "theta_rate": output.theta_rate,
        "theta_ref": state["theta_ref"] + settings["dt"] * _reference(kind, state, settings)[1],
        "integral": _integral(kind, state, settings, acts, saturated, error),
        **remembered(kind, state, acts, reading, measured_v[: system.m]),
        **memory,
        "u": u,
        "phase": ca.SX(0) if kind.free else _next_phase(state, settings),
    }
    measured = output
    if beam is None:  # the logged speed is that of the measured velocities
        y_pair = _controlled(system, settings, q, measured_v)
        measured = _coordinates(frame, kind, state, settings, values[:, 0], *y_pair)
    row = state | {"y": tip, "u": u, "force": force} | logged(output, measured.theta_rate, settings)
    later = state_layout(system).join(after)
    outputs = [later, log_layout(system).join(row), bases(later, settings_symbol)]
    return ca.Function("advance", [state_symbol, settings_symbol, values], ca.cse(outputs))


def _controlled(
    system: MechanicalSystem, settings: Fields, q: ca.SX, v: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """The controlled output and its rate, by the controller's model, each (p, 1), [m], [m/s]."""
    return system.with_rate(system.controlled_output)(q, v, settings["model"])


def _beam(
    system: MechanicalSystem, state: Fields, settings: Fields, q: ca.SX, v: ca.SX
) -> composite.Compensation:
    """Composite control's estimate of the flexible link, half a tick ahead."""
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
    """Torque for the commanded y'', (m, 1), and the memory of composite control after this tick."""
    memory = {name: state[name] for name, _ in composite.MEMORY.fields if name in state}
    if beam is None:
        return controllers.linearization(system, q, v, settings["model"], command), memory
    rate = composite.rates(beam, settings["speed"], command)
    after = {name: x + settings["dt"] * rate[name] for name, x in memory.items()}
    return composite.torques(beam, rate, command), after


def _next_phase(state: Fields, settings: Fields) -> ca.SX:
    """Ticks since the last evaluation of the control law, modulo `hold_ticks`."""
    phase = state["phase"] + 1
    return phase * (phase < settings["hold_ticks"] - 0.5)


def _integral(
    kind: Kind, state: Fields, settings: Fields, acts: ca.SX, saturated: ca.SX, error: ca.SX
) -> ca.SX:
    """The next value of the integral that K3 multiplies; 0 if K3 = 0.

        I⁺ = I + hold_ticks dt e  in ticks in which the control law is evaluated.

    It is frozen while a torque saturates (anti-windup) and while the brake is on.
    """
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
    """The virtual output at y, from the curve's `values` at the predicted θ."""
    names = ("level_centre", "level_weights", "level_constant")
    level = LevelSet(*[settings[name] for name in names]) if kind.level_set else None
    start = LocalCurve.from_values(_predicted(state, settings), kind.closed, values)
    return virtual_output(start.project(frame.split(y)[0]), frame, level, y, y_rate)


def _reference(kind: Kind, state: Fields, settings: Fields) -> tuple[ca.SX, ca.SX]:
    """The reference θ_r of trajectory tracking half a tick ahead [rad], and its rate [rad/s]."""
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
    """Commanded y'' and the error that is integrated (λ or e), both (p, 1)."""
    gains = Gains(*[settings[name] for name in GAINS])
    k5, speed = settings["K5"], settings["speed"]
    speed = speed if beam is None else composite.wanted_speed(beam, output, k5)
    task = PathReference(settings["position"], settings["target"], speed)
    integral = state["integral"]
    if kind.controller == "path_following":
        across = integral[: frame.p - 1]
        command = controllers.path_following(output, kind.closed, gains, task, across)
        return command, ca.vertcat(output.xi, 0)
    if kind.controller != "trajectory_tracking":
        raise NotImplementedError(f"no command for the law {kind.controller!r}")
    theta_ref, rate = _reference(kind, state, settings)
    reference = LocalCurve.from_values(theta_ref, kind.closed, values[:, 1])
    error, error_rate, feedforward = controllers.tracking_error(reference, frame, *measured, rate)
    command = controllers.trajectory_tracking(error, error_rate, feedforward, gains, integral)
    return command, error
