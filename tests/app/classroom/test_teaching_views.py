"""What the teacher's page shows of a class without names: where all are, their gains, sketches."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from onpath.app.classroom.class_sync import GAINS, ClassSync
from onpath.app.classroom.classroom import Classroom, Display
from onpath.app.classroom.gains_html import HEIGHT, PAIRS, WIDTH, gains_view
from onpath.app.classroom.pace_html import pace_view, whereabouts
from onpath.app.classroom.teaching.class_answers import ClassAnswers, picked
from onpath.app.classroom.teaching.teacher_context import TeacherChoices
from onpath.app.lab import commands as c
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.lab import Lab
from onpath.lessons.course import Course, read_course
from onpath.lessons.pace import Pace
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import write_lesson

LESSON, SKETCH = "01-a", 1


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    folder: Path = tmp_path_factory.mktemp("lessons")
    write_lesson(folder)
    return read_course([folder])[0]


def at(step: int, lesson: str = LESSON, ended: bool = False) -> Progress:
    """A student in a step."""
    return Progress(lesson=lesson, notes={lesson: Notes(step=step)}, ended=ended)


@given(st.lists(st.builds(at, st.integers(0, 50), st.sampled_from((LESSON, "", "gone")))))
def test_every_student_is_somewhere(course: Course, ways: list[Progress]) -> None:
    found = whereabouts(course.lesson(LESSON, "en"), ways)
    assert sum(found.steps) + found.ended + found.elsewhere == len(ways)


def test_bars_are_as_long_as_many_are_there(course: Course) -> None:
    lesson = course.lesson(LESSON, "en")
    ways = [at(0), at(2), at(2), at(0, "02-b"), at(len(lesson.steps) - 1, ended=True)]
    shown = pace_view(lesson, ways, Pace(LESSON, 0, 2), ENGLISH)
    assert re.findall(r"<b>(\d+)</b>", shown) == ["1", "2"]
    assert re.findall(r"width:([\d.]+)%", shown)[:3] == ["42.5", "0.0", "85.0"]
    assert ENGLISH("class.whereabouts", ended=1, elsewhere=1) in shown
    closed = shown.count('<div style="color:')
    assert closed == len(lesson.steps) - 3


def test_on_a_projector_no_title_tells_what_will_happen(course: Course) -> None:
    lesson = course.lesson(LESSON, "en")
    small, large = (pace_view(lesson, [], None, ENGLISH, on) for on in (False, True))
    titles = [f": {step.title}" for step in lesson.steps]
    assert all(title in small and title not in large for title in titles)


def test_the_gains_of_a_lab_reach_the_class(course: Course) -> None:
    room, lab = Classroom(lambda: 0.0), Lab(loop_cache(), FIVE_BAR, course)
    room.join("lab", room.code, "Ada")
    sync = ClassSync(room, {"lab": (lab, True)}.get)
    do(lab, c.Set("K1", 123.0), c.Set("K5", 7.0))
    sync.check()
    member = room.member("lab")
    assert member is not None
    told = dict(zip(GAINS, member.gains, strict=True))
    assert (told["K1"], told["K5"]) == (123.0, 7.0)


gains = st.tuples(*[st.floats(0, 1e6)] * len(GAINS))


@given(st.lists(st.one_of(st.just(()), gains)), st.sampled_from(PAIRS))
def test_all_gains_are_on_the_diagram(each: list[tuple[float, ...]], pair: tuple[str, str]) -> None:
    shown = gains_view(pair, each, ENGLISH)
    dots = re.findall(r'cx="([-\d.]+)" cy="([-\d.]+)"', shown)
    assert all(0 < float(x) < WIDTH and 0 < float(y) < HEIGHT for x, y in dots)
    known = [gain for gain in each if gain]
    at_ = [GAINS.index(name) for name in pair]
    assert len(dots) == len({(gain[at_[0]], gain[at_[1]]) for gain in known})
    assert ENGLISH("gains.students", count=len(known)) in shown


def test_students_with_the_same_gains_are_counted() -> None:
    same = (400.0, 40.0, 0.0, 25.0, 10.0)
    shown = gains_view(("K1", "K2"), [same, same, same], ENGLISH)
    assert shown.count("<circle") == 1 and re.search(r">3</text>", shown)


class Teaching:
    """What the teacher's page knows of a class."""

    def __init__(self, room: Classroom) -> None:
        self.classroom, self.chosen = room, TeacherChoices()
        room.show(Display(LESSON, SKETCH, shown=True))

    def progress(self) -> Progress:
        return Progress()


def test_picked_sketches_keep_their_numbers_while_others_come_in(course: Course) -> None:
    room = Classroom(lambda: 0.0)
    labs = {f"lab {i}": (Lab(loop_cache(), FIVE_BAR, course), True) for i in range(3)}
    sync = ClassSync(room, labs.get)
    for code, (lab, _) in labs.items():
        room.join(code, room.code, f"Nick {code}")
        do(lab, TakeStep(LESSON, SKETCH))
    teaching: Any = Teaching(room)
    answers = ClassAnswers(course, ENGLISH, teaching)
    seen: list[list[str]] = []
    for number in (2, 0, 1):  # not in the order of joining
        do(labs[f"lab {number}"][0], c.Predict(times=(0.0, 1.0), values=(1.0 + number, 2.0)))
        sync.check()
        teaching.chosen.picked = ()
        everything = answers.view(False)
        assert "Nick" not in everything
        seen.append(polylines(everything))
    small = seen[-1][3:]  # below the plot with all three
    assert len(seen[-1]) == 6 and len(set(small)) == 3
    assert small[0] == seen[0][0] and small[:2] == seen[1][2:]
    teaching.chosen.picked = (1, 3)
    shown = answers.view(False)
    assert set(polylines(shown)) == {small[0], small[2]}
    assert re.findall(r'font-weight="700"[^>]*>(\d+)</text>', shown) == ["1", "3"]


def polylines(shown: str) -> list[str]:
    """The points of all curves."""
    return re.findall(r'<polyline points="([^"]*)"', shown)


@pytest.mark.parametrize(
    ("typed", "numbers"),
    [("", ()), ("3", (3,)), (" 2,5; 2", (2, 5)), ("0 -7 x 301", (7,)), ("٣", ()), ("9" * 500, ())],
)
def test_only_numbers_of_sketches_are_read(typed: str, numbers: tuple[int, ...]) -> None:
    assert picked(typed) == numbers
