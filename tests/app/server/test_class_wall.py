"""The wall of a class: what its pages are told, and that they change nothing."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, get_args
from urllib.request import urlopen

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.channel.class_messages import Order
from onpath.app.classroom.classroom import Classroom, Display
from onpath.app.classroom.teaching.class_answers import ClassAnswers
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.lab import commands as c
from onpath.app.lab.lesson_state import LessonState
from onpath.app.server.built_in_course import built_in_course
from onpath.app.server.lab_server import LabServer
from onpath.app.viser_adapter.addresses import class_address
from onpath.app.viser_adapter.data_channel import NO_GREETING
from onpath.lessons.given import Answer
from onpath.lessons.progress import Notes, Progress, Truth
from onpath.lessons.schema import Choice
from onpath.lessons.words import Words
from tests.support import waiting
from tests.support.own_socket import OwnSocket

wait_for = partial(waiting.wait_for, seconds=60.0)
COURSE = built_in_course()
LESSON = next(iter(COURSE.lessons))
STEPS = COURSE.lesson(LESSON, "en").steps
ASKING = [at for at, step in enumerate(STEPS) if step.predictions()]
CHOICE = next(at for at in ASKING if isinstance(STEPS[at].predictions()[0], Choice))
NAMES = "Zaphod", "Quirin", "Xanthippe"


@dataclass
class Context:
    classroom: Classroom
    chosen: TeacherChoices = field(default_factory=TeacherChoices)

    def progress(self) -> Progress:
        return Progress()


def answering(at: int, option: int) -> Progress:
    """Progress of a student who has answered the prediction of a step, and knows what happens."""
    notes = Notes(step=at, seen=at + 1)
    student = LessonState(COURSE, Progress(lesson=LESSON, notes={LESSON: notes}))
    is_choice = isinstance(STEPS[at].predictions()[0], Choice)
    curve = Answer(times=(0.0, 8.0), values=(0.0, 0.01 * option))
    student.note_answer(Answer(option=option) if is_choice else curve)
    truth = Truth("distance", (0.0, 4.0, 8.0), (0.0, 0.0471, 0.0), (0.0, 0.0, 0.0))
    student.note(truths={str(at): truth})
    return student.progress


def come(room: Classroom, name: str, progress: Progress) -> None:
    lab = (name * 2)[:12].lower()
    room.join(lab, room.code, name)
    room.note(lab, progress=progress)


@st.composite
def classes(draw: st.DrawFn) -> tuple[Classroom, Classroom]:
    """Two classes with the same step and vote: one in which nobody is, and one with answers."""
    at, wait = draw(st.sampled_from(ASKING)), draw(st.sampled_from([None, 0.0, 60.0]))
    empty, room = (Classroom(now=lambda: 1e9) for _ in range(2))
    for each in (empty, room):
        each.push(c.TakeStep(LESSON, at), [str(at)])
        if wait is not None:
            each.close(each.open_votes, wait)
    for name in draw(st.lists(st.sampled_from(NAMES), unique=True)):
        come(room, name, answering(at, draw(st.integers(0, 1))))
    return empty, room


@given(classes(), st.sampled_from(["en", "de"]))
@settings(max_examples=12, deadline=None)
def test_before_the_teacher_shows_nothing_on_the_wall_depends_on_the_answers(
    both: tuple[Classroom, Classroom], language: str
) -> None:
    views = [ClassAnswers(COURSE, Words(language), Context(room)) for room in both]
    before, after = ((each.view(large=True, silent=True), each.closing()) for each in views)
    assert before == after


def address(server: LabServer, room: Classroom) -> str:
    return f"127.0.0.1:{server.server.get_port()}{class_address(room.code)}wall"


def wall(server: LabServer, room: Classroom) -> OwnSocket:
    return OwnSocket(f"ws://{address(server, room)}")


def shown(page: OwnSocket) -> dict[str, Any]:
    """What a page was told last, besides the robots."""
    return ([{"asked": ""}] + [each for each in list(page.told) if each["is"] == "wall"])[-1]


def sides(page: OwnSocket) -> list[dict[str, Any]]:
    return [each for each in list(page.told) if each["is"] == "frame"]


def test_a_wall_has_neither_names_nor_answers_until_the_teacher_shows_them(
    server: LabServer, room: Classroom
) -> None:
    with wall(server, room) as page:
        room.push(c.TakeStep(LESSON, CHOICE), [str(CHOICE)])
        wait_for(lambda: "A</b>" in shown(page)["asked"])
        told = shown(page)
        for name in NAMES:
            come(room, name, answering(CHOICE, 0))
        room.close(room.open_votes, wait=60.0)
        wait_for(lambda: shown(page)["closing"])
        messages = [each for each in list(page.told) if each["is"] == "wall"]
        since = messages[messages.index(told) :]
        assert (
            all({**each, "closing": None} == told for each in since)
            and "<b>3</b>" not in told["asked"]
        )
        room.show(Display(LESSON, CHOICE, shown=True))
        wait_for(lambda: "<b>3</b>" in shown(page)["asked"])
        assert "✓" not in shown(page)["asked"]
        room.show(Display(LESSON, CHOICE, shown=True, revealed=True))
        wait_for(lambda: "✓" in shown(page)["asked"])
        everything = json.dumps(page.told)
        assert not any(name in everything for name in (*NAMES, room.key))
        assert not any(lab in everything for lab in room.members())
    room.end()


def test_walls_share_a_lab_which_is_gone_with_the_last_of_them(
    server: LabServer, room: Classroom
) -> None:
    wait_for(lambda: not server.thread.labs)
    with wall(server, room) as one:
        wait_for(lambda: sides(one))
        with wall(server, room) as other:
            wait_for(lambda: sides(other) and len(server.thread.labs) == 1)
            mark = len(sides(one))
            wait_for(lambda: len(sides(one)) > mark + 20)
            assert any(each in sides(one) for each in sides(other)[5:])
        wait_for(lambda: len(server.visits) == 1)
        assert len(server.thread.labs) == 1
    wait_for(lambda: not server.thread.labs)


ORDERS = [{"is": "lead", "do": do} for do in get_args(Order)]
SENT = st.sampled_from(
    [
        *ORDERS,
        {"do": "Hold", "on": True},
        {"is": "ask", "what": "keep"},
        {"is": "join", "code": "", "name": "Eve"},
    ]
)


@pytest.mark.thorough
@given(st.lists(SENT, min_size=3, max_size=9))
@settings(max_examples=3, deadline=None)
def test_nothing_that_a_wall_sends_changes_anything(
    server: LabServer, room: Classroom, sent: list[dict[str, Any]]
) -> None:
    room.show(Display(LESSON, CHOICE))
    with wall(server, room) as page:
        wait_for(lambda: "A</b>" in shown(page)["asked"])
        before = room.state
        for message in sent:
            page.tell(message)
        room.show(Display(LESSON, 0))
        wait_for(lambda: "A</b>" not in shown(page)["asked"])
        assert room.state == replace(before, display=Display(LESSON, 0))
        assert "refused" not in page.kinds()


def test_every_code_has_the_same_page_but_only_a_class_has_a_wall(
    server: LabServer, room: Classroom
) -> None:
    there = address(server, room)
    other = there.replace(room.code, "a" * len(room.code))
    pages = [urlopen(f"http://{each}").read() for each in (there, other)]
    assert pages[0] == pages[1] and len(pages[0]) < 60_000
    with OwnSocket(f"ws://{other}") as page:
        wait_for(lambda: page.code == NO_GREETING)
