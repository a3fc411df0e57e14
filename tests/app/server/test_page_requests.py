"""What a page asks of its server without a change of its lab, over its own websocket alone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import get_args

import pytest

from onpath.app.channel.sheet_messages import SheetName
from onpath.app.common.access_codes import new_code, shown
from onpath.app.exports.exporter import Exporter
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.page_data import MOST_REQUESTS
from onpath.app.server.server_options import ServerOptions
from onpath.app.storage.expiry import Retention
from onpath.app.storage.records import Records, file_url
from onpath.app.view.comparing import MOST
from onpath.lessons.words import ENGLISH
from tests.support.student import Student


@pytest.fixture(scope="module", params=["kept", "not kept"])
def student(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Student]:
    """In a lab that is stored, or is not."""
    file: Path = tmp_path_factory.mktemp("labs") / "labs.db"
    records = Records(file_url(file)) if request.param == "kept" else None
    options = ServerOptions(records=records, retention=Retention(30))
    server = LabServer("127.0.0.1", 0, LoopCache(), options)
    with Student(f"ws://127.0.0.1:{server.server.get_port()}", scene=False) as student:
        student.open()
        student.read(lambda: student.values)
        student.is_kept = records is not None  # type: ignore[attr-defined]
        yield student
    server.stop()


def told(student: Student, **message: object) -> str:
    """What is told in answer to a message."""
    student.told.pop("told", None)
    student.tell(message)
    student.read(lambda: "told" in student.told)
    return student.told["told"]["text"]


@pytest.mark.thorough
def test_every_sheet_comes_when_it_is_asked_for(student: Student) -> None:
    for what in get_args(SheetName):
        assert student.ask(what)["is"] == what


def test_a_lab_that_is_kept_tells_its_code_and_for_how_long(student: Student) -> None:
    sheet = student.ask("keep")
    if student.is_kept:  # type: ignore[attr-defined]
        assert sheet["code"] == shown(student.code)
        assert sheet["until"] == ENGLISH("keep.until", days=30)
    else:
        assert sheet["code"] == sheet["until"] == ""


def test_the_report_has_the_code_only_when_its_owner_says_so_and_it_opens_the_lab(
    student: Student, monkeypatch: pytest.MonkeyPatch
) -> None:
    codes = list[str]()
    monkeypatch.setattr(Exporter, "report", lambda _, code="": codes.append(code))
    for with_code in (False, True, False):
        before = len(codes)
        student.tell({"is": "make", "file": "report", "with_code": with_code})
        student.read(lambda before=before: len(codes) > before)
    own = student.code if student.is_kept else ""  # type: ignore[attr-defined]
    assert codes == ["", own, ""]


def test_another_lab_that_does_not_exist_is_refused_in_words(student: Student) -> None:
    assert told(student, **{"is": "enter", "code": new_code()}) == ENGLISH("error.no_such_lab")
    assert student.state["own"]


@pytest.mark.parametrize("laws", [["no such law"], ["path_following", "across = 0"]])
def test_only_laws_that_are_offered_are_compared(student: Student, laws: list[str]) -> None:
    asked = {"is": "compare_laws", "laws": laws, "obstruction": "brake"}
    assert told(student, **asked) == ENGLISH("compare.count", most=MOST)
    asked = {"is": "compare_laws", "laws": ["path_following"], "obstruction": "a wall of fire"}
    assert told(student, **asked) == ENGLISH("compare.count", most=MOST)


def test_what_a_user_prefers_is_kept_in_the_browser(student: Student) -> None:
    for on in (True, False):
        student.tell({"is": "prefer", "name": "sounds", "on": on})
        wanted = "yes" if on else "no"
        student.read(lambda wanted=wanted: student.kept.get("onpath_sounds") == wanted)


def test_too_many_requests_at_once_are_refused_and_the_page_goes_on(student: Student) -> None:
    student.tell(*[{"is": "summary"}] * (4 * MOST_REQUESTS))
    student.read(lambda: "too many requests" in student.told.get("refused", {}).get("why", ""))
    student.read(lambda: student.state["said"]["summaries"])  # some have been served
    assert student.ask("display")["languages"]
