"""The lab with the flexible link: it runs, looks back, diverges and comes back, and is exported."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest

from onpath.app.exports.files import csv_bytes
from onpath.app.exports.history_figure import draw_history
from onpath.app.exports.recording import record_scene
from onpath.app.exports.replay import replay
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.app.scene.stage_catalogue import stage_of
from onpath.models.systems.catalogue import FIVE_BAR, FLEXIBLE
from onpath.models.systems.flexible_robot import (
    UNSTABLE,
    FlexibleParameters,
    critical_alpha,
)
from tests.support.drawing import drawn
from tests.support.lab import FOLLOWER, TRACKER, do, loop_cache, run, states

STAGE = stage_of(FLEXIBLE.make(FLEXIBLE.parameters()))


def flexible(seconds: float = 0.0, **changes: object) -> Lab:
    """A lab with the flexible link, some of its parameters changed."""
    lab = Lab(loop_cache(), FLEXIBLE)
    do(lab, *[c.Set(name, value) for name, value in changes.items()])
    run(lab, seconds)
    assert lab.message == ""
    return lab


def extras(lab: Lab, name: str) -> np.ndarray:
    """One of the extra fields over the whole history, (rows, robots, size)."""
    _, samples = lab.simulation.history.samples(0.0, lab.simulation.time, 10_000)
    return lab.simulation.sample_layout.unpack(samples)[name].astype(float)


def test_it_runs_on_its_path() -> None:
    lab = flexible(3.0)
    for run_ in lab.simulation.runs.values():
        assert run_.diverged is None and run_.distance < 1e-3
    assert lab.simulation.runs[FOLLOWER].shown()["theta_rate"][0] == pytest.approx(2.0, abs=0.1)


def test_held_back_the_follower_waits_and_the_tracker_is_torn_off() -> None:
    lab = flexible(1.0)
    do(lab, c.Hold(True))
    run(lab, 1.5)
    worst = {name: run_.max_distance for name, run_ in lab.simulation.runs.items()}
    assert worst[FOLLOWER] < 0.5 * worst[TRACKER]
    assert all(run_.diverged is None for run_ in lab.simulation.runs.values())
    do(lab, c.Hold(False))
    run(lab, 2.5)
    assert max(run_.distance for run_ in lab.simulation.runs.values()) < 2e-3


@pytest.mark.parametrize("plane", list(STAGE.pulls))
def test_a_pull_bends_the_link_and_is_survived(plane: str) -> None:
    lab = flexible(0.5, speed=0.0)
    robot, start = lab.simulation.robot, lab.simulation.runs[FOLLOWER].shown()["y"].copy()
    across = np.cross(STAGE.pulls[plane].normal, [0.0, 0.0, 1.0])
    way = np.array([1.0, 0.0, 0.0]) if not across.any() else across / np.linalg.norm(across)
    do(lab, c.Grab(FOLLOWER, robot.output_at(robot.position(start) + 0.03 * way)))
    run(lab, 0.3)
    moved = robot.position(lab.simulation.runs[FOLLOWER].shown()["y"]) - robot.position(start)
    assert moved @ way > 1e-4
    assert np.abs(extras(lab, "deflection")[-1]).max() > 1e-4
    do(lab, c.Release())
    run(lab, 2.0)
    assert lab.simulation.runs[FOLLOWER].distance < 1e-3 and lab.message == ""


def test_going_on_from_the_past_is_the_same_motion_again() -> None:
    lab = flexible(1.0)
    segment = lab.simulation.history.at(0.5)
    assert segment is not None
    do(lab, c.LookAt(lab.simulation.time - 0.5))
    shown = take_snapshot(lab, 1.0).robots[FOLLOWER]
    q = segment.drives[FOLLOWER].state[: lab.simulation.robot.system.n]
    np.testing.assert_allclose(
        shown.bars, drawn(lab.simulation.robot.skeleton, q, 1.0)[0], atol=1e-15
    )
    then = {name: drive.state.copy() for name, drive in segment.drives.items()}
    do(lab, c.GoOn())
    for name, state in states(lab.simulation).items():
        np.testing.assert_array_equal(state, then[name])
    run(lab, 0.5)
    assert lab.simulation.time > segment.time and lab.message_level == "info"


def test_past_the_critical_alpha_the_vibration_grows_and_is_caught() -> None:
    lab = flexible(1.0, output="redefined")
    own = lab.simulation.parameters
    assert isinstance(own, FlexibleParameters)
    critical = critical_alpha(own, lab.simulation.runs[FOLLOWER].shown()["q"][:3])
    assert 0.5 < critical < 0.9
    calm = extras(lab, "internal_energy")[-20:].max()
    do(lab, c.Set("alpha", 0.9))
    run(lab, 3.0)
    assert lab.message_level == "error" and str(UNSTABLE) in lab.message
    assert extras(lab, "internal_energy").max() > 100 * calm
    for run_ in lab.simulation.runs.values():
        assert np.isfinite(run_.state).all() and np.isfinite(run_.row).all()
    do(lab, c.Reset())
    run(lab, 3.0)
    assert str(UNSTABLE) in lab.message  # still too high: it says so again
    do(lab, c.Set("alpha", 0.5), c.Reset())
    assert lab.message == ""
    run(lab, 2.5)
    assert lab.message == "" and max(r.distance for r in lab.simulation.runs.values()) < 2e-3


def test_each_robot_keeps_its_side() -> None:
    lab = Lab(loop_cache())
    do(lab, c.Set("K1", 900), c.ChoosePath("clover"))
    do(lab, c.ChooseRobot("flexible"))
    assert (
        lab.simulation.editor.design.name == "circle"
        and lab.simulation.parameters == FLEXIBLE.parameters()
    )
    do(lab, c.Set("rho", 0.3), c.ChoosePath("ellipse"))
    run(lab, 0.2)
    do(lab, c.ChooseRobot("five_bar"))
    assert lab.simulation.editor.design.name == "clover" and lab.simulation.parameters.K1 == 900
    assert (
        lab.simulation.entry is FIVE_BAR
        and lab.simulation.time == 0.0
        and not lab.simulation.robot.extras
    )
    do(lab, c.ChooseRobot("flexible"))
    assert lab.simulation.editor.design.name == "ellipse"
    assert (
        isinstance(lab.simulation.parameters, FlexibleParameters)
        and lab.simulation.parameters.rho == 0.3
    )


def test_exaggeration_is_drawn_and_said_but_not_simulated() -> None:
    plain, drawn = flexible(0.3), flexible(0.3)
    for lab in (plain, drawn):
        do(lab, c.Hold(True))
    do(drawn, c.Set("larger", 10))
    run(plain, 0.3)
    run(drawn, 0.3)
    for name, state in states(plain.simulation).items():
        np.testing.assert_array_equal(states(drawn.simulation)[name], state)
    true, large = (take_snapshot(lab, 1.0) for lab in (plain, drawn))
    assert true.note == "" and "10×" in large.note
    one, two = true.robots[FOLLOWER], large.robots[FOLLOWER]
    rigid = one.marks[0]
    np.testing.assert_allclose(two.tip - rigid, 10 * (one.tip - rigid), atol=2e-3)
    assert one.deflection == two.deflection != 0.0
    np.testing.assert_array_equal(one.trace[-1], two.trace[-1])
    do(drawn, c.Set("larger", float("nan")))
    assert drawn.simulation.settings.larger == 10 and drawn.message


@pytest.mark.parametrize(("name", "value"), [("modes", 5), ("plant", "unit_modes")])
def test_a_structural_change_starts_anew_and_fits_what_is_kept(name: str, value: object) -> None:
    lab = flexible(0.2)
    do(lab, c.Set(name, value))
    assert lab.simulation.time == 0.0 and not len(lab.simulation.history)
    run(lab, 0.2)
    sizes = dict(lab.simulation.sample_layout.fields)
    assert sizes["modes"] == (value if name == "modes" else 3)
    total = extras(lab, "modes").sum(-1)
    np.testing.assert_allclose(total, extras(lab, "deflection")[..., 0], atol=1e-8)


@pytest.mark.thorough
def test_it_can_be_taken_home() -> None:
    lab = flexible(0.5)
    robot, history = lab.simulation.robot, lab.simulation.history.all()
    rows = list(csv.reader(io.StringIO(csv_bytes(robot, history).decode())))
    assert {"q3_rad", "y3_m", "f1_m1.5"} <= set(rows[0]) and len(rows) > 400
    assert draw_history(replay(robot, history)).startswith(b"\x89PNG")
    assert b"<html" in record_scene(robot, history).lower()
