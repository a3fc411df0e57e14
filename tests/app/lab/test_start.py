"""Where and how a run starts: the same as in an experiment, kept with the set-up, or refused."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.setup import RobotSetup, Setup
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.setups.stored import from_data
from onpath.models.closed_loop.start import BOUNDS, ON_PATH, Start, nearest_start
from onpath.models.control.sides import SIDES
from onpath.models.paths.path_design import presets
from onpath.models.studies.experiments import experiments
from onpath.models.studies.experiments import run as run_experiment
from onpath.models.systems.catalogue import ROBOTS
from tests.support.lab import (
    FOLLOWER,
    TRACKER,
    assert_sound,
    do,
    new_lab,
    replayed,
    run,
    states,
    take_snapshot,
    y,
)

OFF = Start(theta=0.7, beside=-0.012, along=0.2, across=-0.1, clock_offset=0.4)


def at(start: Start, robot: str = "five_bar") -> Any:
    """A lab at that start."""
    lab = new_lab()
    do(lab, c.ChooseRobot(robot))
    values = {name: getattr(start, name) for name in BOUNDS}
    do(lab, *[c.Set(f"start_{name}", value) for name, value in values.items()], c.Reset())
    assert lab.message == "" and lab.simulation.start == start
    return lab


@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_it_starts_where_and_as_it_is_told(robot: str) -> None:
    lab = at(OFF, robot)
    simulation = lab.simulation
    curve, frame = simulation.editor.curve, simulation.robot.frame
    first = curve.at(np.array(0.7), 1)[:2]
    along = first / np.linalg.norm(first)
    left = np.array([-along[1], along[0]])
    for name, state in simulation.runs.items():
        z = frame.planar(y(simulation, name)) - curve.at(np.array(0.7))[:2]
        assert (z @ along, z @ left) == pytest.approx((0.0, -0.012), abs=1e-6)
        assert state.fields()["theta_ref"][0] == pytest.approx(0.7 + 0.4, abs=1e-3)
    before = {name: frame.planar(y(simulation, name)) for name in SIDES}
    simulation.simulate(1)
    if simulation.robot.system.n == simulation.robot.system.m:  # a beam bends at once
        for name, z in before.items():
            step = (frame.planar(y(simulation, name)) - z) / 1e-3
            assert (step @ along, step @ left) == pytest.approx((0.2, -0.1), abs=0.02)
    assert_sound(lab)


def test_it_is_the_start_of_an_experiment() -> None:
    """The same numbers, given to `onpath experiment`, give the same motion."""
    circle = presets()["circle"].curve
    z = OFF.place(circle)
    lab = at(OFF)
    run(lab, 0.5)
    mine = replayed(lab.simulation)
    values = {
        "start_z1": z[0],
        "start_z2": z[1],
        "start_along": 0.2,
        "start_across": -0.1,
        "clock_offset": 0.4,
        "hold_from": 0,
        "hold_to": 0,
        "duration": 0.4,
    }
    experiment = experiments()["obstruction"].with_values(values)
    for name, law in lab.simulation.laws.items():
        there = run_experiment(experiment, law)
        here = mine[name].fields["y"][: len(there.t)]
        assert np.abs(here - there.fields["y"]).max() < 1e-6, law


def test_on_the_path_with_velocity_along_it_the_follower_stays_on_it() -> None:
    """Invariance: whatever the velocity is, and wherever the clock."""
    for along in (-0.5, 0.2, 0.5):
        lab = at(Start(theta=1.0, along=along, clock_offset=1.0))
        run(lab, 1.0)
        assert lab.simulation.runs[FOLLOWER].max_distance < 2e-6
        assert lab.simulation.runs[TRACKER].max_distance > 5e-3


def test_a_new_lab_starts_as_ever() -> None:
    lab = new_lab()
    before = states(lab.simulation)
    do(lab, c.Set("start_beside", 0.02), c.Reset(), c.StartOnPath(), c.Reset())
    for name, state in states(lab.simulation).items():
        np.testing.assert_array_equal(state, before[name])


def test_it_takes_effect_at_reset_and_stays() -> None:
    lab = new_lab(0.3)
    before = states(lab.simulation)
    do(lab, c.Set("start_beside", 0.02))
    for name, state in states(lab.simulation).items():
        np.testing.assert_array_equal(state, before[name])
    for _ in range(2):
        do(lab, c.Reset())
        assert lab.simulation.runs[FOLLOWER].distance == pytest.approx(0.02, abs=1e-9)
    do(lab, c.ChooseRobot("two_link_arm"))
    assert lab.simulation.start == ON_PATH
    do(lab, c.ChooseRobot("five_bar"))
    assert lab.simulation.runs[FOLLOWER].distance == pytest.approx(0.02, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(sorted(presets())), st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
def test_a_drag_takes_it_to_the_mouse(name: str, z1: float, z2: float) -> None:
    """Beside an end of an open path it is as near as a normal there comes."""
    curve, z = presets()[name].curve, np.array([z1, z2])
    start = nearest_start(curve, z, OFF)
    assert (start.along, start.across, start.clock_offset) == (0.2, -0.1, 0.4)
    missed = float(np.linalg.norm(start.place(curve) - z))
    if curve.closed:
        assert missed < 2e-5
    else:
        assert missed <= curve.nearest(z[None])[1][0] + 1e-9


@pytest.mark.parametrize(
    "command",
    [
        c.Set("start_beside", -0.19),
        c.Set("start_beside", math.nan),
        c.Set("start_theta", 4.0),
        c.Set("start_along", math.inf),
        c.Set("start___class__", 0.0),
        c.Set("start_along", "fast"),  # type: ignore[arg-type]
        c.MoveStart(np.array([0.24, 0.1])),
        c.MoveStart(np.array([math.nan, 0.0])),
        c.MoveStart(np.zeros(5)),
    ],
    ids=repr,
)
def test_what_is_not_possible_is_refused_and_changes_nothing(command: c.Command) -> None:
    lab = new_lab(0.2)
    before, start = states(lab.simulation), lab.simulation.start
    do(lab, command)
    assert lab.message and lab.message_level == "warning"
    assert lab.simulation.start is start
    for name, state in states(lab.simulation).items():
        np.testing.assert_array_equal(state, before[name])


def test_a_start_that_another_path_puts_out_of_reach_is_refused_at_reset() -> None:
    lab = new_lab()
    do(lab, c.Set("start_beside", -0.09), c.Reset())  # 90 mm outside the circle, still in reach
    assert lab.message == "" and lab.simulation.runs[FOLLOWER].distance == pytest.approx(0.09)
    do(lab, c.ChoosePath("clover"))
    run(lab, 0.5)
    before = states(lab.simulation)
    do(lab, c.Reset())
    assert "cannot start there" in lab.message and lab.simulation.time == pytest.approx(
        0.5, abs=0.02
    )
    for name, state in states(lab.simulation).items():
        np.testing.assert_array_equal(state, before[name])
    setup = capture(lab.simulation)  # can be restored: without that start
    assert setup.robots["five_bar"].settings == {}
    restore(new_lab().simulation, setup)
    do(lab, c.ChooseRobot("two_link_arm"), c.ChooseRobot("five_bar"))
    assert lab.simulation.runs[FOLLOWER].distance < 1e-9


def test_set_ups_and_share_codes_carry_it_and_old_ones_start_as_ever() -> None:
    lab = at(OFF)
    setup = capture(lab.simulation)
    other = new_lab()
    restore(other.simulation, decode(encode(setup)))
    assert other.simulation.start == OFF and capture(other.simulation) == setup
    for name in SIDES:
        assert y(other.simulation, name) == pytest.approx(y(at(OFF).simulation, name), abs=1e-9)
    restore(other.simulation, from_data({"benches": {"five_bar": {"parameters": {"K1": 300.0}}}}))
    assert other.simulation.start == ON_PATH
    assert other.simulation.runs[FOLLOWER].distance < 1e-12


@pytest.mark.parametrize(
    "start",
    [
        {"start_beside": -0.19},
        {"start_theta": 9.0},
        {"start_up": 1.0},
        {"start_along": "x"},
        {"start_across": 1e300},
    ],
)
def test_a_set_up_with_an_impossible_start_is_refused_as_a_whole(start: dict[str, Any]) -> None:
    lab = new_lab(0.2)
    before = capture(lab.simulation), states(lab.simulation)
    with pytest.raises(ValueError):
        restore(
            lab.simulation, Setup(robots={"five_bar": RobotSetup({"K1": 100.0}, settings=start)})
        )
    assert capture(lab.simulation) == before[0]
    for name, state in states(lab.simulation).items():
        np.testing.assert_array_equal(state, before[1][name])


def test_it_is_drawn_where_it_is_and_follows_the_path() -> None:
    lab = at(OFF)
    for path in ("circle", "clover"):
        do(lab, c.ChoosePath(path))
        run(lab, 0.5)
        simulation = lab.simulation
        z = OFF.place(simulation.editor.curve)
        drawn = take_snapshot(lab, 1.0).start
        assert drawn[0] == pytest.approx(simulation.robot.position(simulation.robot.frame.lift(z)))
        assert np.linalg.norm(drawn[1] - drawn[0]) == pytest.approx(math.hypot(0.2, 0.1))
