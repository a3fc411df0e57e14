"""A class that was kept within steps which the course no longer has."""

from __future__ import annotations

import pytest

from onpath.app.classroom.classroom import Classroom
from onpath.app.common.access_codes import shown
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.lessons.pace import Pace
from tests.support.student import Student

LESSON = "01-path-or-timetable"


@pytest.mark.parametrize(
    ("pace", "is_kept"),
    [
        (Pace("renamed", 0, 1), False),
        (Pace(LESSON, 0, 400), False),
        (Pace(LESSON, -1, 2), False),
        (Pace(LESSON, 3, 2), False),
        (Pace(LESSON, 1, 2), True),
    ],
)
def test_the_class_goes_on_and_its_teacher_is_let_in(pace: Pace, is_kept: bool) -> None:
    room = Classroom()
    room.keep_within(pace)
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(classrooms=[room]))
    try:
        address = f"ws://127.0.0.1:{server.server.get_port()}/c/{room.code}"
        with Student(address) as teacher:
            teacher.open()
            teacher.teach(shown(room.key))
            teacher.read(lambda: teacher.teaches)
        assert room.orders.pace == (pace if is_kept else None)
    finally:
        server.stop()
