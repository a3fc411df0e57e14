"""Whose lab is kept reads for how long; a report has its code only if its owner wants so."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from onpath.app.exports.exporter import Exporter
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.app.storage.expiry import Retention
from onpath.app.storage.records import Records, file_url
from onpath.lessons.words import ENGLISH
from tests.support.student import Student


@pytest.fixture(params=["kept", "not kept"])
def student(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Student]:
    """In a lab that has a code for its user, or none."""
    records = Records(file_url(tmp_path / "labs.db")) if request.param == "kept" else None
    server = LabServer(
        "127.0.0.1", 0, LoopCache(), ServerOptions(records=records, retention=Retention(30))
    )
    with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
        student.open()
        yield student
    server.stop()


def test_the_report_has_the_code_only_when_its_owner_says_so(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    codes: list[str] = []
    monkeypatch.setattr(Exporter, "report", lambda _, code="": codes.append(code))
    button, choice = ENGLISH("keep.report"), ENGLISH("keep.with_code")
    student.set(button, True)
    student.read(lambda: len(codes) == 1 and student.code)
    assert codes == [""]
    student.read(lambda: student.has_widget(ENGLISH("controls.help")))  # the last widget
    kept = student.has_widget(ENGLISH("keep.other"))
    assert student.has_widget(choice) == student.sees(ENGLISH("keep.with_code_means")) == kept
    if kept:
        for chosen in (True, False):
            student.set(choice, chosen)
            student.set(button, True)
            student.read(lambda: len(codes) > 1 + (not chosen))
        assert codes == ["", student.code, ""]


def test_the_page_says_after_how_many_days_the_lab_is_deleted(student: Student) -> None:
    student.read(lambda: student.has_widget(ENGLISH("controls.help")))  # the last widget
    kept = student.has_widget(ENGLISH("keep.other"))
    assert student.sees(ENGLISH("keep.until", days=30)) == kept
