"""A side gets another control law while its robot moves: what goes on, and what begins anew."""

from __future__ import annotations

import csv
import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.exports.files import csv_bytes
from onpath.app.exports.history_figure import draw_history
from onpath.app.exports.recording import record_scene
from onpath.app.exports.replay import replay
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.share_code import decode, encode
from onpath.app.lab.snapshots.snapshot import MARKER
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.models.closed_loop.loop_kind import Kind
from onpath.models.closed_loop.loops import Loop
from onpath.models.control.laws.registry import LAWS
from onpath.models.control.sides import DEFAULT_LAWS, LEFT, RIGHT, SIDES
from onpath.models.systems.robots import Robot
from tests.support.lab import FRAME, assert_sound, do, new_lab, run, states
from tests.support.suitable_laws import laws_for

WITH_MEMORY = next(name for name, law in LAWS.items() if law.memory)
ONLY_SQUARE = next(name for name, law in LAWS.items() if law.square)
OTHERS = [name for name in laws_for() if name not in DEFAULT_LAWS.values()]


def change(lab: Lab, side: str, law: str) -> None:
    """Change a law at once, as a script does."""
    lab.simulation.change_law(side, law)


@pytest.mark.thorough
@settings(max_examples=10)
@given(side=st.sampled_from(SIDES), law=st.sampled_from(laws_for()))
def test_the_robot_goes_on_from_where_it_is(side: str, law: str) -> None:
    lab = new_lab(0.5)
    do(lab, c.Set("K3", 500.0), c.Hold(True))
    run(lab, 0.3)
    before, time = states(lab.simulation)[side], lab.simulation.time
    own = lab.simulation.runs[side]
    old = {name: value.copy() for name, value in own.fields().items()}
    change(lab, side, law)
    new = own.fields()
    if law == DEFAULT_LAWS[side]:
        assert np.array_equal(own.state, before)
        return
    for name in ("q", "v", "theta", "theta_rate", "u", "encoder", "encoder_rate", "phase"):
        assert np.array_equal(new[name], old[name]), name
    assert new["theta_ref"] == new["theta"] and not new["integral"].any()
    assert all(not new[name].any() for name, _ in LAWS[law].memory)
    assert lab.simulation.time == time and lab.simulation.laws[side] == law
    event = lab.simulation.events.last
    assert event is not None
    assert (event.name, event.detail, event.sides) == ("law", law, (side,))
    assert lab.simulation.forces.held == set(SIDES)
    run(lab, 0.2)
    assert_sound(lab)


class SlowCache(LoopCache):
    """Loops of other laws than the usual ones are ready when it is said so."""

    ready = False

    def find(self, robot: Robot, kind: Kind) -> Loop | None:
        known = self.ready or kind.law in DEFAULT_LAWS.values()
        return super().find(robot, kind) if known else None


def test_the_old_law_goes_on_until_the_new_loop_can_run() -> None:
    cache = SlowCache(at_once=True)
    lab = Lab(cache)
    run(lab, 0.2)
    do(lab, c.ChooseLaw(LEFT, "waiting_clock"))
    time = lab.simulation.time
    run(lab, 0.2)
    assert lab.simulation.laws == DEFAULT_LAWS and lab.simulation.time > time + 0.15
    assert take_snapshot(lab, 1.0).run.laws[LEFT] == "waiting_clock"  # what the menu shows
    assert take_snapshot(lab, 1.0).laws == DEFAULT_LAWS  # what moves the robots
    assert capture(lab.simulation).laws == {LEFT: "waiting_clock"}
    cache.ready = True
    run(lab, FRAME)
    assert lab.simulation.laws == {**DEFAULT_LAWS, LEFT: "waiting_clock"}
    cache.close()


def test_a_choice_is_taken_back_before_its_loop_is_ready() -> None:
    cache = SlowCache(at_once=True)
    lab = Lab(cache)
    do(lab, c.ChooseLaw(LEFT, "set_point"), c.ChooseLaw(LEFT, DEFAULT_LAWS[LEFT]))
    cache.ready = True
    run(lab, 0.1)
    assert lab.simulation.laws == DEFAULT_LAWS == lab.simulation.chosen_laws
    assert not [event for event in lab.simulation.events if event.name == "law"]
    cache.close()


@pytest.mark.parametrize(
    ("side", "law", "said"),
    [
        ("middle", "set_point", "unknown side"),
        (LEFT, "sett_point", "did you mean set_point"),
        (RIGHT, "", "unknown law"),
    ],
)
def test_a_wrong_name_is_refused_and_changes_nothing(side: str, law: str, said: str) -> None:
    lab = new_lab(0.1)
    do(lab, c.ChooseLaw(side, law))
    assert said in lab.message and lab.message_level == "warning"
    assert lab.simulation.chosen_laws == DEFAULT_LAWS


def test_a_law_that_does_not_suit_the_robot() -> None:
    lab = new_lab()
    change(lab, RIGHT, ONLY_SQUARE)
    do(lab, c.ChooseRobot("flexible"))
    assert lab.simulation.laws == DEFAULT_LAWS and LAWS[ONLY_SQUARE].label in lab.message
    do(lab, c.ChooseLaw(LEFT, ONLY_SQUARE))
    assert (
        "not possible with this robot" in lab.message and lab.simulation.chosen_laws == DEFAULT_LAWS
    )


def changing() -> Lab:
    """A lab whose sides change their laws twice, with memories of different sizes."""
    lab = new_lab(0.5)
    change(lab, LEFT, WITH_MEMORY)
    run(lab, 0.5)
    change(lab, RIGHT, "waiting_clock")
    change(lab, LEFT, "set_point")
    run(lab, 0.5)
    return lab


@pytest.mark.thorough
def test_history_is_replayed_to_the_last_bit_across_changes() -> None:
    lab = new_lab(0.5)
    seen: list[tuple[str, float, np.ndarray, np.ndarray]] = []
    for laws in ({LEFT: WITH_MEMORY}, {RIGHT: "waiting_clock", LEFT: "set_point"}, DEFAULT_LAWS):
        for side, law in laws.items():
            change(lab, side, law)
        for _ in range(20):
            run(lab, FRAME)
            for side, own in lab.simulation.runs.items():
                row = own.shown()
                seen.append((side, lab.simulation.time, row["q"].copy(), row["u"].copy()))
    runs = replay(lab.simulation.robot, lab.simulation.history.all())
    names = [trajectory.law for trajectory in runs[LEFT]]
    assert names == ["trajectory_tracking", WITH_MEMORY, "set_point", "trajectory_tracking"]
    fields = {
        side: {n: np.concatenate([p.fields[n] for p in parts]) for n in ("q", "u")}
        for side, parts in runs.items()
    }
    for side, time, q, u in seen:
        at = round(time * 1e3) - 1
        assert np.array_equal(fields[side]["q"][at], q)
        assert np.array_equal(fields[side]["u"][at], u)


def test_looking_back_shows_each_frame_under_its_law() -> None:
    lab = changing()
    for ago, laws in (
        (1.3, DEFAULT_LAWS),
        (0.7, {**DEFAULT_LAWS, LEFT: WITH_MEMORY}),
        (0.2, {LEFT: "set_point", RIGHT: "waiting_clock"}),
    ):
        do(lab, c.LookAt(ago))
        shown = take_snapshot(lab, 1.0)
        assert shown.laws == laws
        assert shown.run.laws == {LEFT: "set_point", RIGHT: "waiting_clock"}
        assert_sound(lab)


def test_going_on_from_before_a_change_and_undoing_that() -> None:
    lab = changing()
    end = states(lab.simulation)
    do(lab, c.LookAt(1.2))
    past = lab.simulation.history.at(lab.simulation.viewing or 0.0)
    assert past is not None
    do(lab, c.GoOn())
    assert lab.simulation.laws == {LEFT: "set_point", RIGHT: "waiting_clock"}  # those of now
    for side, own in lab.simulation.runs.items():
        drive = past.drives[side]
        assert drive.kind.law == DEFAULT_LAWS[side]
        assert np.array_equal(own.fields()["q"], drive.state[:2])
        assert own.fields()["theta_ref"] == own.fields()["theta"]
    told = [(event.detail, event.sides) for event in lab.simulation.events if event.name == "law"]
    assert told == [("set_point", (LEFT,)), ("waiting_clock", (RIGHT,))]
    run(lab, 0.3)
    change(lab, RIGHT, "contouring")
    do(lab, c.UndoGoOn())
    assert lab.simulation.laws == {LEFT: "set_point", RIGHT: "waiting_clock"}
    for side, state in states(lab.simulation).items():
        assert np.array_equal(state, end[side])
    run(lab, 0.1)
    do(lab, c.UndoGoOn())
    assert lab.simulation.laws[RIGHT] == "contouring"
    assert_sound(lab)


def test_the_marker_is_what_the_law_aims_at() -> None:
    lab = new_lab(0.4)
    simulation = lab.simulation
    for law in laws_for():
        change(lab, RIGHT, law)
        run(lab, 0.2)
        own = simulation.runs[RIGHT].shown()[LAWS[law].aim]
        place = simulation.robot.position(
            simulation.robot.frame.lift(simulation.editor.curve.at(own))
        )
        view = take_snapshot(lab, 1.0).robots[RIGHT]
        assert view.law == law and view.points[MARKER] == pytest.approx(place[0], abs=1e-6)


def test_a_set_up_carries_the_laws() -> None:
    lab = changing()
    setup = capture(lab.simulation)
    assert setup.laws == {LEFT: "set_point", RIGHT: "waiting_clock"}
    other = new_lab()
    do(other, c.UseShared(encode(setup)))
    assert other.simulation.laws == setup.laws and other.simulation.time == 0.0
    assert capture(other.simulation) == setup == decode(encode(setup))
    do(other, c.Reset())
    assert other.simulation.laws == setup.laws
    do(other, c.UseShared(encode(capture(new_lab().simulation))))
    assert other.simulation.laws == DEFAULT_LAWS


@pytest.mark.thorough
def test_files_tell_the_side_and_the_law_of_every_row() -> None:
    lab = changing()
    change(lab, RIGHT, "set_point")  # both alike
    run(lab, 0.2)
    history = lab.simulation.history.all()
    rows = list(csv.DictReader(io.StringIO(csv_bytes(lab.simulation.robot, history).decode())))
    found = dict.fromkeys((row["side"], row["law"]) for row in rows)
    assert list(found) == [
        (LEFT, "trajectory_tracking"),
        (LEFT, WITH_MEMORY),
        (LEFT, "set_point"),
        (RIGHT, "path_following"),
        (RIGHT, "waiting_clock"),
        (RIGHT, "set_point"),
    ]
    assert len(rows) == 2 * round(lab.simulation.time * 1e3)
    assert draw_history(replay(lab.simulation.robot, history)).startswith(b"\x89PNG")
    assert record_scene(lab.simulation.robot, history).rstrip().endswith(b"</html>")
