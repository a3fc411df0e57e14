"""The lab with the flexible link: it runs, looks back, diverges and comes back, and is exported."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from onpath.app.exports.figures import draw_history
from onpath.app.exports.files import csv_bytes
from onpath.app.exports.recording import record_scene
from onpath.app.exports.replay import replay
from onpath.app.lab import commands as c
from onpath.app.lab.session import Session
from onpath.app.lab.take_snapshot import take_snapshot
from onpath.app.page.panels.flexible_panel import alpha_bar, critical_alpha
from onpath.app.scene.stage_catalogue import FLEXIBLE as STAGE
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE
from onpath.models.systems.flexible_robot import UNSTABLE, FlexibleFiveBar, FlexibleParameters
from tests.support.drawing import drawn
from tests.support.lab import FOLLOWER, TRACKER, do, run, states, store


def flexible(seconds: float = 0.0, **changes: object) -> Session:
    """A lab with the flexible link, some of its parameters changed."""
    session = Session(store(), FLEXIBLE)
    do(session, *[c.SetParameter(name, value) for name, value in changes.items()])
    run(session, seconds)
    assert session.message == ""
    return session


def robot_of(session: Session) -> FlexibleFiveBar:
    assert isinstance(session.robot, FlexibleFiveBar)
    return session.robot


def extras(session: Session, name: str) -> np.ndarray:
    """One of the extra fields over the whole history, (rows, robots, size)."""
    _, samples = session.history.samples(0.0, session.time, 10_000)
    return session.sample_layout.unpack(samples)[name].astype(float)


def test_it_runs_on_its_path() -> None:
    session = flexible(3.0)
    for run_ in session.runs.values():
        assert run_.diverged is None and run_.distance < 1e-3
    assert session.runs[FOLLOWER].shown()["theta_rate"][0] == pytest.approx(2.0, abs=0.1)


def test_held_back_the_follower_waits_and_the_tracker_is_torn_off() -> None:
    session = flexible(1.0)
    do(session, c.Hold(True))
    run(session, 1.5)
    worst = {name: run_.max_distance for name, run_ in session.runs.items()}
    assert worst[FOLLOWER] < 0.5 * worst[TRACKER]
    assert all(run_.diverged is None for run_ in session.runs.values())
    do(session, c.Hold(False))
    run(session, 2.5)
    assert max(run_.distance for run_ in session.runs.values()) < 2e-3


@pytest.mark.parametrize("plane", list(STAGE.pulls))
def test_a_pull_bends_the_link_and_is_survived(plane: str) -> None:
    session = flexible(0.5, speed=0.0)
    robot, start = session.robot, session.runs[FOLLOWER].shown()["y"].copy()
    across = np.cross(STAGE.pulls[plane].normal, [0.0, 0.0, 1.0])
    way = np.array([1.0, 0.0, 0.0]) if not across.any() else across / np.linalg.norm(across)
    do(session, c.Grab(FOLLOWER, robot.place(start) + 0.03 * way))
    run(session, 0.3)
    moved = robot.place(session.runs[FOLLOWER].shown()["y"]) - robot.place(start)
    assert moved @ way > 1e-4
    assert abs(float(robot_of(session).deflection(session.runs[FOLLOWER].fields()["q"]))) > 1e-4
    do(session, c.Release())
    run(session, 2.0)
    assert session.runs[FOLLOWER].distance < 1e-3 and session.message == ""


def test_going_on_from_the_past_is_the_same_motion_again() -> None:
    session = flexible(1.0)
    stretch = session.history.at(0.5)
    assert stretch is not None
    do(session, c.LookAt(session.time - 0.5))
    shown = take_snapshot(session, 1.0).robots[FOLLOWER]
    q = stretch.drives[FOLLOWER].state[: session.robot.system.n]
    np.testing.assert_allclose(shown.bars, drawn(session.robot.skeleton, q, 1.0)[0], atol=1e-15)
    then = {name: drive.state.copy() for name, drive in stretch.drives.items()}
    do(session, c.GoOn())
    for name, state in states(session).items():
        np.testing.assert_array_equal(state, then[name])
    run(session, 0.5)
    assert session.time > stretch.time and session.message_level == "info"


def test_past_the_critical_alpha_the_vibration_grows_and_is_caught() -> None:
    session = flexible(1.0, law="redefined")
    own = session.parameters
    assert isinstance(own, FlexibleParameters)
    critical = critical_alpha(own, session.runs[FOLLOWER].shown()["q"][:3])
    assert 0.5 < critical < 0.9
    calm = extras(session, "internal_energy")[-20:].max()
    do(session, c.SetParameter("alpha", 0.9))
    run(session, 3.0)
    assert session.message_level == "error" and UNSTABLE in session.message
    assert extras(session, "internal_energy").max() > 100 * calm
    for run_ in session.runs.values():
        assert np.isfinite(run_.state).all() and np.isfinite(run_.row).all()
    do(session, c.Reset())
    run(session, 3.0)
    assert UNSTABLE in session.message  # still too high: it says so again
    do(session, c.SetParameter("alpha", 0.5), c.Reset())
    assert session.message == ""
    run(session, 2.5)
    assert session.message == "" and max(r.distance for r in session.runs.values()) < 2e-3


def test_each_robot_keeps_its_bench() -> None:
    session = Session(store())
    do(session, c.SetParameter("K1", 900), c.ChoosePath("clover"))
    do(session, c.ChooseRobot("flexible"))
    assert session.editor.design.name == "circle" and session.parameters == FLEXIBLE.lab
    do(session, c.SetParameter("rho", 0.3), c.ChoosePath("ellipse"))
    run(session, 0.2)
    do(session, c.ChooseRobot("five_bar"))
    assert session.editor.design.name == "clover" and session.parameters.K1 == 900
    assert session.entry is FIVE_BAR and session.time == 0.0 and not session.robot.extra_fields
    do(session, c.ChooseRobot("flexible"))
    assert session.editor.design.name == "ellipse"
    assert isinstance(session.parameters, FlexibleParameters) and session.parameters.rho == 0.3


def test_exaggeration_is_drawn_and_said_but_not_simulated() -> None:
    plain, drawn = flexible(0.3), flexible(0.3)
    for session in (plain, drawn):
        do(session, c.Hold(True))
    do(drawn, c.SetExaggeration(10))
    run(plain, 0.3)
    run(drawn, 0.3)
    for name, state in states(plain).items():
        np.testing.assert_array_equal(states(drawn)[name], state)
    true, large = (take_snapshot(session, 1.0) for session in (plain, drawn))
    assert true.note == "" and "10×" in large.note
    one, two = true.robots[FOLLOWER], large.robots[FOLLOWER]
    rigid = one.marks[0]
    np.testing.assert_allclose(two.tip - rigid, 10 * (one.tip - rigid), atol=2e-3)
    assert one.deflection == two.deflection != 0.0
    np.testing.assert_array_equal(one.trace[-1], two.trace[-1])
    do(drawn, c.SetExaggeration(float("nan")))
    assert drawn.exaggeration == 10 and drawn.message


@pytest.mark.parametrize(("name", "value"), [("modes", 5), ("plant", "unit_modes")])
def test_a_structural_change_starts_anew_and_fits_what_is_kept(name: str, value: object) -> None:
    session = flexible(0.2)
    do(session, c.SetParameter(name, value))
    assert session.time == 0.0 and not len(session.history)
    run(session, 0.2)
    sizes = dict(session.sample_layout.fields)
    assert sizes["modes"] == robot_of(session).modes
    total = extras(session, "modes").sum(-1)
    np.testing.assert_allclose(total, extras(session, "deflection")[..., 0], atol=1e-8)


def test_it_can_be_taken_home() -> None:
    session = flexible(0.5)
    robot, history = session.robot, session.history.all()
    rows = list(csv.reader(io.StringIO(csv_bytes(robot, history).decode())))
    assert {"q3_rad", "y3_m", "f1_m1.5"} <= set(rows[0]) and len(rows) > 400
    assert draw_history(replay(robot, history)).startswith(b"\x89PNG")
    assert b"<html" in record_scene(robot, history).lower()


def test_the_bar_marks_alpha_and_says_when_it_is_too_high() -> None:
    assert "unstable" in alpha_bar(0.9, 0.7, True, ENGLISH)
    assert "unstable" not in alpha_bar(0.5, 0.7, True, ENGLISH)
    assert "unstable" not in alpha_bar(0.9, 0.7, False, ENGLISH)
    assert "none" in alpha_bar(1.0, float("inf"), True, ENGLISH)
    assert "nan" not in alpha_bar(0.5, float("nan"), True, ENGLISH)
