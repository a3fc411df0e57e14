"""A class that the teacher keeps within some steps of a lesson."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from onpath.app.classroom.class_sync import ClassSync
from onpath.app.classroom.classroom import Classroom
from onpath.app.lab import commands as c
from onpath.app.lab.commands import KeepWithin, TakeStep
from onpath.app.lab.lab import Lab
from onpath.lessons.course import Course, read_course
from onpath.lessons.pace import Pace
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.lab import do, loop_cache
from tests.support.lesson_texts import write_lesson

LESSON, OTHER = "01-a", "02-b"
FIRST, LAST = 1, 3


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    folder: Path = tmp_path_factory.mktemp("lessons")
    for name in (LESSON, OTHER):
        write_lesson(folder, name=name)
    return read_course([folder])[0]


class Room:
    """A class, its labs, and the rounds of its thread."""

    def __init__(self, course: Course) -> None:
        self.room, self._course = Classroom(lambda: 0.0), course
        self.labs: dict[str, tuple[Lab, bool]] = {}
        self._sync = ClassSync(self.room, self.labs.get)

    def student(self) -> Lab:
        """One more, in the class."""
        code = f"lab {len(self.labs)}"
        self.labs[code] = Lab(loop_cache(), FIVE_BAR, self._course), True
        self.room.join(code, self.room.code, code)
        return self.labs[code][0]

    def check(self) -> None:
        """Send orders, and let the labs apply them."""
        self._sync.check()
        for lab, _ in self.labs.values():
            lab.drain()


def place(lab: Lab) -> tuple[str, int]:
    """Lesson and step."""
    return lab.lessons.progress.lesson, lab.lessons.index


def test_all_are_brought_within_the_steps_and_those_within_stay(course: Course) -> None:
    klass = Room(course)
    free, elsewhere, within = (klass.student() for _ in range(3))
    do(elsewhere, TakeStep(OTHER, 2))
    do(within, TakeStep(LESSON, 2))
    klass.room.keep_within(Pace(LESSON, FIRST, LAST))
    klass.check()
    later = klass.student()
    klass.check()
    places = [place(lab) for lab in (free, elsewhere, within, later)]
    assert places == [(LESSON, FIRST), (LESSON, FIRST), (LESSON, 2), (LESSON, FIRST)]


ways = st.sampled_from(
    (
        *(c.GoToStep(by) for by in (1, -1, 2, 5)),
        *(c.OpenLesson(name) for name in (LESSON, OTHER)),
        *(c.CloseLesson(), c.FinishLesson(), c.Predict(option=0), c.PlayStep(), c.BeginStepAnew()),
    )
)


@pytest.mark.thorough
@given(st.lists(ways, max_size=12))
@settings(max_examples=60)
def test_no_way_of_a_student_leads_out_of_them(course: Course, walk: list[c.Command]) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, KeepWithin(Pace(LESSON, FIRST, LAST)))
    for way in walk:
        do(lab, way)
        assert place(lab)[0] == LESSON and FIRST <= place(lab)[1] <= LAST
        assert not lab.lessons.ended
    do(lab, KeepWithin(None), c.CloseLesson())
    assert lab.lessons.lesson is None


def test_at_the_border_a_prediction_is_neither_skipped_nor_let_happen(course: Course) -> None:
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, KeepWithin(Pace(LESSON, 0, 1)), c.GoToStep(1), c.GoToStep(1))
    assert place(lab) == (LESSON, 1) and lab.lessons.waits
    assert lab.message == lab.words("lesson.out_of_pace", first=1, last=2)
    do(lab, c.Predict(times=(0.0, 1.0), values=(1.0, 2.0)), c.GoToStep(1))
    assert place(lab) == (LESSON, 1) and lab.lessons.answer() is not None
    do(lab, KeepWithin(Pace(LESSON, 0, 2)), c.GoToStep(1))
    assert place(lab) == (LESSON, 2)


def test_within_the_last_step_a_lesson_can_be_finished(course: Course) -> None:
    last = len(course.lesson(LESSON, "en").steps) - 1
    lab = Lab(loop_cache(), FIVE_BAR, course)
    do(lab, KeepWithin(Pace(LESSON, last - 1, last)), c.FinishLesson())
    assert lab.lessons.ended


def test_a_step_sent_outside_ends_it_one_within_does_not(course: Course) -> None:
    klass = Room(course)
    lab, pace = klass.student(), Pace(LESSON, FIRST, LAST)
    klass.room.keep_within(pace)
    klass.room.push(TakeStep(LESSON, LAST))
    klass.check()
    assert place(lab) == (LESSON, LAST) and klass.room.orders.pace == pace
    klass.room.push(TakeStep(OTHER, 0))
    klass.check()
    assert place(lab) == (OTHER, 0) and lab.lessons.pace is None


def test_who_leaves_the_class_or_outlives_it_may_go_anywhere(course: Course) -> None:
    klass = Room(course)
    gone, stays = klass.student(), klass.student()
    klass.room.keep_within(Pace(LESSON, FIRST, LAST))
    klass.check()
    klass.room.leave("lab 0")
    klass.check()
    assert gone.lessons.pace is None and stays.lessons.pace is not None
    klass.room.end()
    klass.check()
    assert stays.lessons.pace is None and klass.room.orders.pace is None
