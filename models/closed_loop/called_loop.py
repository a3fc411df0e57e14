"""A closed loop whose law is a Python function, which is called once in every control interval.

The function is a law for studies: see `Now` in models/control/laws/python_law.py. An exception or
an invalid command stops the run, and the message has file and line. The time limit is not here,
since models have no clock: app/common/own_laws.py wraps the function in one that raises.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import casadi as ca
import numpy as np
from typing_extensions import override

from onpath.models.arrays import Array
from onpath.models.closed_loop.buffered import Buffered
from onpath.models.closed_loop.controller_tick import wanted_torque
from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.law_view import beam_estimate, law_view
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loop_vectors import GAINS, kept_layout, settings_layout
from onpath.models.closed_loop.loops import Loop
from onpath.models.closed_loop.sensing import look_ahead, measure
from onpath.models.closed_loop.simulation import NO_LIMIT
from onpath.models.control.laws.expressions import LARGEST_NUMBER
from onpath.models.control.laws.law import Law
from onpath.models.control.laws.law_error import error_in
from onpath.models.control.laws.python_law import CALLED, MOST, Now
from onpath.models.control.laws.registry import law_named
from onpath.models.errors import Message
from onpath.models.layout import Layout
from onpath.models.systems.robots import Robot


def callable_loop(robot: Robot, kind: Kind, kernel: Kernel, loop: Loop) -> Loop:
    """The loop itself, or one that calls the law's function between its ticks, for a single run.

    Args:
        kernel: of the robot and the kind.
        loop: of this kernel.
    """
    law = law_named(kind.law)
    return loop if law.called is None else CalledLoop(robot, kind, law, kernel, loop)


@dataclass(slots=True)
class _Progress:
    """The law in a run, with its memory.

    Attributes:
        act: the function.
        calls: number of calls so far.
        failure: why the law has been stopped, or None.
    """

    act: Callable[[Now], Any]
    calls: int = 0
    failure: Message | None = None


class CalledLoop(Loop):
    """Calls a law's function between the ticks of a loop, for one run of one robot.

    After a failure the reference point is NaN, which stops the run; see `fault_in`.

    Args:
        robot, kind, law: of the run.
        kernel: of them.
        loop: of the kernel.
    """

    def __init__(self, robot: Robot, kind: Kind, law: Law, kernel: Kernel, loop: Loop) -> None:
        assert law.called is not None and law.origin is not None
        self.layouts, self._loop, self._law = kernel.layouts, loop, law
        self._values, self._seen = Buffered(kernel.at()), _seen(robot, kind, law)
        self._p, self._origin = robot.system.p, law.origin
        self._changed = kernel.changed
        self._before: tuple[Array, _Progress] | None = None
        self._now: _Progress | None = None

    @property
    def failure(self) -> Message | None:
        """Why the law has been stopped, with file and line; None if it has not been."""
        return None if self._now is None else self._now.failure

    @override
    def run(self, state: Array, settings: Array, table: Array, ticks: int) -> tuple[Array, Array]:
        self._begin(state)
        given, rows = self.layouts.settings.unpack(settings), list[Array]()
        every, state, done = round(float(given["hold_ticks"][0])), state.copy(), 0
        while done < ticks:
            fields = self.layouts.state.unpack(state)
            phase, left = round(float(fields["phase"][0])), ticks - done
            if not np.isnan(fields["theta_ref"][0]) and phase == 0:
                self._call(fields, state, settings, table, every * float(given["dt"][0]))
            failed = np.isnan(fields["theta_ref"][0])
            count = left if failed else min(left, every - phase)
            state, log = self._loop.run(state, settings, table, count)
            rows.append(log)
            done += count
        width = self.layouts.log.size
        return state, np.concatenate(rows) if rows else np.empty((0, width))

    @override
    def run_many(
        self,
        states: Sequence[Array] | Array,
        settings: Sequence[Array],
        tables: Sequence[Array],
        ticks: int,
    ) -> tuple[Array, Array]:
        if len(states) != 1:
            raise ValueError("a law that is called has a memory for one run only")
        state, rows = self.run(states[0], settings[0], tables[0], ticks)
        return state[None], rows[None]

    def check(self, state: Array, settings: Array, table: Array) -> None:
        """Call a new copy of the function at the start of a run.

        Raises:
            CodedError: it fails, or what it returns is not a command; with file and line.
        """
        given = self.layouts.settings.unpack(settings)
        span = float(given["hold_ticks"][0]) * float(given["dt"][0])
        values = self._values(state[: self._changed], settings, table)[0]
        assert self._law.called is not None and self._law.origin is not None
        try:
            seen = self._seen(state[: self._changed], settings, values, 0, span)
            _command(self._law.called()(seen), self._p)
        except (Exception, SystemExit) as error:
            raise error_in(self._law.name, error, *self._law.origin) from None

    def _begin(self, state: Array) -> None:
        """Restore the law's memory if the run begins again in the state of its last beginning."""
        if self._before is not None and np.array_equal(self._before[0], state):
            self._now = self._before[1]
        if self._now is None:
            self._now = self._made()
        try:
            self._before = state.copy(), copy.deepcopy(self._now)
        except Exception as error:  # of whatever the law keeps
            self._now.failure = self._reason(TypeError(f"its memory cannot be copied: {error}"))

    def _made(self) -> _Progress:
        assert self._law.called is not None
        try:
            return _Progress(self._law.called())
        except (Exception, SystemExit) as error:
            return _Progress(lambda _: None, failure=self._reason(error))

    def _reason(self, error: BaseException) -> Message:
        told = error_in(self._law.name, error, *self._origin).message.arguments
        law, reason, file, line = (told[name] for name in ("law", "reason", "file", "line"))
        return Message(
            "stop.called_law", {"law": law, "reason": reason, "file": file, "line": line}
        )

    def _call(
        self, fields: dict[str, Array], state: Array, settings: Array, table: Array, span: float
    ) -> None:
        """Call the function, and write its command, or NaN for the reference point, into a state.

        Args:
            fields: views of the state's fields.
            span: the control interval, [s].
        """
        now = self._now
        assert now is not None
        try:
            if now.failure is None:
                before = state[: self._changed]
                values = self._values(before, settings, table)[0]
                given = now.act(self._seen(before, settings, values, now.calls, span))
                fields[CALLED][: self._p] = _command(given, self._p)
                now.calls += 1
        except (Exception, SystemExit) as error:
            now.failure = self._reason(error)
        if now.failure is not None:
            fields["theta_ref"][:] = np.nan


def _command(given: Any, p: int) -> Array:
    """The numbers that a function returned, shape (p,).

    Raises:
        ValueError: they are not a valid command.
    """
    form = f"{p} finite numbers, θ'' and λ''" + ("" if p == 2 else " in each normal direction")
    try:
        numbers = np.asarray(given)
    except ValueError:
        raise ValueError(f"it returned {given!r:.60}, not {form}") from None
    real = numbers.dtype.kind in "iuf"  # no texts, and nothing complex
    if numbers.shape != (p,) or not real or not (np.abs(numbers) < LARGEST_NUMBER).all():  # or NaN
        raise ValueError(f"it returned {given!r:.60}, not {form}")
    return numbers


def _seen(robot: Robot, kind: Kind, law: Law) -> Callable[..., Now]:
    """(state, settings, values, calls so far, interval) -> the argument of the function."""
    system = robot.system
    state_symbol, state = kept_layout(system, kind, law.memory).symbols("state")
    settings_symbol, settings = settings_layout(system, kind).symbols("settings")
    frame = robot.frame if not kind.space or robot.frame.space is None else robot.frame.space
    values, h = ca.SX.sym("values", kind.value_rows, 1), settings["look_ahead"]
    measured = measure(system, kind, state, settings)[:2]
    q, v = look_ahead(system, state, settings, *measured, h)
    beam = beam_estimate(system, state, settings, q, v, h) if kind.output == "composite" else None
    plane = frame.at(settings["plane"])
    view = law_view(system, plane, kind, law, state, settings, values, measured, (q, v), beam)
    output, gains, limit = view.output, view.gains, settings["torque_limit"]
    command = ca.SX.sym("command", MOST)
    clock = replace(view.clock, memory={CALLED: command})
    action, uncut = law.command(replace(view, clock=clock)), replace(kind, across_first=False)
    torque, _ = wanted_torque(uncut, state, settings, view, action, beam)
    gain = ca.jacobian(torque, command)[:, : system.p]
    found = {
        "q": view.q,
        "v": view.v,
        "y": view.y,
        "y_rate": view.y_rate,
        "theta": output.theta,
        "theta_rate": output.theta_rate,
        "xi": output.xi,
        "xi_rate": output.xi_rate,
        "speed": view.task.speed,
        "torque": ca.substitute(torque, command, ca.SX.zeros(MOST)),
        "torque_gain": ca.vec(ca.substitute(gain, command, ca.SX.zeros(MOST))),
        "torque_limit": ca.if_else(limit < NO_LIMIT, system.torque_limits(limit), np.inf),
        **dict(zip(GAINS, (gains.k1, gains.k2, gains.k3, gains.k4, gains.k5), strict=True)),
    }
    layout = Layout(tuple((name, ca.SX(value).numel()) for name, value in found.items()))
    inputs = [state_symbol, settings_symbol, values]
    function = Buffered(ca.Function("seen", inputs, [ca.densify(layout.join(found))]))
    scalars = {"theta", "theta_rate", "speed", *GAINS}

    def seen(state: Array, settings: Array, values: Array, calls: int, span: float) -> Now:
        fields = layout.unpack(function(state, settings, values)[0].copy())
        given: dict[str, Any] = {
            name: float(each[0]) if name in scalars else each for name, each in fields.items()
        }
        given["torque_gain"] = given["torque_gain"].reshape(system.m, system.p, order="F")
        return Now(t=calls * span, interval=span, **given)

    return seen
