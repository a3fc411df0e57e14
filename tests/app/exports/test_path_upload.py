"""Files with paths from a browser: read in another process, and refused in words."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from onpath.app.channel.file_inbox import MOST_BYTES
from onpath.app.exports import path_upload, upload_reader
from onpath.app.exports.export_process import ExportProcess
from onpath.app.exports.path_upload import Read, Upload
from onpath.app.exports.upload_reader import UploadReader
from onpath.app.lab import commands as c
from onpath.app.lab.commands.path import FollowCurve
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.lessons.words import ENGLISH
from onpath.models.errors import Message
from onpath.models.path_files.placing import ROUND, Placing
from onpath.models.paths.curves import circle
from onpath.models.paths.spline_curves import SplineCurve
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, new_lab, run

pytest.importorskip("svgpathtools")

HEAD = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9">'
BOMB = b"<!DOCTYPE a [" + b"".join(
    b'<!ENTITY a%d "%s">' % (i, b"&a%d;" % (i - 1) * 10 if i else b"x" * 99) for i in range(9)
)
HOSTILE = {
    "entities that inflate": (
        BOMB + b"]><svg>&a8;</svg>",
        "a.svg",
        "does not stand for plain text",
    ),
    "a file of the server": (
        b'<!DOCTYPE s [<!ENTITY a SYSTEM "file:///etc/passwd">]><svg><text>&a;</text></svg>',
        "a.svg",
        "does not stand for plain text",
    ),
    "too large": (b"0,0\n" * (MOST_BYTES // 4 + 1), "a.csv", "larger than 1 MB"),
    "too many points": (b"0,0\n" * 100_001, "a.csv", "more than"),
    "too many pieces": (
        HEAD + b'<path d="M0 0' + b"q1 1 2 0" * 50_000 + b'"/></svg>',
        "a.svg",
        "more than|too long",
    ),
    "many cubic pieces": (
        HEAD + b'<path d="M0 0' + b"c0 1 1 1 2 0" * 80_000 + b'"/></svg>',
        "a.svg",
        "more than",
    ),
    "deeply nested": (HEAD + b"<g>" * 100_000, "a.svg", "in each other"),
    "transforms of transforms": (
        HEAD + b'<g transform="' + b"scale(2)" * 50_000 + b'"><circle r="3"/></g></svg>',
        "a.svg",
        ".",
    ),
    "not finite": (HEAD + b'<path d="M0 0L1e999 0L1 1z"/></svg>', "a.svg", "."),
    "a picture": (b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 99, "a.svg", "."),
    "a program": (b"import os; os.remove('x')", "a.py", "line 1"),
    "nothing": (b"", "a.csv", "empty"),
    "a name that is a path": (b"", "../../../etc/passwd", "empty"),
    "a pickle": (b"cos\nsystem\n(S'touch x'\ntR.", "a.pkl", "line 1"),
}
WAIT = 60.0


@pytest.fixture(scope="module", autouse=True)
def stopped() -> Iterator[None]:
    yield
    upload_reader.process.stop()


SIZED = Placing(fit=0.1)


def command(found: Read) -> FollowCurve:
    assert isinstance(found.found, FollowCurve)
    return found.found


def read(content: bytes, name: str, placing: Placing = SIZED) -> Read:
    """What was read, in this process."""
    upload = Upload(name, content, placing, FIVE_BAR.name, FIVE_BAR.parameters())
    return path_upload.read_upload(upload, "en")


def answer(content: bytes, name: str, placing: Placing = SIZED) -> Any:
    """The command, or the reason of the refusal."""
    found, done = list[Any](), threading.Event()

    def take(result: Any) -> None:
        found.append(result.found if isinstance(result, Read) else result)
        done.set()

    upload = Upload(name, content, placing, FIVE_BAR.name, FIVE_BAR.parameters())
    UploadReader().read(upload, "en", take, take)
    assert done.wait(WAIT)
    return found[0]


@pytest.mark.thorough
@pytest.mark.parametrize("case", HOSTILE)
def test_a_hostile_file_is_refused_in_words_and_the_next_one_is_read(case: str) -> None:
    content, name, words = HOSTILE[case]
    refusal = answer(content, name)
    text = ENGLISH.sentence(refusal)
    assert "Traceback" not in text and "\n" not in text and len(text) < 300
    assert re.search(words, text), text
    good = answer(b"0,0\n4,0\n4,3\n0,3\n", "a.csv")
    assert isinstance(good, FollowCurve)


CORNERS = b"0,0\n1,1\n0,1\n" * 11_000


@pytest.mark.thorough
@pytest.mark.parametrize("case", ["many cubic pieces", "corners"])
def test_what_is_dear_is_refused_long_before_the_time_is_over(case: str) -> None:
    """Within 5 s of processor time; each took more than 15 s."""
    content, name, words = HOSTILE.get(case, (CORNERS, "a.csv", "too many corners"))
    placing = Placing(fit=0.1, corners=ROUND)
    upload = Upload(name, content, placing, FIVE_BAR.name, FIVE_BAR.parameters())
    begun = time.process_time()
    refusal = path_upload.read_upload(upload, "en").found
    assert time.process_time() - begun < 5.0
    assert isinstance(refusal, Message) and re.search(words, refusal.text())


@pytest.mark.thorough
def test_a_file_that_takes_for_ever_is_ended_and_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(path_upload, "read_upload", wait_for_ever)
    monkeypatch.setattr(upload_reader, "SECONDS", 2.0)
    process = ExportProcess()
    monkeypatch.setattr(upload_reader, "process", process)
    assert "took too long" in ENGLISH.sentence(answer(b"0,0\n", "a.csv"))
    process.stop()


def wait_for_ever(_upload: Upload, _language: str) -> None:
    threading.Event().wait()


@pytest.mark.thorough
def test_a_library_that_fails_is_not_quoted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(path_upload, "read_upload", fail)
    monkeypatch.setattr(upload_reader, "log_error", lambda _: None)
    assert ENGLISH.sentence(answer(b"0,0\n", "a.csv")) == "the file could not be read"


def fail(_upload: Upload, _language: str) -> None:
    raise RuntimeError("/home/teacher/secret")


def test_a_tab_reads_one_file_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    reader, found, done = UploadReader(), list[Any](), threading.Event()
    hold = threading.Event()

    class Slow:
        def call(self, *_: Any) -> Any:
            hold.wait(WAIT)
            return Read(FollowCurve(circle(0.05)))

    monkeypatch.setattr(upload_reader, "process", Slow())
    upload = Upload("a.csv", b"0,0", Placing(), FIVE_BAR.name, FIVE_BAR.parameters())
    reader.read(upload, "en", lambda _: done.set(), found.append)
    reader.read(upload, "en", found.append, found.append)
    assert [message.code for message in found] == ["error.file_busy"]
    hold.set()
    assert done.wait(WAIT)


def test_the_lab_follows_all_lines_of_a_file_and_tells_of_them() -> None:
    lab = new_lab(0.2)
    do(lab, command(read(LINES, "a.svg")))
    design = lab.simulation.editor.design
    assert design.name == "drawn" and not lab.simulation.editor.faults
    assert "keeps within 0." in lab.message and "raised 3 times" in lab.message
    run(lab, 1.0)
    assert all(each.diverged is None for each in lab.simulation.runs.values())


@pytest.mark.thorough
@pytest.mark.parametrize("placing", [Placing(fit=0.4), Placing(fit=0.1, centre=(0.2, 0.0))])
def test_what_cannot_be_followed_is_marked_where_and_the_old_path_kept(placing: Placing) -> None:
    lab = new_lab(0.2)
    before, found = lab.simulation.editor.design, read(LINES, "a.svg", placing)
    assert "cannot be followed" in found.why
    do(lab, command(found))
    assert lab.simulation.editor.design is before and "refused" in lab.message
    refused = take_page_snapshot(lab, 1.0).path.refused
    robot, curve = lab.simulation.robot, command(found).curve
    places = robot.position(robot.frame.lift(curve.at(curve.sample(4 * curve.grid))))
    assert len(refused)
    assert all(np.linalg.norm(places - place, axis=1).min() < 1e-3 for place in refused)
    do(lab, c.MovePoint(0, before.points[0] + 1e-3))
    assert not len(take_page_snapshot(lab, 1.0).path.refused)


LINES = b"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 90 90">
<circle cx="20" cy="20" r="10"/><circle cx="60" cy="60" r="20"/><circle cx="20" cy="70" r="8"/>
</svg>"""


def test_all_lines_are_shown_as_they_lie_in_the_file_and_any_can_be_taken() -> None:
    every = read(LINES, "a.svg")
    assert len(every.lines) == 3 and not every.helps
    low = np.min([line.min(0) for line in every.lines], axis=0)
    high = np.max([line.max(0) for line in every.lines], axis=0)
    assert low == pytest.approx([0, 0]) and high.max() == pytest.approx(1)
    middles = np.array([line.mean(0) for line in every.lines])
    assert middles[0, 1] > middles[1, 1] and middles[0, 0] < middles[1, 0]  # y points up
    for part, count in (((3,), 0), ((3, 1), 1), (None, 3)):
        curve = command(read(LINES, "a.svg", Placing(fit=0.1, part=part))).curve
        assert isinstance(curve, SplineCurve) and len(curve.raised) == count
    none = read(LINES, "a.svg", Placing(fit=0.1, part=(4,)))
    assert isinstance(none.found, Message) and len(none.lines) == 3


@pytest.mark.parametrize(("size", "sides"), [(0.3, 4), (0.4, 3)])
def test_what_is_said_to_help_does(size: float | None, sides: int) -> None:
    angles = np.linspace(0, 2 * np.pi, sides + 1) + 0.3
    points = 20 * np.column_stack([np.cos(angles), np.sin(angles)])
    content = "".join(
        f"G{min(i, 1)} X{x:.4f} Y{y:.4f}\n" for i, (x, y) in enumerate(points)
    ).encode()
    found = read(content, "a.nc", Placing(fit=size))
    assert found.why and found.helps
    for text, placing in found.helps:
        again = read(content, "a.nc", placing)
        assert isinstance(again.found, FollowCurve) and not again.why, text


def test_undo_takes_back_an_upload_each_change_of_its_placing_and_a_stroke_as_one_step() -> None:
    lab, designs = new_lab(0.2), list[Any]()
    editor = lab.simulation.editor
    for size in (0.06, 0.08, 0.1):
        designs.append(editor.design)
        do(lab, command(read(LINES, "a.svg", Placing(fit=size))))
    designs.append(editor.design)
    do(lab, c.DrawPath(np.array([[-0.05, 0.0], [0.0, 0.02], [0.05, -0.01]])))
    assert editor.design.name == "drawn" and editor.design is not designs[-1]
    for design in reversed(designs):
        do(lab, c.Undo())
        assert editor.design is design
    do(lab, c.Undo())
    assert editor.design is designs[0]
