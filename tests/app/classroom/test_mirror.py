"""A student's lab in another process, as the teacher sees it: the same motion, a little later."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.classroom.mirror import BEHIND, Mirror
from onpath.app.classroom.moment import Moment
from onpath.app.classroom.moment_check import read_moment
from onpath.app.classroom.moment_of_lab import tell
from onpath.app.lab import commands as c
from onpath.app.lab.advance_together import advance_together
from onpath.app.lab.commands import Freeze
from onpath.app.lab.lab import Lab
from onpath.app.lab.session import Session
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot as take_snapshot
from onpath.app.simulation.simulation_thread import ScheduledLab
from onpath.models.control.benches import BENCHES
from tests.support.lab import FRAME, assert_drawable, do, new_lab, store, y

OFTEN = 8  # frames from one telling to the next
SAME = 1e-3  # [m]


Act = Callable[[float], c.Command | None]
"""What is done, by the time since when, [s]."""


def told(scheduled: ScheduledLab) -> str:
    return msgspec.json.encode(tell(scheduled)).decode()


@dataclass
class Followed:
    """A student's lab, its mirror, and where the student's end-points were when.

    Attributes:
        late: frames that a telling takes; called for each.
    """

    late: Callable[[], int] = lambda: 5
    scheduled: ScheduledLab = field(default_factory=lambda: ScheduledLab(new_lab(0.5)))
    frames: int = 0
    ways: dict[str, list[tuple[float, np.ndarray]]] = field(default_factory=dict)
    jumps: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.mirror = Mirror(Lab(store()), told(self.scheduled))
        self._under_way: list[tuple[int, str]] = []

    @property
    def lab(self) -> Lab:
        return self.scheduled.lab

    @property
    def session(self) -> Session:
        return self.lab.session

    def run(
        self, seconds: float, act: Callable[[float], c.Command | None] = lambda _: None
    ) -> None:
        """Both go on; what the teacher sees is compared with what was."""
        for number in range(round(seconds / FRAME)):
            command = act(number * FRAME)
            do(self.lab, *([command] if command else []))
            self.lab.advance(self.session.rate * FRAME)
            for name in BENCHES:
                way = self.ways.setdefault(name, [])
                way.append((self.session.time, y(self.lab.session, name)))
            if self.frames % OFTEN == 0:
                self._under_way.append((self.frames + self.late(), told(self.scheduled)))
            while self._under_way and self._under_way[0][0] <= self.frames:
                self.mirror.tell(self._under_way.pop(0)[1])
            before = self.mirror.session.time
            advance_together([self.mirror.frame(FRAME)])
            self.jumps.append(self.mirror.session.time - before)
            self.frames += 1

    def distance(self) -> float:
        """Of the mirror's end-points from where the student's were at that time, [m]."""
        time = self.mirror.session.time
        return max(self._distance(name, time) for name in BENCHES)

    def _distance(self, name: str, time: float) -> float:
        times, points = (np.array(part) for part in zip(*self.ways[name], strict=True))
        there = np.array([np.interp(time, times, along) for along in points.T])
        return float(np.linalg.norm(y(self.mirror.lab.session, name) - there))


def test_the_same_motion_a_little_later_and_smoothly() -> None:
    rng = np.random.default_rng(1)
    both = Followed(late=lambda: int(rng.integers(2, 12)))
    both.run(2.0)
    both.jumps.clear()
    for _ in range(60):
        both.run(0.05)
        assert both.distance() < SAME
        assert 0.05 < both.session.time - both.mirror.session.time < 2 * BEHIND
    assert min(both.jumps) >= 0.5 * FRAME - 1e-3 and max(both.jumps) <= 2 * FRAME + 1e-3
    assert_drawable(take_snapshot(both.mirror.lab, 1.0))


def test_what_is_done_to_the_lab_is_seen_within_a_millimetre() -> None:
    both = Followed()
    both.run(1.0)
    for command in (
        c.Hold(True),
        c.Hold(False),
        c.SetParameter("K1", 90.0),
        c.ChoosePath("clover"),
    ):
        do(both.lab, command)
        both.run(1.5)
        assert both.distance() < SAME, command
    assert both.mirror.session.parameters.K1 == 90.0
    assert both.mirror.session.editor.design.name == "clover"


def test_a_speed_profile_is_seen_with_its_phase() -> None:
    both = Followed()
    do(both.lab, c.SetParameter("speed_profile", "stop_and_go"))
    both.run(0.5)
    for _ in range(10):
        both.run(0.3)
        assert both.distance() < SAME
    assert both.mirror.session.parameters.speed_profile == "stop_and_go"


def test_a_path_that_is_dragged_and_let_go_is_the_same_path() -> None:
    both = Followed()
    index, (x, up) = 2, both.session.editor.design.points[2]

    def drag(time: float) -> c.Command | None:
        at = np.array([x + 0.02 * time, up + 0.01 * time])
        return c.MovePoint(index, at, finished=False) if round(time / FRAME) % 3 == 0 else None

    both.run(1.0)
    both.run(1.0, drag)
    assert both.mirror.session.editor.points()[index][0] > x
    do(both.lab, c.EndMove())
    both.run(1.5)
    assert both.distance() < SAME
    mine, theirs = both.mirror.session.editor, both.session.editor
    assert np.allclose(mine.curve.series, theirs.curve.series, atol=1e-9)
    assert np.allclose(mine.points(), theirs.points())


def test_a_hand_that_pulls_is_near_meanwhile_and_exact_after() -> None:
    both = Followed()
    both.run(1.0)

    def pull(time: float) -> c.Command | None:
        return c.MoveHand(0.002 * np.cos(3 * time), 0.002 * np.sin(3 * time))

    both.run(1.0, pull)
    assert both.distance() < 5 * SAME and both.mirror.session.grips.grabbed
    do(both.lab, c.Release())
    both.run(1.5)
    assert both.distance() < SAME and not both.mirror.session.grips.grabbed


def test_a_wall_and_a_brake_in_both_directions_act_there_too() -> None:
    both = Followed()
    both.run(1.0)
    for command in (
        *(c.SetWall(True), c.NudgeWall(up=-0.01, turn=0.3), c.SetHoldDirection("both")),
        *(c.Hold(True), c.MoveHand(0.01, 0.0), c.Release(), c.Hold(False), c.SetWall(False)),
    ):
        do(both.lab, command)
        both.run(0.8)
        assert both.distance() < SAME, command
        for mine, theirs in zip(
            both.mirror.session.grips.pushes.values(),
            both.session.grips.pushes.values(),
            strict=True,
        ):
            assert (mine.wall is None) == (theirs.wall is None)
            assert (mine.hold_normal is None) == (theirs.hold_normal is None)
        shown, real = (take_snapshot(lab, 1.0).wall for lab in (both.mirror.lab, both.lab))
        np.testing.assert_allclose(shown, real, atol=1e-12)


def test_a_moment_of_an_earlier_version_has_no_wall() -> None:
    lab = new_lab(0.1)
    plain = msgspec.json.decode(told(ScheduledLab(lab)))
    for name in ("wall",):
        del plain[name]
    for robot in plain["robots"]:
        del robot["normal"]
    moment = read_moment(msgspec.json.encode(plain).decode())
    assert moment.wall == () and moment.robots[0].normal == ()


@pytest.mark.parametrize(
    "still", [c.SetRunning(False), c.LookAt(0.4), Freeze(True)], ids=lambda s: type(s).__name__
)
def test_a_lab_that_stands_still_is_shown_where_it_stands(still: Any) -> None:
    both = Followed()
    both.run(1.0)
    do(both.lab, still)
    both.run(1.5)
    shown, real = (take_snapshot(s, 1.0) for s in (both.mirror.lab, both.lab))
    assert abs(shown.time - real.time) < 2e-3 and shown.running == real.running
    for name in BENCHES:
        assert np.abs(shown.robots[name].tip - real.robots[name].tip).max() < SAME
    assert shown.message == real.message


def test_a_new_start_and_another_robot_are_followed() -> None:
    both = Followed()
    both.run(1.0)
    do(both.lab, c.Reset())
    both.run(0.7)
    assert both.mirror.session.time < 0.8
    do(both.lab, c.ChooseRobot("flexible"), c.SetParameter("modes", 2))
    both.ways.clear()
    both.run(1.2)
    assert both.mirror.session.robot is both.session.robot
    assert both.distance() < SAME


def test_nothing_that_the_teacher_does_reaches_the_lab_and_nothing_runs_unseen() -> None:
    both = Followed()
    both.run(1.0)
    before = both.mirror.session.time, both.session.time
    for _ in range(60):
        both.mirror.tell(told(both.scheduled))
        both.mirror.lab.post(c.Reset())  # whatever a page may do wrong
    assert (both.mirror.session.time, both.session.time) == before
    assert len(both.mirror._coming) <= 50


def spoilt(text: str) -> st.SearchStrategy[str]:
    """One value of a moment replaced."""
    values = st.one_of(
        st.none(),
        st.text(max_size=5),
        st.integers(),
        st.floats(),
        st.lists(st.floats(), max_size=3),
    )
    data = msgspec.json.decode(text)
    keys = [*((key,) for key in data), *(("path", key) for key in data["path"])]
    keys += [("robots", 0, key) for key in data["robots"][0]]

    def replaced(key: tuple[Any, ...], value: Any) -> str:
        new = msgspec.json.decode(text)
        part: Any = new
        for step in key[:-1]:
            part = part[step]
        part[key[-1]] = value
        return msgspec.json.encode(new).decode()

    return st.builds(replaced, st.sampled_from(keys), values)


TEXT = told(ScheduledLab(new_lab(0.2)))


@given(st.one_of(st.text(), spoilt(TEXT)))
def test_what_comes_is_a_lab_or_is_left_out(text: str) -> None:
    mirror = Mirror(Lab(store()), TEXT)
    advance_together([mirror.frame(FRAME)])
    mirror.tell(text)
    for _ in range(3):
        advance_together([mirror.frame(FRAME)])
    assert_drawable(take_snapshot(mirror.lab, 1.0))
    try:
        assert isinstance(read_moment(text), Moment)
    except ValueError:
        assert mirror.is_seen is False


def test_a_payload_that_is_put_on_is_seen_without_a_new_run() -> None:
    both = Followed()
    do(both.lab, c.ChooseRobot("flexible"))
    both.run(0.8)
    do(both.lab, c.SetParameter("payload", 0.02))
    both.run(1.5)
    assert both.mirror.session.robot is both.session.robot
    assert both.distance() < SAME


def test_another_plane_of_the_path_is_followed() -> None:
    both = Followed()
    do(both.lab, c.ChooseRobot("flexible"))
    both.run(0.8)
    do(both.lab, c.SetParameter("d", 0.45), c.SetParameter("b", -0.3))
    both.ways.clear()
    both.run(1.5)
    assert both.mirror.session.robot is both.session.robot
    assert both.distance() < SAME
