"""What is said before a run, against what the run does."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import assume, event, example, given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.trajectory import Trajectory
from onpath.models.control.forecast import (
    NO_REST,
    SINGULAR,
    UNPLANNED,
    doubts,
    exhausted,
    forecast,
    growth_rate,
    unmodelled,
)
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.rank_test import rank_number
from onpath.models.control.speed_limit import SHARE
from onpath.models.control.standing_torque import standing_torque
from onpath.models.errors import CodedError
from onpath.models.paths.curves import circle
from onpath.models.studies.experiments import on_path, run
from onpath.models.systems.cart_pendulum import ROBOT as CART
from onpath.models.systems.cart_pendulum import CartParameters
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot, RobotEntry
from onpath.models.systems.rod_gantry import PERCUSSION, ROD, RodGantryParameters
from onpath.models.systems.rod_gantry import ROBOT as GANTRY
from onpath.models.systems.zero_dynamics import zero_dynamics
from tests.support.drawings import star
from tests.support.passive_chain import Shape, entry_of, passive_chain
from tests.support.suitable_laws import laws_for

FOLLOW = "path_following"
CRITICAL = zero_dynamics(GANTRY.make(RodGantryParameters()).system)
CHAIN_LAWS = [name for name, law in LAWS.items() if not law.spatial]
GANTRIES = st.builds(
    RodGantryParameters,
    alpha=st.floats(-0.5, 1.5),
    rod=st.floats(0.05, 0.5),
    pivot=st.sampled_from([0.0, 0.002]),
)


def at_rest(robot: Robot) -> Array:
    return robot.rest(np.array([0.03, 0.0]))


def said(entry: RobotEntry, parameters: Parameters, law: str = FOLLOW) -> str | None:
    robot = entry.make(parameters)
    found = forecast(robot, law, parameters, at_rest(robot))
    return found and found.code


def ran(entry: RobotEntry, parameters: Parameters, law: str, seconds: float) -> Trajectory:
    chosen = on_path(entry, parameters, circle(0.03)).with_values({"duration": seconds})
    return run(chosen, law)


@settings(deadline=None, max_examples=200)
@given(GANTRIES)
def test_the_growth_rate_is_that_of_the_closed_form(own: RodGantryParameters) -> None:
    """a s² - b / S s - g = 0 with a = (α - 1) L and S = m l / 2; unstable where a > 0."""
    beyond = (own.alpha - 1) * PERCUSSION
    assume(abs(own.alpha - 1) > 0.01)
    robot = GANTRY.make(own)
    damping = own.pivot / (ROD * own.rod / 2)
    roots = np.roots([beyond, -damping, -9.81])
    largest = roots.real.max()
    expected = largest if largest > 1e-9 else min(largest, 0.0)
    found = growth_rate(robot, own, at_rest(robot))
    assert found == pytest.approx(expected, rel=1e-6, abs=1e-6)


@settings(deadline=None, max_examples=50)
@given(GANTRIES)
@example(RodGantryParameters())
def test_the_critical_alpha_is_one_with_any_payload(own: RodGantryParameters) -> None:
    own = replace(own, payload=own.rod / 2)
    robot = GANTRY.make(own)
    found = CRITICAL.critical_alpha(at_rest(robot), robot.plant(own))
    assert found == pytest.approx(1, abs=1e-6)


@settings(deadline=None, max_examples=25)
@given(GANTRIES)
def test_the_gantry_does_what_is_foretold(own: RodGantryParameters) -> None:
    """Close to the critical α, torques that are held for a millisecond matter, too."""
    assume(abs(own.alpha - 1) > 0.05)
    code = said(GANTRY, own)
    assert code == ("forecast.unstable" if own.alpha > 1 else None)
    log = ran(GANTRY, own, FOLLOW, 2.0)
    swing = np.abs(log.fields["q"][:, 2])
    event(str(code))
    if code is None:
        assert log.stopped_at is None and swing.max() < 0.5
        assert np.abs(log.fields["xi"]).max() < 1e-4
        return
    fallen = int((swing > 0.3).argmax())
    assert fallen > 0 and np.abs(log.fields["xi"][:fallen]).max() < 1e-4
    begun = int((swing > 0.06).argmax())
    rate = np.log(swing[fallen] / swing[begun]) / (log.t[fallen] - log.t[begun])
    robot = GANTRY.make(own)
    foretold = growth_rate(robot, own, at_rest(robot))
    assert rate == pytest.approx(foretold, rel=0.25)


@pytest.mark.parametrize("rod", [0.03, 0.1, 0.37])
def test_a_gantry_whose_pen_is_the_output_is_refused(rod: float) -> None:
    own = RodGantryParameters(alpha=1.0, rod=rod)
    assert said(GANTRY, own) == SINGULAR.code
    with pytest.raises(CodedError, match="decoupling matrix is singular at the start"):
        ran(GANTRY, own, FOLLOW, 0.1)


def test_a_gantry_without_damping_is_not_foretold_to_fall() -> None:
    for alpha in (-0.5, 0.0, 0.5, 0.9, 0.99):
        assert said(GANTRY, RodGantryParameters(alpha=alpha, pivot=0.0)) is None


@pytest.mark.parametrize("law", [n for n in laws_for(CART.name) if not LAWS[n].stabilizes])
def test_an_upright_pendulum_falls_and_a_hanging_one_does_not(law: str) -> None:
    for pendulum, code in (("hanging", None), ("upright", "forecast.unstable")):
        own = replace(CartParameters(speed=2.0), pendulum=pendulum)
        expected = code if LAWS[law].commands_acceleration else None
        assert said(CART, own, law) == expected
        log = ran(CART, own, law, 3.0)
        assert log.stopped_at is None
        moves = bool(np.ptp(log.fields["theta"]) > 0.5)
        fell = bool(np.abs(log.fields["q"][:, 2]).max() > 1.5)
        assert fell == (pendulum == "upright" and moves)


@pytest.mark.thorough
def test_of_a_law_that_stabilizes_the_pendulum_nothing_is_foretold() -> None:
    (law,) = (name for name in laws_for(CART.name) if LAWS[name].stabilizes)
    for pendulum in ("hanging", "upright"):
        own = replace(CartParameters(), pendulum=pendulum)
        assert said(CART, own, law) is None
        assert ran(CART, own, law, 3.0).stopped_at is None  # though it starts at a steep place


def test_a_pendulum_that_cannot_rest_where_it_starts_is_noticed() -> None:
    own = CartParameters()
    robot = CART.make(own)
    assert forecast(robot, FOLLOW, own, np.array([0.0, 0.0, 0.4])) == NO_REST


def test_robots_with_a_motor_for_every_coordinate_have_no_forecast() -> None:
    for entry in ROBOTS.values():
        robot = entry.make(entry.parameters())
        if robot.system.n == robot.system.m:
            q = robot.rest(robot.frame.lift(np.zeros(2)))
            assert forecast(robot, FOLLOW, entry.parameters(), q) is None


def test_what_is_foretold_of_the_flexible_link_is_its_critical_alpha() -> None:
    entry = ROBOTS["flexible"]
    link = entry.flexible_link
    assert link is not None
    for alpha in (0.5, 0.7, 0.8, 1.0):
        own = replace(entry.parameters(), output="redefined", alpha=alpha)
        robot = entry.make(own)
        q = robot.rest(robot.frame.lift(np.array([0.05, 0.0])))
        found = forecast(robot, FOLLOW, own, q)
        critical = link.critical_alpha(own, q[: link.joints])
        assert (found is not None) == (alpha > critical)
        assert forecast(robot, FOLLOW, replace(own, output="composite"), q) is None


@st.composite
def shapes(draw: st.DrawFn) -> Shape:
    """A chain of three or four links, with two or three motors."""
    count = draw(st.integers(3, 4))
    return Shape(
        joints=tuple(draw(st.permutations(range(count)))),
        motors=draw(st.integers(2, count - 1)),
        gravity=draw(st.sampled_from([0.0, 9.81])),
        start=tuple(draw(st.lists(st.floats(-2, 2), min_size=count, max_size=count))),
    )


@pytest.mark.thorough
@settings(deadline=None, max_examples=30)
@given(shapes(), st.sampled_from(CHAIN_LAWS))
def test_a_chain_with_passive_joints_runs_or_is_refused_in_words(shape: Shape, law: str) -> None:
    try:
        chain = passive_chain(shape)
        q = at_rest(chain)
    except ValueError:
        assume(False)
    own = Parameters(speed=1.0)
    entry = entry_of(chain)
    if not LAWS[law].suits(chain.system):
        with pytest.raises(CodedError, match="not possible with this robot"):
            ran(entry, own, law, 0.1)
        return
    found = forecast(chain, law, own, q)
    event(found.code if found else "nothing is foretold")
    if found == SINGULAR:
        with pytest.raises(CodedError, match="decoupling matrix is singular"):
            ran(entry, own, law, 0.1)
        return
    log = ran(entry, own, law, 0.5)
    assert log.stopped_at is None or log.reason
    assert log.t.size and np.isfinite(log.fields["q"]).all()
    steady = law == FOLLOW and chain.system.m == 2  # others may leave at once, for a far place
    if steady and rank_number(chain, own, q) > 0.05 and (growth_rate(chain, own, q) or 1) < -0.5:
        assert log.stopped_at is None
        assert np.abs(log.fields["q"] - q).max() < 1.0


# Behind an observer

SENSORS = {"encoder_counts": 2000.0, "sensor_noise": 1e-4}
UNMODELLED = [{"error_M22": 30.0}, {"payload": 0.1}, {"coulomb": 0.02}, {"delay": 0.3}]


def doubted(changes: dict[str, float], law: str = FOLLOW) -> bool:
    parameters = replace(ROBOTS["five_bar"].parameters(), **changes)
    return unmodelled(ROBOTS["five_bar"].make(parameters), (law,), parameters) is not None


@pytest.mark.parametrize("changes", UNMODELLED)
def test_what_an_observer_does_not_know_is_said_where_there_is_one(
    changes: dict[str, float],
) -> None:
    seen = {**changes, **SENSORS}
    assert doubted(seen)
    assert not doubted(changes) and not doubted(SENSORS)
    assert not doubted({**seen, "observer_time": 0.0})
    assert not doubted(seen, "trajectory_tracking")


# With a torque limit


@settings(deadline=None, max_examples=20)
@given(
    st.sampled_from(["two_link_arm", "spatial_arm", "cart_pendulum", "rod_gantry"]),
    st.floats(0.5, 1.5),
    st.floats(-np.pi, np.pi),
)
def test_it_is_said_where_holding_still_takes_most_of_the_torque_limit(
    name: str, ratio: float, theta: float
) -> None:
    """The torque of gravity is ∂V/∂q of the joints with motors, here by differences of energy."""
    entry, path = ROBOTS[name], circle(0.04)
    robot, own = entry.make(entry.parameters()), entry.parameters()
    q, energy = (
        robot.rest(robot.frame.lift(path.at(np.array(theta)))),
        robot.system.function("energy"),
    )
    still, plant, step = np.zeros(robot.system.n), robot.plant(own), 1e-6
    slopes = [
        float(energy(q + step * unit, still, plant) - energy(q - step * unit, still, plant))
        for unit in np.eye(robot.system.n)
    ]
    held = np.abs(slopes).max() / (2 * step)
    assume(abs(ratio - 1) > 0.02)
    limited = replace(own, torque_limit=float(ratio * held / SHARE))
    assert ratio > 1 or exhausted(robot, limited, path) is not None
    assert standing_torque(robot, own, path) >= held * (1 - 0.01)


def test_the_errors_of_the_sensors_count_and_nothing_is_said_without_a_limit() -> None:
    entry, path = ROBOTS["rod_gantry"], circle(0.04)
    exact = replace(entry.parameters(), torque_limit=7.0)
    assert exhausted(entry.make(exact), exact, path) is None
    coarse = replace(exact, **SENSORS)
    assert exhausted(entry.make(coarse), coarse, path) is not None
    free = replace(coarse, torque_limit=0.0)
    assert exhausted(entry.make(free), free, path) is None


def test_a_law_says_where_it_does_not_plan_its_speed() -> None:
    """Its plan is empty exactly there, if the torque is limited at all."""
    own = FIVE_BAR.parameters()
    for law, path, limit in product(laws_for(), (circle(0.05), star()), (0.0, 1.0)):
        limited, plan = replace(own, torque_limit=limit), LAWS[law].plan
        empty = plan is not None and not len(plan(FIVE_BAR.make(limited), limited, path))
        told = doubts(FIVE_BAR.make(limited), [law], limited, path)
        assert (UNPLANNED in told) == (empty and limit > 0), (law, limit)
