"""A payload of the flexible robot in the lab: it is put on and taken off while the robot moves."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.models.control.sides import SIDES
from tests.support.lab import FOLLOWER, TRACKER, assert_sound, do, new_lab, replayed, run, states


def flexible_lab(seconds: float = 1.0) -> Lab:
    lab = new_lab()
    do(lab, c.ChooseRobot("flexible"))
    run(lab, seconds)
    return lab


@pytest.mark.thorough
def test_both_robots_go_on_from_where_they_are() -> None:
    lab = flexible_lab()
    simulation = lab.simulation
    before, runs, time, unloaded = (
        states(simulation),
        simulation.run_number,
        simulation.time,
        simulation.robot,
    )
    for payload in (0.02, 0.05, 0.0):
        do(lab, c.Set("payload", payload))
        assert (simulation.run_number, simulation.time) == (runs, time)
        for side, state in states(simulation).items():
            assert np.array_equal(state, before[side])
        assert (simulation.robot is unloaded) == (payload == 0)
    assert lab.message == ""


@pytest.mark.thorough
def test_the_tip_sags_under_the_load_and_comes_back() -> None:
    lab, distances = flexible_lab(2.0), list[float]()
    for payload in (0.0, 0.02, 0.0):
        do(lab, c.Set("payload", payload))
        run(lab, 2.0)
        distances.append(lab.simulation.runs[FOLLOWER].distance)
    assert distances[1] > 1e-3 > 5e-4 > max(distances[0], distances[2])
    assert_sound(lab)


@pytest.mark.thorough
def test_every_millisecond_of_loaded_and_unloaded_motion_is_replayed() -> None:
    lab = flexible_lab(0.7)
    ends = list[dict[str, np.ndarray]]()
    for payload in (0.02, 0.04, 0.0):
        do(lab, c.Set("payload", payload))
        run(lab, 0.5)
        ends.append({side: own.row.copy() for side, own in lab.simulation.runs.items()})
    for side, own in lab.simulation.runs.items():
        log = replayed(lab.simulation)[side]
        assert np.allclose(np.diff(log.t), 1e-3)
        shown = own.log.unpack(ends[-1][side])
        assert log.fields["y"][-1] == pytest.approx(shown["y"], abs=1e-12)
        assert np.abs(np.diff(log.fields["y"], axis=0)).max() < 1e-3  # [m] in a tick: no jump


@pytest.mark.thorough
def test_going_back_to_before_the_load_goes_on_with_it() -> None:
    lab = flexible_lab(1.0)
    do(lab, c.Set("payload", 0.02))
    run(lab, 1.0)
    do(lab, c.LookAt(1.5), c.GoOn())
    assert lab.simulation.time == pytest.approx(0.5, abs=0.05)
    run(lab, 0.5)
    assert_sound(lab)
    do(lab, c.Set("payload", 0.0), c.UndoGoOn())
    assert all(own.robot is lab.simulation.robot for own in lab.simulation.runs.values())
    do(lab, c.SetRunning(True))
    run(lab, 0.5)
    assert_sound(lab)
    assert set(replayed(lab.simulation)) == {FOLLOWER, TRACKER}


@pytest.mark.thorough
def test_a_typed_law_goes_on_too() -> None:
    lab = flexible_lab(0.2)
    do(lab, c.Set("output", "redefined"))
    for side in SIDES:
        do(lab, c.TypeLaw(side, "across = -K1*xi - K2*dxi; along = -K5*(dtheta - speed)"))
    run(lab, 0.5)
    time = lab.simulation.time
    do(lab, c.Set("payload", 0.02))
    run(lab, 0.3)
    assert lab.simulation.time == pytest.approx(time + 0.3, abs=0.02)
    assert_sound(lab)


@pytest.mark.parametrize(("name", "value"), [("modes", 2), ("plant", "unit_modes"), ("d", 0.45)])
def test_a_robot_with_other_states_begins_anew_and_the_user_is_told(
    name: str, value: int | str | float
) -> None:
    lab = flexible_lab(0.3)
    do(lab, c.Set(name, value))
    assert lab.simulation.time == 0 and "restarted" in lab.message


@pytest.mark.thorough
def test_a_load_with_another_number_of_modes_begins_anew() -> None:
    lab = flexible_lab(0.3)
    do(lab, c.Set("payload", 0.02), c.Set("modes", 2))
    assert lab.simulation.time == 0
    run(lab, 0.2)
    do(lab, c.ResetParameters())
    assert lab.simulation.time == 0 and "restarted" in lab.message
