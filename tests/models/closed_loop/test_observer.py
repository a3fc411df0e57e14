"""The observer behind encoders and noise (models/closed_loop/observer.py)."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from onpath.models.arrays import Array
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import InterpretedLoop
from onpath.models.closed_loop.simulation import (
    FREE,
    first_state,
    kernel_of,
    kind_of,
    settings_vector,
)
from onpath.models.control.laws.registry import LAWS
from onpath.models.paths.curves import Curve
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.parameters import Parameters
from onpath.models.systems.robots import Robot

BARELY = 1e-300
"""A noise that changes no reading, but calls for the observer."""
PATHS = tuple(presets())


def curve_of(path: str) -> Curve:
    return presets()[path].curve


@lru_cache(maxsize=4)
def interpreted(robot: Robot, kind: Kind) -> InterpretedLoop:
    return InterpretedLoop(kernel_of(robot, kind))


def moved(
    robot_name: str, law: str, path: str, ticks: int, parameters: Parameters
) -> dict[str, Array]:
    """The log of an untouched run from rest on the path."""
    robot, curve = ROBOTS[robot_name].make(parameters), curve_of(path)
    loop = interpreted(robot, kind_of(law, parameters, curve))
    begin = robot.rest(robot.frame.lift(curve.at(np.array(0.4))))
    state = first_state(robot, loop.layouts, curve, begin)
    own = settings_vector(robot, loop.layouts, parameters, curve, FREE)
    return loop.layouts.log.unpack(loop.run(state, own, curve.table(), ticks)[1])


@settings(max_examples=10)
@given(
    name=st.sampled_from(tuple(ROBOTS)),
    law=st.sampled_from(tuple(LAWS)),
    path=st.sampled_from(PATHS),
    rate=st.sampled_from((100, 250, 1000, 2000)),
    delay=st.sampled_from((0.0, 0.35, 2.0)),
    step=st.sampled_from((0.0, 0.01)),
    limit=st.sampled_from((0.0, 0.6)),
    time=st.floats(0.001, 0.05),
)
def test_with_an_exact_model_and_no_noise_no_torque_changes(
    name: str,
    law: str,
    path: str,
    rate: int,
    delay: float,
    step: float,
    limit: float,
    time: float,
) -> None:
    robot = ROBOTS[name]
    assume(LAWS[law].suits(robot.make(robot.parameters()).system))
    exact = replace(
        robot.parameters(), control_rate=rate, delay=delay, torque_step=step, torque_limit=limit
    )
    observed = replace(exact, sensor_noise=BARELY, observer_time=time)
    kind = kind_of(law, observed, curve_of(path))
    assert kind.observer and not kind_of(law, exact, curve_of(path)).observer
    one, other = (moved(name, law, path, 60, each) for each in (exact, observed))
    largest = np.abs(one["u"]).max() + 1
    assert np.abs(one["u"] - other["u"]).max() < 1e-9 * largest
