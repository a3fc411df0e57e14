"""The closed loop as one function: one tick of one robot under one control law.

A tick measures, predicts a little ahead, projects onto the path, evaluates the control law, limits
the torque, adds external forces, integrates the plant and writes a log row. State, settings and
curve are inputs of the function, so that no user action rebuilds it.

A tick lasts dt = 1 ms (0.5 ms at 2 kHz). The control law is evaluated in every `hold_ticks`-th
tick, and its torque is held in between.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import casadi as ca

from onpath.models.closed_loop.delay import driven
from onpath.models.closed_loop.law_view import (
    beam_estimate,
    clock_at,
    commanded,
    interval,
    law_view,
    measured_output,
    predicted,
)
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import (
    LoopLayouts,
    kept_layout,
    log_layout,
    loop_layouts,
    settings_layout,
)
from onpath.models.closed_loop.observer import carried_on
from onpath.models.closed_loop.plant_tick import held_torque, move
from onpath.models.closed_loop.reference_speed import next_speed, wanted_speed
from onpath.models.closed_loop.sensing import logged, look_ahead, measure, remembered
from onpath.models.control import composite_control as composite
from onpath.models.control.laws.law import Along, ControlAction, Law, View
from onpath.models.control.laws.law_error import law_error
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.references import clock_rate
from onpath.models.control.laws.registry import law_named
from onpath.models.control.linearization import admissible_along, linearization
from onpath.models.errors import CodedError
from onpath.models.layout import Fields
from onpath.models.paths.frames import Frame
from onpath.models.paths.projection import basis, spline_basis, window, windowed
from onpath.models.systems import forces
from onpath.models.systems.system import MechanicalSystem

INTEGRAL_REACH = 0.01  # largest ρ, [m]
STRAIGHT = 1e-9  # turn per radian of θ, below which a path does not bend
DEFAULT_GRIP = forces.Grip()


@dataclass(frozen=True, slots=True)
class Kernel(LoopLayouts):
    """One tick of a closed loop, and the layouts of its flat vectors.

    Attributes:
        basis: (state, settings) -> basis functions of the curve at the parameters that the tick
            needs, (TERMS, 1 or 2); of a spline (WINDOW, ORDERS or 2 ORDERS), and the numbers of the
            pieces, (1, 1 or 2).
        advance: (state, settings, values) -> (next state, log row, basis for the next tick). Both
            take the part of the state that the loop changes; see `values`.
    """

    basis: ca.Function
    advance: ca.Function

    @property
    def layouts(self) -> LoopLayouts:
        """The layouts alone, without the functions, which take 0.2 MB."""
        return LoopLayouts(
            state=self.state,
            settings=self.settings,
            log=self.log,
            changed=self.changed,
            table_shape=self.table_shape,
            law=self.law,
            spline=self.spline,
        )

    def block(self, ticks: int) -> ca.Function:
        """Many ticks, for an interpreter: (state, settings, curve table) -> (state, log columns).

        The curve enters by one dense matrix product per tick, outside the scalar graphs, because
        CasADi's virtual machine runs that product as compiled code.
        """
        state = ca.MX.sym("state", self.state.size)
        settings = ca.MX.sym("settings", self.settings.size)
        table = ca.MX.sym("curve", *self.table_shape)
        after, rest = state[: self.changed], state[self.changed :]
        found, rows = self.basis.call([after, settings]), list[ca.MX]()
        for _ in range(ticks):
            after, row, *found = self.advance.call([after, settings, self.values(table, found)])
            rows.append(row)
        results = [ca.vertcat(after, rest), ca.horzcat(*rows)]
        return ca.Function("block", [state, settings, table], results)

    def values(self, table: ca.MX, found: list[ca.MX]) -> ca.MX:
        """σ, σ', σ'' and σ''' at the parameters of the tick, one column each.

        Args:
            table: `Curve.table` as a matrix.
            found: results of `basis`.
        """
        if not self.spline:
            return table @ found[0]
        basis, pieces = found
        windows = [window(table, piece) for piece in ca.horzsplit(pieces)]
        return windowed(windows, basis)

    def at(self) -> ca.Function:
        """(state, settings, curve table) -> `values`."""
        state, settings = (ca.MX.sym("given", *self.basis.size_in(i)) for i in (0, 1))
        table = ca.MX.sym("curve", *self.table_shape)
        found = self.values(table, self.basis.call([state, settings]))
        return ca.Function("values", [state, settings, table], [found])

    def tick(self) -> ca.Function:
        """One tick, for a compiler: (state, settings, values) -> (state, log row).

        The state consists of the fields that this loop changes.
        """
        inputs = [ca.SX.sym(f"input{i}", *self.advance.size_in(i)) for i in range(3)]
        after, row, *_ = self.advance.call(inputs)
        return ca.Function("onpath_tick", inputs, [after, row])


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
        ValueError: an unknown law, one that does not suit the robot, or one whose code has an
            error here, of which the message gives file and line; or a space curve for a robot that
            takes none.
    """
    law = law_named(kind.law)
    if not law.suits(system) or (kind.output == "composite" and not law.commands_acceleration):
        raise CodedError("error.law_does_not_suit", law=law.label)
    if kind.space:
        frame = _space(system, frame, kind)
    try:
        return _kernel(system, frame, kind, law, (substeps, grip))
    except CodedError:
        raise
    except (Exception, SystemExit) as error:  # only a law's code is not tested with every robot
        typed = CodedError("error.law_cannot_run") if is_text(law.name) else None
        raise typed or law_error(law.name, error, law.command) from error


def _kernel(
    system: MechanicalSystem, frame: Frame, kind: Kind, law: Law, plant: tuple[int, forces.Grip]
) -> Kernel:
    bases = _bases(system, kind, law)
    advance = _advance(system, frame, kind, law, plant, bases)
    layouts = loop_layouts(system, kind)
    return Kernel(
        state=layouts.state,
        settings=layouts.settings,
        log=layouts.log,
        changed=layouts.changed,
        table_shape=layouts.table_shape,
        basis=bases,
        advance=advance,
        law=layouts.law,
        spline=layouts.spline,
    )


def _space(system: MechanicalSystem, frame: Frame, kind: Kind) -> Frame:
    """The frame of space curves."""
    if frame.space is None or kind.level_set or kind.output == "composite":
        raise ValueError(f"{system.name}: a space curve cannot be followed here")
    return frame.space


def _bases(system: MechanicalSystem, kind: Kind, law: Law) -> ca.Function:
    """`Kernel.basis`, at the predicted closest point and at the law's reference."""
    state_symbol, state = kept_layout(system, kind, law.memory).symbols("state")
    settings_symbol, settings = settings_layout(system, kind).symbols("settings")
    places = [predicted(state, settings)]
    if law.reference is not None:
        places.append(law.reference(clock_at(kind, law, state, settings, settings["look_ahead"])))
    results: list[ca.SX]
    if kind.spline:
        found = [spline_basis(theta, kind.closed, settings["pieces"]) for theta in places]
        results = [ca.horzcat(*each) for each in zip(*found, strict=True)]
    else:
        results = [ca.horzcat(*(basis(theta, kind.closed) for theta in places))]
    outputs = ca.cse([ca.densify(each) for each in results])
    return ca.Function("bases", [state_symbol, settings_symbol], outputs)


def _advance(
    system: MechanicalSystem,
    frame: Frame,
    kind: Kind,
    law: Law,
    plant: tuple[int, forces.Grip],
    bases: ca.Function,
) -> ca.Function:
    """All scalar operations of a tick: see `Kernel.advance`.

    Args:
        plant: number of Runge-Kutta steps, and the springs of hand and brake.
        bases: from `_bases`.
    """
    state_symbol, state = kept_layout(system, kind, law.memory).symbols("state")
    settings_symbol, settings = settings_layout(system, kind).symbols("settings")
    plane = frame.at(settings["plane"])
    values = ca.SX.sym("values", kind.value_rows, 1 if law.reference is None else 2)
    measured_q, measured_v, reading = measure(system, kind, state, settings)
    measured, h = (measured_q, measured_v), settings["look_ahead"]
    q, v = look_ahead(system, state, settings, measured_q, measured_v, h)
    beam = beam_estimate(system, state, settings, q, v, h) if kind.output == "composite" else None
    view = law_view(system, plane, kind, law, state, settings, values, (q, v), beam)
    command = commanded(law, view)
    wanted, memory = wanted_torque(kind, state, settings, view, command, beam)
    fresh, acts, saturated = held_torque(system, kind, state, settings, wanted)
    drive = driven(kind, state, settings, fresh, acts)
    tip, force, moved = move(system, kind, state, settings, drive.parts, plant)
    summed = _integral(kind, law, state, settings, acts, saturated, command)
    estimate = {"estimate": moved["q"], "estimate_rate": moved["v"]}
    if kind.observer:
        estimate = carried_on(system, kind, settings, measured, drive.parts, plant)
    after = {
        **moved,
        **estimate,
        **_next_places(kind, law, state, settings, view, command),
        "integral": bounded(summed, settings, view, command),
        **remembered(kind, state, acts, reading, measured_v[: system.joints]),
        **memory,
        **{n: ca.if_else(acts, command.memory[n], state[n]) for n, _ in law.memory},
        **drive.memory,
        "phase": ca.SX(0) if kind.free else _next_phase(state, settings),
    }
    output = measured_output(system, plane, kind, state, settings, values[:, 0], measured)
    row = {**state, "speed_ref": wanted_speed(state, settings)[0], "y": tip}
    row |= {"u": drive.mean, "force": force} | logged(output)
    row |= {"far": command.far, "integral_used": integral_used(state, settings, view, command)}
    later = kept_layout(system, kind, law.memory).join(after)
    outputs = [later, log_layout(system).join(row), *bases.call([later, settings_symbol])]
    return ca.Function("advance", [state_symbol, settings_symbol, values], ca.cse(outputs))


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
