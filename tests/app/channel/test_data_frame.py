"""What a page knows from the frames of its data channel is what its lab did."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.data_frame import (
    ANGLE,
    FORCE,
    LENGTH,
    MOST,
    TIME,
    FrameSource,
    frame_message,
    path_message,
)
from onpath.app.channel.messages import encoded
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.plot_rows import ASKED, MOST_LINES
from onpath.app.lab.snapshots.take_snapshot import take_motion
from onpath.models.control.sides import LEFT, RIGHT, SIDES
from onpath.models.layout import Layout
from onpath.models.systems.catalogue import ROBOTS
from tests.support.cases import some
from tests.support.lab import FRAME, do, loop_cache, new_lab

UNIT = 1 / LENGTH


class Reader:
    """A page: it keeps the samples of a lab, as `FrameMessage` says."""

    def __init__(self, *fields: str) -> None:
        self.source = FrameSource()
        self.source.ask(fields)
        self.fields: list[tuple[str, int, float]] = []
        self.rows: list[list[int]] = []
        self.straight: list[list[int]] = []
        self.running, self.past, self.frames = False, None, 0

    def see(self, lab: Lab, reads: bool = True) -> bool:
        """Note the present, and read a frame. Returns whether there was one."""
        self.source.note(lab.simulation)
        frame = self.source.take(lab) if reads else None
        if frame is None:
            return False
        message: dict[str, Any] = msgspec.json.decode(encoded(frame_message(frame)))
        assert message["is"] == "frame"
        if message.get("anew"):
            self.rows.clear()
            self.fields = message["fields"]
        first = message["rows"][0][0]
        self.rows = [row for row in self.rows if row[0] < first] + message["rows"]
        self.running, self.past = message["running"], message["past"]
        self.straight = message.get("straight", [])
        self.frames += 1
        return True

    def robots(self, row: list[int]) -> list[dict[str, Any]]:
        """What a row says of each robot, in SI units."""
        more = sum(size for _, size, _ in self.fields)
        size = (len(row) - 2) // len(SIDES) - more
        p = (size - 3) // 2
        found = list[dict[str, Any]]()
        for i in range(len(SIDES)):
            numbers = np.array(row[2 + i * size : 2 + (i + 1) * size], dtype=float)
            found.append(
                {
                    "distance": numbers[0] / LENGTH,
                    "theta": numbers[1] / ANGLE,
                    "theta_ref": numbers[2] / ANGLE,
                    "y": numbers[3 : 3 + p] / LENGTH,
                    "force": numbers[3 + p :] / FORCE,
                    **self.plotted(row[len(row) - (len(SIDES) - i) * more :]),
                }
            )
        return found

    def plotted(self, numbers: list[int]) -> dict[str, Any]:
        """What the first numbers say of the plotted fields, in SI units; None if unknown."""
        found, begin = dict[str, Any](), 0
        for name, size, unit in self.fields:
            part = numbers[begin : begin + size]
            found[name] = None if None in part else np.array(part) / unit
            begin += size
        return found


def assert_knows(reader: Reader, lab: Lab) -> None:
    """Assert that a page knows the present, and the recent past as the lab's history has it."""
    simulation, last = lab.simulation, reader.rows[-1]
    assert last[0] == round(TIME * simulation.time)
    assert (reader.running, reader.past) == (simulation.running, simulation.viewing)
    held = [bool(last[1] >> i & 1) for i in range(len(SIDES))]
    pulled = [bool(last[1] >> (2 + i) & 1) for i in range(len(SIDES))]
    assert held == [side in simulation.forces.held for side in SIDES]
    assert pulled == [side in simulation.forces.hands for side in SIDES]
    for known, run in zip(reader.robots(last), simulation.runs.values(), strict=True):
        row = run.shown()
        assert abs(known["distance"] - run.distance) <= UNIT
        assert abs(known["theta"] - row["theta"]) <= 1 / ANGLE
        assert abs(known["theta_ref"] - row["theta_ref"]) <= 1 / ANGLE
        assert np.abs(known["y"] - row["y"]).max() <= UNIT
        assert np.abs(known["force"] - row["force"]).max() <= 1 / FORCE
    now = simulation.sample()
    for known, sample in zip(reader.robots(last), now, strict=True):
        assert_plots(reader, known, sample, simulation.sample_layout)
    times = [row[0] for row in reader.rows]
    assert all(a < b or a == b == times[-1] for a, b in pairwise(times))
    begins, samples = simulation.history.samples(-1.0, simulation.time, 10_000)
    rows = {row[0]: reader.robots(row) for row in reader.rows}
    far = simulation.sample_layout.slices["distance"].start
    assert times[0] <= round(TIME * begins[0]) if len(begins) else True
    for time, sample in zip(begins, samples, strict=True):
        if (tick := round(TIME * float(time))) in rows and time < simulation.time:
            told = [robot["distance"] for robot in rows[tick]]
            assert np.abs(sample[:, far] - told).max() <= 1.5 * UNIT
            for known, numbers in zip(rows[tick], sample, strict=True):
                assert_plots(reader, known, numbers, simulation.sample_layout)


def assert_plots(reader: Reader, known: dict[str, Any], sample: Any, layout: Layout) -> None:
    """Assert that the plotted fields of a robot are those of a sample, rounded."""
    assert [name for name, _, _ in reader.fields] == [
        name for name in ASKED if name in reader.source.fields and name in layout.slices
    ]
    for name, size, unit in reader.fields:
        told, true = known[name], sample[layout.slices[name]][:size]
        assert size == min(len(sample[layout.slices[name]]), MOST_LINES)
        if told is not None:  # ξ may have had another unit
            assert np.abs(told - true).max() <= 1 / unit + 1e-6 * np.abs(true).max(), name


STEPS = st.sampled_from(
    [
        c.Hold(),
        c.Hold(True, LEFT),
        c.SetRunning(),
        c.SetRunning(True),
        c.StepOnce(),
        c.Reset(),
        c.LookAt(0.4),
        c.GoOn(),
        c.UndoGoOn(),
        c.MoveHand(0.01, 0.02),
        c.Release(),
        c.Set("rate", 0.25),
        c.Set("rate", 4),
        c.ChoosePath("ellipse"),
        c.ChooseRobot("two_link_arm"),
        c.ChooseRobot("five_bar"),
        c.ChooseLaw(RIGHT, "trajectory_tracking"),
        c.Set("K1", 900.0),
        c.Set("across", "level_set"),
        c.Set("across", "distance"),
    ]
)


@pytest.mark.thorough
@settings(max_examples=40, deadline=None)
@given(
    st.sets(st.sampled_from(ASKED)),
    st.lists(
        st.tuples(STEPS, st.integers(0, 25), st.sampled_from([1, 3, 4, MOST + 9])),
        min_size=1,
        max_size=10,
    ),
)
def test_a_page_knows_what_its_lab_did(
    fields: set[str], steps: list[tuple[c.Command, int, int]]
) -> None:
    """Whatever is plotted and done to the lab, and however seldom the page reads."""
    lab, reader = new_lab(FRAME), Reader(*fields)
    for command, frames, seldom in steps:
        do(lab, command)
        for i in range(frames):
            lab.drain()
            lab.advance(lab.simulation.settings.rate * FRAME)
            reader.see(lab, reads=i % seldom == 0)
        reader.see(lab)
        assert_knows(reader, lab)


def test_no_sample_is_left_out_or_sent_twice() -> None:
    lab, reader = new_lab(), Reader()
    reader.see(lab)
    sent = 1
    for i in range(90):
        lab.advance(FRAME)
        before = len(reader.rows)
        if reader.see(lab, reads=i % 3 == 2):
            sent += len(reader.rows) - before
    assert sent == len(reader.rows) == 91
    assert {b[0] - a[0] for a, b in pairwise(reader.rows)} == {160, 170}


def test_a_page_that_reads_nothing_for_long_catches_up_from_the_history() -> None:
    lab, reader = new_lab(), Reader()
    reader.see(lab)
    for _ in range(5 * 60):
        lab.advance(FRAME)
        reader.see(lab, reads=False)
    assert len(reader.source._latest) <= MOST
    reader.see(lab)
    assert len(reader.rows) > 290
    assert_knows(reader, lab)


def test_a_page_that_comes_late_is_told_the_last_minute_with_what_acted() -> None:
    lab = new_lab(1.0)
    do(lab, c.Set("copy", False), c.Hold(True, LEFT))
    for _ in range(30):
        lab.advance(FRAME)
    do(lab, c.Hold(False, LEFT), c.Grab(RIGHT, np.array([0.0, 0.3])))
    for _ in range(30):
        lab.advance(FRAME)
    do(lab, c.Release())
    for _ in range(30):
        lab.advance(FRAME)
    reader = Reader()
    reader.see(lab)
    flags = [(row[0] / TIME, row[1]) for row in reader.rows]
    assert {flag for time, flag in flags if time < 0.98} == {0}
    assert {flag for time, flag in flags if 1.01 < time < 1.48} == {1}
    assert {flag for time, flag in flags if 1.51 < time < 1.98} == {8}
    assert {flag for time, flag in flags if time > 2.01} == {0}


def test_a_row_that_is_opened_later_has_its_past_in_its_present_unit() -> None:
    """And nothing is told of a row that is closed, or that the robot cannot have."""
    lab, reader = new_lab(1.0), Reader()
    reader.see(lab)
    plain = len(reader.rows[-1])
    do(lab, c.Set("across", "level_set"))
    for _ in range(30):
        lab.advance(FRAME)
        reader.see(lab)
    reader.source.ask(["xi", "deflection", "colour"])
    reader.see(lab)
    assert [name for name, _, _ in reader.fields] == ["xi"]
    told = {row[0] / TIME: reader.robots(row)[0]["xi"] for row in reader.rows}
    assert {value is None for time, value in told.items() if time < 0.99} == {True}
    assert {value is None for time, value in told.items() if time > 1.02} == {False}
    assert_knows(reader, lab)
    reader.source.ask([])
    reader.see(lab)
    assert len(reader.rows[-1]) == plain


@pytest.mark.parametrize(
    "name", some(["five_bar", "flexible", "seven_axes"], quick=["five_bar", "flexible"])
)
def test_a_row_costs_at_most_four_kilobytes_a_second(name: str) -> None:
    lab, sources = Lab(loop_cache(), ROBOTS[name]), dict[str, FrameSource]()
    do(lab, c.Hold())
    for field in ("", *ASKED):
        sources[field] = FrameSource()
        sources[field].ask([field])
    sent = dict.fromkeys(sources, 0)
    for i in range(63):
        for field, source in sources.items():
            source.note(lab.simulation)
            if i % 3 == 2 and (frame := source.take(lab)) is not None and i > 2:
                sent[field] += len(encoded(frame_message(frame)))
        lab.advance(FRAME)
    plain = sent[""]
    assert plain > 1000
    assert {field: size for field, size in sent.items() if size - plain > 4000} == {}


def test_nothing_is_sent_while_nothing_changes() -> None:
    lab, reader = new_lab(0.5), Reader()
    do(lab, c.SetRunning(False))
    assert reader.see(lab)
    assert not any(reader.see(lab) for _ in range(20))


@pytest.mark.parametrize(
    "command",
    [c.Hold(), c.StepOnce(), c.Reset(), c.LookAt(0.2), c.SetRunning(True)],
    ids=lambda command: type(command).__name__,
)
def test_what_changes_while_time_stands_still_is_told(command: c.Command) -> None:
    lab, reader = new_lab(0.5), Reader()
    do(lab, c.SetRunning(False))
    reader.see(lab)
    do(lab, command)
    lab.advance(0.2)
    assert reader.see(lab)
    assert_knows(reader, lab)


def test_a_time_is_told_once_while_the_path_is_bent_in_a_pause() -> None:
    lab, reader = new_lab(0.5), Reader()
    do(lab, c.ChoosePath("ellipse"))
    lab.advance(FRAME)
    reader.see(lab)
    do(lab, c.SetRunning(False))
    for _ in range(3):
        lab.advance(FRAME)
        reader.see(lab, reads=False)
    reader.see(lab)
    do(lab, c.SetRunning(True))
    lab.advance(FRAME)
    reader.see(lab)
    assert_knows(reader, lab)


def test_another_lab_is_told_from_its_beginning() -> None:
    """A teacher looks at one student after the other."""
    one, other, reader = new_lab(2.0), new_lab(1.0), Reader()
    reader.see(one)
    reader.see(other, reads=False)
    reader.see(other)
    assert_knows(reader, other)
    assert len(reader.rows) < 70


@pytest.mark.thorough
@settings(max_examples=3)
@given(name=st.sampled_from(list(ROBOTS)))
def test_the_path_has_the_points_that_the_laws_aim_at(name: str) -> None:
    lab, reader = new_lab(), Reader()
    do(lab, c.ChooseRobot(name))
    for _ in range(30):
        lab.advance(FRAME)
    do(lab, c.Hold(True))
    for _ in range(60):
        lab.advance(FRAME)
    reader.see(lab)
    simulation = lab.simulation
    message = msgspec.json.decode(encoded(path_message(simulation.robot, take_motion(lab).path)))
    points = np.array(message["points"]) / LENGTH
    assert message["closed"] is simulation.editor.curve.closed
    right, up = np.array(message["right"]), np.array(message["up"])
    assert [right @ right, up @ up, right @ up] == pytest.approx([1, 1, 0], abs=1e-9)
    for robot, run in zip(reader.robots(reader.rows[-1]), simulation.runs.values(), strict=True):
        place = (robot["theta"] + np.pi) / (2 * np.pi) % 1 * (len(points) - 1)
        closest = [np.interp(place, range(len(points)), column) for column in points.T]
        truth = simulation.robot.frame.lift(simulation.editor.curve.at(run.shown()["theta"][0]))
        assert np.abs(closest - truth).max() < 3e-5
    if simulation.entry.flexible_link:
        rigid = np.array(reader.straight[-1]).reshape(2, -1) / LENGTH
        ends = np.array([robot["y"] for robot in reader.robots(reader.rows[-1])])
        bent = [run.shown()["y"] for run in simulation.runs.values()]
        deflection = simulation.sample()[:, simulation.sample_layout.slices["deflection"].start]
        assert np.linalg.norm(ends - rigid, axis=1) == pytest.approx(np.abs(deflection), abs=2e-5)
        assert np.abs(ends - bent).max() <= UNIT
    else:
        assert reader.straight == []
