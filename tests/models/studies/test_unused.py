"""What is said to have no effect has none, and what is not said has one: found by running."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import changed, specs, value_of
from onpath.models.paths.curves import circle
from onpath.models.studies.experiments import Experiment, on_path, run
from onpath.models.studies.unused import unused, unused_text
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters

START = {"duration": 0.3, "start_along": 0.1, "start_across": 0.05}
HOLD = {"hold_from": 0.05, "hold_to": 0.15, "hold_direction": "both"}
PUSH = {"push_from": 0.2, "push_to": 0.25, "push_z1": 0.07}
SWITCHES: tuple[dict[str, Any], ...] = (
    *({}, {"task": "position"}, {"speed_profile": "sine"}, {"ramp": 5.0}),
    *({"encoder_counts": 2000.0}, {"sensor_noise": 1e-4}, {"tracker_integral": "on"}),
)
MAY_BE_IDLE = ("across", "at_limit", "torque_limit", "stiction")
"""A run may be the same though they select another loop: under a law that follows a clock, if no
torque is as large as the limit, or if each is larger than static friction where a joint rests."""


def experiment(parameters: Parameters, robot: str) -> Experiment:
    return on_path(ROBOTS[robot], parameters, circle(0.05)).with_values({**START, **HOLD, **PUSH})


def moved(parameters: Parameters, robot: str, law: str, **schedule: Any) -> np.ndarray:
    whole = experiment(parameters, robot).with_values(schedule)
    return run(whole, law).fields["q"]


def laws_for(robot: str, parameters: Parameters) -> list[str]:
    system = ROBOTS[robot].make(parameters).system
    composite = getattr(parameters, "output", "") == "composite"
    suit = [law for law in LAWS.values() if law.suits(system)]
    return [law.name for law in suit if law.commands_acceleration or not composite]


@st.composite
def cases(draw: st.DrawFn) -> tuple[str, str, Parameters, str]:
    robot = draw(st.sampled_from(list(ROBOTS)))
    own = {"target": 0.02, **draw(st.sampled_from(SWITCHES))}  # a place that is reached soon
    if "output" in specs(ROBOTS[robot].parameters):
        own["output"] = draw(st.sampled_from(["composite", "redefined"]))
    parameters = ROBOTS[robot].parameters(**own)
    law = draw(st.sampled_from(laws_for(robot, parameters)))
    return robot, law, parameters, draw(st.sampled_from(list(specs(parameters))))


@pytest.mark.thorough
@settings(max_examples=40)
@given(cases(), st.randoms(use_true_random=False))
def test_what_has_no_effect_is_named_and_nothing_else(
    case: tuple[str, str, Parameters, str], random: Any
) -> None:
    robot, law, parameters, name = case
    said = unused(experiment(parameters, robot), law, [name]) == [name]
    spec, own = specs(parameters)[name], value_of(parameters, name)
    values = list(spec.options) or [spec.low, spec.high, random.uniform(spec.low, spec.high)]
    usual = moved(parameters, robot, law)
    same = []
    for value in values:
        other = changed(parameters, name, value)
        if value == own or law not in laws_for(robot, other):
            continue
        after = moved(other, robot, law)
        same.append(after.shape == usual.shape and np.array_equal(after, usual))
    if said:
        assert all(same)
    else:
        assert name in MAY_BE_IDLE or not all(same)


@pytest.mark.parametrize(
    ("law", "name", "schedule"),
    [
        ("path_following", "clock_offset", {"clock_offset": 0.5}),
        ("trajectory_tracking", "clock_offset", {"clock_offset": 0.5}),
        ("set_point", "profile", {"profile": "0:0,0.2:6"}),
        ("path_following", "profile", {"profile": "0:0,0.2:6"}),
    ],
)
def test_the_schedule_too(law: str, name: str, schedule: dict[str, Any]) -> None:
    parameters = ROBOTS["five_bar"].parameters()
    whole = experiment(parameters, "five_bar").with_values(schedule)
    usual = moved(parameters, "five_bar", law)
    same = np.array_equal(moved(parameters, "five_bar", law, **schedule), usual)
    assert unused(whole, law, [name]) == ([name] if same else [])


def test_a_value_that_one_of_the_laws_uses_is_used() -> None:
    whole = experiment(ROBOTS["five_bar"].parameters(), "five_bar")
    laws = ["trajectory_tracking", "path_following"]
    assert unused_text(whole, laws, ["K5", "hold_from"]) == ""
    told = unused_text(whole, laws, ["K5", "K4", "clock_gain"])
    assert told == "no effect under trajectory tracking, path following: K4, clock_gain"
