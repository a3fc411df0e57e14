"""A route in the list of lessons and on the page of the open step."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from onpath.app.classroom.class_state import push_data, read_push
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.lessons.words import ENGLISH
from tests.lessons.test_routes import written
from tests.support import waiting
from tests.support.student import Student

wait_for = partial(waiting.wait_for, seconds=30.0)  # only ends a test that would hang


@pytest.mark.thorough
def test_a_student_follows_a_route_from_the_list_to_its_end(tmp_path: Path) -> None:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course=written(tmp_path)))
    try:
        with Student(f"ws://127.0.0.1:{server.server.get_port()}") as student:
            student.open()
            student.read(lambda: student.code)
            lab = wait_for(lambda: server.registry.find(student.code)).scheduled.lab
            (route,) = student.ask("lessons")["routes"]
            assert "1. A lesson, steps 2 to 3, 5 min" in route["stops"]
            assert "11.5" in route["minutes"]
            student.tell({"do": "FollowRoute", "name": route["name"]})
            student.read(lambda: student.sees("Short: part 1 of 3, to step 3, 5 min"))
            assert lab.lessons.progress.route == "short"
            lab.post(TakeStep("02-b", 5))
            student.read(lambda: student.sees("Short: part 2 of 3, to step 6, 2.5 min"))
            student.press(ENGLISH("lesson.next"))
            student.read(lambda: student.sees("Short: part 3 of 3"))
            assert not student.has_button(ENGLISH("lesson.finish"))
            student.press(ENGLISH("lesson.next"))
            student.read(lambda: student.has_button(ENGLISH("lesson.finish")))
            lab.post(TakeStep("02-b", 0))
            student.read(lambda: student.sees("Step 1 of 8") and not student.sees("Short: part"))
    finally:
        server.stop()


def test_what_the_teacher_sends_keeps_its_route() -> None:
    """In the database of a class, and as earlier versions kept it."""
    for push in (TakeStep("01-a", 1, "short"), TakeStep("01-a", 1)):
        assert read_push(push_data(push)) == push
    assert read_push({"lesson": "01-a", "step": 1}) == TakeStep("01-a", 1)
