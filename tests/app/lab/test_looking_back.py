"""No history is erased silently: only resuming discards it, and that can be undone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.lessons.course import read_course
from onpath.models.control.sides import RIGHT
from onpath.models.paths.distance import path_distance
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import FOLLOWER, assert_sound, do, loop_cache, new_lab, run, states, y
from tests.support.lesson_texts import write_lesson


@dataclass(frozen=True)
class Seen:
    """All that a lab has done, and where it stands, bit by bit."""

    time: float
    kept: dict[float, bytes]
    robots: tuple[bytes, ...]
    held: frozenset[str]
    events: tuple[object, ...]


def seen(lab: Lab) -> Seen:
    """What is to be kept. A segment is known by its time: those that wait may still grow."""
    kept = {
        segment.time: b"".join(
            [segment.sample.tobytes(), *(d.state.tobytes() for d in segment.drives.values())]
        )
        for segment in lab.simulation.history.all()
    }
    robots = tuple(
        run.state.tobytes()
        + run.row.tobytes()
        + np.array([run.distance, run.max_distance]).tobytes()
        for run in lab.simulation.runs.values()
    )
    held = frozenset(lab.simulation.forces.held)
    return Seen(lab.simulation.time, kept, robots, held, tuple(lab.simulation.events))


ACTIONS = [
    "run",
    "run",
    "back",
    "back",
    "forward",
    "present",
    "Run",
    "hold",
    "step",
    "go on",
    "undo",
]
COMMANDS: dict[str, c.Command] = {
    "back": c.LookBack(0.2),
    "forward": c.LookBack(-0.1),
    "present": c.LookAt(0.0),
    "Run": c.SetRunning(True),
    "hold": c.Hold(),
    "step": c.StepOnce(),
    "go on": c.GoOn(),
    "undo": c.UndoGoOn(),
}


@pytest.mark.thorough
@settings(max_examples=40, deadline=None)
@given(st.lists(st.sampled_from(ACTIONS), max_size=25))
@example(["run", "back", "Run", "run"])
@example(["run", "hold", "run", "back", "go on", "run", "undo", "undo", "hold", "back", "go on"])
def test_only_going_on_forgets_and_undo_brings_all_of_it_back(actions: list[str]) -> None:
    lab = new_lab(0.4)
    aside: Seen | None = None
    for action in actions:
        before, viewing = seen(lab), lab.simulation.viewing
        if action == "run":
            run(lab, 0.1)
        else:
            do(lab, COMMANDS[action])
        after = seen(lab)
        assert_sound(lab)
        if action == "undo" and aside is not None:
            assert after == aside
            assert lab.simulation.viewing is None and not lab.simulation.running
            aside = before
        elif action == "go on" and viewing is not None:
            assert lab.message and lab.simulation.undo_timeline is not None
            assert after.time <= viewing and after.kept == {
                time: bits for time, bits in before.kept.items() if time < after.time
            }
            aside = before
        else:
            assert after.kept.items() >= before.kept.items() and after.time >= before.time
            if action in ("back", "forward", "present", "Run"):
                assert after == before
            if action == "Run":
                assert lab.simulation.running and lab.simulation.viewing is None


def test_a_restored_lab_continues_as_if_nothing_had_happened() -> None:
    lab, twin = new_lab(), new_lab()
    for each in (lab, twin):
        do(each, c.Set("K3", 200), c.Set("encoder_counts", 4000))
        run(each, 0.5)
        do(each, c.Hold(True))
        run(each, 0.5)
    do(lab, c.LookAt(0.7), c.GoOn())
    assert not lab.simulation.forces.held
    run(lab, 0.3)
    do(lab, c.UndoGoOn())
    assert lab.simulation.forces.held == twin.simulation.forces.held != set()
    for each in (lab, twin):
        each.simulation.simulate(50)
        do(each, c.Hold(False))
        each.simulation.simulate(400)
    assert seen(lab) == seen(twin)


def test_a_robot_that_had_stopped_stands_still_again_after_undo() -> None:
    lab = new_lab(0.5)
    lab.simulation.runs[FOLLOWER].fields()["v"][:] = 500.0
    run(lab, 0.3)
    stopped = lab.simulation.runs[FOLLOWER].diverged
    assert stopped
    do(lab, c.LookAt(0.6), c.GoOn())
    assert lab.simulation.runs[FOLLOWER].diverged is None
    do(lab, c.UndoGoOn())
    assert lab.simulation.runs[FOLLOWER].diverged == stopped
    assert "Path following stopped" in lab.message


def test_what_was_set_meanwhile_stays_when_the_past_comes_back() -> None:
    lab = new_lab(0.6)
    end = y(lab.simulation, FOLLOWER)
    do(lab, c.LookAt(0.4), c.GoOn(), c.ChoosePath("segment"), c.Set("K1", 300))
    run(lab, 0.8)
    do(lab, c.UndoGoOn())
    assert lab.simulation.time == pytest.approx(0.6, abs=0.02)
    assert np.array_equal(y(lab.simulation, FOLLOWER), end)
    assert lab.simulation.parameters.K1 == 300 and not lab.simulation.editor.curve.closed
    do(lab, c.SetRunning(True))
    run(lab, 2.0)
    assert_sound(lab)
    assert all(run_.distance < 1e-3 for run_ in lab.simulation.runs.values())


@pytest.mark.parametrize("command", [c.Reset(), c.ChooseRobot("flexible")])
def test_a_new_beginning_leaves_nothing_to_bring_back(command: c.Command) -> None:
    lab = new_lab(0.5)
    do(lab, c.LookAt(0.3), c.GoOn(), command)
    before = states(lab.simulation)
    do(lab, c.UndoGoOn())
    assert lab.simulation.time == 0.0 and "Nothing" in lab.message
    assert all(
        np.array_equal(state, before[name]) for name, state in states(lab.simulation).items()
    )


def test_a_step_of_a_lesson_cannot_be_passed_by_bringing_back_what_came_before(
    tmp_path: Path,
) -> None:
    write_lesson(tmp_path)
    lab = Lab(loop_cache(), FIVE_BAR, read_course([tmp_path])[0])
    do(lab, c.OpenLesson("01-a"), c.SetRunning(True))
    run(lab, 0.5)
    do(lab, c.LookAt(0.3), c.GoOn())
    assert lab.simulation.undo_timeline is not None
    do(lab, c.GoToStep(1))
    assert lab.simulation.undo_timeline is None


def test_a_notice_goes_when_its_reason_does() -> None:
    lab = new_lab(1.0)
    tip = lab.simulation.runs[RIGHT].shown()["y"].copy()
    paused = lab.words("say.pull_paused")
    for end in (c.SetRunning(True), c.Release()):
        do(lab, c.SetRunning(False), c.Grab(RIGHT, tip))
        assert lab.notice[0] == paused
        run(lab, 0.5)
        assert lab.notice[0] == paused
        do(lab, end)
        assert lab.notice[0] == ""
        do(lab, c.SetRunning(True), c.Release())
    do(lab, c.LookBack(0.5))
    assert lab.notice[0] == lab.words("say.looking_back")
    do(lab, c.Reset())
    assert lab.notice[0] != lab.words("say.looking_back")


def test_acting_on_the_lab_while_looking_back_returns_to_the_present_and_says_so() -> None:
    for command in (c.Hold(True), c.MoveHand(0.01, 0.0), c.StepOnce(), c.ChoosePath("ellipse")):
        lab = new_lab(0.5)
        do(lab, c.LookAt(0.3))
        assert "the past" in lab.message
        do(lab, command)
        assert "present" in lab.message
    lab = new_lab(0.5)
    do(lab, c.MoveHand(0.01, 0.0), c.LookAt(0.3))
    assert "let go" in lab.message and not lab.simulation.forces.hands
    lab = new_lab(0.5)
    do(lab, c.LookAt(0.3), c.ChoosePath("figure of eight"))
    assert "crosses itself" in lab.message


def test_going_on_forgets_what_was_done_later_and_undo_brings_it_back() -> None:
    """Else a lesson's task could be passed by what never happened."""
    lab = new_lab(0.5)
    simulation = lab.simulation
    do(lab, c.Hold(True))
    run(lab, 0.5)
    do(lab, c.Hold(False))
    run(lab, 0.5)
    all_of_it = tuple(simulation.events)
    do(lab, c.LookBack(1.2), c.GoOn())
    later = [event for event in all_of_it if event.time > simulation.time]
    assert {event.name for event in later} >= {"hold", "let_go"}
    assert all(event.time <= simulation.time for event in simulation.events)
    do(lab, c.UndoGoOn())
    assert tuple(simulation.events) == all_of_it


@pytest.mark.parametrize("running", [True, False])
@pytest.mark.parametrize(
    "back", [c.LookAt(0.0), c.Hold(True), c.MovePoint(0, np.array([0.06, 0.0])), c.Reset()]
)
def test_in_the_present_time_runs_again_only_if_it_ran_before(
    back: c.Command, running: bool
) -> None:
    lab = new_lab(0.5)
    do(lab, c.SetRunning(running), c.LookAt(0.3), c.LookAt(0.2))
    assert not lab.simulation.running
    do(lab, back)
    assert lab.simulation.viewing is None and lab.simulation.running == running


def test_a_paused_lab_measures_the_distance_from_a_path_that_changes() -> None:
    lab = new_lab(0.5)
    simulation = lab.simulation
    do(lab, c.SetRunning(False))
    do(lab, *[c.MovePoint(i, 1.15 * each) for i, each in enumerate(simulation.editor.points())])
    run(lab, 3.0)
    for each in simulation.runs.values():
        y = each.shown()["y"][None]
        expected = path_distance(simulation.robot.frame, simulation.editor.curve, y)
        assert each.distance == pytest.approx(float(expected[0]), abs=1e-6)
    assert max(each.distance for each in simulation.runs.values()) > 1e-3
    before = simulation.runs["right"].distance
    do(lab, c.Grab("right", simulation.runs["right"].shown()["y"]))
    assert "paused" in lab.message
    assert simulation.runs["right"].distance == before
