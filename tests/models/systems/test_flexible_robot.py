"""Laws of the flexible five-bar as a robot of the lab: where it is drawn, when it is stopped."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from onpath.models.arrays import Array
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    Push,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.closed_loop.translated_loop import translate_loop
from onpath.models.paths.curves import circle
from onpath.models.systems.beam import beam_modes
from onpath.models.systems.catalogue import FLEXIBLE, ROBOTS
from onpath.models.systems.five_bar_parameters import FiveBarParameters
from onpath.models.systems.flexible_robot import (
    BENT,
    LINKS,
    MOST_BENT,
    UNSTABLE,
    FlexibleParameters,
    flexible_five_bar_robot,
    robot_for,
    start_of,
)
from tests.support.drawing import drawn

ROBOT, DEFAULTS = flexible_five_bar_robot(), FlexibleParameters(output="redefined")
START, TIP = start_of(), beam_modes(3, LINKS.beam).tip
SEEDS = range(6)


def pose(seed: int) -> Array:
    rng = np.random.default_rng(seed)
    joints = [np.pi / 2, np.pi, 0.0] + 0.4 * rng.normal(size=3)
    return np.concatenate([joints, 0.01 * rng.normal(size=3)])


# Where it is --------------------------------------------------------------------------------------


def test_one_instance_for_each_number_of_modes_and_plant() -> None:
    assert robot_for(replace(DEFAULTS, alpha=0.1, rho=0.5)) is ROBOT
    others = {
        robot_for(replace(DEFAULTS, modes=m, plant=p))
        for m in (1, 3)
        for p in ("lagrangian", "unit_modes")
    }
    assert len(others) == 4 and ROBOT in others
    assert ROBOTS["flexible"] is FLEXIBLE and FLEXIBLE.make(DEFAULTS) is ROBOT
    with pytest.raises(TypeError, match="FiveBarParameters"):
        ROBOT.plant(FiveBarParameters())


def test_rest_puts_the_straight_link_s_tip_where_asked() -> None:
    rng = np.random.default_rng(0)
    y = ROBOT.frame.lift(0.1 * rng.uniform(-1, 1, size=(20, 2)))
    q = ROBOT.rest(y)
    assert ROBOT.endpoint(q) == pytest.approx(y, abs=1e-12)
    assert np.array_equal(q[:, 3:], np.zeros((20, 3)))
    assert ROBOT.rest(ROBOT.endpoint(START)) == pytest.approx(START, abs=1e-12)
    with pytest.raises(ValueError, match="out of reach"):
        ROBOT.rest(np.array([1.0, 0.0, 0.0]))


def test_drawing_is_a_rigid_motion_that_keeps_up_and_turns_the_path_to_the_viewer() -> None:
    rng = np.random.default_rng(1)
    y = rng.normal(size=(4, 3))
    placed = ROBOT.position(y)
    assert ROBOT.output_at(placed) == pytest.approx(y, abs=1e-15)
    axes = placed[1:] - placed[0]
    assert axes @ axes.T == pytest.approx((y[1:] - y[0]) @ (y[1:] - y[0]).T)
    assert np.sign(np.linalg.det(axes)) == np.sign(np.linalg.det(y[1:] - y[0]))
    corners = ROBOT.position(ROBOT.frame.lift(np.array([[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]])))
    right, up = corners[1] - corners[0], corners[2] - corners[0]
    assert up == pytest.approx([0, 0, 0.1])
    assert right[0] == pytest.approx(0.1) and abs(right[1]) < 0.02
    assert corners[0, 1] < 0  # in front of the waist, seen from negative y


def test_bars_hang_together_from_the_base_to_the_tip() -> None:
    for seed in SEEDS:
        q = pose(seed)
        bars, joints = drawn(ROBOT.skeleton, q, 1.0)
        assert bars[0, 0] == pytest.approx(joints[0]) and bars[1, 0] == pytest.approx(joints[0])
        assert bars[0, 1] == pytest.approx(joints[1]) and bars[1, 1] == pytest.approx(joints[2])
        assert np.array_equal(bars[2], joints[[2, 3]]) and np.array_equal(bars[3], joints[[3, 1]])
        chain = bars[3:]
        assert chain[1:, 0] == pytest.approx(chain[:-1, 1], abs=1e-15)
        assert chain[-1, 1] == pytest.approx(ROBOT.position(ROBOT.endpoint(q)), abs=1e-12)
        assert joints[1] - joints[0] == pytest.approx(joints[3] - joints[2], abs=1e-12)


def test_exaggeration_stretches_the_deflection_and_nothing_else() -> None:
    q = pose(3)
    straight, bent, more = (drawn(ROBOT.skeleton, q, k)[0] for k in (0.0, 1.0, 5.0))
    assert more - straight == pytest.approx(5 * (bent - straight), abs=1e-12)
    rigid = np.concatenate([q[:3], np.zeros(3)])
    assert straight[-1, 1] == pytest.approx(ROBOT.position(ROBOT.endpoint(rigid)), abs=1e-12)
    gap = np.linalg.norm(bent[-1, 1] - straight[-1, 1])
    assert gap == pytest.approx(abs(q[3:] @ TIP))


def test_margin_falls_to_zero_at_the_rim_and_is_one_at_home() -> None:
    z = np.array([[0.0, 0.0], [0.0, 0.2], [0.0, 0.28], [0.0, 0.32], [0.0, 0.3244], [0.0, 0.33]])
    margin = ROBOT.margin(z)
    assert margin[0] == pytest.approx(1.0)
    assert np.all(np.diff(margin) < 0) and margin[-2] < 0.05 and margin[-1] == 0


# When it is stopped -------------------------------------------------------------------------------


def test_a_bent_link_is_caught_and_the_reason_is_the_right_one() -> None:
    q, v = np.tile(START, (5, 1)), np.zeros((5, 6))
    assert ROBOT.fault(q, v, DEFAULTS) is None
    q[3:, 3] = 1.01 * MOST_BENT * LINKS.beam / TIP[0]
    assert ROBOT.fault(q, v, DEFAULTS) == (3, BENT)
    assert ROBOT.fault(q, v, replace(DEFAULTS, alpha=1.0)) == (3, UNSTABLE)
    q[2, 4] = np.nan
    found = ROBOT.fault(q, v, DEFAULTS)
    assert found is not None and found[0] == 2 and "range" in str(found[1])


@pytest.mark.parametrize("alpha", [0.3, 0.9])
def test_energy_inside_is_the_model_s_without_motion_of_the_joints(alpha: float) -> None:
    own = replace(DEFAULTS, alpha=alpha, rho=0.3, frequency=5.0)
    q, v = pose(2), np.concatenate([np.zeros(3), [0.1, -0.2, 0.3]])
    energy = float(ROBOT.system.function("energy")(q, v, ROBOT.plant(own)))
    assert ROBOT.measured(q, v, own)["internal_energy"][0] == pytest.approx(energy)


def test_the_controller_s_model_is_wrong_where_asked_and_only_there() -> None:
    assert np.array_equal(ROBOT.model(DEFAULTS), ROBOT.plant(DEFAULTS))
    names = ROBOT.system.parameter_names
    for name in ("M11", "M22", "J0", "rho", "omega1"):
        own = replace(DEFAULTS, **{f"error_{name}": 20.0})
        ratio = ROBOT.model(own) / np.where(ROBOT.plant(own) == 0, 1, ROBOT.plant(own))
        assert [names[i] for i in np.flatnonzero(np.abs(ratio - 1.2) < 1e-12)] == [name]
        assert np.array_equal(ROBOT.plant(own), ROBOT.plant(DEFAULTS))


# How it runs --------------------------------------------------------------------------------------


@pytest.mark.thorough
@pytest.mark.parametrize("law", ["path_following", "trajectory_tracking"])
@pytest.mark.parametrize("modes, plant", [(1, "unit_modes"), (3, "lagrangian"), (6, "lagrangian")])
def test_compiled_and_interpreted_loops_agree(law: str, modes: int, plant: str) -> None:
    curve = circle(0.05)
    own = replace(DEFAULTS, modes=modes, plant=plant)
    robot = robot_for(own)
    push = Push(hand=np.array([0.5, 0.06, 0.02]))
    kernel = kernel_of(robot, kind_of(law, own, curve, push))
    state = first_state(robot, kernel, curve, start_of(modes))
    interpreted, compiled = (
        loop.run(state, settings_vector(robot, kernel, own, curve, push), curve.table(), 1000)[1]
        for loop in (InterpretedLoop(kernel), translate_loop(kernel))
    )
    assert np.array_equal(interpreted, compiled, equal_nan=True)
    fields = kernel.log.unpack(interpreted[np.isfinite(interpreted).all(axis=1)])
    assert len(fields["y"]) == 1000 or modes == 6  # six modes diverge under the hand
    assert np.ptp(fields["y"][:, 1]) > 0.02 and np.abs(fields["force"]).max() > 0.9


def pulled(alpha: float) -> tuple[Array, Array]:
    """(q, v) while a hand pulls the tip of the resting robot along the path, and after."""
    own, curve = replace(DEFAULTS, speed=0.0, alpha=alpha), circle(0.05)
    start = ROBOT.rest(ROBOT.frame.lift(curve.at(np.array(np.pi / 2))))
    kernel = kernel_of(ROBOT, kind_of("path_following", own, curve))
    loop, state = InterpretedLoop(kernel), first_state(ROBOT, kernel, curve, start)
    aside, parts = ROBOT.endpoint(start) + np.array([0.0, 0.02, 0.0]), list[Array]()
    for push, ticks in ((Push(hand=aside), 500), (FREE, 4000)):
        settings = settings_vector(ROBOT, kernel, own, curve, push)
        state, rows = loop.run(state, settings, curve.table(), ticks)
        parts.append(rows)
    fields = kernel.log.unpack(np.concatenate(parts))
    return fields["q"], fields["v"]


def test_a_pull_across_the_link_bends_it_and_letting_go_lets_it_ring_down() -> None:
    own = replace(DEFAULTS, alpha=0.2)
    q, v = pulled(own.alpha)
    assert ROBOT.fault(q, v, own) is None
    found = ROBOT.measured(q, v, own)
    assert np.abs(found["deflection"][:500]).max() > 5e-3
    energy = found["internal_energy"][500::500, 0]
    assert energy[-1] < 0.2 * energy[0]


def test_a_firm_grip_on_the_tip_is_more_than_half_of_the_deflection_can_bear() -> None:
    """The force enters at the tip, the controller looks elsewhere: the grip feeds the modes."""
    fault = ROBOT.fault(*pulled(0.5), DEFAULTS)
    assert fault is not None and fault[1] == BENT
