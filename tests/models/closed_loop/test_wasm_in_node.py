"""What WebAssembly computes in Node, as in Chromium, is what CasADi's virtual machine computes.

Where the engine's functions differ from the C library's in their last bits, as those of some
versions do, runs differ as much as two of the virtual machine that start a few bits apart.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.closed_loop.faults import fault_in
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.operations import MATHEMATICS, OPERATIONS
from onpath.models.closed_loop.simulation import (
    Push,
    brake_at,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.control.laws.registry import NAMES
from onpath.models.paths.curves import Curve, circle, segment
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from tests.support.cases import some
from tests.support.node_page import NodePage, needs_node
from tests.support.scalar_operations import PAIRS, applied, logging_kernel
from tests.support.suitable_laws import laws_for, suitable_pairs
from tests.support.wasm_runs import rows_in_node

pytestmark = needs_node
LAST_BITS = dict.fromkeys(MATHEMATICS, 1) | {"hypot": 2, "fmod": 0, "remainder": 0}
"""How far functions of the engine's mathematics may be off."""
TICKS, CLOSE = 1000, 1e-12
FEW_BITS, TIMES = 2.0**-50, 4.0
OBSERVED = {
    "encoder_counts": 2000,
    "sensor_noise": 1e-4,
    "observer_time": 0.008,
    "control_rate": 250,
}
TYPED = "across = -K1*xi - K2*tanh(dxi); along = min(-K5*(dtheta - speed), 3)"
CASES = [
    *((robot, law, {}) for robot in ROBOTS for law in NAMES),
    *(("five_bar", law, {}) for law in laws_for() if law not in NAMES),
    ("five_bar", TYPED, {}),
    ("flexible", "path_following", {"output": "composite", "modes": 2}),
    ("five_bar", "path_following", {"delay": 1.5, "stiction": 0.02, "sensor_noise": 0.002}),
    ("two_link_arm", "path_following", OBSERVED),
]
QUICK = [
    ("five_bar", "path_following", {}),
    ("spatial_arm", "trajectory_tracking", {}),
    *CASES[-4:],
]
KINDS: list[dict[str, Any]] = [
    {"encoder_counts": 4000, "coulomb": 0.01},
    {"torque_limit": 0.5, "control_rate": 200},
    {"across": "level_set"},
    {"delay": 0.5, "sensor_noise": 0.001},
    {"stiction": 0.02, "torque_step": 0.01},
]


@pytest.fixture(scope="module")
def page() -> Iterator[NodePage]:
    page = NodePage()
    yield page
    page.close()


@pytest.mark.thorough
def test_every_operation_is_the_interpreter_s_for_all_kinds_of_numbers(page: NodePage) -> None:
    """But for the functions of the engine's mathematics, whose last bits may be others."""
    codes = [code for code, each in OPERATIONS.items() if each.wasm]
    pairs = PAIRS[::5]
    x = ca.SX.sym("x", pairs.size)
    rows = [applied(code, x[2 * i], x[2 * i + 1]) for code in codes for i in range(len(pairs))]
    kernel = logging_kernel(rows, x)
    given = pairs.ravel(), np.zeros(1), circle(0.05).table(), 1
    wanted = InterpretedLoop(kernel).run(*given)[1].reshape(len(codes), -1)
    every = rows_in_node(page, kernel, *given).reshape(len(codes), -1)
    for code, expected, found in zip(codes, wanted, every, strict=True):
        name = OPERATIONS[code].wasm.split()[-1]
        with np.errstate(invalid="ignore"):
            ulps = np.abs(found - expected) / np.spacing(np.abs(expected))
        same = (found == expected) | (np.isnan(found) & np.isnan(expected))
        differing = np.c_[pairs, found, expected][~same & ~(ulps <= LAST_BITS.get(name, 0))]
        assert not len(differing), (name, differing[:5])
        numbers = ~np.isnan(expected)
        assert np.array_equal(np.signbit(expected)[numbers], np.signbit(found)[numbers]), name


def assert_same_run(
    page: NodePage, name: str, law: str, values: dict[str, Any], curve: Curve
) -> None:
    """Node's log of a loop that is held is that of CasADi's virtual machine.

    A difference of `FEW_BITS` at the start tells how much rounding makes of this run. It ends where
    it has diverged: there, lab and figure stop it.
    """
    calm = (
        {"output": "redefined"} if ROBOTS[name].flexible_link else {}
    )  # composite diverges in some kinds
    parameters: Parameters = replace(ROBOTS[name].parameters(), **{**calm, **values})
    robot = ROBOTS[name].make(parameters)
    kind = kind_of(law, parameters, curve)
    assert kind.observer == (kind.encoder or kind.noise)  # the observer is in new labs
    kernel = kernel_of(robot, kind)
    start = robot.frame.lift(curve.at(np.array(0.3)))
    state = first_state(robot, kernel, curve, robot.rest(start))
    brake = Push(hold=brake_at(robot, curve, start, 0.3))
    settings = settings_vector(robot, kernel, parameters, curve, brake)
    given = settings, curve.table(), TICKS
    expected, *beside = (
        InterpretedLoop(kernel).run(np.asarray(state) * (1.0 + bits), *given)[1]
        for bits in (0.0, FEW_BITS, -FEW_BITS)
    )
    found = rows_in_node(page, kernel, state, *given)
    fault = fault_in(robot, kernel.log, law, expected, parameters)
    end = TICKS if fault is None else fault[0]
    assert end > 0 and np.isfinite(found[:end]).all()
    rounding = max(np.abs(other - expected)[:end].max() for other in beside)
    assert np.abs(found - expected)[:end].max() <= CLOSE + TIMES * rounding, values


@pytest.mark.parametrize("name, law, values", some(CASES, QUICK), ids=lambda case: str(case)[:20])
def test_a_run_is_the_interpreter_s(
    page: NodePage, name: str, law: str, values: dict[str, Any]
) -> None:
    assert_same_run(page, name, law, values, circle(0.05))


@pytest.mark.thorough
@settings(max_examples=15)
@given(pair=st.sampled_from(suitable_pairs(TYPED)))
def test_any_law_of_any_robot_is_the_interpreter_s(page: NodePage, pair: tuple[str, str]) -> None:
    name, law = pair
    for values in KINDS:
        assert_same_run(page, name, law, values, circle(0.05))
    line = segment((-0.04, -0.02), (0.04, 0.02))
    assert_same_run(page, name, law, {}, line)
