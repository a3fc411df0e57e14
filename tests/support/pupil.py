"""A student who does a lesson with a real mouse, step by step, from its first page to its end."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import Locator

from onpath.lessons.schema import (
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Prediction,
    Quiz,
    SecondTry,
    Sketch,
    Step,
)
from onpath.lessons.task_schema import Task
from tests.support.browser import Tab, wait_for
from tests.support.hands import Hands
from tests.support.solutions import SOLUTIONS, passed, verdicts

PLACE_OF = """(options, html) => {
    const bare = text => text.replace(/\\s+/g, "")
    const wanted = document.createElement("div")
    wanted.innerHTML = html
    return options.findIndex(each => bare(each.textContent).slice(1) === bare(wanted.textContent))
}"""
"""The place among the options on the page of the one with a text; -1 if there is none."""
BOARD = ((0.1, 0.8), (0.35, 0.75), (0.45, 0.35), (0.6, 0.3), (0.75, 0.8))
"""A curve on the board for sketches, in shares of its width and height."""


def sketch(hands: Hands) -> None:
    """Draw a curve on the board."""
    page = hands.tab.page
    box = Hands.box(page.locator(".board"))
    way = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in BOARD]
    with hands.tab.dragging(*way, in_scene=False):
        pass
    page.get_by_text("Draw again, or commit").wait_for()


class Pupil:
    """Does lessons in a tab.

    Args:
        right: whether the right options are chosen, or each time the next one of the file.
    """

    def __init__(self, tab: Tab, right: bool = True) -> None:
        self.tab, self._right, self._hands = tab, right, Hands(tab, touch=False)
        self._asked = 0

    @property
    def lesson(self) -> Lesson:
        """The open lesson."""
        lesson = self.tab.lab.lessons.lesson
        assert lesson is not None
        return lesson

    @property
    def step(self) -> Step:
        """The open step."""
        return self.lesson.steps[self.tab.lab.lessons.index]

    @property
    def index(self) -> int:
        """Index of the open step."""
        return self.tab.lab.lessons.index

    def hurry(self) -> None:
        """Let time run as fast as a student can."""
        self.tab.button("Time, plots").click()
        self.tab.page.get_by_label("Time runs at").select_option(index=5)
        self.tab.page.keyboard.press("Escape")
        wait_for(lambda: self.tab.simulation.settings.rate == 4.0)

    def open(self, label: str, name: str) -> None:
        """Open a lesson from the list of lessons."""
        self.tab.press("Lessons")
        self.tab.card(label).click()
        run = self.tab.lab.lessons
        wait_for(lambda: run.lesson is not None and run.lesson.name == name)

    def steps(self) -> Iterator[Step]:
        """Each step when it has just been opened; when the caller goes on, it is done.

        The lesson is at its end afterwards.
        """
        run = self.tab.lab.lessons
        while not run.ended:
            self.arrive()
            yield self.step
            before = run.index
            self.do()
            if run.index == before:
                self.press("Finish" if run.at_end else "Next")
            wait_for(lambda before=before: run.ended or run.index != before)

    def arrive(self) -> None:
        """Return when the page shows the open step."""
        self.tab.page.get_by_role("heading", name=self.step.title, exact=True).wait_for()
        self.tab.wait_until_built()
        if self.step.tasks():
            self.pause()

    def do(self) -> None:
        """Do what the open step asks for."""
        if self.step.script is not None:
            self._see()
        for place, block in enumerate(self.step.blocks):
            if isinstance(block, Prediction):
                self._predict(block)
            elif isinstance(block, Task):
                self._pass(block)
            elif isinstance(block, Quiz):
                self._answer(place, block)
            elif isinstance(block, NumberQuestion):
                self._compute(block)
            elif isinstance(block, OpenQuestion):
                self._write(block)
            elif isinstance(block, Derivation):
                self._derive(place, block)

    def pause(self) -> None:
        """Pause the lab, so that nothing but the gestures of a task happens."""
        if self.tab.simulation.running:
            self.tab.button("Pause").filter(visible=True).first.click()
            wait_for(lambda: not self.tab.simulation.running)

    def press(self, name: str) -> None:
        """Press a button of the page."""
        self.tab.press(name)

    def _predict(self, block: Choice | Sketch) -> None:
        page, run = self.tab.page, self.tab.lab.lessons
        if isinstance(block, Choice):
            self.choose(block)
        else:
            self.tab.settle()
            sketch(Hands(self.tab, touch=False))
        page.get_by_label("How sure are you? (optional)").select_option(label="fairly sure")
        if block.reasons:
            page.get_by_label("Why? (optional)").select_option(index=1)
        elif block.why:
            page.get_by_label("Why? (optional)").fill("Because.")
        page.get_by_role("button", name="Commit to this prediction").click()
        answer = wait_for(run.answer)
        assert answer.sure == "fairly", answer
        assert (answer.reason == 0) == bool(block.reasons) and bool(answer.why) == block.why, answer

    def _see(self) -> None:
        """Watch the experiment of the step to its end."""
        run = self.tab.lab.lessons
        if not run.playing and not run.has_played():
            self.press("Let it happen")
            wait_for(lambda: run.playing or run.has_played())
        wait_for(run.has_played)
        self.tab.wait_until_built()
        if (found := run.prediction()) is None:
            return
        index = int(found[0])
        for place, block in enumerate(self.lesson.steps[index].blocks):
            tried = run.is_second_tried(self.lesson, index, place)
            if tried and isinstance(block, Choice) and block.second is not None:
                self._try_again(block.second, f"{index}.{place}")

    def choose(self, block: Choice | Quiz, again: bool = False) -> int:
        """Press an option of a question; returns its index in the lesson's file.

        Args:
            again: whether it is asked a second time, after a wrong answer.
        """
        right = next(i for i, option in enumerate(block.options) if option.right)
        index = right if self._right or again else self._asked % len(block.options)
        self._asked += 1
        options = self.tab.page.locator("#op-column .step.open .options label")
        text = block.options[index].text
        place = wait_for(lambda: options.evaluate_all(PLACE_OF, text) + 1) - 1
        options.nth(place).click()
        return index

    def _answer(self, place: int, block: Quiz, again: bool = False) -> None:
        notes, key = self.tab.lab.lessons, f"{self.tab.lab.lessons.index}.{place}"
        index = self.choose(block, again)
        box = self.tab.page.locator(f'#op-column .step.open [data-block="{place}"]')
        box.get_by_role("button").first.click()
        wait_for(lambda: notes.notes.quiz.get(key) == index)
        self.tab.wait_until_built()
        if block.options[index].right:
            return
        if block.second is not None:
            self._try_again(block.second, f"{notes.index}.{place}")
        else:
            self.tab.page.get_by_text("answer once more").first.wait_for()
            self._answer(place, block, again=True)

    def _try_again(self, second: SecondTry, place: str) -> None:
        """Answer what is asked after a wrong choice, in a block of a step, rightly."""
        box = self.tab.page.locator(f'#op-column .step.open [data-second="{place}"]')
        if second.number is None:
            right = next(i for i, option in enumerate(second.options) if option.right)
            box.locator(f'input[value="{right}"]').click()
        else:
            box.locator("input").fill(f"{second.number:g}")
        box.get_by_role("button").first.click()
        notes = self.tab.lab.lessons
        wait_for(lambda: f"{place}.second" in notes.notes.by_item)
        self.tab.wait_until_built()

    def _compute(self, block: NumberQuestion) -> None:
        if not self._right:
            self.number(block, 3 * block.number)
        self.number(block, block.number)

    def number(self, block: NumberQuestion, given: float) -> None:
        """Answer a question with a number."""
        unit = f" [{block.unit}]" if block.unit else ""
        typed = f"{given:g}"
        self.tab.page.get_by_label(f"Your number{unit}").fill(typed)
        self.press("Check")
        run = self.tab.lab.lessons
        wait_for(lambda: float(typed) in run.notes.numbers.values())
        self.tab.wait_until_built()

    def _write(self, block: OpenQuestion) -> None:
        self.field("Your answer, in your own words").fill("In my own words.")
        self.press("Keep my answer")
        wait_for(lambda: self.tab.lab.lessons.notes.written)
        self.tab.wait_until_built()

    def _derive(self, place: int, block: Derivation) -> None:
        """Type what is right, after something else for those who begin wrong."""
        notes, key = self.tab.lab.lessons, f"{self.tab.lab.lessons.index}.{place}"
        box = self.tab.page.locator(f'#op-column .step.open [data-block="{place}"]')
        rows = 0
        for i in range(len(block.line)):
            right = expanded(block, i)
            for row in (right,) if self._right else ("77777", right):
                box.locator(f'[data-line="{i}"] input').fill(row)
                box.locator(f'[data-line="{i}"] button').click()
                rows += 1
                wait_for(lambda: len(notes.notes.written.get(key, "").split("\n")) == rows)
                self.tab.wait_until_built()

    def field(self, label: str) -> Locator:
        """Return a field of the page."""
        return self.tab.page.get_by_label(label).filter(visible=True)

    def _pass(self, task: Task) -> None:
        """Do what passes the task."""
        for gesture in SOLUTIONS[self.lesson.name][task.id]:
            gesture(self._hands)
        try:
            wait_for(lambda: passed(self.tab, task), seconds=10.0)
        except AssertionError:
            pytest.fail(f"{task.id}: {verdicts(self.tab, task)} {self.tab.lab.message}")


def expanded(block: Derivation, index: int, formula: str = "") -> str:
    """The formula of a line, or another one in its place, in the derivation's names alone."""
    text = formula or block.line[index].formula
    for earlier in reversed(block.line[:index]):
        if earlier.name:
            text = re.sub(rf"\b{earlier.name}\b", f"({earlier.formula})", text)
    return text
