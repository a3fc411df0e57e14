"""States of a page without a server: at the start of an edited path, and under another law."""

from __future__ import annotations

import casadi as ca

from onpath.models.closed_loop.kernel import Kernel
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.page_functions import lift_of
from onpath.models.control.laws.registry import law_named
from onpath.models.systems.robots import Robot


def begin_function(robot: Robot, kind: Kind, kernel: Kernel) -> ca.Function:
    """(θ, values there, first state on another path) -> the first state at θ, at rest; the values
    are those of the scan "curve"."""
    begin, values = ca.SX.sym("begin"), ca.SX.sym("values", kind.value_rows)
    symbol, state = kernel.state.symbols("state")
    q = robot.inverse(lift_of(robot, kind)(values[: kind.dimension], False))
    theta = {"theta": begin, "theta_ref": begin}
    seen = {"encoder": q[: robot.system.joints], "estimate": q}
    state = dict(state) | {"q": q} | seen | theta
    first = ca.densify(kernel.state.join(state))
    return ca.Function("begin", [begin, values, symbol], [first])


def change_function(before: Kernel, after: Kernel, law: str) -> ca.Function:
    """State of a loop under another law -> the state with which it continues under this law.

    As in the lab: the reference point starts at the closest point, and the integral and the memory
    of the law at 0.
    """
    symbol, state = before.state.symbols("state")
    memory = {name for name, _ in law_named(law).memory}
    values = {
        name: state[name] if name in state and name not in memory else ca.SX.zeros(size)
        for name, size in after.state.fields
    }
    values |= {"theta_ref": state["theta"], "integral": 0 * state["integral"]}
    return ca.Function("change", [symbol], [ca.densify(after.state.join(values))])
