"""A lab recovers from every state, and both robots receive the same inputs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.lab import MOST_COMMANDS, Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.app.storage.lab_state import _now, _state, put_back
from onpath.lessons.action_schema import Action
from onpath.lessons.course import Course, read_course
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.closed_loop.loop_vectors import loop_layouts
from onpath.models.closed_loop.simulation import FREE, kernel_of, kind_of, settings_vector
from onpath.models.control.laws.own import PATH_FOLLOWING
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.settable import changed, specs
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, SIDES
from onpath.models.paths.curve_faults import curve_faults
from onpath.models.paths.path_design import presets
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support.lab import (
    FOLLOWER,
    FRAME,
    TRACKER,
    assert_drawable,
    assert_sound,
    do,
    loop_cache,
    new_lab,
    run,
    states,
    y,
)
from tests.support.lesson_texts import write_lesson

SOME_SIDES = st.sampled_from([*SIDES, "", "nobody"])
WILD = st.one_of(
    st.floats(-0.5, 0.5),
    st.sampled_from([float("nan"), float("inf"), -1e300, 1e300, 10**400, 0, -0.0]),
)
INDICES = st.one_of(st.none(), st.integers(-3, 30))


def points(most: int) -> st.SearchStrategy[np.ndarray]:
    """Arrays of points, mostly of the right shape."""
    size = st.sampled_from([2, 2, 2, 2, 3, 0])
    values = st.one_of(st.floats(-0.1, 0.5), st.sampled_from([np.nan, np.inf, 1e300]))
    row = size.flatmap(lambda n: st.lists(values, min_size=n, max_size=n))
    if most == 1:
        return row.map(np.array)
    return st.lists(st.lists(values, min_size=2, max_size=2), max_size=most).map(
        lambda rows: np.array(rows).reshape(-1, 2)
    )


def circles() -> st.SearchStrategy[np.ndarray]:
    """Strokes that a hand could draw: rings anywhere, either way round, whole or in part."""

    middle = new_lab().simulation.robot.output_at(np.array([0.2, 0.0, 0.2]))

    def stroke(radius: float, x: float, phase: float, turn: float) -> np.ndarray:
        a = phase + turn * np.linspace(0, 2 * np.pi, 40)
        return middle + np.stack([x + radius * np.cos(a), radius * np.sin(a)], axis=1)

    return st.builds(
        stroke, st.floats(0, 0.2), st.floats(-0.1, 0.1), st.floats(-4, 4), st.floats(-1.1, 1.1)
    )


def parameter_values() -> st.SearchStrategy[c.Set]:
    def values(name: str) -> st.SearchStrategy[Any]:
        own = SETTINGS[name].spec if name in SETTINGS else None
        spec = own or specs(new_lab().simulation.parameters).get(name)
        if spec is None or spec.options:
            good = st.sampled_from(spec.options if spec else (1,))
        else:
            good = st.floats(spec.low, spec.high)
        return st.one_of(good, good, WILD, st.sampled_from(["", "x", None, "1e9", [1, 2]]))

    names = st.sampled_from([*specs(new_lab().simulation.parameters), *SETTINGS, "K6", ""])
    return names.flatmap(lambda name: values(name).map(lambda v: c.Set(name, v)))


TYPED = [PATH_FOLLOWING, "across = e1; along = sqrt(1 - t)", "u1 = 0.01*t; u2 = 0", "xi", ""]
LESSON_COMMANDS: dict[type, st.SearchStrategy[Any]] = {
    c.OpenLesson: st.builds(c.OpenLesson, st.sampled_from(["", "hexapod"])),
    c.FollowRoute: st.builds(c.FollowRoute, st.sampled_from(["", "1-lab-90-minutes"])),
    c.CloseLesson: st.builds(c.CloseLesson),
    c.FinishLesson: st.builds(c.FinishLesson),
    c.GoToStep: st.builds(c.GoToStep, st.integers(-3, 3)),
    c.Predict: st.builds(
        c.Predict,
        st.one_of(st.none(), INDICES),
        st.just((0.0, 1.0)),
        st.tuples(WILD, WILD),
        st.sampled_from(["", "fairly", "x"]),
        st.one_of(st.none(), INDICES),
        st.text(),
    ),
    c.PlayStep: st.builds(c.PlayStep),
    c.BeginStepAnew: st.builds(c.BeginStepAnew),
    c.ShowHint: st.builds(c.ShowHint, st.just("")),
    c.AnswerQuiz: st.builds(c.AnswerQuiz, INDICES, INDICES),
    c.AnswerNumber: st.builds(c.AnswerNumber, INDICES, st.floats()),
    c.AnswerInWords: st.builds(c.AnswerInWords, INDICES, st.text()),
    c.Act: st.builds(c.Act, st.just((Action(hold=True), Action(pull=(20.0, -400.0))))),
    c.SetLanguage: st.builds(c.SetLanguage, st.sampled_from(["de", "en", "../en", ""])),
}
COMMANDS: dict[type, st.SearchStrategy[Any]] = {
    **LESSON_COMMANDS,
    c.Set: parameter_values(),
    c.ResetParameters: st.builds(c.ResetParameters),
    c.Identify: st.builds(c.Identify),
    c.ChooseRobot: st.builds(c.ChooseRobot, st.sampled_from(["five_bar", "", "hexapod"])),
    c.SetRunning: st.builds(c.SetRunning, st.sampled_from([None, True, True, False])),
    c.StepOnce: st.builds(c.StepOnce),
    c.Reset: st.builds(c.Reset),
    c.RemoveLog: st.builds(c.RemoveLog),
    c.LookAt: st.builds(c.LookAt, st.one_of(st.floats(-1, 5), WILD)),
    c.LookBack: st.builds(c.LookBack, st.one_of(st.floats(-1, 5), WILD)),
    c.GoOn: st.builds(c.GoOn),
    c.UndoGoOn: st.builds(c.UndoGoOn),
    c.Hold: st.builds(
        c.Hold, st.sampled_from([None, True, False]), st.one_of(st.none(), SOME_SIDES)
    ),
    c.Grab: st.builds(c.Grab, SOME_SIDES, points(1)),
    c.Release: st.builds(c.Release, st.one_of(st.none(), SOME_SIDES)),
    c.Pulse: st.builds(c.Pulse),
    c.MoveHand: st.builds(c.MoveHand, WILD, WILD),
    c.ChooseLaw: st.builds(
        c.ChooseLaw, SOME_SIDES, st.sampled_from([*LAWS, "", "no_law", "path following"])
    ),
    c.TypeLaw: st.builds(c.TypeLaw, SOME_SIDES, st.sampled_from(TYPED)),
    c.MoveWall: st.builds(c.MoveWall, points(1)),
    c.SwingWall: st.builds(c.SwingWall, st.integers(-2, 2), points(1)),
    c.NudgeWall: st.builds(c.NudgeWall, WILD, WILD, WILD),
    c.MoveStart: st.builds(c.MoveStart, points(1)),
    c.DragJoint: st.builds(c.DragJoint, INDICES, points(1)),
    c.StartOnPath: st.builds(c.StartOnPath),
    c.ChoosePath: st.builds(
        c.ChoosePath, st.sampled_from([*new_lab().simulation.presets, "", "hexagon"])
    ),
    c.SelectPoint: st.builds(c.SelectPoint, INDICES),
    c.MovePoint: st.builds(c.MovePoint, st.integers(-3, 30), points(1), st.booleans()),
    c.EndMove: st.builds(c.EndMove),
    c.SelectNext: st.builds(c.SelectNext),
    c.NudgePoint: st.builds(c.NudgePoint, WILD, WILD),
    c.PlacePoint: st.builds(c.PlacePoint, st.one_of(st.none(), WILD), st.one_of(st.none(), WILD)),
    c.AddPoint: st.builds(c.AddPoint),
    c.RemovePoint: st.builds(c.RemovePoint),
    c.DrawPath: st.builds(c.DrawPath, st.one_of(points(6), circles(), circles())),
    c.Undo: st.builds(c.Undo),
    c.Redo: st.builds(c.Redo),
    c.Share: st.builds(c.Share),
    c.ReplayBreakdown: st.builds(c.ReplayBreakdown),
    c.UseEarlierSettings: st.builds(c.UseEarlierSettings),
    c.UseShared: st.builds(c.UseShared, st.sampled_from(["", "ONPATH1-aaaa", "x" * 10_000])),
}


def test_every_command_is_tried() -> None:
    there = {getattr(c, name) for name in c.__all__}
    commands = {one for one in there if isinstance(one, type) and issubclass(one, c.Command)}
    assert set(COMMANDS) == {one for one in commands - {c.Command} if not one.from_teacher}


@pytest.mark.thorough
@settings(max_examples=50, deadline=None)
@given(
    st.lists(
        st.tuples(st.one_of(*COMMANDS.values()), st.sampled_from([0, 0, 1, 5, 20])),
        min_size=1,
        max_size=14,
    )
)
@example([(c.ChooseLaw(LEFT, "set_point"), 0)])  # which leaves the curve on its way
def test_no_sequence_of_commands_breaks_a_lab(steps: list[tuple[c.Command, int]]) -> None:
    lab = new_lab()
    for command, frames in steps:
        do(lab, command)
        for _ in range(frames):
            lab.advance(lab.simulation.settings.rate * FRAME)
        assert_sound(lab)
    do(lab, c.ResetParameters(), c.ChoosePath("circle"), c.Set("rate", 1.0))
    do(lab, *[c.ChooseLaw(side, law) for side, law in DEFAULT_LAWS.items()])
    do(lab, c.Set("wall", False), c.StartOnPath(), c.SetRunning(True))
    run(lab, 0.4)  # the path has blended in
    do(lab, c.Reset())
    run(lab, 0.8)
    assert lab.simulation.time == pytest.approx(0.8, abs=0.02) and lab.message == ""
    for run_ in lab.simulation.runs.values():
        assert run_.diverged is None and run_.distance < 0.005 and run_.max_distance < 0.005


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    """Of one small lesson."""
    folder = tmp_path_factory.mktemp("course")
    write_lesson(folder)
    return read_course([folder])[0]


IN_A_LESSON: dict[type, st.SearchStrategy[Any]] = LESSON_COMMANDS | {
    c.OpenLesson: st.builds(c.OpenLesson, st.sampled_from(["01-a", "01-a", ""])),
    c.GoToStep: st.builds(c.GoToStep, st.sampled_from([1, 1, 1, 2, -1, 10**9])),
    c.ShowHint: st.builds(c.ShowHint, st.sampled_from(["hold", ""])),
}


@pytest.mark.thorough
@settings(max_examples=25, deadline=None)
@given(
    robot=st.sampled_from(["five_bar"] * 4 + ["flexible"]),
    steps=st.lists(
        st.tuples(
            st.one_of(*IN_A_LESSON.values(), *IN_A_LESSON.values(), *COMMANDS.values()),
            st.sampled_from([0, 1, 4]),
        ),
        min_size=4,
        max_size=16,
    ),
)
def test_no_sequence_of_commands_breaks_a_lesson(
    course: Course, robot: str, steps: list[tuple[c.Command, int]]
) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, c.ChooseRobot(robot))
    assert lab.simulation.entry.name == robot
    if robot == FIVE_BAR.name:
        do(lab, c.OpenLesson("01-a"))
    for command, frames in steps:
        do(lab, command)
        for _ in range(frames):
            lab.drain()
            lab.advance(lab.simulation.settings.rate * FRAME)
        assert_sound(lab)
    put_back(Lab(loop_cache(), FIVE_BAR, course), _state(*_now(lab)))  # it can be kept
    do(lab, c.CloseLesson())
    assert lab.lessons.lesson is None and lab.locked is None
    do(lab, c.ChooseRobot("five_bar"), c.ResetParameters(), c.ChoosePath("circle"))
    do(lab, c.Set("rate", 1.0), c.Set("wall", False), c.StartOnPath(), c.SetRunning(True))
    run(lab, 0.4)  # the path has blended in
    do(lab, c.Reset())
    run(lab, 0.5)
    assert lab.simulation.time == pytest.approx(0.5, abs=0.02)
    assert all(run_.diverged is None for run_ in lab.simulation.runs.values())


def test_commands_wait_for_the_next_frame_in_their_order_and_a_flood_is_dropped() -> None:
    lab = new_lab()
    lab.post(c.Set("K1", 100))
    lab.post(c.Set("K1", 200))
    assert lab.simulation.parameters.K1 == 400
    lab.drain()
    assert lab.simulation.parameters.K1 == 200
    for k in range(3 * MOST_COMMANDS):
        lab.post(c.Set("K1", k))
    assert len(lab._inbox) == MOST_COMMANDS


def test_bad_command_is_answered_and_the_next_one_is_done() -> None:
    lab = new_lab()
    do(lab, c.Set("K1", float("nan")), c.Set("K2", 50))
    assert "K1" in lab.message and lab.message_level == "warning"
    assert (lab.simulation.parameters.K1, lab.simulation.parameters.K2) == (400, 50)


def test_a_gain_that_is_posted_is_the_number_that_both_loops_are_run_with() -> None:
    lab = new_lab()
    for value, packed in (("905", 905.0), (float("nan"), 905.0), (1e300, 905.0), (30, 30.0)):
        lab.post(c.Set("K1", value))
        run(lab, FRAME)
        for run_ in lab.simulation.runs.values():
            settings = kernel_of(lab.simulation.robot, run_.kind).settings.unpack(run_.settings)
            assert settings["K1"] == packed


@pytest.mark.parametrize(
    "command",
    [
        c.Grab(FOLLOWER, np.array([np.nan, 0.0])),
        c.Grab(TRACKER, np.array([0.0, np.inf])),
        c.MoveHand(float("nan"), 0.0),
        c.Act((Action(pull=(float("nan"), 0.0)),)),
        c.Act((Action(pull=(0.0, float("-inf"))),)),
    ],
)
def test_a_pull_to_no_point_is_refused_by_its_command(command: c.Command) -> None:
    lab = new_lab(0.1)
    do(lab, command)
    assert "not a" in lab.message and lab.message_level == "warning"
    assert not lab.simulation.forces.hands and lab.simulation.forces.grabbed is None


@pytest.mark.thorough
@given(st.data())
def test_parameters_within_their_ranges_are_packed_to_finite_numbers(data: st.DataObject) -> None:
    """Whatever `changed` lets in: nothing checks the vector again."""
    entry = ROBOTS[data.draw(st.sampled_from(list(ROBOTS)))]
    parameters, structural = entry.parameters(), ("modes", "plant")
    for name, spec in specs(parameters).items():
        if name not in structural:
            bounds = st.sampled_from([spec.low, spec.high]) | st.floats(spec.low, spec.high)
            values = st.sampled_from(spec.options) if spec.options else bounds
            parameters = changed(parameters, name, data.draw(values))
    robot, curve = entry.make(parameters), presets()["ellipse"].curve
    for law in DEFAULT_LAWS.values():
        kernel = kernel_of(robot, kind_of(law, parameters, curve))
        assert np.isfinite(settings_vector(robot, kernel, parameters, curve, FREE)).all()


# Running


@pytest.mark.parametrize("rate", [0.125, 0.25, 0.5, 1.0, 2.0, 4.0])
def test_speed_scales_simulated_time_and_nothing_else(rate: float) -> None:
    lab, reference = new_lab(), new_lab()
    do(lab, c.Set("rate", rate))
    for _ in range(24):
        lab.advance(lab.simulation.settings.rate * FRAME)
    assert lab.simulation.time == pytest.approx(24 * FRAME * rate, abs=1.01e-3)
    reference.simulation.simulate(round(lab.simulation.time / 1e-3))
    for name, state in states(lab.simulation).items():
        assert np.array_equal(state, reference.simulation.runs[name].state)


def test_paused_lab_stands_still_and_steps_by_one_action() -> None:
    lab = new_lab(0.5)
    do(lab, c.SetRunning(False))
    before = states(lab.simulation)
    run(lab, 0.5)
    assert all(
        np.array_equal(state, before[name]) for name, state in states(lab.simulation).items()
    )
    for rate, step in ((1000, 1e-3), (50, 0.02), (2000, 1e-3), (250, 4e-3)):
        do(lab, c.Set("control_rate", rate))
        time = lab.simulation.time
        do(lab, c.StepOnce())
        assert lab.simulation.time - time == pytest.approx(step) and not lab.simulation.running
    time = lab.simulation.time
    do(lab, c.SetRunning(True))
    lab.advance(FRAME)
    assert lab.simulation.time - time == pytest.approx(FRAME, abs=1.01e-3)  # no time has piled up


def test_space_toggles_and_arrow_steps_when_no_point_is_selected() -> None:
    lab = new_lab(0.1)
    do(lab, c.SetRunning())
    time = lab.simulation.time
    do(lab, c.NudgePoint(0.001, 0.0))
    assert not lab.simulation.running and lab.simulation.time > time
    do(lab, c.SetRunning())
    assert lab.simulation.running


# Fairness


def test_both_robots_share_path_parameters_and_clock() -> None:
    lab = new_lab(0.2)
    do(lab, c.Set("K1", 100), c.ChoosePath("ellipse"))
    run(lab, 0.5)
    for name in ("K1", "K2", "speed", "dt", "plant", "model", "torque_limit"):
        values = []
        for run_ in lab.simulation.runs.values():
            layout = kernel_of(lab.simulation.robot, run_.kind).settings
            values.append(layout.unpack(run_.settings)[name])
        assert np.array_equal(*values), name


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("copy", [True, False])
def test_hold_acts_on_both_with_copy_and_on_one_without(side: str, copy: bool) -> None:
    lab = new_lab(0.5)
    do(lab, c.Set("copy", copy), c.Hold(True, side))
    assert lab.simulation.forces.held == (set(SIDES) if copy else {side})
    run(lab, 0.2)
    for name, run_ in lab.simulation.runs.items():
        force = np.linalg.norm(run_.shown()["force"])
        assert (force > 0.1) == (name in lab.simulation.forces.held)
    do(lab, c.Hold(False, side))
    run(lab, 0.1)
    assert all(np.all(r.shown()["force"] == 0) for r in lab.simulation.runs.values())


def test_hold_tears_the_tracker_off_and_not_the_follower() -> None:
    lab = new_lab(1.0)
    do(lab, c.Hold())
    run(lab, 1.5)
    shown = take_snapshot(lab, 1.0)
    assert shown.held
    assert shown.robots[FOLLOWER].max_distance < 0.004 < 0.03 < shown.robots[TRACKER].max_distance
    do(lab, c.Hold())
    assert not lab.simulation.forces.held


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("copy", [True, False])
def test_grab_pulls_both_by_the_same_or_one_alone(side: str, copy: bool) -> None:
    lab = new_lab(0.5)
    do(lab, c.Set("copy", copy))
    before = {name: lab.simulation.runs[name].shown()["y"].copy() for name in SIDES}
    assert np.linalg.norm(before[FOLLOWER] - before[TRACKER]) > 0.01  # they are not in one place
    for shift in ([0.02, 0.01], [0.03, -0.02]):
        do(lab, c.Grab(side, before[side] + np.array(shift)))
        assert set(lab.simulation.forces.hands) == (set(SIDES) if copy else {side})
        for name, hand in lab.simulation.forces.hands.items():
            assert hand - before[name] == pytest.approx(shift)
    lab.simulation.simulate(1)
    pulled = {n for n, r in lab.simulation.runs.items() if np.linalg.norm(r.shown()["force"]) > 0.1}
    assert pulled == set(lab.simulation.forces.hands)
    other = next(name for name in SIDES if name != side)
    do(lab, c.Release(other))
    assert lab.simulation.forces.hands  # that robot was not the one being pulled
    do(lab, c.Release(side))
    lab.simulation.simulate(1)
    assert not lab.simulation.forces.hands and take_snapshot(lab, 1.0).grabbed is None
    assert all(np.all(r.shown()["force"] == 0) for r in lab.simulation.runs.values())


def test_the_hand_holds_one_robot_at_a_time_unless_it_is_copied() -> None:
    lab = new_lab(0.3)
    do(lab, c.Set("copy", False))
    for name in (TRACKER, FOLLOWER):
        do(lab, c.Grab(name, y(lab.simulation, name) + np.array([0.02, 0.02])))
        lab.simulation.simulate(1)
        pulled = {n for n, r in lab.simulation.runs.items() if np.any(r.shown()["force"] != 0)}
        assert pulled == {name} == set(lab.simulation.forces.hands)


def test_same_state_same_hand_same_force() -> None:
    lab = new_lab()
    do(lab, c.Grab(TRACKER, y(lab.simulation, TRACKER) + np.array([0.03, 0.02])))
    lab.simulation.simulate(1)
    one, other = (r.shown()["force"] for r in lab.simulation.runs.values())
    assert np.array_equal(one, other) and np.linalg.norm(one) > 1


def test_hand_far_away_pulls_no_harder_than_it_can() -> None:
    lab = new_lab(0.2)
    do(lab, c.Grab(FOLLOWER, np.array([1e300, -1e300])))
    run(lab, 0.05)
    for run_ in lab.simulation.runs.values():
        assert 0 < np.linalg.norm(run_.shown()["force"]) <= 15 + 1e-9


def test_tug_takes_hold_and_adds_up() -> None:
    lab = new_lab(0.2)
    do(lab, c.SetRunning(False))
    start = lab.simulation.runs[FOLLOWER].shown()["y"].copy()
    do(lab, c.MoveHand(0.01, 0.0), c.MoveHand(0.01, -0.01))
    assert lab.simulation.forces.grabbed == FOLLOWER
    assert lab.simulation.forces.hands[FOLLOWER] - start == pytest.approx([0.02, -0.01])


# The path


@pytest.mark.parametrize("name", ["ellipse", "rounded square", "clover", "segment"])
def test_new_path_is_followed_after_it_has_blended_in(name: str) -> None:
    lab = new_lab(0.5)
    do(lab, c.ChoosePath(name))
    assert lab.message == ""
    run(lab, 0.35)
    assert lab.simulation.editor.curve is lab.simulation.presets[name].curve
    run(lab, 2.0)
    for run_ in lab.simulation.runs.values():
        assert run_.diverged is None and run_.distance < 1e-3


def test_a_jump_of_the_path_empties_the_integrals() -> None:
    """An error summed along one path says nothing of another one."""
    lab = new_lab()
    do(lab, c.Set("tracker_integral", "on"), c.Set("coulomb", 0.05))
    run(lab, 1.0)
    summed = {
        name: np.abs(run_.fields()["integral"]).max() for name, run_ in lab.simulation.runs.items()
    }
    assert min(summed.values()) > 1e-6
    do(lab, c.SetRunning(False), c.ChoosePath("segment"))  # no blend: the kind changes
    run(lab, 2 * FRAME)
    assert lab.simulation.editor.curve is lab.simulation.presets["segment"].curve
    for run_ in lab.simulation.runs.values():
        assert not run_.fields()["integral"].any()


FAR = c.DrawPath(0.19 * np.column_stack([np.cos(TURN := np.linspace(0, 6.2, 60)), np.sin(TURN)]))
"""A stroke out of the robot's reach."""


def test_refused_path_keeps_the_previous_one_and_says_why() -> None:
    lab = new_lab(0.5)
    design, curve = lab.simulation.editor.design, lab.simulation.editor.curve
    do(lab, FAR)
    assert lab.simulation.editor.design is design and "leaves the workspace" in lab.message
    assert lab.message_level == "warning"
    assert len(take_snapshot(lab, 1.0).path.refused)
    run(lab, 0.5)
    assert np.array_equal(lab.simulation.editor.table, curve.table())
    assert max(r.max_distance for r in lab.simulation.runs.values()) < 5e-3


@pytest.mark.parametrize("begin", np.arange(0.2, 3.4, 0.4))
def test_a_path_that_crosses_itself_is_followed_with_a_warning(begin: float) -> None:
    lab = new_lab(begin)
    do(lab, c.ChoosePath("figure of eight"))
    assert (
        lab.simulation.editor.design.name == "figure of eight" and not lab.simulation.editor.faults
    )
    assert "crosses itself" in lab.message and lab.message_level == "warning"
    assert not len(take_snapshot(lab, 1.0).path.refused)
    run(lab, 3.0)
    assert all(
        each.diverged is None and each.distance < 5e-3 for each in lab.simulation.runs.values()
    )
    do(lab, c.ChoosePath("circle"))
    assert lab.message == ""


@pytest.mark.parametrize("theta", [-np.pi / 2, np.pi / 2])
def test_a_start_at_a_crossing_is_on_the_strand_that_it_names(theta: float) -> None:
    lab = new_lab()
    do(lab, c.ChoosePath("figure of eight"))
    run(lab, 0.5)
    do(lab, c.Set("start_theta", theta), c.Set("start_along", 0.1), c.Reset())
    for each in lab.simulation.runs.values():
        first = lab.simulation.editor.curve.at(np.array(theta), 1)
        at = each.fields()
        assert at["theta"][0] == pytest.approx(theta, abs=1e-6)
        y = [lab.simulation.robot.endpoint(q) for q in (at["q"], at["q"] + 1e-6 * at["v"])]
        wanted = 0.1e-6 * first / np.linalg.norm(first)
        assert y[1] - y[0] == pytest.approx(wanted, abs=1e-12)


def ring(lab: Lab, phase: float, sense: int) -> np.ndarray:
    a = phase + sense * np.linspace(0, 6.2, 60)
    middle = lab.simulation.robot.output_at(np.array([0.2, 0.0, 0.2]))
    return middle + 0.05 * np.stack([np.cos(a), np.sin(a)], axis=1)


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("phase", [0.0, 1.7, 3.1])
def test_a_circle_drawn_anyhow_is_run_as_the_same_preset(phase: float, sense: int) -> None:
    lab = new_lab(1.0)
    before = {name: run_.max_distance for name, run_ in lab.simulation.runs.items()}
    do(lab, c.DrawPath(ring(lab, phase, sense)))
    assert lab.simulation.editor.design.name == "drawn" and "keeps within 0.0" in lab.message
    assert lab.simulation.time == 0.0  # from its beginning
    run(lab, 1.0)
    for name, run_ in lab.simulation.runs.items():
        assert run_.max_distance < before[name] + 1e-4
        assert run_.shown()["theta_rate"][0] > 5  # and goes on in its direction


def test_drag_of_a_point_is_one_edit_and_follows_meanwhile() -> None:
    lab = new_lab(0.3)
    first = lab.simulation.editor.design
    place = first.points[2]
    for k in range(1, 6):
        do(lab, c.MovePoint(2, place + np.array([0.0, -0.002 * k]), finished=False))
        run(lab, 0.1)
    assert lab.simulation.editor.design is first and lab.simulation.editor.selected == 2
    assert not np.allclose(lab.simulation.editor.table, first.curve.table(), atol=1e-4)
    do(lab, c.EndMove())
    assert lab.simulation.editor.design.points[2] - first.points[2] == pytest.approx([0.0, -0.01])
    do(lab, c.Undo())
    assert lab.simulation.editor.design is first
    do(lab, c.Undo())
    assert lab.simulation.editor.design is first and "no change" in lab.message


@pytest.mark.parametrize("beyond", [(0.15, 0.15), (0.0, -0.18), (-0.1, 0.0)])
def test_a_drag_beyond_what_is_valid_goes_as_far_as_it_may(beyond: tuple[float, float]) -> None:
    lab = new_lab(0.3)
    editor, first = lab.simulation.editor, lab.simulation.editor.design
    start, way = first.points[2], np.array(beyond)
    do(lab, c.MovePoint(2, start + np.array([0.0, 0.01]), finished=False))
    run(lab, 0.4)
    do(lab, c.MovePoint(2, start + way, finished=False))
    assert len(take_snapshot(lab, 1.0).path.refused)
    do(lab, c.EndMove())
    assert not len(take_snapshot(lab, 1.0).path.refused)  # the marks go with the hand
    assert "no further" in lab.message and lab.message_level == "warning"
    share = (editor.design.points[2] - start) @ way / (way @ way)
    assert editor.design.points[2] == pytest.approx(start + share * way)
    assert 0 < share < 1 and not curve_faults(lab.simulation.robot.margin, editor.design.curve)
    next_one = first.moved(2, start + (share + 1 / 64) * way)
    assert curve_faults(lab.simulation.robot.margin, next_one.curve)
    run(lab, 0.4)
    assert editor.curve is editor.design.curve
    do(lab, c.MovePoint(2, start))  # back to where it began
    assert lab.message == "" and not editor.faults
    do(lab, c.Undo(), c.Undo())
    assert editor.design is first


def test_a_drag_that_comes_back_from_beyond_goes_where_the_hand_is() -> None:
    lab = new_lab(0.3)
    editor, start = lab.simulation.editor, lab.simulation.editor.design.points[2]
    for down in (0.01, 0.2, 0.005):
        do(lab, c.MovePoint(2, start - np.array([0.0, down]), finished=False))
    do(lab, c.EndMove())
    assert editor.design.points[2] == pytest.approx(start + np.array([0.0, -0.005]))
    assert lab.message == "" and not editor.faults


@pytest.mark.parametrize("command", [c.NudgePoint(0.15, 0.15), c.PlacePoint(0.19, 0.19)])
def test_by_key_and_by_number_too_a_point_goes_as_far_as_it_may(command: c.Command) -> None:
    lab = new_lab()
    editor, first = lab.simulation.editor, lab.simulation.editor.design
    do(lab, c.SelectPoint(2), command)
    assert "no further" in lab.message and editor.design is not first
    assert not curve_faults(lab.simulation.robot.margin, editor.design.curve)


@settings(max_examples=3)
@given(robot=st.sampled_from(list(ROBOTS)))
def test_a_command_carries_coordinates_of_the_path_s_plane_to_the_bit(robot: str) -> None:
    lab = new_lab()
    do(lab, c.ChooseRobot(robot))
    there = lab.simulation.editor.design.points[1] + np.array([0.001, -0.002])
    do(lab, c.MovePoint(1, there))
    assert np.array_equal(lab.simulation.editor.design.points[1], there)
    for wrong in (there[:1], np.append(there, 0.0)):
        do(lab, c.MovePoint(1, wrong))
        assert "not a point" in lab.message
    assert np.array_equal(lab.simulation.editor.design.points[1], there)


def test_undo_in_the_middle_of_a_drag_takes_the_drag_back() -> None:
    lab = new_lab(0.3)
    first = lab.simulation.editor.design
    moved = first.points[2] + np.array([0.0, -0.01])
    do(lab, c.MovePoint(2, moved, finished=False))
    run(lab, 0.4)
    do(lab, c.Undo())
    run(lab, 0.4)
    do(lab, c.EndMove())
    assert lab.simulation.editor.design is first and lab.simulation.editor.curve is first.curve


def test_keyboard_moves_the_selected_point_as_a_drag_would() -> None:
    by_key, by_number, by_mouse = new_lab(), new_lab(), new_lab()
    start = by_key.simulation.editor.design.points[3]
    do(
        by_key,
        c.SelectPoint(2),
        c.SelectNext(),
        c.NudgePoint(0.003, 0.0),
        c.NudgePoint(0.0, -0.004),
    )
    do(
        by_number,
        c.SelectPoint(3),
        c.PlacePoint(start[0] + 0.003),
        c.PlacePoint(None, start[1] - 0.004),
    )
    target = start + np.array([0.003, -0.004])
    do(by_mouse, c.MovePoint(3, target))
    for lab in (by_key, by_number):
        assert lab.simulation.editor.selected == 3
        assert lab.simulation.editor.design.points == pytest.approx(
            by_mouse.simulation.editor.design.points
        )
    assert by_mouse.simulation.editor.design.points[3] - start == pytest.approx([0.003, -0.004])


@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.sampled_from(["move", "add", "remove", "preset", "undo", "redo", "eight", "far"]))
)
def test_undo_and_redo_walk_the_line_of_edits(actions: list[str]) -> None:
    lab = new_lab()
    line, at = [lab.simulation.editor.design], 0
    for k, action in enumerate(actions):
        editor = lab.simulation.editor
        if action == "undo":
            at = max(0, at - 1)
            do(lab, c.Undo())
        elif action == "redo":
            at = min(len(line) - 1, at + 1)
            do(lab, c.Redo())
        else:
            edits: dict[str, Callable[[], c.Command]] = {
                "move": lambda: c.NudgePoint(0.001, 0.0005),
                "add": c.AddPoint,
                "remove": c.RemovePoint,
                "preset": lambda: c.ChoosePath(("ellipse", "circle")[k % 2]),
                "eight": lambda: c.ChoosePath("figure of eight"),
                "far": lambda: FAR,
            }
            do(lab, c.SelectPoint(k % len(editor.design.points)), edits[action]())
            if editor.design is not line[at]:
                line, at = [*line[: at + 1], editor.design], at + 1
        assert editor.design is line[at]


# Divergence


def unstable() -> Lab:
    lab = new_lab(0.2)
    values = {"K1": 2500, "K2": 200, "control_rate": 50}
    do(lab, *[c.Set(name, value) for name, value in values.items()])
    run(lab, 3.0)
    return lab


def test_divergence_freezes_the_robot_says_why_and_reset_brings_it_back() -> None:
    lab = unstable()
    assert any(r.diverged for r in lab.simulation.runs.values())
    assert "Reset" in lab.message and lab.message_level == "error"
    frozen = {n: r.state.copy() for n, r in lab.simulation.runs.items() if r.diverged}
    time = lab.simulation.time
    run(lab, 0.2)
    assert lab.simulation.time == pytest.approx(time + 0.2, abs=1e-2)
    for name, state in frozen.items():
        assert np.array_equal(lab.simulation.runs[name].state, state)
    assert_sound(lab)
    do(lab, c.ResetParameters(), c.Reset())
    run(lab, 0.5)
    assert lab.message == ""
    assert all(r.diverged is None and r.distance < 0.005 for r in lab.simulation.runs.values())


def test_frozen_robot_shows_the_last_instant_that_is_all_numbers() -> None:
    lab = new_lab(0.1)
    run_ = lab.simulation.runs[FOLLOWER]

    class Breaking:
        """A loop whose closest point is lost before the robot is."""

        layouts = loop_layouts(lab.simulation.robot.system, run_.kind)

        def run_many(self, states: list[np.ndarray], *_: object) -> tuple[np.ndarray, np.ndarray]:
            rows = np.tile(run_.row, (len(states), 9, 1))
            fields = self.layouts.log.unpack(rows)
            fields["y"][..., 0] = np.arange(9)
            fields["theta"][:, 4:] = np.nan
            fields["q"][:, 6:] = np.inf
            return np.stack(states) * np.nan, rows

    class Store(LoopCache):
        def find(self, *_: object) -> Breaking:  # type: ignore[override]
            return Breaking()

    broken = Store()
    for each in lab.simulation.runs.values():
        each._loop_cache, each._loop = broken, None
    before = run_.state.copy()
    lab.simulation.simulate(9)
    assert run_.diverged and run_.diverged.time == pytest.approx(lab.simulation.time - 9e-3 + 6e-3)
    assert run_.shown()["y"][0] == 3 and np.array_equal(run_.state, before)
    assert_drawable(take_snapshot(lab, 1.0))
    do(
        lab,
        c.Hold(True),
        c.Grab(FOLLOWER, lab.simulation.robot.output_at(np.array([0.2, 0.0, 0.2]))),
    )
    lab.simulation.simulate(9)


def test_one_robot_stands_still_and_the_other_goes_on() -> None:
    lab = new_lab(0.3)
    do(lab, c.Set("copy", False))
    lab.simulation.runs[FOLLOWER].fields()["v"][:] = 200.0
    run(lab, 0.5)
    assert lab.simulation.runs[FOLLOWER].diverged and not lab.simulation.runs[TRACKER].diverged
    assert "Path following stopped at 0.3" in lab.message
    before = y(lab.simulation, TRACKER)
    do(
        lab,
        c.Hold(True),
        c.Grab(FOLLOWER, lab.simulation.robot.output_at(np.array([0.2, 0.0, 0.2]))),
    )
    run(lab, 0.1)
    assert not np.array_equal(y(lab.simulation, TRACKER), before)
    assert_sound(lab)


def test_a_simulation_never_notices_another() -> None:
    alone, beside = new_lab(), new_lab()
    other = new_lab()
    do(
        other,
        c.Set("K2", 0),
        c.Set("K1", 2500),
        c.Set("control_rate", 50),
    )
    for k in range(60):
        alone.advance(FRAME)
        other.advance(FRAME)
        if k == 30:
            other.simulation.runs[TRACKER].fields()["q"][:] = np.nan
            do(other, c.ChoosePath("clover"), c.Hold(True))
        beside.advance(FRAME)
    assert other.simulation.runs[TRACKER].diverged
    for name, state in states(alone.simulation).items():
        assert np.array_equal(state, beside.simulation.runs[name].state)
    assert beside.message == "" and beside.simulation.parameters == alone.simulation.parameters


def test_a_dragged_slider_is_recorded_once_a_second() -> None:
    lab = Lab(loop_cache())
    for step in range(170):
        do(lab, c.Set("K1", 500.0 + step))
        lab.advance(FRAME)
    do(lab, c.Set("K2", 50.0), c.Set("K1", 300.0))
    told = [(event.detail, round(event.time, 1)) for event in lab.simulation.events]
    assert told == [("K1", 0.0), ("K1", 1.0), ("K1", 2.0), ("K2", 2.8), ("K1", 2.8)]
