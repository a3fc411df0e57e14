"""A lesson's step has on its page the plots and controls of which its text speaks."""

from __future__ import annotations

from unittest.mock import MagicMock

import pytest

from onpath.app.lab.dry_runs.behaviour_check import labels_of
from onpath.app.lab.dry_runs.course_check import lab_at
from onpath.app.lab.snapshots.take_snapshot import take_page_snapshot
from onpath.app.page.panel_factory import PanelFactory
from onpath.lessons.schema import Lesson, Step
from onpath.lessons.words import Words
from tests.support.built_in import built_in_course
from tests.support.lab import store

COURSE = built_in_course()[0]


def shown(lesson: Lesson, step: Step, words: Words) -> set[str]:
    """All labels and titles of the widgets that a step's page has."""
    first, gui, other = (
        take_page_snapshot(lab_at(lesson, step, store()), 1.0),
        MagicMock(),
        MagicMock(),
    )
    factory = PanelFactory(
        gui=gui,
        words=words,
        post=other,
        exporter=other,
        files=other,
        submit=other,
        scene=other,
        overlays=other,
        context=other,
        reset_view=other,
    )
    factory.of_step(lesson.scene_at(lesson.steps.index(step)), first)
    added = [call for call in gui.mock_calls if call[0].startswith("add_")]
    given = [each for _, some, named in added for each in (*some, *named.values())]
    return {each for each in given if isinstance(each, str)}


@pytest.mark.parametrize("language", ["en", "de"])
def test_a_plot_and_a_control_that_a_text_names_are_on_its_page(language: str) -> None:
    words, seen = Words(language), 0
    for name in COURSE.lessons:
        lesson = COURSE.lesson(name, language)
        for step in lesson.steps:
            marks = [each for each in step.behaviours if each.verb in ("plot", "control")]
            texts = shown(lesson, step, words) if marks else set()
            for said in marks:
                if said.verb == "plot":
                    names = {words(f"axis.{said.name}").partition(" [")[0]}
                else:
                    names = labels_of(said.name, words)
                on_page = any(label in text for text in texts for label in names)
                assert on_page != said.absent, (name, said.text, names, texts)
                seen += 1
    assert seen > 5
