"""The log of a real arm over the plots of a lab: from a file to what its page is told."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import onpath
from onpath.app.exports.log_upload import LogUpload, read_log
from onpath.app.lab import commands as c
from onpath.app.lab.commands.logs import ShowLog
from onpath.app.lab.lab import Lab
from onpath.app.lab.shown_log import ShownLog, log_data, log_from, read_shown_log
from onpath.app.server.page_log import PageLog
from onpath.app.storage.lab_state import keep, put_back
from onpath.lessons.course import NO_LESSONS, read_course
from onpath.lessons.words import ENGLISH
from onpath.models.paths.distance import path_distance
from onpath.models.systems.catalogue import FIVE_BAR, ROBOTS
from tests.support.lab import do, loop_cache, new_lab, run, take_snapshot
from tests.support.lesson_texts import LESSON, write_lesson


@pytest.fixture(scope="module")
def motion() -> onpath.Run:
    return onpath.simulate(duration=2.0, hold=(0.5, 1.0))


def written(motion: onpath.Run, names: str = "", scale: float = 1.0) -> bytes:
    """The log of a run: times, angles times a scale, torques."""
    numbers = np.column_stack([motion.t, scale * motion.q, motion.torque])[::4]
    file = io.BytesIO()
    np.savetxt(file, numbers, delimiter=";", header=names, comments="", fmt="%.9f")
    return file.getvalue()


def read(content: bytes, name: str = "arm.csv", robot: str = "five_bar", **use: Any):
    parameters = ROBOTS[robot].parameters()
    upload = LogUpload(name, content, robot, parameters, **{"columns": {}, "units": {}, **use})
    return read_log(upload)


class Page:
    """What a page knows of a lab's log."""

    def __init__(self) -> None:
        self._log = PageLog(lambda work: work())
        self.knows: dict[str, Any] = {"file": ""}
        self.heard = 0
        self._before = None

    def look(self, lab: Lab) -> dict[str, Any]:
        self._before = take_snapshot(lab, 1.0, self._before)
        if (message := self._log.news(self._before.log)) is not None:
            self.knows = msgspec.json.decode(message)
            self.heard += 1
        return self.knows

    def field(self, name: str) -> np.ndarray:
        found = {field: np.array(x, dtype=float) / unit for field, unit, x in self.knows["fields"]}
        return found[name]


def test_a_log_is_told_as_curves_of_the_run_that_it_is(motion: onpath.Run) -> None:
    found = read(written(motion, "t;q1;q2;tau1;tau2")).found
    assert isinstance(found, ShownLog)
    lab, page = new_lab(), Page()
    do(lab, ShowLog(found))
    assert "arm.csv" in lab.message
    assert page.look(lab)["file"] == "arm.csv"
    times = np.array(page.knows["times"])
    for name, true in (
        ("distance", motion.distance),
        ("theta", motion.theta),
        ("theta_rate", motion.theta_rate),
        ("xi", motion.xi[:, 0]),
    ):
        calm = np.abs(times - 0.5) > 0.1
        calm &= np.abs(times - 1.0) > 0.1  # rates are filtered, and rows are interpolated
        apart = np.abs(page.field(name)[0] - np.interp(times, motion.t, true))[calm]
        assert apart.max() < 0.02 * max(np.abs(true).max(), 1e-3), name
    assert [name for name, _, _ in page.knows["fields"]].count("force") == 0


@settings(max_examples=25)
@given(st.lists(st.floats(0.0, 1.9), min_size=1, max_size=5), st.floats(0.06, 0.5))
def test_a_log_with_gaps_is_told_whole_and_open_at_the_gaps(
    motion: onpath.Run, begins: list[float], length: float
) -> None:
    """What is told are the rows that there are, at their times, and nothing between."""
    lines = written(motion).decode().splitlines()
    t = np.array([float(line.partition(";")[0]) for line in lines])
    gone = np.any([(t > begin) & (t < begin + length) for begin in begins], axis=0)
    kept = t[~gone]
    parts = np.split(kept, np.flatnonzero(np.diff(kept) > 0.05) + 1)
    assume(all(len(part) >= 20 for part in parts))  # shorter ones are left out
    rows = [line for line, is_gone in zip(lines, gone, strict=True) if not is_gone]
    found = read("\n".join(rows).encode())
    assert isinstance(found.found, ShownLog) and found.is_whole
    lab, page = new_lab(), Page()
    do(lab, ShowLog(found.found))
    page.look(lab)
    times = kept[0] + np.array(page.knows["times"])
    known = np.isfinite(page.field("distance")[0])
    assert np.count_nonzero(~known) == len(parts) - 1
    within = [(times >= part[0] - 1e-3) & (times <= part[-1] + 1e-3) for part in parts]
    assert np.array_equal(np.any(within, axis=0), known) and all(np.any(within, axis=1))
    true = np.transpose([np.interp(times[known], motion.t, each) for each in motion.y.T])
    assert np.abs(found.found.motion.y[known] - true).max() < 1e-4


def test_the_curves_follow_the_path_once_it_rests(motion: onpath.Run) -> None:
    found = read(written(motion)).found
    assert isinstance(found, ShownLog)
    lab, page = new_lab(), Page()
    do(lab, ShowLog(found))
    page.look(lab)
    do(lab, c.ChoosePath("clover"))
    page.look(lab)
    heard = page.heard
    for _ in range(60):
        run(lab, 1 / 60)
        page.look(lab)
    assert page.heard <= heard + 1  # not in every frame of the blend
    robot, curve = lab.simulation.robot, lab.simulation.editor.curve
    true = path_distance(robot.frame, curve, found.motion.y)
    assert np.abs(page.field("distance")[0] - true).max() < 1e-5


def test_it_is_hidden_in_a_lesson_and_for_another_robot_and_removed_by_one_command(
    motion: onpath.Run, tmp_path: Path
) -> None:
    found = read(written(motion)).found
    assert isinstance(found, ShownLog)
    write_lesson(tmp_path, LESSON)
    lab, page = Lab(loop_cache(), FIVE_BAR, read_course([tmp_path])[0]), Page()
    do(lab, ShowLog(found))
    lesson = next(iter(lab.lessons.course.lessons))
    for hide, bring in (
        (c.ChooseRobot("two_link_arm"), c.ChooseRobot("five_bar")),
        (c.OpenLesson(lesson), c.CloseLesson()),
    ):
        assert page.look(lab)["file"]
        do(lab, hide)
        assert not page.look(lab).get("file")
        do(lab, bring)
        assert page.look(lab)["file"]
    do(lab, c.RemoveLog())
    assert not page.look(lab).get("file") and lab.log is None
    heard = page.heard
    page.look(lab)
    assert page.heard == heard


def test_it_is_kept_with_the_lab(motion: onpath.Run) -> None:
    found = read(written(motion)).found
    assert isinstance(found, ShownLog)
    lab, states = new_lab(), list[Any]()
    do(lab, ShowLog(found))
    keep(lab, lambda make: states.append(make()))
    state = msgspec.json.decode(msgspec.json.encode(states[0]))
    other = Lab(loop_cache(), FIVE_BAR, NO_LESSONS)
    put_back(other, state)
    assert other.log is not None and other.log.file == "arm.csv"
    for name in ("t", "y", "y_rate", "u", "force"):
        kept = getattr(other.log.motion, name)
        assert np.allclose(kept, getattr(found.motion, name), rtol=1e-6, atol=1e-9)
    bad = {**log_data(found), "y": "AAAA"}
    for data in (None, 3, {}, bad, {**log_data(found), "rows": 10**9}):
        assert log_from(data) is None


def test_a_long_log_of_seven_axes_is_small() -> None:
    """A minute at 1 kHz."""
    rng, rows, axes = np.random.default_rng(1), 60_000, 7
    t = 1e-3 * np.arange(rows)
    angles = 0.3 * np.sin(np.outer(t, 1 + np.arange(axes)))
    file = io.BytesIO()
    np.savez(file, t=t, q=angles, tau=rng.normal(size=(rows, axes)))
    found = read(file.getvalue(), "arm.npz", "seven_axes").found
    assert isinstance(found, ShownLog) and len(found.motion.y) <= 1200
    assert len(msgspec.json.encode(log_data(found))) < 150_000


@pytest.mark.parametrize(
    "content, use, why",
    [
        (b"", {}, "empty"),
        (b"a;b;c\n1;2;3\n4;5;6\n", {}, "say which columns are t, q1, q2, tau1, tau2"),
        (b"\x93NUMPY garbage", {}, "say which"),
        (b"1;2;3;4;5\n2;2;3;4;x\n", {}, "line 2"),
        (b"t;a;b;c;d\n1;2;3;4;5\n", {"columns": {"q9": "a"}}, "say which"),
        (b"1;2;3;4;5\n1.5;2;3;4;5\n", {"units": {"q1": "parsec"}}, "parsec"),
    ],
)
def test_what_does_not_fit_is_refused_in_a_sentence(content: bytes, use: Any, why: str) -> None:
    refused = read(content, **use)
    assert not isinstance(refused.found, ShownLog)
    sentence = ENGLISH.sentence(refused.found)
    assert why in sentence and "Traceback" not in sentence


def test_what_is_refused_tells_what_can_be_chosen(motion: onpath.Run) -> None:
    content = written(motion, "ms;a;b;M1;M2", 180 / np.pi)
    refused = read(content)
    assert refused.columns == ("ms", "a", "b", "M1", "M2")
    assert {each.name for each in refused.quantities} >= {"t", "q1", "tau2", "force1"}
    columns = {"t": "ms", "q1": "a", "q2": "b", "tau1": "M1", "tau2": "M2"}
    chosen = read(content, columns=columns, units={"q1": "deg", "q2": "deg"}).found
    plain = read(written(motion)).found
    assert isinstance(chosen, ShownLog) and isinstance(plain, ShownLog)
    assert np.abs(chosen.motion.y - plain.motion.y).max() < 1e-7


def test_a_figure_and_the_command_line_read_the_same_log(
    motion: onpath.Run, tmp_path: Path
) -> None:
    file = tmp_path / "arm.csv"
    file.write_bytes(written(motion, "t;q1;q2;tau1;tau2"))
    columns = {name: name for name in ("t", "q1", "q2", "tau1", "tau2")}
    log = read_shown_log(file, FIVE_BAR, columns, {})
    plain = read(file.read_bytes()).found
    assert isinstance(plain, ShownLog)
    assert np.array_equal(log.motion.y, plain.motion.y)
    with pytest.raises(ValueError, match=r"arm\.csv"):
        read_shown_log(file, ROBOTS["seven_axes"], {"t": "t"}, {})
