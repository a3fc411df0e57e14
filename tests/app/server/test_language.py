"""A new lab speaks the language that the browser prefers; one that is kept speaks its own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.app.classroom.classroom import Classroom
from onpath.app.common.access_codes import shown
from onpath.app.lab.commands import SetLanguage
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.assets.messages import languages, preferred
from onpath.lessons.words import ENGLISH, Words
from tests.support.lab import loop_cache
from tests.support.student import Student

HEADERS = {
    "": "en",
    "de-DE,de;q=0.9,en;q=0.8": "de",
    "fr-FR, de;q=0.5, en;q=0.4": "de",
    "en;q=0.5, de;q=0.7": "de",
    "en, de": "en",
    "de;q=0, en;q=0.1": "en",
    "de;q=0": "en",
    "DE-at": "de",
    "ar-EG": "en",
    "de;q=2": "en",
    "*": "en",
}


@pytest.mark.parametrize(("header", "language"), HEADERS.items())
def test_the_language_with_the_greatest_weight_is_preferred(header: str, language: str) -> None:
    assert preferred(header) == language


@given(st.text())
@example(";q=,;;,=q")
def test_any_header_names_a_language(header: str) -> None:
    assert preferred(header) in languages()


@pytest.fixture
def server() -> Iterator[LabServer]:
    server = LabServer("127.0.0.1", 0, loop_cache())
    yield server
    server.stop()


def test_a_new_lab_speaks_the_language_of_its_browser(server: LabServer) -> None:
    address = f"ws://127.0.0.1:{server.server.get_port()}"
    headers: Any = {"Accept-Language": "de-AT,de;q=0.9,en;q=0.5"}
    with Student(address, **headers) as student:
        student.open()
        student.read(lambda: student.fields)
        assert student.fields["path"]["label"] == "Bahn"
        lab = server.registry.find(student.code)
        assert lab is not None and lab.scheduled.lab.words.language == "de"


def test_a_page_that_waits_for_a_place_reads_why_in_the_language_of_its_browser() -> None:
    server = LabServer("127.0.0.1", 0, loop_cache(), ServerOptions(most_clients=1))
    address = f"ws://127.0.0.1:{server.server.get_port()}"
    german: Any = {"Accept-Language": "de-AT,de;q=0.9,en;q=0.5"}
    try:
        with Student(address) as inside, Student(address, **german) as outside:
            inside.open()
            inside.read(lambda: inside.fields)
            outside.open()
            outside.read(lambda: "wait" in outside.told)
            words = Words("de")
            text = f"{words('full.text', places=1)} {words('full.before', count=0)}"
            assert outside.told["wait"]["text"] == text
    finally:
        server.stop()


@pytest.mark.thorough
def test_the_teachers_page_follows_the_teachers_language_whoever_is_shown() -> None:
    room, german = Classroom(), Words("de")
    server = LabServer("127.0.0.1", 0, loop_cache(), ServerOptions(classrooms=[room]))
    address = f"ws://127.0.0.1:{server.server.get_port()}/c/{room.code}"
    with Student(address) as student, Student(address) as teacher:
        student.open()
        student.join("Ada")
        student.read(lambda: student.is_member)
        teacher.open()
        teacher.teach(shown(room.key))
        teacher.read(lambda: "class.freeze" in teacher.fields)
        own = server.registry.find(teacher.code)
        assert own is not None
        own.scheduled.lab.post(SetLanguage("de"))
        label = german("class.freeze")
        teacher.read(lambda: teacher.fields["class.freeze"]["label"] == label)
        teacher.set("class.follow", 1)
        following = german("class.following", name="Ada")
        teacher.read(lambda: teacher.values["class.who"] == following)
        assert teacher.fields["class.freeze"]["label"] == label
    server.stop()


@pytest.mark.parametrize(("time", "text"), [("0.5", "0,5"), ("−12.25", "−12,25"), ("3", "3")])
def test_numbers_in_german_texts_have_a_comma(time: str, text: str) -> None:
    assert text in Words("de")("say.brought_back", time=time)
    assert time in ENGLISH("say.brought_back", time=time)
