"""When a robot has stopped: its last moments slowly, and the settings that did well."""

from __future__ import annotations

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.app.lab.breakdown import LARGER, LASTS, RESTS, SPAN
from onpath.app.lab.commands import Freeze
from onpath.app.lab.lab import Lab
from onpath.models.paths.distance import near_distance
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.robots import RobotEntry
from tests.support.cases import drawn
from tests.support.lab import FRAME, do, new_lab, run, take_snapshot


@pytest.fixture
def blown_up() -> Lab:
    """The flexible robot, whose actual tip has become the output after a while."""
    lab = new_lab()
    do(lab, c.ChooseRobot("flexible"), c.Set("output", "redefined"))
    run(lab, 1.5)
    do(lab, c.Set("alpha", 1.0))
    run(lab, 0.5)
    assert any(each.diverged for each in lab.simulation.runs.values())
    return lab


@pytest.mark.thorough
def test_the_last_moments_are_shown_slowly_and_larger(blown_up: Lab) -> None:
    lab, simulation = blown_up, blown_up.simulation
    fault = max(run.diverged.time for run in simulation.runs.values() if run.diverged)
    said = lab.message
    do(lab, c.ReplayBreakdown())
    times, ends, notes = [], [], set[str]()
    while lab.breakdown.replaying and len(times) < 1000:
        shown = take_snapshot(lab, 1.0)
        times.append(shown.time)
        ends.append(shown.robots["right"].end)
        notes.add(shown.note)
        assert f"bending is drawn {LARGER:g} times as large" in lab.message
        run(lab, FRAME)
    assert times == sorted(times) and fault - SPAN - 1e-9 <= times[0] < times[-1]
    assert times[-1] == pytest.approx(fault, abs=2e-3)
    assert len(times) == pytest.approx((LASTS + RESTS) / FRAME, abs=3)
    assert len({end.tobytes() for end in ends}) > 5  # not only the beginnings of frames
    assert np.isfinite(ends).all()
    assert any(f"{LARGER:g}" in note for note in notes)
    assert simulation.settings.larger == 1.0 and simulation.viewing is None
    assert lab.message == said


@pytest.mark.parametrize(
    "entry",
    drawn([e for e in ROBOTS.values() if not e.flexible_link], 2),
    ids=lambda entry: entry.name,
)
def test_of_a_rigid_robot_it_says_nothing_of_bending(entry: RobotEntry) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot(entry.name), c.Set("control_rate", 50))
    do(lab, c.Set("K1", 2500.0), c.Set("K2", 200.0))
    for _ in range(40):
        run(lab, 0.25)
        if any(each.diverged for each in lab.simulation.runs.values()):
            break
    do(lab, c.ReplayBreakdown())
    assert lab.breakdown.replaying and lab.simulation.settings.larger == 1.0
    assert "Its last moments, slowly." in lab.message and "bending" not in lab.message


def test_any_action_of_the_user_ends_it_and_time_runs(blown_up: Lab) -> None:
    lab, simulation = blown_up, blown_up.simulation
    said, running = lab.message, simulation.running
    for command, then in (
        (c.SelectPoint(None), running),
        (c.SetRunning(), not running),
        (c.Set("K1", 300.0), running),
    ):
        simulation.running = running
        do(lab, c.ReplayBreakdown())
        run(lab, 0.5)
        assert lab.message.startswith(said.partition(". Reset")[0])  # which robot, and why
        assert lab.message_level == "replay"
        do(lab, command)
        assert not lab.breakdown.replaying and simulation.settings.larger == 1.0
        assert simulation.viewing is None and simulation.running is then
        assert lab.message == said and lab.message_level == "error"
    simulation.running = True
    do(lab, c.ReplayBreakdown(), c.Reset())
    assert not lab.breakdown.replaying and simulation.running and lab.message == ""


def test_a_teacher_who_freezes_the_lab_stops_it_too(blown_up: Lab) -> None:
    do(blown_up, c.ReplayBreakdown())
    run(blown_up, 0.5)
    shown = take_snapshot(blown_up, 1.0).time
    do(blown_up, Freeze(True))
    run(blown_up, 0.5)
    assert take_snapshot(blown_up, 1.0).time == shown


def test_time_runs_afterwards_as_before(blown_up: Lab) -> None:
    for running in (True, False):
        blown_up.simulation.running = running
        do(blown_up, c.ReplayBreakdown())
        assert not blown_up.simulation.running
        run(blown_up, LASTS + RESTS + 0.1)
        assert not blown_up.breakdown.replaying and blown_up.simulation.running is running


def test_the_message_names_the_robot_that_stopped_last(blown_up: Lab) -> None:
    last = max(r.diverged.time for r in blown_up.simulation.runs.values() if r.diverged)
    assert f"{last:.2f} s" in blown_up.message
    said = blown_up.message
    blown_up.clear_message()
    assert blown_up.message == said


def test_looking_elsewhere_ends_it(blown_up: Lab) -> None:
    do(blown_up, c.ReplayBreakdown())
    run(blown_up, 0.5)
    do(blown_up, c.LookAt(0.02))
    run(blown_up, 0.1)
    simulation = blown_up.simulation
    assert not blown_up.breakdown.replaying and simulation.settings.larger == 1.0
    assert simulation.viewing == pytest.approx(simulation.time - 0.02)


def test_the_last_stable_settings_are_offered_and_applied(blown_up: Lab) -> None:
    assert take_snapshot(blown_up, 1.0).remedy == {"alpha": 0.5}
    do(blown_up, c.UseEarlierSettings())
    run(blown_up, 1.0)
    simulation = blown_up.simulation
    assert take_snapshot(blown_up, 1.0).parameters["alpha"] == 0.5 and simulation.running
    assert not any(each.diverged for each in simulation.runs.values())
    assert take_snapshot(blown_up, 1.0).remedy == {}


def test_without_a_stopped_robot_there_are_no_earlier_settings_to_go_back_to() -> None:
    lab = new_lab(0.1)
    do(lab, c.UseEarlierSettings())
    assert lab.message and lab.message_level == "warning"


def test_a_replay_that_is_asked_for_after_a_reset_is_not_shown(blown_up: Lab) -> None:
    """The page sends it by itself, perhaps too late; the user sees no message."""
    do(blown_up, c.Reset(), c.ReplayBreakdown())
    assert not blown_up.message and not blown_up.breakdown.replaying
    assert blown_up.simulation.viewing is None


def test_the_distance_of_a_stopped_robot_is_that_of_its_pose(blown_up: Lab) -> None:
    """In the readout as in the plot, and also as the largest one."""
    simulation = blown_up.simulation
    column = simulation.sample_layout.slices["distance"].start
    _, samples = simulation.history.samples(0.0, simulation.time, 1000)
    stopped = [(i, each) for i, each in enumerate(simulation.runs.values()) if each.diverged]
    assert stopped
    for place, each in stopped:
        y, theta = each.shown()["y"], each.shown()["theta"]
        far = near_distance(simulation.robot.frame, simulation.editor.curve, y[None], theta)
        assert each.distance == pytest.approx(float(far[0]))
        assert each.max_distance >= each.distance
        assert samples[-1, place, column] == pytest.approx(each.distance, rel=1e-6)
