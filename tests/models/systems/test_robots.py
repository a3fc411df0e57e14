"""The contract of robots: every robot of the catalogue keeps it, and what breaks it is named."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.models.control.forecast import growth_rate
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.contract import faults_of
from onpath.models.systems.robots import RobotEntry
from onpath.models.systems.rows import Rows
from onpath.models.systems.two_link_arm import TWO_LINK_ARM
from tests.support.new_robot import GANTRY, new_robot
from tests.support.overhead_crane import CRITICAL, CraneParameters
from tests.support.overhead_crane import ROBOT as CRANE


@pytest.mark.parametrize("entry", [*ROBOTS.values(), CRANE], ids=lambda entry: entry.name)
def test_nothing_is_wrong_with_a_sound_robot(entry: RobotEntry) -> None:
    assert faults_of(entry) == []


@pytest.mark.parametrize("entry", [*ROBOTS.values(), CRANE], ids=lambda entry: entry.name)
def test_a_motor_in_newtons_works_where_a_length_changes_and_no_other_does(
    entry: RobotEntry,
) -> None:
    """Its power is u times the rate B(q)^T v, which is a speed in m/s for a force."""
    parameters = entry.parameters()
    robot = entry.make(parameters)
    system, q = robot.system, robot.rest(np.zeros(robot.system.p))
    along = ca.DM([float(name.endswith("_m")) for name in system.coordinate_names])
    rates = ca.evalf(system.input_rates(ca.SX(q), ca.SX(along), ca.SX(robot.plant(parameters))))
    assert ["N" if rate else "N m" for rate in rates.full()[:, 0]] == [*system.motor_units]


def test_where_its_zero_dynamics_change_is_that_of_the_closed_form() -> None:
    robot = CRANE.make(CRANE.parameters())
    rest = robot.rest(np.zeros(3))
    for alpha in (0.8, CRITICAL - 1e-3, CRITICAL + 1e-3):
        parameters = CraneParameters(alpha=alpha)
        rate = growth_rate(robot, parameters, rest)
        assert rate is not None and (rate > 0) == (alpha > CRITICAL)


def test_nor_with_that_of_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with new_robot(tmp_path, monkeypatch) as entry:
        assert faults_of(entry) == []


WRONG = {
    "the entry's name is 'gantry', but": (
        'name="gantry",\n        q=q',
        'name="crane",\n        q=q',
    ),
    "make() returns another object": ("make=lambda _: GANTRY", "make=lambda _: gantry()"),
    "3 coordinate_names for 2": ('("q1_m", "q2_m")', '("q1_m", "q2_m", "q3_m")'),
    "plant() does not return 2 finite": ("0.5 + own.payload}", "0.5 + own.payload}) * np.nan + (0"),
    "inverse(y) has the shape": ("inverse=lambda y: y", "inverse=lambda y: ca.vertcat(y, 0)"),
    "h(q) depends on v": ("output=q", "output=q + v"),
    "the regularity depends on q": ("ca.fmin(1, 4", 'ca.SX.sym("q") * ca.fmin(1, 4'),
    "is not finite at home": ("inverse=lambda y: y", "inverse=lambda y: ca.sqrt(y - 0.1)"),
    "regularity is not positive": ("regularity=ca", "regularity=0 * ca"),
    "hardly any path": (
        "HOME, TRAVEL = (0.2, 0.0, 0.15), 0.15",
        "HOME, TRAVEL = (0.2, 0, 0.15), 0.04",
    ),
    "h(inverse(y)) is not y": ("inverse=lambda y: y", "inverse=lambda y: 0.9 * y"),
    "last bar does not end": ("HOME[2] + q[1])", "HOME[2] - q[1])"),
    "reach is 0.2 m, but": ("reach=0.5", "reach=0.2"),
    "mass matrix is not symmetric": (
        "mass=ca.diag(ca.vertcat(carriage + tool, tool))",
        "mass=ca.blockcat([[carriage + tool, 0.1], [0, tool]])",
    ),
    "mass matrix is not positive definite": (
        "mass=ca.diag(ca.vertcat(carriage + tool, tool))",
        "mass=ca.blockcat([[carriage + tool, 2], [2, tool]])",
    ),
    "B does not have the rank 2": (
        "inputs=2",
        "inputs=2, actuation=ca.SX(ca.DM([[1, 1], [1, 1]]))",
    ),
    "bias at rest is not the gradient": ("friction=0.5 * v", "bias=0.5 * v"),
    "is not Lagrange's for the mass": ("friction=0.5 * v", "friction=0.5 * v + v[0] * v[1]"),
    "friction adds energy": ("friction=0.5 * v", "friction=-0.5 * v"),
    "solve(M, R) does not return": ("inputs=2", "inputs=2, solve=lambda m, r: r"),
    "a run stops at rest": (
        "        regularity=",
        "        stops=(StopCondition(ca.fabs(q[0]) > 0.01, SINGULAR),),\n        regularity=",
    ),
    "payload changes tool, on which h(q) depends": ("output=q", "output=q * (1 + 1e-9 * tool)"),
    "the drawing's motors": (
        "        regularity=",
        "        drawing=Drawing(motors=(7,)),\n        regularity=",
    ),
}
"""What the contract says of the README's robot if one part of its text is another."""


@pytest.mark.parametrize("told", WRONG)
def test_what_is_wrong_with_a_new_robot_is_said(
    told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    right, wrong = WRONG[told]
    assert GANTRY.count(right) == 1
    text = GANTRY.replace(right, wrong).replace(
        "import Robot, RobotEntry",
        "import SINGULAR, Robot, RobotEntry, StopCondition\nimport numpy as np\n"
        "from onpath.models.systems.drawing import Drawing",
    )
    with new_robot(tmp_path, monkeypatch, text) as entry:
        found = faults_of(entry)
    assert [each for each in found if told in each], found


def test_a_pose_that_jumps_on_the_way_is_named() -> None:
    robot = TWO_LINK_ARM

    def turned(y: ca.SX) -> ca.SX:
        return robot.inverse(y) + 2 * np.pi * (y[0] > 0.01)

    jumping = replace(robot, inverse=turned)
    entry = replace(ROBOTS["two_link_arm"], make=lambda _: jumping)
    assert [each for each in faults_of(entry) if "inverse(y) jumps by 6.3" in each]


numbers = st.floats(-10, 10)


@given(st.lists(st.tuples(numbers, numbers, numbers), max_size=70))
def test_values_of_rows_do_not_depend_on_the_rows_beside_them(
    rows: list[tuple[float, ...]],
) -> None:
    q, a = ca.SX.sym("q", 2), ca.SX.sym("a")
    function = Rows([q, a], ca.vertcat(ca.sin(q[0]) * a, ca.sqrt(q[1]), a))
    given = np.array(rows).reshape(-1, 3)
    found = function(given[:, :2], given[:, 2:])
    assert found.shape == (len(rows), 3)
    each = [function(row[:2], row[2:]) for row in given]
    np.testing.assert_array_equal(found, np.array(each).reshape(-1, 3))
    both = np.stack([given[:, :2]] * 2)
    np.testing.assert_array_equal(function(both, given[:, 2:])[1], found)
