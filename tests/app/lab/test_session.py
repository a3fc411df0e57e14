"""A lab can be driven into anything, and comes back; both robots get the same of everything."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.lab import commands as c
from onpath.app.lab.session import MOST_COMMANDS, Session
from onpath.app.lab.take_snapshot import take_snapshot
from onpath.app.storage.lab_state import _now, _state, put_back
from onpath.lessons.course import Course, read_course
from onpath.lessons.schema import Action
from onpath.models.closed_loop.simulation import kernel_of
from onpath.models.control.laws import NAMES
from onpath.models.systems.catalogue import FIVE_BAR
from onpath.models.systems.parameters import specs
from tests.support.lab import (
    FOLLOWER,
    FRAME,
    TRACKER,
    assert_drawable,
    assert_sound,
    do,
    new_session,
    run,
    states,
    store,
    y,
)
from tests.support.lesson_texts import write_lesson

CONTROLLERS = st.sampled_from([*NAMES, "", "nobody"])
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

    middle = new_session().robot.unplace(np.array([0.2, 0.0, 0.2]))

    def stroke(radius: float, x: float, phase: float, turn: float) -> np.ndarray:
        a = phase + turn * np.linspace(0, 2 * np.pi, 40)
        return middle + np.stack([x + radius * np.cos(a), radius * np.sin(a)], axis=1)

    return st.builds(
        stroke, st.floats(0, 0.2), st.floats(-0.1, 0.1), st.floats(-4, 4), st.floats(-1.1, 1.1)
    )


def parameter_values() -> st.SearchStrategy[c.SetParameter]:
    def values(name: str) -> st.SearchStrategy[Any]:
        spec = specs(new_session().parameters).get(name)
        if spec is None or spec.options:
            good = st.sampled_from(spec.options if spec else (1,))
        else:
            good = st.floats(spec.low, spec.high)
        return st.one_of(good, good, WILD, st.sampled_from(["", "x", None, "1e9", [1, 2]]))

    names = st.sampled_from([*specs(new_session().parameters), "K6", ""])
    return names.flatmap(lambda name: values(name).map(lambda v: c.SetParameter(name, v)))


LESSON_COMMANDS: dict[type, st.SearchStrategy[Any]] = {
    c.OpenLesson: st.builds(c.OpenLesson, st.sampled_from(["", "hexapod"])),
    c.CloseLesson: st.builds(c.CloseLesson),
    c.GoToStep: st.builds(c.GoToStep, st.integers(-3, 3)),
    c.Predict: st.builds(
        c.Predict, st.one_of(st.none(), INDICES), st.just((0.0, 1.0)), st.tuples(WILD, WILD)
    ),
    c.PlayStep: st.builds(c.PlayStep),
    c.BeginStepAnew: st.builds(c.BeginStepAnew),
    c.ShowHint: st.builds(c.ShowHint, st.just("")),
    c.AnswerQuiz: st.builds(c.AnswerQuiz, INDICES, INDICES),
    c.Act: st.builds(c.Act, st.just((Action(hold=True), Action(pull=(20.0, -400.0))))),
    c.SetLanguage: st.builds(c.SetLanguage, st.sampled_from(["de", "en", "../en", ""])),
    c.SetPresenting: st.builds(c.SetPresenting, st.booleans()),
}
COMMANDS: dict[type, st.SearchStrategy[Any]] = {
    **LESSON_COMMANDS,
    c.SetParameter: parameter_values(),
    c.ResetParameters: st.builds(c.ResetParameters),
    c.Identify: st.builds(c.Identify),
    c.ChooseRobot: st.builds(c.ChooseRobot, st.sampled_from(["five_bar", "", "hexapod"])),
    c.SetRunning: st.builds(c.SetRunning, st.sampled_from([None, True, True, False])),
    c.StepOnce: st.builds(c.StepOnce),
    c.Reset: st.builds(c.Reset),
    c.SetRate: st.builds(c.SetRate, st.one_of(st.sampled_from([0.125, 1, 4, 4]), WILD)),
    c.LookAt: st.builds(c.LookAt, st.one_of(st.floats(-1, 5), WILD)),
    c.LookBack: st.builds(c.LookBack, st.one_of(st.floats(-1, 5), WILD)),
    c.GoOn: st.builds(c.GoOn),
    c.UndoGoOn: st.builds(c.UndoGoOn),
    c.Hold: st.builds(
        c.Hold, st.sampled_from([None, True, False]), st.one_of(st.none(), CONTROLLERS)
    ),
    c.Grab: st.builds(c.Grab, CONTROLLERS, points(1)),
    c.Release: st.builds(c.Release, st.one_of(st.none(), CONTROLLERS)),
    c.MoveHand: st.builds(c.MoveHand, WILD, WILD),
    c.SetCopy: st.builds(c.SetCopy, st.booleans()),
    c.SetExaggeration: st.builds(c.SetExaggeration, WILD),
    c.ChoosePath: st.builds(c.ChoosePath, st.sampled_from([*new_session().presets, "", "hexagon"])),
    c.SelectPoint: st.builds(c.SelectPoint, INDICES),
    c.MovePoint: st.builds(c.MovePoint, st.integers(-3, 30), points(1), st.booleans()),
    c.EndMove: st.builds(c.EndMove),
    c.SelectNext: st.builds(c.SelectNext),
    c.Arrow: st.builds(c.Arrow, WILD, WILD),
    c.PlacePoint: st.builds(c.PlacePoint, st.one_of(st.none(), WILD), st.one_of(st.none(), WILD)),
    c.AddPoint: st.builds(c.AddPoint),
    c.RemovePoint: st.builds(c.RemovePoint),
    c.DrawPath: st.builds(c.DrawPath, st.one_of(points(6), circles(), circles())),
    c.Undo: st.builds(c.Undo),
    c.Redo: st.builds(c.Redo),
    c.Share: st.builds(c.Share),
    c.UseShared: st.builds(c.UseShared, st.sampled_from(["", "ONPATH1-aaaa", "x" * 10_000])),
}


def test_every_command_is_tried() -> None:
    there = {getattr(c, name) for name in c.__all__}
    commands = {one for one in there if isinstance(one, type) and issubclass(one, c.Command)}
    assert set(COMMANDS) == {one for one in commands - {c.Command} if not one.from_teacher}


@settings(max_examples=50, deadline=None)
@given(
    st.lists(
        st.tuples(st.one_of(*COMMANDS.values()), st.sampled_from([0, 0, 1, 5, 20])),
        min_size=1,
        max_size=14,
    )
)
def test_no_sequence_of_commands_breaks_a_lab(steps: list[tuple[c.Command, int]]) -> None:
    session = new_session()
    for command, frames in steps:
        do(session, command)
        for _ in range(frames):
            session.advance(session.rate * FRAME)
        assert_sound(session)
    do(session, c.ResetParameters(), c.ChoosePath("circle"), c.SetRate(1.0))
    do(session, c.SetRunning(True))
    run(session, 0.4)  # the path has blended in
    do(session, c.Reset())
    run(session, 0.8)
    assert session.time == pytest.approx(0.8, abs=0.02) and session.message == ""
    for run_ in session.runs.values():
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
    session = Session(store(), FIVE_BAR, course)
    do(session, c.ChooseRobot(robot))
    assert session.entry.name == robot
    if robot == "five_bar":
        do(session, c.OpenLesson("01-a"))
    for command, frames in steps:
        do(session, command)
        for _ in range(frames):
            session.drain()
            session.advance(session.rate * FRAME)
        assert_sound(session)
    put_back(Session(store(), FIVE_BAR, course), _state(*_now(session)))  # it can be kept
    do(session, c.CloseLesson())
    assert session.lessons.lesson is None and session.locked == ""
    do(session, c.ChooseRobot("five_bar"), c.ResetParameters(), c.ChoosePath("circle"))
    do(session, c.SetRate(1.0), c.SetRunning(True))
    run(session, 0.4)  # the path has blended in
    do(session, c.Reset())
    run(session, 0.5)
    assert session.time == pytest.approx(0.5, abs=0.02)
    assert all(run_.diverged is None for run_ in session.runs.values())


def test_commands_wait_for_the_next_frame_in_their_order_and_a_flood_is_dropped() -> None:
    session = new_session()
    session.post(c.SetParameter("K1", 100))
    session.post(c.SetParameter("K1", 200))
    assert session.parameters.K1 == 400
    session.drain()
    assert session.parameters.K1 == 200
    for k in range(3 * MOST_COMMANDS):
        session.post(c.SetParameter("K1", k))
    assert len(session._inbox) == MOST_COMMANDS


def test_bad_command_is_answered_and_the_next_one_is_done() -> None:
    session = new_session()
    do(session, c.SetParameter("K1", float("nan")), c.SetParameter("K2", 50))
    assert "K1" in session.message and session.message_level == "warning"
    assert (session.parameters.K1, session.parameters.K2) == (400, 50)


# Running


@pytest.mark.parametrize("rate", [0.125, 0.25, 0.5, 1.0, 2.0, 4.0])
def test_speed_scales_simulated_time_and_nothing_else(rate: float) -> None:
    session, reference = new_session(), new_session()
    do(session, c.SetRate(rate))
    for _ in range(24):
        session.advance(session.rate * FRAME)
    assert session.time == pytest.approx(24 * FRAME * rate, abs=1.01e-3)
    reference.simulate(round(session.time / 1e-3))
    for name, state in states(session).items():
        assert np.array_equal(state, reference.runs[name].state)


def test_paused_lab_stands_still_and_steps_by_one_action() -> None:
    session = new_session(0.5)
    do(session, c.SetRunning(False))
    before = states(session)
    run(session, 0.5)
    assert all(np.array_equal(state, before[name]) for name, state in states(session).items())
    for rate, step in ((1000, 1e-3), (50, 0.02), (2000, 1e-3), (250, 4e-3)):
        do(session, c.SetParameter("control_rate", rate))
        time = session.time
        do(session, c.StepOnce())
        assert session.time - time == pytest.approx(step) and not session.running
    time = session.time
    do(session, c.SetRunning(True))
    session.advance(FRAME)
    assert session.time - time == pytest.approx(FRAME, abs=1.01e-3)  # no time has piled up


def test_space_toggles_and_arrow_steps_when_no_point_is_selected() -> None:
    session = new_session(0.1)
    do(session, c.SetRunning())
    time = session.time
    do(session, c.Arrow(0.001, 0.0))
    assert not session.running and session.time > time
    do(session, c.SetRunning())
    assert session.running


# Fairness


def test_both_robots_share_path_parameters_and_clock() -> None:
    session = new_session(0.2)
    do(session, c.SetParameter("K1", 100), c.ChoosePath("ellipse"))
    run(session, 0.5)
    for name in ("K1", "K2", "speed", "dt", "plant", "model", "torque_limit"):
        values = []
        for run_ in session.runs.values():
            layout = kernel_of(session.robot, run_.kind).settings
            values.append(layout.unpack(run_.settings)[name])
        assert np.array_equal(*values), name


@pytest.mark.parametrize("controller", NAMES)
@pytest.mark.parametrize("copy", [True, False])
def test_hold_acts_on_both_with_copy_and_on_one_without(controller: str, copy: bool) -> None:
    session = new_session(0.5)
    do(session, c.SetCopy(copy), c.Hold(True, controller))
    assert session.grips.held == (set(NAMES) if copy else {controller})
    run(session, 0.2)
    for name, run_ in session.runs.items():
        force = np.linalg.norm(run_.shown()["force"])
        assert (force > 0.1) == (name in session.grips.held)
    do(session, c.Hold(False, controller))
    run(session, 0.1)
    assert all(np.all(r.shown()["force"] == 0) for r in session.runs.values())


def test_hold_tears_the_tracker_off_and_not_the_follower() -> None:
    session = new_session(1.0)
    do(session, c.Hold())
    run(session, 1.5)
    shown = take_snapshot(session, 1.0)
    assert shown.held
    assert shown.robots[FOLLOWER].max_distance < 0.004 < 0.03 < shown.robots[TRACKER].max_distance
    do(session, c.Hold())
    assert not session.grips.held


@pytest.mark.parametrize("controller", NAMES)
@pytest.mark.parametrize("copy", [True, False])
def test_grab_pulls_both_by_the_same_or_one_alone(controller: str, copy: bool) -> None:
    session = new_session(0.5)
    do(session, c.SetCopy(copy))
    before = {name: session.runs[name].shown()["y"].copy() for name in NAMES}
    assert np.linalg.norm(before[FOLLOWER] - before[TRACKER]) > 0.01  # they are not in one place
    for shift in ([0.02, 0.01], [0.03, -0.02]):
        do(session, c.Grab(controller, before[controller] + np.array(shift)))
        assert set(session.grips.hands) == (set(NAMES) if copy else {controller})
        for name, hand in session.grips.hands.items():
            assert hand - before[name] == pytest.approx(shift)
    session.simulate(1)
    pulled = {n for n, r in session.runs.items() if np.linalg.norm(r.shown()["force"]) > 0.1}
    assert pulled == set(session.grips.hands)
    other = next(name for name in NAMES if name != controller)
    do(session, c.Release(other))
    assert session.grips.hands  # that robot was not the one being pulled
    do(session, c.Release(controller))
    session.simulate(1)
    assert not session.grips.hands and take_snapshot(session, 1.0).grabbed is None
    assert all(np.all(r.shown()["force"] == 0) for r in session.runs.values())


def test_the_hand_holds_one_robot_at_a_time_unless_it_is_copied() -> None:
    session = new_session(0.3)
    do(session, c.SetCopy(False))
    for name in (TRACKER, FOLLOWER):
        do(session, c.Grab(name, y(session, name) + np.array([0.02, 0.02])))
        session.simulate(1)
        pulled = {n for n, r in session.runs.items() if np.any(r.shown()["force"] != 0)}
        assert pulled == {name} == set(session.grips.hands)


def test_same_state_same_hand_same_force() -> None:
    session = new_session()
    do(session, c.Grab(TRACKER, y(session, TRACKER) + np.array([0.03, 0.02])))
    session.simulate(1)
    one, other = (r.shown()["force"] for r in session.runs.values())
    assert np.array_equal(one, other) and np.linalg.norm(one) > 1


def test_hand_far_away_pulls_no_harder_than_it_can() -> None:
    session = new_session(0.2)
    do(session, c.Grab(FOLLOWER, np.array([1e300, -1e300])))
    run(session, 0.05)
    for run_ in session.runs.values():
        assert 0 < np.linalg.norm(run_.shown()["force"]) <= 15 + 1e-9


def test_tug_takes_hold_and_adds_up() -> None:
    session = new_session(0.2)
    do(session, c.SetRunning(False))
    start = session.runs[FOLLOWER].shown()["y"].copy()
    do(session, c.MoveHand(0.01, 0.0), c.MoveHand(0.01, -0.01))
    assert session.grips.grabbed == FOLLOWER
    assert session.grips.hands[FOLLOWER] - start == pytest.approx([0.02, -0.01])


# The path


@pytest.mark.parametrize("name", ["ellipse", "rounded square", "clover", "segment"])
def test_new_path_is_followed_after_it_has_blended_in(name: str) -> None:
    session = new_session(0.5)
    do(session, c.ChoosePath(name))
    assert session.message == ""
    run(session, 0.35)
    assert session.editor.curve is session.presets[name].curve
    run(session, 2.0)
    for run_ in session.runs.values():
        assert run_.diverged is None and run_.distance < 1e-3


def test_a_jump_of_the_path_empties_the_integrals() -> None:
    """An error summed along one path says nothing of another one."""
    session = new_session()
    do(session, c.SetParameter("K3", 1000.0), c.SetParameter("coulomb", 0.05))
    run(session, 1.0)
    summed = {name: np.abs(run_.fields()["integral"]).max() for name, run_ in session.runs.items()}
    assert min(summed.values()) > 1e-6
    do(session, c.SetRunning(False), c.ChoosePath("segment"))  # no blend: the kind changes
    run(session, 2 * FRAME)
    assert session.editor.curve is session.presets["segment"].curve
    for run_ in session.runs.values():
        assert not run_.fields()["integral"].any()


def test_refused_path_keeps_the_previous_one_and_says_why() -> None:
    session = new_session(0.5)
    design, curve = session.editor.design, session.editor.curve
    do(session, c.ChoosePath("figure of eight"))
    assert session.editor.design is design and "crosses itself" in session.message
    assert session.message_level == "warning"
    assert len(take_snapshot(session, 1.0).path.refused)
    run(session, 0.5)
    assert np.array_equal(session.editor.table, curve.table())
    assert max(r.max_distance for r in session.runs.values()) < 5e-3


def ring(session: Session, phase: float, sense: int) -> np.ndarray:
    a = phase + sense * np.linspace(0, 6.2, 60)
    middle = session.robot.unplace(np.array([0.2, 0.0, 0.2]))
    return middle + 0.05 * np.stack([np.cos(a), np.sin(a)], axis=1)


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("phase", [0.0, 1.7, 3.1])
def test_the_same_circle_drawn_anyhow_disturbs_nobody(phase: float, sense: int) -> None:
    session = new_session(1.0)
    do(session, c.DrawPath(ring(session, phase, sense)))
    assert session.editor.design.name == "drawn" and session.message == ""
    before = {name: run_.max_distance for name, run_ in session.runs.items()}
    run(session, 1.0)
    for name, run_ in session.runs.items():
        assert run_.max_distance < before[name] + 1.5e-3
        assert run_.shown()["theta_rate"][0] > 5  # and goes on in its direction


def test_drag_of_a_point_is_one_edit_and_follows_meanwhile() -> None:
    session = new_session(0.3)
    first = session.editor.design
    place = first.points[2]
    for k in range(1, 6):
        do(session, c.MovePoint(2, place + np.array([0.0, -0.002 * k]), finished=False))
        run(session, 0.1)
    assert session.editor.design is first and session.editor.selected == 2
    assert not np.allclose(session.editor.table, first.curve.table(), atol=1e-4)
    do(session, c.EndMove())
    assert session.editor.design.points[2] - first.points[2] == pytest.approx([0.0, -0.01])
    do(session, c.Undo())
    assert session.editor.design is first
    do(session, c.Undo())
    assert session.editor.design is first and "nothing" in session.message


def test_drag_that_ends_in_a_refused_place_goes_all_the_way_back() -> None:
    session = new_session(0.3)
    first = session.editor.design
    place = first.points[2]
    do(session, c.MovePoint(2, place + np.array([0.0, 0.01]), finished=False))
    run(session, 0.4)
    assert not np.allclose(session.editor.table, first.curve.table(), atol=1e-4)
    do(session, c.MovePoint(2, place + np.array([0.15, 0.15])))
    assert "refused" in session.message
    run(session, 0.4)
    assert session.editor.design is first and session.editor.curve is first.curve


def test_undo_in_the_middle_of_a_drag_takes_the_drag_back() -> None:
    session = new_session(0.3)
    first = session.editor.design
    moved = first.points[2] + np.array([0.0, -0.01])
    do(session, c.MovePoint(2, moved, finished=False))
    run(session, 0.4)
    do(session, c.Undo())
    run(session, 0.4)
    do(session, c.EndMove())
    assert session.editor.design is first and session.editor.curve is first.curve


def test_keyboard_moves_the_selected_point_as_a_drag_would() -> None:
    by_key, by_number, by_mouse = new_session(), new_session(), new_session()
    start = by_key.editor.design.points[3]
    do(by_key, c.SelectPoint(2), c.SelectNext(), c.Arrow(0.003, 0.0), c.Arrow(0.0, -0.004))
    do(
        by_number,
        c.SelectPoint(3),
        c.PlacePoint(start[0] + 0.003),
        c.PlacePoint(None, start[1] - 0.004),
    )
    target = start + np.array([0.003, -0.004])
    do(by_mouse, c.MovePoint(3, target))
    for session in (by_key, by_number):
        assert session.editor.selected == 3
        assert session.editor.design.points == pytest.approx(by_mouse.editor.design.points)
    assert by_mouse.editor.design.points[3] - start == pytest.approx([0.003, -0.004])


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from(["move", "add", "remove", "preset", "undo", "redo", "eight"])))
def test_undo_and_redo_walk_the_line_of_edits(actions: list[str]) -> None:
    session = new_session()
    line, at = [session.editor.design], 0
    for k, action in enumerate(actions):
        editor = session.editor
        if action == "undo":
            at = max(0, at - 1)
            do(session, c.Undo())
        elif action == "redo":
            at = min(len(line) - 1, at + 1)
            do(session, c.Redo())
        else:
            edits: dict[str, Callable[[], c.Command]] = {
                "move": lambda: c.Arrow(0.001, 0.0005),
                "add": c.AddPoint,
                "remove": c.RemovePoint,
                "preset": lambda: c.ChoosePath(("ellipse", "circle")[k % 2]),
                "eight": lambda: c.ChoosePath("figure of eight"),
            }
            do(session, c.SelectPoint(k % len(editor.design.points)), edits[action]())
            if editor.design is not line[at]:
                line, at = [*line[: at + 1], editor.design], at + 1
        assert editor.design is line[at]


# Divergence


def unstable() -> Session:
    session = new_session(0.2)
    values = {"K1": 2500, "K2": 200, "control_rate": 50}
    do(session, *[c.SetParameter(name, value) for name, value in values.items()])
    run(session, 3.0)
    return session


def test_divergence_freezes_the_robot_says_why_and_reset_brings_it_back() -> None:
    session = unstable()
    assert any(r.diverged for r in session.runs.values())
    assert "Reset" in session.message and session.message_level == "error"
    frozen = {n: r.state.copy() for n, r in session.runs.items() if r.diverged}
    time = session.time
    run(session, 0.2)
    assert session.time == pytest.approx(time + 0.2, abs=1e-2)
    for name, state in frozen.items():
        assert np.array_equal(session.runs[name].state, state)
    assert_sound(session)
    do(session, c.ResetParameters(), c.Reset())
    run(session, 0.5)
    assert session.message == ""
    assert all(r.diverged is None and r.distance < 0.005 for r in session.runs.values())


def test_frozen_robot_shows_the_last_instant_that_is_all_numbers() -> None:
    session = new_session(0.1)
    run_ = session.runs[FOLLOWER]

    class Breaking:
        """A loop whose closest point is lost before the robot is."""

        kernel = kernel_of(session.robot, run_.kind)

        def run(self, state: np.ndarray, *_: object) -> tuple[np.ndarray, np.ndarray]:
            rows = np.tile(run_.row, (9, 1))
            fields = self.kernel.log.unpack(rows)
            fields["y"][:, 0] = np.arange(9)
            fields["theta"][4:] = np.nan
            fields["q"][6:] = np.inf
            return state * np.nan, rows

    class Store:
        def get(self, *_: object) -> Breaking:
            return Breaking()

    session._store = Store()  # pyright: ignore[reportAttributeAccessIssue]
    before = run_.state.copy()
    session.simulate(9)
    assert run_.diverged and run_.diverged.time == pytest.approx(session.time - 9e-3 + 6e-3)
    assert run_.shown()["y"][0] == 3 and np.array_equal(run_.state, before)
    assert_drawable(take_snapshot(session, 1.0))
    do(session, c.Hold(True), c.Grab(FOLLOWER, session.robot.unplace(np.array([0.2, 0.0, 0.2]))))
    session.simulate(9)


def test_one_robot_stands_still_and_the_other_goes_on() -> None:
    session = new_session(0.3)
    do(session, c.SetCopy(False))
    session.runs[FOLLOWER].fields()["v"][:] = 200.0
    run(session, 0.5)
    assert session.runs[FOLLOWER].diverged and not session.runs[TRACKER].diverged
    assert "Path following stopped at 0.3" in session.message
    before = y(session, TRACKER)
    do(session, c.Hold(True), c.Grab(FOLLOWER, session.robot.unplace(np.array([0.2, 0.0, 0.2]))))
    run(session, 0.1)
    assert not np.array_equal(y(session, TRACKER), before)
    assert_sound(session)


def test_a_session_never_notices_another() -> None:
    alone, beside = new_session(), new_session()
    other = new_session()
    do(
        other,
        c.SetParameter("K2", 0),
        c.SetParameter("K1", 2500),
        c.SetParameter("control_rate", 50),
    )
    for k in range(60):
        alone.advance(FRAME)
        other.advance(FRAME)
        if k == 30:
            other.runs[TRACKER].fields()["q"][:] = np.nan
            do(other, c.ChoosePath("clover"), c.Hold(True))
        beside.advance(FRAME)
    assert other.runs[TRACKER].diverged
    for name, state in states(alone).items():
        assert np.array_equal(state, beside.runs[name].state)
    assert beside.message == "" and beside.parameters == alone.parameters
