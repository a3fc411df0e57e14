"""What was kept or shared when a lab had two fixed laws is read as before.

`tests/data/two_laws` was written by that version: a database with two labs, one in a lesson with a
sketch, its truth and two passed tasks, and with a class of two that was sent a set-up.
"""

from __future__ import annotations

import sqlite3
from contextlib import closing
from datetime import datetime
from pathlib import Path

import pytest

from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_state import LessonState
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.setup import to_data
from onpath.app.lab.setups.share_code import decode
from onpath.app.storage.lab_state import put_back
from onpath.app.storage.records import Records, file_url
from onpath.models.control.benches import DEFAULT_LAWS, LEFT
from tests.support.built_in import built_in_course
from tests.support.checkout import ROOT
from tests.support.lab import do, new_lab, store

DATA = ROOT / "tests" / "data" / "two_laws"
COURSE = built_in_course()[0]
LESSON = "01-path-or-timetable"
DAY = datetime(2026, 11, 23)
ELLIPSE = (
    "ONPATH1-VNDISD44OEAHFNRFFBKGVCNRJ7LRYGECAY5EAO4MFXGQZDMB62MBXGUYQD42MIAJCNBYRKAFJAKKMFRCBAITHUEB"
    "FDKEKEUMVUC5UXKSTYHYZOV45T4MJIS4FSXAIBVRWEY5BEKAAAAA-MX2GGNI"
)
"""An ellipse with a point moved and K1 = 900, and K2 = 33 for the two-link arm."""
SLOW = "ONPATH1-VNDI2L6UXA2UDC22RTMKYBIA-C45SUEI"
"""The flexible robot in slow motion, drawn four times larger, without copying."""


@pytest.fixture
def records(tmp_path: Path) -> Records:
    file = tmp_path / "onpath.db"
    with closing(sqlite3.connect(file)) as raw:
        raw.executescript((DATA / "database.sql").read_text("utf-8"))
    return Records(file_url(file), lambda: 1.8e9)


@pytest.mark.parametrize("code", [ELLIPSE, SLOW])
def test_a_share_code_sets_up_the_usual_laws(code: str) -> None:
    lab = new_lab()
    lab.session.change_law(LEFT, "set_point")
    do(lab, c.UseShared(code))
    assert lab.message == lab.words("say.set_up") and lab.session.laws == DEFAULT_LAWS
    assert decode(code).laws == {} and "laws" not in to_data(capture(lab.session))
    if code == ELLIPSE:
        assert lab.session.parameters.K1 == 900.0
        assert lab.session.earlier["two_link_arm"][0].K2 == 33.0
    else:
        session = lab.session
        told = session.entry.name, session.rate, session.copy, session.exaggeration
        assert told == ("flexible", 0.5, False, 4.0)


def test_a_kept_lab_opens_in_its_lesson(records: Records) -> None:
    kept = records.load("c0de01")
    assert kept is not None
    lab = Lab(store(), course=COURSE)
    put_back(lab, kept)
    assert lab.session.laws == DEFAULT_LAWS and lab.lessons.progress.lesson == LESSON
    notes = lab.lessons.notes
    assert notes.answers["1"].values == (0.0, 1.0, 30.0, 2.0)
    assert max(notes.truths["1"].tracker) > 40 > 5 > max(notes.truths["1"].follower)
    assert set(notes.tasks) == {"hold-two-seconds", "thirty-times"}
    page = report(LessonState(COURSE, lab.lessons.progress), "", DAY).decode()
    assert "Tracker" in page and "Follower" in page
    do(lab, c.CloseLesson())
    assert lab.session.parameters.K1 == 900.0 and lab.session.editor.design.name == "edited"
    records.close()
