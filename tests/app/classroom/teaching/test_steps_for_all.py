"""Back and next for a whole class: every step once, forwards and backwards."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec import structs

from onpath.app.classroom.class_state import from_stored, to_stored
from onpath.app.classroom.classroom import NOTHING_DONE, Classroom, ClassState, Display
from onpath.app.classroom.teaching.lesson_labels import step_label
from onpath.app.classroom.teaching.steps_for_all import StepsForAll
from onpath.app.lab.commands import ChoosePath, CloseLesson, Set, TakeSetup, TakeStep
from onpath.app.lab.lab import Lab
from onpath.app.lab.setups.capture import capture
from onpath.app.lab.setups.setup import Setup
from onpath.app.server.built_in_course import built_in_course
from onpath.lessons.course import Course
from onpath.lessons.pace import Pace
from onpath.lessons.words import ENGLISH
from tests.support.lab import do, loop_cache, run


def with_a_branch(course: Course) -> Course:
    """A course whose third step is for some answers only."""
    name = next(iter(course.lessons))
    lesson = course.lesson(name, "en")
    steps = list(lesson.steps)
    steps[2] = structs.replace(steps[2], when="no")
    branched = structs.replace(lesson, steps=tuple(steps))
    return replace(course, lessons={**course.lessons, name: {"en": branched}})


COURSE = with_a_branch(built_in_course())
STEPS = StepsForAll(COURSE, "en")


def for_all(lesson: str, first: int = 0, last: int | None = None) -> list[tuple[str, int]]:
    """The steps of a lesson that everybody is meant to see."""
    steps = COURSE.lesson(lesson, "en").steps
    indices = range(len(steps))[first:last]
    return [(lesson, index) for index in indices if not steps[index].when]


@cache
def way_of(route: str) -> list[tuple[str, int]]:
    """All steps of a route, or of the course, that everybody is meant to see."""
    if not route:
        return [each for name in COURSE.lessons for each in for_all(name)]
    stops = COURSE.routes[route].stop
    return [e for stop in stops for e in for_all(stop.lesson, stop.steps[0] - 1, stop.steps[1])]


def led(room: Classroom, by: int) -> list[tuple[str, int]]:
    """Everywhere a class is led from where it is, until there is nothing more."""
    been = list[tuple[str, int]]()
    while (step := STEPS.beside(room.display, room.orders, by)) is not None:
        room.push(step)
        been.append((step.lesson, step.step))
    return been


def test_next_leads_through_all_lessons_and_back_leads_through_them_backwards() -> None:
    room, everything = Classroom(), way_of("")
    assert everything[:3] == [(everything[0][0], index) for index in (0, 1, 3)]
    assert led(room, 1) == everything
    assert led(room, -1) == everything[-2::-1]


@pytest.mark.parametrize("name", COURSE.routes)
def test_on_a_route_next_leads_along_the_route(name: str) -> None:
    route, room = way_of(name), Classroom()
    room.push(TakeStep(*route[0], name))
    assert led(room, 1) == route[1:]
    assert isinstance(room.orders.push, TakeStep) and room.orders.push.route == name
    assert led(room, -1) == route[-2::-1]


def stored_and_read(room: Classroom) -> None:
    room.restore(from_stored(to_stored(room.state, 0.0), lambda _: NOTHING_DONE, 0.0))


ROOM = Classroom()  # another one would take a tenth of a second for its code
BETWEEN: dict[str, Callable[[Classroom], object]] = {
    "a set-up is sent": lambda room: room.push(TakeSetup(Setup())),
    "nothing stands any more": lambda room: room.push(None),
    "all stop": lambda room: room.freeze(True),
    "all are kept": lambda room: room.keep_within(Pace(room.display.lesson, 0, 3)),
    "answers are shown": lambda room: room.show(replace(room.display, shown=True)),
    "a vote opens again": lambda room: room.open_again(()),
    "the process ends": stored_and_read,
}


@settings(max_examples=40)
@given(
    st.sampled_from(["", *COURSE.routes]),
    st.lists(st.sampled_from([1, 1, 1, -1, *BETWEEN]), max_size=30),
)
def test_whatever_happens_between_them_next_and_back_lead_on_from_the_last_step(
    route: str, history: list[int | str]
) -> None:
    way, room, at = way_of(route), ROOM, 0
    room.restore(ClassState())
    room.push(TakeStep(*way[0], route))
    for event in history:
        if isinstance(event, str):
            BETWEEN[event](room)
            continue
        step = STEPS.beside(room.display, room.orders, event)
        if at + event not in range(len(way)):
            assert step is None
        else:
            at += event
            assert step == TakeStep(*way[at], route)
            room.push(step)


@pytest.mark.parametrize("test", COURSE.tests)
def test_a_concept_test_is_begun_for_all_who_then_go_on_by_themselves(test: str) -> None:
    room = Classroom()
    assert STEPS.beside(Display(test, 0), room.orders, 1) == TakeStep(test, 0)
    for index in range(len(COURSE.lesson(test, "en").steps)):
        room.push(TakeStep(test, index))
        assert led(room, 1) == led(room, -1) == []


displays = st.builds(
    Display, st.sampled_from(["", "gone", *COURSE.lessons, *COURSE.tests]), st.integers(0, 99)
)


@pytest.mark.thorough
@given(displays, st.sampled_from((-1, 1)))
def test_from_any_stored_place_there_is_a_step_that_exists(display: Display, by: int) -> None:
    lesson, index = STEPS.shown(display)
    assert index in range(len(COURSE.lesson(lesson, "en").steps))
    room = Classroom()
    room.push(TakeSetup(Setup()))
    step = STEPS.beside(display, room.orders, by)
    assert step is None or step.step in range(len(COURSE.lesson(step.lesson, "en").steps))


def test_on_a_projector_the_step_that_comes_next_does_not_tell_what_will_happen() -> None:
    for name in COURSE.lessons:
        lesson = COURSE.lesson(name, "en")
        for index, step in enumerate(lesson.steps):
            assert step.title in step_label(lesson, index, ENGLISH)
            assert f": {step.title}" not in step_label(lesson, index, ENGLISH, large=True)


@pytest.mark.parametrize("name", list(COURSE.lessons)[:3])
def test_every_demonstration_is_played_in_the_teacher_s_lab_which_is_then_put_back(
    name: str,
) -> None:
    lab = Lab(loop_cache(), course=COURSE)
    do(lab, ChoosePath("clover"), Set("K1", 77.0))
    before = capture(lab.simulation)
    steps, played = COURSE.lesson(name, "en").steps, set[int]()
    for index in range(len(steps)):
        step = STEPS.demonstration(Display(name, index))
        if step is not None:
            assert step.step - index in (0, 1)
            do(lab, step)
            assert lab.lessons.playing and lab.simulation.running and lab.message_level != "error"
            run(lab, 0.1)
            played.add(step.step)
    assert played == {index for index, step in enumerate(steps) if step.script is not None}
    do(lab, CloseLesson())
    assert capture(lab.simulation) == before
