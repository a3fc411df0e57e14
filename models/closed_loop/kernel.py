"""The closed loop as one function: one tick of one robot under one control law.

A tick measures, predicts a little ahead, projects onto the path, evaluates the control law, limits
the torque, adds external forces, integrates the plant and writes a log row. State, settings and
curve are inputs of the function, so that no user action rebuilds it.

A tick lasts dt = 1 ms (0.5 ms at 2 kHz). The control law is evaluated in every `hold_ticks`-th
tick, and its torque is held in between.
"""

from __future__ import annotations

from dataclasses import dataclass

import casadi as ca

from onpath.models.closed_loop.controller_tick import decide, integral_used
from onpath.models.closed_loop.law_view import (
    clock_at,
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
from onpath.models.closed_loop.plant_tick import move
from onpath.models.closed_loop.reference_speed import wanted_speed
from onpath.models.closed_loop.sensing import logged, measure
from onpath.models.control.laws.law import Law
from onpath.models.control.laws.law_error import law_error
from onpath.models.control.laws.own import is_text
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import CodedError
from onpath.models.paths.frames import Frame
from onpath.models.paths.projection import basis, spline_basis, window, windowed
from onpath.models.systems import forces
from onpath.models.systems.system import MechanicalSystem

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
    frame = frame_of(system, frame, kind)
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


def frame_of(system: MechanicalSystem, frame: Frame, kind: Kind) -> Frame:
    """The robot's frame, or that of space curves.

    Raises:
        ValueError: the robot takes no space curves here.
    """
    if not kind.space:
        return frame
    if frame.space is None or kind.level_set or kind.output == "composite":
        raise ValueError(f"{system.name}: a space curve cannot be followed here")
    return frame.space


def _bases(system: MechanicalSystem, kind: Kind, law: Law) -> ca.Function:
    """`Kernel.basis`, at the predicted closest point and at the law's reference."""
    state_symbol, state = kept_layout(system, kind, law.memory).symbols("state")
    settings_symbol, settings = settings_layout(system, kind).symbols("settings")
    thetas = [predicted(state, settings)]
    if law.reference is not None:
        thetas.append(law.reference(clock_at(kind, law, state, settings, settings["look_ahead"])))
    results: list[ca.SX]
    if kind.spline:
        found = [spline_basis(theta, kind.closed, settings["pieces"]) for theta in thetas]
        results = [ca.horzcat(*each) for each in zip(*found, strict=True)]
    else:
        results = [ca.horzcat(*(basis(theta, kind.closed) for theta in thetas))]
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
    q, v, reading = measure(system, kind, state, settings)
    decided = decide(system, plane, kind, law, state, settings, values, (q, v), reading)
    drive, command = decided.drive, decided.command
    tip, force, moved = move(system, kind, state, settings, drive.parts, plant)
    estimate = {"estimate": moved["q"], "estimate_rate": moved["v"]}
    if kind.observer:
        estimate = carried_on(system, kind, settings, (q, v), drive.parts, plant)
    after = {**moved, **estimate, **decided.after}
    output = measured_output(system, plane, kind, state, settings, values[:, 0], (q, v))
    row = {**state, "speed_ref": wanted_speed(state, settings)[0], "y": tip}
    row |= {"u": drive.mean, "force": force} | logged(output)
    used = integral_used(state, settings, decided.view, command)
    row |= {"far": command.far, "integral_used": used}
    later = kept_layout(system, kind, law.memory).join(after)
    outputs = [later, log_layout(system).join(row), *bases.call([later, settings_symbol])]
    return ca.Function("advance", [state_symbol, settings_symbol, values], ca.cse(outputs))
