"""A lesson's step has on its page the plots and controls of which its text speaks."""

from __future__ import annotations

import pytest

from onpath.app.lab.commands import ChooseRobot
from onpath.app.lab.dry_runs.behaviour_check import labels_of
from onpath.app.lab.dry_runs.course_check import lab_at
from onpath.app.lab.plot_rows import row_data
from onpath.app.lab.snapshots.page_snapshot import PageSnapshot
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.view.lab_form import NO_STEP, form_of
from onpath.lessons.action_schema import StepSetup
from onpath.lessons.behaviour.marks import Behaviour
from onpath.lessons.words import ENGLISH, Words
from tests.support.built_in import built_in_course
from tests.support.lab import do, loop_cache, new_lab

COURSE = built_in_course()[0]
ELSEWHERE = {"hold", "past", "plots", "robot"}  # always on the page: below the robots, at the top


def labels(setup: StepSetup, first: PageSnapshot, words: Words) -> set[str]:
    """The labels of all controls that a step's page has."""
    fields = [field for group in form_of(first, setup, words).groups for field in group.fields]
    options = {option.label for field in fields for option in field.options}
    return {field.label for field in fields} | options


def plots(setup: StepSetup, first: PageSnapshot) -> set[str]:
    """Names of the plots under the stage in a step: rows over time, and the phase plane."""
    possible = {row.name for row in row_data(first.key.fields, False, ENGLISH)}
    return (possible | {"phase"}) & {"distance", *setup.plots}


def is_shown(said: Behaviour, setup: StepSetup, first: PageSnapshot, words: Words) -> bool:
    """Whether a step's page has the plot or the control of a mark."""
    if said.verb == "plot":
        return said.name in plots(setup, first)
    known, shown = labels_of(said.name, words), labels(setup, first, words)
    return any(label in text for text in shown for label in known)


def test_a_plot_and_a_control_that_a_text_names_are_on_its_page() -> None:
    seen = 0
    for versions in COURSE.lessons.values():
        lesson = versions["en"]
        for index, step in enumerate(lesson.steps):
            marks = [each for each in step.behaviours if each.verb in ("plot", "control")]
            if not marks:
                continue
            first = take_page_snapshot(lab_at(lesson, step, loop_cache()), 1.0)
            for words in map(Words, COURSE.languages()):
                for said in marks:
                    on_page = is_shown(said, lesson.setup_at(index), first, words)
                    assert on_page != said.absent, (lesson.name, said.text, words.language)
                    seen += 1
    assert seen > 10


@pytest.mark.thorough
def test_every_control_that_a_step_names_is_on_its_page() -> None:
    for versions in COURSE.lessons.values():
        lesson = versions["en"]
        for index, step in enumerate(lesson.steps):
            named = {*lesson.setup_at(index).controls} - ELSEWHERE
            first = take_page_snapshot(lab_at(lesson, step, loop_cache()), 1.0) if named else None
            for name in named:
                assert first is not None
                alone = StepSetup(controls=(name,))
                assert form_of(first, alone, ENGLISH) is not NO_STEP, (lesson.name, index, name)


@pytest.mark.parametrize("robot", ["two_link_arm", "cart_pendulum"])
def test_every_step_has_a_form_whatever_robot_is_chosen(robot: str) -> None:
    """Another robot lacks some of the parameters among the controls, and of the plots."""
    lab = new_lab()
    do(lab, ChooseRobot(robot))
    first = take_page_snapshot(lab, 1.0)
    for versions in COURSE.lessons.values():
        lesson = versions["en"]
        for index in range(len(lesson.steps)):
            form_of(first, lesson.setup_at(index), ENGLISH)
