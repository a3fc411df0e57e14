"""Every lesson from its first step to its end, with a mouse: nothing is skipped."""

from __future__ import annotations

import html
import re
from collections.abc import Iterator

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser

from onpath.app.lab import commands as c
from onpath.app.server.lab_server import LabServer
from onpath.lessons.schema import NumberQuestion, OpenQuestion, Quiz, Sketch, Step, Text
from tests.in_browser.test_tasks_browser import COURSE, SOLUTIONS, passed
from tests.support.browser import Tab, wait_for
from tests.support.hands import Hands

pytestmark = pytest.mark.thorough

CURVE = ((0.2, 0.57), (0.4, 0.55), (0.5, 0.45), (0.6, 0.43), (0.8, 0.56))
"""A curve on the board, in shares of the scene."""


@pytest.fixture(scope="module")
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    yield tab
    assert tab.errors == []
    context.close()


class Reader:
    """A student who does everything that a lesson asks."""

    def __init__(self, tab: Tab, lesson: str) -> None:
        self._tab, self._hands, self._name = tab, Hands(tab, touch=False), lesson
        self.steps = COURSE.lesson(lesson, "en").steps

    def do(self, index: int) -> None:
        """Do what a step asks, and go on to the next one, or to the end."""
        step, last = self.steps[index], index + 1 == len(self.steps)
        self._arrive(index)
        asked = step.predictions()
        if asked:
            self._predict(isinstance(asked[0], Sketch))
        if step.kind == "run":
            self._see_it_happen()
        self._read(step)
        self._answer(step)
        self._pass(step)
        if asked and not last and self.steps[index + 1].kind == "run":
            self._tab.press("Let it happen")
        else:
            self._tab.press("Finish" if last else "Next")

    def _arrive(self, index: int) -> None:
        run = self._tab.lab.lessons
        wait_for(lambda: run.lesson is not None and run.index == index and not run.ended)
        title = self.steps[index].title
        self._tab.page.get_by_role("heading", name=title, exact=True).wait_for()
        self._tab.wait_until_built()

    def _predict(self, draws: bool) -> None:
        tab = self._tab
        if draws:
            box = tab.page.locator("canvas").first.bounding_box()
            assert box is not None
            tab.settle()
            places = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in CURVE]
            with tab.dragging(*places):
                pass
            tab.page.get_by_text("Draw again, or commit").wait_for()
            tab.press("Commit to this prediction")
        else:
            tab.button("A").click()
            tab.press("Commit to this prediction: A")
        wait_for(tab.lab.lessons.answer)
        tab.wait_until_built()

    def _see_it_happen(self) -> None:
        tab, run = self._tab, self._tab.lab.lessons
        if not run.playing and not run.has_played():
            tab.press("Let it happen")
        wait_for(lambda: run.playing or run.has_played())
        tab.ask(c.SetRate(4.0))
        wait_for(run.has_played, seconds=180)
        tab.wait_until_built()

    def _read(self, step: Step) -> None:
        texts = [block for block in step.blocks if isinstance(block, Text)]
        for block in texts:
            plain = re.sub(r"<[^>]+>", " ", re.split(r"<math|<img|<details", str(block.html))[0])
            if first := " ".join(html.unescape(plain).split()[:3]):
                self._tab.page.locator(".op-text").filter(has_text=first).first.wait_for()

    def _answer(self, step: Step) -> None:
        tab, run = self._tab, self._tab.lab.lessons
        quizzes = [number for number, b in enumerate(step.blocks) if isinstance(b, Quiz)]
        for place, number in enumerate(quizzes):
            tab.wait_until_built()
            tab.button("A").nth(place).click()
            wait_for(lambda number=number: f"{run.index}.{number}" in run.notes.quiz)
        for number, block in enumerate(step.blocks):
            if isinstance(block, NumberQuestion | OpenQuestion):
                tab.wait_until_built()
                given = block.number if isinstance(block, NumberQuestion) else None
                self._type(number, given)

    def _type(self, number: int, given: float | None) -> None:
        tab, run = self._tab, self._tab.lab.lessons
        key = f"{run.index}.{number}"
        if given is None:
            box = tab.page.get_by_label("Your answer, in your own words")
            box.fill("Because the matrix has no inverse there.")
            tab.press("Keep my answer")
            wait_for(lambda: key in run.notes.written)
        else:
            tab.page.get_by_label(re.compile("^Your number")).first.fill(f"{given:g}")
            tab.press("Check")
            wait_for(lambda: key in run.notes.numbers)

    def _pass(self, step: Step) -> None:
        tab = self._tab
        for task in step.tasks():
            tab.ask(c.SetRunning(False))
            tab.settle()
            for gesture in SOLUTIONS[self._name][task.id]:
                gesture(self._hands)
            wait_for(lambda task=task: passed(tab, task))


@pytest.mark.parametrize("lesson", COURSE.lessons)
def test_a_lesson_is_done_from_its_first_step_to_its_end(tab: Tab, lesson: str) -> None:
    tab.ask(c.OpenLesson(lesson))
    reader = Reader(tab, lesson)
    for index in range(len(reader.steps)):
        reader.do(index)
    run = tab.lab.lessons
    wait_for(lambda: run.ended)
    notes, steps = run.notes, reader.steps
    assert {key for key, answer in notes.answers.items() if not answer.skipped} == {
        str(index) for index, step in enumerate(steps) if step.predictions()
    }
    assert {*notes.played} == {str(i) for i, step in enumerate(steps) if step.kind == "run"}
    assert {*notes.tasks} == {task.id for step in steps for task in step.tasks()}
    tab.page.get_by_role("heading", name="What you predicted, and what happened").wait_for()
    tab.ask(c.CloseLesson())
