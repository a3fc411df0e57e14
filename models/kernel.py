"""The closed loop as one function: one control tick of one robot under one controller.

A tick is: measure, look half a tick ahead, project, control, saturate, push, integrate, log.
State, settings and curve are inputs, so that nothing a user turns ever rebuilds the function. Time
passes in steps of dt (1 ms; 0.5 ms at 2 kHz); the controller acts at every `hold_ticks`-th tick
and its torque is held between.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from models import composite_control as composite
from models import controllers, forces
from models.controllers import Gains, Task
from models.curves import TABLE_SHAPE
from models.frames import Frame
from models.layout import Layout
from models.loop_vectors import GAINS, log_layout, settings_layout, state_layout
from models.projection import LocalCurve, basis
from models.system import MechanicalSystem
from models.virtual_output import LevelSet, VirtualOutput, virtual_output

Fields = dict[str, ca.SX]
DEFAULT_GRIP = forces.Grip()


@dataclass(frozen=True, slots=True)
class Kind:
    """What a loop is made of; all else is a run-time setting.

    Attributes:
        controller: one of `controllers.NAMES`.
        closed: whether its path is a closed curve.
        level_set: lambda is the paper's s(y) instead of the distance.
        encoder: the controller sees encoder steps and filtered velocities, not the truth.
        free: nothing pushes, no limit or dry friction bears on the torque, and the controller
            acts in every tick; what these need is left out, for speed alone.
        law: what is put on the path, the "redefined" output, or by "composite" control the tip
            of a flexible link; see composite_control.py.
    """

    controller: str
    closed: bool = True
    level_set: bool = False
    encoder: bool = False
    free: bool = False
    law: str = "redefined"


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
    measured_q, measured_v, reading = _measure(system, kind, state, settings)
    q, v = _ahead(system, state, settings, measured_q, measured_v)
    beam = _beam(system, state, settings, q, v) if kind.law == "composite" else None
    y, y_rate = _controlled(system, settings, q, v) if beam is None else (beam.y, beam.y_rate)
    output = _coordinates(frame, kind, state, settings, values[:, 0], y, y_rate)
    command, error = _command(frame, kind, state, settings, values, output, (y, y_rate), beam)
    wanted, memory = _wanted(system, state, settings, q, v, command, beam)
    u, acts, saturated = _torque(kind, state, settings, wanted)
    tip, force, effort = _push(system, kind, state, settings, u, world[1])

    after = {
        **_integrate(system, state, settings, effort, world[0]),
        "theta": output.theta,
        "theta_rate": output.theta_rate,
        "theta_ref": state["theta_ref"] + settings["dt"] * _reference(kind, state, settings)[1],
        "integral": _integral(kind, state, settings, acts, saturated, error),
        **_remembered(kind, state, acts, reading, measured_v[: system.m]),
        **memory,
        "u": u,
        "phase": ca.SX(0) if kind.free else _next_phase(state, settings),
    }
    seen = output
    if beam is None:  # the log's speed is from velocities as they are measured
        own = _controlled(system, settings, q, measured_v)
        seen = _coordinates(frame, kind, state, settings, values[:, 0], *own)
    row = state | {"y": tip, "u": u, "force": force} | _now(output, seen.theta_rate, settings)
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


def _measure(
    system: MechanicalSystem, kind: Kind, state: Fields, settings: Fields
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """q and v as the controller sees them, and the encoders' reading.

    Without encoders it sees the truth; with them joint angles come in steps and velocities from
    their filtered differences. Coordinates without a motor are seen exactly.
    """
    q, v, m = state["q"], state["v"], system.m
    if not kind.encoder:
        return q, v, q[:m]
    step, dt = settings["encoder_step"], settings["dt"] * settings["hold_ticks"]
    reading = step * ca.floor(q[:m] / step + 0.5)
    weight = dt / (settings["encoder_filter"] + dt)
    difference = (reading - state["encoder"]) / dt
    rate = state["encoder_rate"] + weight * (difference - state["encoder_rate"])
    return ca.vertcat(reading, q[m:]), ca.vertcat(rate, v[m:]), reading


def _ahead(
    system: MechanicalSystem, state: Fields, settings: Fields, q: ca.SX, v: ca.SX
) -> tuple[ca.SX, ca.SX]:
    """q and v half a tick later, by the controller's model under the torque held so far.

    A torque held over a tick acts, on average, half a tick late; meeting the robot there keeps
    the path invariant to O(dt^2) and not only O(dt).
    """
    inputs = [system.q, system.v, system.tau, system.parameters]
    slope = ca.Function("slope", inputs, [system.acceleration])
    effort = ca.vertcat(state["u"], ca.SX(system.n - system.m, 1))
    half = settings["dt"] / 2
    gained = half * slope(q, v, effort, settings["model"])
    return q + half * (v + gained / 2), v + gained


def _now(output: VirtualOutput, theta_rate: ca.SX, settings: Fields) -> Fields:
    """What the log says of theta and xi: half a tick back from where the controller looked.

    The speed along the path is the measured one: under a push that the controller cannot foresee,
    the one it looks ahead to would be wrong for as long as the push lasts.
    """
    half = settings["dt"] / 2
    return {
        "theta": output.theta - half * theta_rate,
        "theta_rate": theta_rate,
        "xi": output.xi - half * output.xi_rate,
        "xi_rate": output.xi_rate,
    }


def _remembered(kind: Kind, state: Fields, acts: ca.SX, reading: ca.SX, rate: ca.SX) -> Fields:
    """What the encoders remember: exact sensing needs no sampling."""
    if not kind.encoder:
        return {"encoder": reading, "encoder_rate": rate}
    return {
        "encoder": ca.if_else(acts, reading, state["encoder"]),
        "encoder_rate": ca.if_else(acts, rate, state["encoder_rate"]),
    }


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
    task = Task(settings["position"], settings["target"], speed)
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
    task = Task(settings["position"], settings["target"], speed)
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


def _torque(
    kind: Kind, state: Fields, settings: Fields, wanted: ca.SX
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Torque of this tick, whether the controller acts in it, whether it saturates."""
    limit = settings["torque_limit"]
    fresh = ca.fmin(ca.fmax(wanted, -limit), limit)
    if kind.free:
        return fresh, ca.SX(1), ca.SX(0)
    acts = state["phase"] < 0.5
    return ca.if_else(acts, fresh, state["u"]), acts, ca.mmax(ca.fabs(wanted)) > limit


def _push(
    system: MechanicalSystem,
    kind: Kind,
    state: Fields,
    settings: Fields,
    u: ca.SX,
    grip: forces.Grip,
) -> tuple[ca.SX, ca.SX, ca.SX]:
    """The actual end-point, the force on it, and all generalized forces, held over the tick."""
    y, y_rate = system.with_rate(system.output)(state["q"], state["v"], settings["plant"])
    unactuated = ca.SX(system.n - system.m, 1)
    if kind.free:
        return y, ca.SX.zeros(system.p, 1), ca.vertcat(u, unactuated)
    pull = forces.hand(y, y_rate, settings["hand_target"], settings["hand_active"], grip.hand)
    where = settings["hold_anchor"], settings["hold_tangent"]
    brake = forces.hold(y, y_rate, *where, settings["hold_active"], grip.hold)
    force = ca.SX.sym("force", system.p)
    transposed = ca.Function(
        "transposed",
        [system.q, system.parameters, force],
        [ca.jtimes(system.output, system.q, force, True)],
    )
    pushed = transposed(state["q"], settings["plant"], pull + brake)
    motors = u + forces.dry_friction(state["v"][: system.m], settings["coulomb"])
    return y, pull + brake, pushed + ca.vertcat(motors, unactuated)


def _integrate(
    system: MechanicalSystem, state: Fields, settings: Fields, tau: ca.SX, substeps: int
) -> Fields:
    """Classical Runge-Kutta of the plant over one tick with generalized forces tau held."""
    slope = ca.Function(
        "slope",
        [system.q, system.v, system.tau, system.parameters],
        [system.acceleration],
    )
    q, v, h = state["q"], state["v"], settings["dt"] / substeps
    half, sixth, plant = h / 2, h / 6, settings["plant"]
    for _ in range(substeps):
        drift = half * v
        middle = q + drift
        ahead = middle + drift
        a1 = slope(q, v, tau, plant)
        a2 = slope(middle, v + half * a1, tau, plant)
        a3 = slope(middle + half**2 * a1, v + half * a2, tau, plant)
        a4 = slope(ahead + half * h * a2, v + h * a3, tau, plant)
        early, late = a1 + (a2 + a3), (a2 + a3) + a4
        q, v = ahead + h * sixth * early, v + sixth * (early + late)
    return {"q": q, "v": v}
