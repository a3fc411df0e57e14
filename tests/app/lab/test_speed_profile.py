"""A speed profile in the lab: fed forward, kept, shared, replayed, and without anything built."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.restore import restore
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.setups.stored import from_data, to_data
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.vocabulary.setups import setup_faults
from onpath.models.closed_loop.profile_shapes import profile_of
from onpath.models.studies.experiments import experiments
from onpath.models.studies.experiments import run as run_experiment
from tests.support.lab import FOLLOWER, FRAME, TRACKER, do, new_lab, replayed, run, states

SHAPES = ["ramp_up", "sine", "stop_and_go"]


def lab_with(shape: str, seconds: float = 0.0, **parameters: Any) -> Lab:
    """A lab that has run from the start with a shape of period 1.3 s."""
    lab, values = new_lab(), {"speed_profile": shape, "profile_period": 1.3, **parameters}
    do(lab, *[c.Set(name, value) for name, value in values.items()], c.Reset())
    run(lab, seconds)
    return lab


def wanted(lab: Lab, count: int) -> np.ndarray:
    profile = profile_of(lab.simulation.parameters)
    assert profile is not None
    return np.array([profile.leg(tick, 1e-3).at(tick) for tick in range(count)])


@pytest.mark.parametrize("shape", SHAPES)
def test_both_robots_follow_the_profile_and_stay_on_the_path(shape: str) -> None:
    lab = lab_with(shape, 4.0)
    for log in replayed(lab.simulation).values():
        expected = wanted(lab, len(log.t))
        assert log.fields["speed_ref"][:, 0] == pytest.approx(expected, abs=1e-9)
        late = log.t > 1.5
        assert log.fields["theta_rate"][late, 0] == pytest.approx(expected[late], abs=0.05)
        assert log.distance[late].max() < 1e-4


def test_the_lab_and_the_command_line_compute_the_same() -> None:
    lab = lab_with("stop_and_go", 2.0)
    values = {"speed_profile": "stop_and_go", "profile_period": 1.3, "duration": 2.0}
    known = experiments()["obstruction"].with_values({**values, "hold_from": 0, "hold_to": 0})
    for side, law in ((FOLLOWER, "path_following"), (TRACKER, "trajectory_tracking")):
        here, there = replayed(lab.simulation)[side], run_experiment(known, law)
        count = len(here.t)
        assert here.fields["q"] == pytest.approx(there.fields["q"][:count], abs=1e-9)


def test_a_profile_is_the_same_however_its_time_is_cut_into_frames() -> None:
    coarse, fine = lab_with("sine"), lab_with("sine")
    coarse.simulation.simulate(1000)
    for _ in range(500):
        fine.simulation.simulate(2)
    for side, state in states(coarse.simulation).items():
        assert np.array_equal(state, states(fine.simulation)[side])


def test_the_history_replays_to_the_present_and_beyond_a_branch() -> None:
    lab = lab_with("sine", 3.0)
    before = replayed(lab.simulation)
    do(lab, c.LookAt(1.0), c.GoOn())
    at = round(lab.simulation.time / 1e-3)
    run(lab, 0.5)
    for side, log in replayed(lab.simulation).items():
        count = min(len(log.t), at + 400)
        expected = before[side].fields["theta"][:count]
        assert log.fields["theta"][:count] == pytest.approx(expected, abs=1e-9)


def test_the_slider_scales_the_profile_at_once_while_it_runs() -> None:
    lab = lab_with("sine", 2.0, speed=4.0)
    do(lab, c.Set("speed", 8.0))
    lab.simulation.simulate(1)
    reference = lab.simulation.runs[FOLLOWER].shown()["speed_ref"][0]
    assert reference == pytest.approx(wanted(lab, round(lab.simulation.time / 1e-3))[-1], rel=1e-9)


def test_without_a_profile_the_speed_is_that_of_the_slider_again() -> None:
    lab = lab_with("stop_and_go", 1.2)
    do(lab, c.Set("speed_profile", "constant"))
    run(lab, 1.0)
    shown = lab.simulation.runs[FOLLOWER].shown()
    assert shown["speed_ref"][0] == lab.simulation.parameters.speed
    assert shown["theta_rate"][0] == pytest.approx(lab.simulation.parameters.speed, abs=1e-2)


def test_a_profile_needs_no_other_loop() -> None:
    lab = lab_with("constant", 0.1)
    kinds = {side: run.kind for side, run in lab.simulation.runs.items()}
    loops = {side: run.loop() for side, run in lab.simulation.runs.items()}
    for shape in SHAPES:
        do(lab, c.Set("speed_profile", shape))
        run(lab, 4 * FRAME)
        for side, own in lab.simulation.runs.items():
            assert own.kind == kinds[side] and own.loop() is loops[side]


@pytest.mark.parametrize("shape", SHAPES)
def test_set_ups_and_share_codes_carry_it(shape: str) -> None:
    lab = lab_with(shape, 0.2)
    setup = capture(lab.simulation)
    assert decode(encode(setup)) == setup == from_data(to_data(setup))
    other = new_lab()
    restore(other.simulation, decode(encode(setup)))
    assert other.simulation.parameters == lab.simulation.parameters
    run(other, 0.5)
    assert wanted(lab, 600).std() > 0
    reference = other.simulation.runs[FOLLOWER].shown()["speed_ref"][0]
    assert reference == pytest.approx(wanted(lab, 1000)[round(other.simulation.time / 1e-3) - 1])


def test_a_lesson_may_set_it_and_nothing_else_by_that_name() -> None:
    good = StepSetup(set={"speed_profile": "sine", "profile_period": 3.0})
    assert list(setup_faults(good, "five_bar")) == []
    bad = StepSetup(set={"speed_profile": "zigzag"})
    assert list(setup_faults(bad, "five_bar"))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("speed_profile", "zigzag"),
        ("speed_profile", "__class__"),
        ("speed_profile", 3),
        ("speed_profile", None),
        ("profile_period", float("nan")),
        ("profile_period", 0.0),
        ("profile_period", -1.0),
        ("profile_period", 1e300),
        ("profile_period", "0:0, 1:1"),
    ],
)
def test_an_invalid_profile_is_refused_and_changes_nothing(name: str, value: Any) -> None:
    lab = lab_with("sine", 0.1)
    before = lab.simulation.parameters
    do(lab, c.Set(name, value))
    assert lab.simulation.parameters is before
    assert lab.message_level == "warning" and name in lab.message
    with pytest.raises(ValueError):
        from_data({"defaults": 2, "benches": {"five_bar": {"parameters": {name: value}}}})


def test_whoever_chooses_to_ramp_up_in_a_run_is_told_when_it_will() -> None:
    lab = new_lab(3.0)
    do(lab, c.Set("speed_profile", "ramp_up"))
    assert "start of a run" in lab.message
    do(lab, c.Reset())
    run(lab, 1.0)
    assert lab.simulation.runs[FOLLOWER].shown()["speed_ref"][0] == pytest.approx(np.pi, rel=0.01)
