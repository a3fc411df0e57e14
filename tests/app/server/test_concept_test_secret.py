"""No key of the concept test is in anything that a student's browser gets before it is over.

Every message of both websockets is read, in a class for which a teacher opens the test, and on
its wall; and the files of the pages.
"""

from __future__ import annotations

import json
from functools import partial
from typing import Any
from urllib.request import urlopen

from typing_extensions import override

from onpath.app.classroom.classroom import Classroom
from onpath.app.lab.commands import TakeStep
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.addresses import class_address
from onpath.assets import asset_path
from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, SITTINGS, name_of, sitting_of
from onpath.lessons.words import ENGLISH
from tests.support import waiting
from tests.support.built_in import built_in_course
from tests.support.concept_key import asked_in, found_in, key_of
from tests.support.own_socket import OwnSocket
from tests.support.student import Student

wait_for = partial(waiting.wait_for, seconds=60.0)
FORMS = built_in_course()[0].forms("en")
KEY, ASKED = key_of(FORMS), asked_in(FORMS)
LAST = len(FORMS[0].steps) - 1


class Reader(Student):
    """A tab that keeps all that it has received.

    Attributes:
        received_text: since it was emptied last.
    """

    received_text = ""

    @override
    def _take_message(self, message: dict[str, Any]) -> None:
        self.received_text += json.dumps(message, ensure_ascii=False)
        super()._take_message(message)

    @override
    def hear_scene(self, message: dict[str, Any]) -> None:
        self.received_text += str(message)


def sit(student: Reader, room: Classroom, sitting: str) -> None:
    """The teacher opens a test for the class, in which the student chooses any option."""
    room.push(TakeStep(sitting, 0))
    for index in range(LAST + 1):
        student.read(
            lambda at=index: (
                sitting_of(student.lesson.get("lesson", "")) == sitting
                and student.lesson["index"] == at
            )
        )
        blocks = student.lesson["steps"][index]["blocks"]
        at = next(i for i, block in enumerate(blocks) if block["kind"] == "quiz")
        student.tell({"do": "AnswerQuiz", "block": at, "option": index % 4})
        answered = ENGLISH("test.answered", part=index + 1, all=LAST + 1)
        student.read(lambda told=answered: student.sees(told))
        student.tell({"do": "GoToStep", "by": 1})


def test_no_frame_has_a_key_before_the_second_form_is_handed_in(
    server: LabServer, room: Classroom
) -> None:
    path = f"127.0.0.1:{server.server.get_port()}{class_address(room.code)}"
    with Reader(f"ws://{path}") as student, OwnSocket(f"ws://{path}wall") as wall:
        student.open()
        student.read(lambda: student.code)
        student.join("Ada")
        student.read(lambda: student.is_member)
        forms = list[str]()
        for sitting in SITTINGS:
            sit(student, room, sitting)
            forms.append(student.lesson["lesson"])
            for sheet in ("lessons", "keep"):
                student.ask(sheet)
            assert found_in(KEY, student.received_text) == []
            assert '"right"' not in json.dumps(student.lesson)
            student.press(ENGLISH("test.hand_in"))
            thanks = ENGLISH("test.thanks")
            student.read(lambda told=thanks: student.sees(told))
            if sitting == BEFORE:
                assert found_in(KEY, student.received_text) == []
        assert sorted(forms) in (
            sorted([BEFORE, name_of(AFTER, 1)]),
            sorted([name_of(BEFORE, 1), AFTER]),
        )
        assert len(set(found_in(KEY, student.received_text))) >= len(KEY) // 4  # all that is right
        assert len(found_in(ASKED, student.received_text)) == len(ASKED)
        wait_for(lambda: ENGLISH("test.alone") in json.dumps(wall.told))
        assert found_in([*KEY, *ASKED], json.dumps(wall.told, ensure_ascii=False)) == []
    room.end()


def test_no_page_and_no_file_for_pages_has_a_key_or_a_question(
    server: LabServer, room: Classroom
) -> None:
    root = f"http://127.0.0.1:{server.server.get_port()}"
    for page in ("/", class_address(room.code)):
        with urlopen(f"{root}{page}") as answer:
            assert found_in([*KEY, *ASKED], answer.read().decode()) == [], page
    files = [*asset_path("web").glob("*.*"), *asset_path("page").rglob("*.*")]
    assert any(file.suffix == ".js" and file.stat().st_size > 100_000 for file in files)
    for file in files:
        text = file.read_bytes().decode("utf-8", "replace")
        assert found_in([*KEY, *ASKED], text) == [], file
