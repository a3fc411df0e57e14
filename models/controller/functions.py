"""The controller alone: from what a robot measures to the torques of its motors.

A step is a tick of the closed loop without its plant, with checks of what it is given. All of it is
in CasADi functions, so that Python and the exported C compute the same bits.

Time is counted in ticks of dt from the start on. `due` says how many ticks without a measurement
have passed since the last step. In these, the controller's model carries q and v on, and the law is
not evaluated. It is evaluated in the first step that is at least `hold_ticks` after its last
evaluation, and its torque is held in between, as in the lab.

Without velocities, an observer or a filter finds them, as the lab's do behind encoders.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca

from onpath.models.closed_loop.controller_tick import Decision, decide
from onpath.models.closed_loop.kernel import Kernel, frame_of
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.observer import carried_on, corrected
from onpath.models.closed_loop.sensing import filtered
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.layout import Fields, Layout
from onpath.models.paths.curves import PERIOD
from onpath.models.paths.projection import LARGEST_STEP, LocalCurve
from onpath.models.systems.robots import FASTEST_JOINT, Robot, stop_code
from onpath.models.systems.system import MechanicalSystem

AT_FAULT = ("zero", "hold", "damp")
"""What a controller does after it has refused a measurement: no torque, the last one, or -c v."""
JUMP_TIME = 0.01  # [s] for which a joint may be ahead at its fastest: encoders read in steps
DAMPING_TIME = 0.1  # [s] in which "damp" slows a motor down to 1/e
LARGEST = 1e300  # numbers beyond count as not finite
REFUSALS = {
    "not_started": Message("refused.not_started"),
    "time": Message("refused.time"),
    "late": Message("refused.late"),
    "not_finite": Message("refused.not_finite"),
    "jump": Message("refused.jump"),
    "fast": Message("refused.fast"),
    "no_torque": Message("refused.no_torque"),
    "stopped": Message("refused.stopped"),
}
"""Why steps are refused, with codes from 1 on; those of `Robot.reasons` follow. 0 is none."""
_CODES = {name: number for number, name in enumerate(REFUSALS, 1)}
STOPPED = _CODES["stopped"]  # of a controller that was told to stop
OWN_SETTINGS = ("at_fault", "fastest")
"""Settings that a loop lacks: place in `AT_FAULT`, and largest rate of a joint, [rad/s]."""
HOLD, DAMP = AT_FAULT.index("hold"), AT_FAULT.index("damp")
_READ = ("encoder", "encoder_rate")
"""Fields of the state that a tick without a measurement leaves as they are."""
_PLANT = ("coulomb", "stiction", "encoder_step", "sensor_noise", "strain_noise", "seed", "plant")
_LEVEL = ("level_centre", "level_weights", "level_constant")
_OUTSIDE = ("hand_", "hold_a", "hold_tangent", "hold_normal", "wall_")
"""Settings of the loop, or how they begin, that are the plant's alone."""


@dataclass(frozen=True, slots=True, eq=False)
class Functions:
    """The functions of a controller. All vectors are flat.

    Attributes:
        state, settings, sample: layouts.
        begin: (t, q, v, θ of the closest point) -> the state of a controller that starts now.
        due: (state, settings, t) -> ticks since the last step that have no measurement, at most two
            control intervals.
        basis: as `Kernel.basis`.
        step: (state, settings, values, sample) -> (state, torque of the motors (m, 1) [N m]): a
            tick, with a measurement or without.
        tick: (state, settings, curve table, sample) -> as `step`, for CasADi's virtual machine.
        near: (settings, values, θ, q) -> (a better θ of the closest point [rad], squared distance
            at θ [m²]).
        spline: whether the curve consists of pieces.
        table_shape: of the curve's table.
    """

    state: Layout
    settings: Layout
    sample: Layout
    begin: ca.Function
    due: ca.Function
    basis: ca.Function
    step: ca.Function
    tick: ca.Function
    near: ca.Function
    spline: bool
    table_shape: tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
class _ControllerParts:
    """What all functions of a controller are made of."""

    robot: Robot
    kind: Kind
    kernel: Kernel
    state: Layout
    settings: Layout

    @property
    def system(self) -> MechanicalSystem:
        return self.robot.system

    def given(self) -> tuple[ca.SX, Fields, ca.SX, Fields]:
        """Symbols of state and settings with their fields; the plant's settings are 0."""
        state_symbol, state = self.state.symbols("state")
        settings_symbol, settings = self.settings.symbols("settings")
        return state_symbol, state, settings_symbol, _whole(self.kernel.settings, settings)


def controller_kind(kind: Kind, observer: bool) -> Kind:
    """The kind of a controller that can do without velocities, for a lab's kind of loop.

    Args:
        observer: whether an observer finds the velocities, not a filter.
    """
    return replace(kind, encoder=True, observer=observer, noise=False, stiction=False, free=False)


@lru_cache(maxsize=8)
def controller_functions(robot: Robot, kind: Kind) -> Functions:
    """The functions for a robot and a `controller_kind`.

    Raises:
        CodedError: as `build_kernel`.
    """
    kernel, system = kernel_of(robot, kind), robot.system
    kept = kernel.state.fields[: _count(kernel.state, kernel.changed)]
    own = (("torque", system.m), ("start", 1), ("next", 1), ("age", 1), ("time", 1), ("code", 1))
    symbols = _ControllerParts(
        robot=robot,
        kind=kind,
        kernel=kernel,
        state=Layout((*kept, *own)),
        settings=Layout((*_used(kernel, kind), *((name, 1) for name in OWN_SETTINGS))),
    )
    sample = Layout((("t", 1), ("q", system.n), ("v", system.n), ("has_q", 1), ("has_v", 1)))
    basis, step = _basis(symbols), _step(symbols, sample)
    return Functions(
        state=symbols.state,
        settings=symbols.settings,
        sample=sample,
        begin=_begin(symbols),
        due=_due(symbols),
        basis=basis,
        step=step,
        tick=_tick(kernel, basis, step),
        near=_near(symbols),
        spline=kernel.spline,
        table_shape=kernel.table_shape,
    )


def _used(kernel: Kernel, kind: Kind) -> list[tuple[str, int]]:
    """The settings of a loop that its controller uses."""
    unused = [*_PLANT]
    unused += [] if kind.level_set and kind.level is None else _LEVEL
    unused += ["plan"] if law_named(kind.law).plan is None else []
    fields = [each for each in kernel.settings.fields if each[0] not in unused]
    return [each for each in fields if not each[0].startswith(_OUTSIDE)]


def _count(layout: Layout, size: int) -> int:
    """The number of leading fields that take so many numbers."""
    return sum(where.stop <= size for where in layout.slices.values())


def _whole(layout: Layout, settings: Fields) -> Fields:
    sizes = dict(layout.fields)
    whole = {name: settings.get(name, ca.SX.zeros(size, 1)) for name, size in sizes.items()}
    return whole | {name: settings[name] for name in OWN_SETTINGS}


def _tick_now(state: Fields, settings: Fields, t: ca.SX) -> ca.SX:
    """The number of the tick at time t."""
    return ca.floor((t - state["start"]) / settings["dt"] + 0.5)


def _begin(symbols: _ControllerParts) -> ca.Function:
    system = symbols.system
    t, theta = ca.SX.sym("t"), ca.SX.sym("theta")
    q, v = ca.SX.sym("q", system.n), ca.SX.sym("v", system.n)
    state = {name: ca.SX.zeros(size, 1) for name, size in symbols.state.fields}
    state |= {"q": q, "v": v, "theta": theta, "theta_ref": theta, "start": t, "time": t}
    state |= {"encoder": q[: system.joints], "encoder_rate": v[: system.joints]}
    state |= {"estimate": q, "estimate_rate": v, "age": ca.SX(1)}
    return ca.Function("begin", [t, q, v, theta], [symbols.state.join(state)])


def _due(symbols: _ControllerParts) -> ca.Function:
    state_symbol, state, settings_symbol, settings = symbols.given()
    t = ca.SX.sym("t")
    passed = _tick_now(state, settings, t) - state["next"]
    missed = ca.fmin(ca.fmax(passed, 0), 2 * settings["hold_ticks"])
    inputs = [state_symbol, settings_symbol, t]
    return ca.Function("due", inputs, [(state["code"] == 0) * missed])


def _basis(symbols: _ControllerParts) -> ca.Function:
    kernel = symbols.kernel
    state_symbol, _, settings_symbol, settings = symbols.given()
    found = kernel.basis.call([state_symbol[: kernel.changed], kernel.settings.join(settings)])
    return ca.Function("basis", [state_symbol, settings_symbol], ca.cse(found))


def _values(symbols: _ControllerParts) -> ca.SX:
    return ca.SX.sym("values", symbols.kind.value_rows, symbols.kernel.advance.size_in(2)[1])


def _decided(
    symbols: _ControllerParts,
    state: Fields,
    settings: Fields,
    values: ca.SX,
    measured: tuple[ca.SX, ca.SX],
    has_v: ca.SX,
) -> tuple[Decision, Fields]:
    """The decision in a tick, and the next state with the estimate for the next tick."""
    robot, kind, system = symbols.robot, symbols.kind, symbols.system
    plane = frame_of(system, robot.frame, kind).at(settings["plane"])
    late = "observer_time" if kind.observer else "encoder_filter"
    known = {
        **settings,
        late: ca.if_else(has_v, 0, settings[late]),
    }  # exact velocities are not late
    law = law_named(kind.law)
    reading = measured[0][: system.joints]
    found = decide(system, plane, kind, law, state, known, values, measured, reading)
    plant = robot.substeps, robot.grip
    later = carried_on(system, kind, settings, measured, found.drive.parts, plant)
    ticks = {"phase": state["phase"] + 1, "next": state["next"] + 1}
    return found, {**state, **found.after, **later, **ticks, "v": measured[1]}


def _step(symbols: _ControllerParts, sample: Layout) -> ca.Function:
    state_symbol, state, settings_symbol, settings = symbols.given()
    sample_symbol, given = sample.symbols("sample")
    values = _values(symbols)
    phase, now = state["phase"], _tick_now(state, settings, given["t"])
    due = ca.logic_or(phase < 0.5, phase > settings["hold_ticks"] - 0.5)
    acts = ca.logic_and(given["has_q"], due)
    before = {**state, "phase": ca.if_else(acts, 0, ca.fmax(phase, 1))}
    q, v = _measured(symbols, before, settings, given)
    found, after = _decided(symbols, before, settings, values, (q, v), given["has_v"])
    again = ca.logic_and(now == state["next"] - 1, state["next"] > 0)
    after |= {
        "q": ca.if_else(given["has_q"], given["q"], state["q"]),
        "age": ca.if_else(given["has_q"], 1, state["age"] + 1),
        "time": ca.if_else(given["has_q"], given["t"], state["time"]),
        "torque": ca.if_else(acts, found.torque, state["torque"]),
    }
    unseen = ca.logic_not(given["has_q"])
    after |= {name: ca.if_else(unseen, state[name], after[name]) for name in _READ}
    code = _code(symbols, before, settings, given, now, (q, v), after)
    code = ca.if_else(ca.logic_or(unseen, state["code"]), state["code"], code)
    refused, skipped = code != 0, ca.logic_and(again, given["has_q"])
    stopped, usable = _stopped(symbols, {**state, "code": code}, settings, given)
    chosen = {
        name: ca.if_else(refused, stopped[name], ca.if_else(skipped, state[name], after[name]))
        for name, _ in symbols.state.fields
    }
    fallback = _fallback(symbols, stopped, settings, given, usable)
    torque = ca.if_else(refused, fallback, chosen["torque"])
    inputs = [state_symbol, settings_symbol, values, sample_symbol]
    outputs = [ca.densify(each) for each in (symbols.state.join(chosen), torque)]
    return ca.Function("step", inputs, ca.cse(outputs))


def _tick(kernel: Kernel, basis: ca.Function, step: ca.Function) -> ca.Function:
    state, settings, sample = (ca.MX.sym("given", step.numel_in(i)) for i in (0, 1, 3))
    table = ca.MX.sym("curve", *kernel.table_shape)
    values = kernel.values(table, basis.call([state, settings]))
    results = step.call([state, settings, values, sample])
    return ca.Function("tick", [state, settings, table, sample], results)


def _measured(
    symbols: _ControllerParts, state: Fields, settings: Fields, given: Fields
) -> tuple[ca.SX, ca.SX]:
    """q and v for the law, each (n, 1)."""
    joints, reading = symbols.system.joints, given["q"]
    if symbols.kind.observer:
        q, v = corrected(state, settings, reading)
    else:
        rates = filtered(state, settings, reading[:joints])
        q, v = reading, ca.vertcat(rates, state["estimate_rate"][joints:])
    q, v = ca.if_else(given["has_v"], reading, q), ca.if_else(given["has_v"], given["v"], v)
    seen = given["has_q"]
    return ca.if_else(seen, q, state["estimate"]), ca.if_else(seen, v, state["estimate_rate"])


def _code(
    symbols: _ControllerParts,
    state: Fields,
    settings: Fields,
    given: Fields,
    now: ca.SX,
    measured: tuple[ca.SX, ca.SX],
    after: Fields,
) -> ca.SX:
    """0, or the reason why the step is refused: the first that applies."""
    system, following = symbols.system, state["next"]
    stop = ca.Function("stop", [system.q, system.v], [stop_code(symbols.robot)])(*measured)
    passed = settings["dt"] * state["age"]
    farthest = ca.fmin(FASTEST_JOINT * passed, settings["fastest"] * (passed + JUMP_TIME))
    jump = ca.mmax(ca.fabs(given["q"] - state["q"])[: system.joints]) > farthest
    checks = [
        (ca.logic_not(now >= ca.fmax(following - 1, 0)), ca.SX(_CODES["time"])),  # or NaN
        (now > following, ca.SX(_CODES["late"])),
        (ca.logic_not(_finite(_numbers(given))), ca.SX(_CODES["not_finite"])),
        (jump, ca.SX(_CODES["jump"])),
        (stop != 0, len(REFUSALS) + stop),
        (ca.mmax(ca.fabs(measured[1][: system.joints])) > settings["fastest"], _CODES["fast"]),
        (ca.logic_not(_finite(ca.vertcat(*after.values()))), ca.SX(_CODES["no_torque"])),
    ]
    code = ca.SX(0)
    for bad, number in reversed(checks):
        code = ca.if_else(bad, number, code)
    return code


def _numbers(given: Fields) -> ca.SX:
    """What is measured: q, and v if it is."""
    return ca.vertcat(given["q"], ca.if_else(given["has_v"], given["v"], 0))


def _finite(numbers: ca.SX) -> ca.SX:
    """Whether all numbers are finite."""
    sound = ca.SX(1)
    for number in ca.vertsplit(numbers):
        sound = ca.logic_and(sound, ca.fabs(number) < LARGEST)
    return sound


def _stopped(
    symbols: _ControllerParts, state: Fields, settings: Fields, given: Fields
) -> tuple[Fields, ca.SX]:
    """The state after a refused step, and whether its measurement can be used to slow down.

    Only the rates of the joints go on, as measured, or by a filter that leaves out jumps.
    """
    joints, passed = symbols.system.joints, given["t"] - state["time"]
    weight = passed / (settings["encoder_filter"] + passed)
    difference = (given["q"][:joints] - state["encoder"]) / passed
    change = ca.if_else(ca.fabs(difference) < FASTEST_JOINT, difference - state["encoder_rate"], 0)
    rate = state["encoder_rate"] + weight * change
    rate = ca.if_else(given["has_v"], given["v"][:joints], rate)
    usable = ca.logic_and(_finite(_numbers(given)), passed > 0)
    seen = {"encoder": given["q"][:joints], "encoder_rate": rate, "time": given["t"]}
    return state | {n: ca.if_else(usable, each, state[n]) for n, each in seen.items()}, usable


def _fallback(
    symbols: _ControllerParts, stopped: Fields, settings: Fields, given: Fields, usable: ca.SX
) -> ca.SX:
    """The torque of a refused step, (m, 1), within the limits.

    "damp" is -r_i / (w_ii DAMPING_TIME), with r = B^T v the rates of the motors and w their
    compliance, B^T M⁻¹ B; and 0 if what is measured cannot be used.
    """
    system, model = symbols.system, settings["model"]
    v = ca.vertcat(stopped["encoder_rate"], ca.SX.zeros(system.modes, 1))
    rates = system.input_rates(given["q"], v, model)
    damp = -rates / (ca.diag(system.compliance(given["q"], model)) * DAMPING_TIME)
    sound, chosen = ca.logic_and(usable, _finite(damp)), settings["at_fault"]
    torque = ca.if_else(chosen == HOLD, stopped["torque"], 0)
    torque = ca.if_else(ca.logic_and(chosen == DAMP, sound), damp, torque)
    limit = system.torque_limits(settings["torque_limit"])
    return ca.fmin(ca.fmax(torque, -limit), limit)


def _near(symbols: _ControllerParts) -> ca.Function:
    _, _, settings_symbol, settings = symbols.given()
    system, kind = symbols.system, symbols.kind
    values, theta, q = _values(symbols), ca.SX.sym("theta"), ca.SX.sym("q", system.n)
    plane = frame_of(system, symbols.robot.frame, kind).at(settings["plane"])
    y, _ = system.with_rate(system.output)(q, ca.SX.zeros(system.n, 1), settings["model"])
    local = LocalCurve.from_values(theta, kind.closed, values[:, 0])
    reach = ca.fmin(LARGEST_STEP, 1.5 * PERIOD / settings["pieces"]) if kind.spline else None
    local = local if reach is None else replace(local, reach=reach)
    z = plane.split(y)[0]
    gap = z - local.sigma
    found = [local.project(z).theta, ca.dot(gap, gap)]
    return ca.Function("near", [settings_symbol, values, theta, q], ca.cse(found))
