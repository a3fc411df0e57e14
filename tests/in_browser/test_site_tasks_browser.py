"""Each task of the course on the site, by hand: its author's solution passes, the wrong way fails.

What is typed, pressed and pulled are the author's own numbers, at the author's own times: the
verdict must be the lab's, in the lab's words.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from onpath.app.lab.dry_runs.course_check import lab_at, solved
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.lessons.action_schema import Action, Script, Value
from onpath.lessons.course import BUILT_IN, REFERENCE, read_references
from onpath.lessons.task_schema import Task
from tests.support.browser import BLUR
from tests.support.built_in import built_in_course
from tests.support.site_export import exported_site
from tests.support.site_reader import SiteReader
from tests.support.site_tasks import ONLY_IN_LAB, ROUGH

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.thorough

COURSE = built_in_course()[0]
STILL = "Object.getPrototypeOf(site.stage.figure.engine).pass = () => false"
"""Time passes only when a test lets it."""
FOLLOWED = """seconds => {
    const {data: {dt}} = site.stage.simulation, tenth = Math.round(0.1 / dt)
    for (let left = Math.round(seconds / dt); left > 0; left -= tenth) {
        site.stage.figure.advance(Math.min(left, tenth))
        site.tasks.forEach(each => each.follow())
    }
}"""
"""Let time pass, and look at the tasks ten times a second."""
ANEW = """step => {
    site.notes.given = []
    site.open(step)
}"""
FIELD = """name => site.stage.figure.data.form.groups.flatMap(group => group.fields)
    .find(field => field.name === name)"""
REMADE = "name => name in site.page.steps[site.index].remade"  # whether it makes another robot
LINKS = """() => site.page.steps[site.index].blocks
    .flatMap(block => block.kind === "text" ? block.links : [])"""
SAID = "all => all.map(each => each.textContent.slice(2))"
KEYS = (("a", "d"), ("s", "w"))
ARROWS = (("ArrowLeft", "ArrowRight"), ("ArrowDown", "ArrowUp"))
FURTHER = 5  # [mm], by which a key pulls


class Solver:
    """A reader who does an author's script in a lesson of the site by mouse and keys."""

    def __init__(self, browser: Browser, address: str) -> None:
        self.reader = SiteReader(browser, address, reduced_motion="reduce")
        self.page = self.reader.page
        self.reader.ready()
        self.page.evaluate(STILL)

    def open(self, step: int) -> None:
        """Open a step anew, as somebody who has passed nothing."""
        self.page.evaluate(ANEW, step)
        self.reader.ready()

    def do(self, script: Script) -> None:
        """Every action at its time."""
        now = 0.0
        for action in sorted(script.do, key=lambda each: each.at):
            self.page.evaluate(FOLLOWED, action.at - now)
            now = action.at
            self.act(action)
        self.page.evaluate(FOLLOWED, script.until - now)

    def act(self, action: Action) -> None:
        """One action."""
        keys = self.page.keyboard
        if action.hold is not None:
            keys.press("h")
        elif action.pull is not None:
            self.press_for(action.pull, KEYS, FURTHER)
        elif action.release:
            keys.press("x")
        elif action.reset:
            self.reader.press("Reset")
        elif action.move is not None:
            index, *by = action.move
            for _ in range(index + 1):
                keys.press("n")
            self.press_for(by, ARROWS, 1)
            keys.press("Escape")
        else:
            assert action.set, action
            for name, value in self.by_link(action.set).items():
                self.set(name, value)
        self.page.evaluate(BLUR)

    def by_link(self, wanted: dict[str, Value]) -> dict[str, Value]:
        """Press a link in sight that gives some settings their values; return the others."""
        for place, link in enumerate(self.page.evaluate(LINKS)):
            given = {name: v for act in link or () for name, v in act.get("set", {}).items()}
            link = self.page.locator(".step.open button[data-link]").nth(place)
            if given and given.items() <= wanted.items() and link.is_visible():
                link.click()
                return {name: v for name, v in wanted.items() if name not in given}
        return wanted

    def press_for(self, by: Any, keys: Any, each: int) -> None:
        """Press keys in turns, until they have moved something by (right, up), [mm]."""
        left = [round(way / each) for way in by]
        assert [each * way for way in left] == list(by)
        while any(left):
            for axis, way in enumerate(left):
                if way:
                    self.page.keyboard.press(keys[axis][way > 0])
                    left[axis] -= 1 if way > 0 else -1

    def set(self, name: str, value: Value) -> None:
        """Give a setting of the step's form a value."""
        field = self.page.evaluate(FIELD, name)
        assert field, f"the step has no {name}"
        form = self.page.locator(".step.open .form")
        if field["kind"] == "choice":
            option = next(each for each in field["options"] if each["value"] == value)
            before = self.page.evaluate_handle("site.stage")
            form.get_by_label(field["label"]).select_option(label=option["label"])
            if self.page.evaluate(REMADE, name):
                self.page.wait_for_function("before => site.stage !== before", arg=before)
            return
        unit = f" [{field['unit']}]" if field.get("unit") else ""
        box = form.get_by_role("textbox", name=f"{field['label']}{unit}", exact=True)
        box.fill(repr(float(value) * (field.get("factor") or 1)))
        box.press("Enter")

    def said(self, place: int) -> list[str]:
        """What the page says of a task's conditions."""
        task = self.page.locator(".step.open .task").nth(place)
        return task.locator(".verdicts li").evaluate_all(SAID)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return exported_site(tmp_path_factory.mktemp("site"), ("en",), tuple(COURSE.lessons))


def lab_says(name: str, index: int, script: Script, task: Task, cache: LoopCache) -> list[str]:
    """The lab's words after a script that fails a task."""
    lesson = COURSE.lesson(name, "en")
    passed, verdicts = solved(lab_at(lesson, lesson.steps[index], cache), script, task)
    assert not passed
    return [each.words for each in verdicts]


@pytest.mark.parametrize("name", COURSE.lessons)
def test_every_task_is_passed_and_failed_by_hand(browser: Browser, site: Path, name: str) -> None:
    lesson, cache = COURSE.lesson(name, "en"), LoopCache(at_once=True)
    references, _ = read_references(lesson, BUILT_IN / name / REFERENCE)
    tasks = [(i, step, task) for i, step in enumerate(lesson.steps) for task in step.tasks()]
    solver = Solver(browser, f"{(site / name).as_uri()}.html#{tasks[0][0] + 1}")
    for index, step, task in tasks:
        if task.id in ONLY_IN_LAB:
            continue
        place, reference = step.tasks().index(task), references[task.id]
        for script, passes in ((reference.failure, False), (reference.solution, True)):
            solver.open(index)
            solver.do(script)
            said = solver.said(place)
            assert said[-1].startswith("Passed") == passes, (task.id, said)
            if not passes and task.id not in ROUGH:
                assert said == lab_says(name, index, script, task, cache), task.id
    assert solver.reader.complaints == []
    solver.reader.context.close()
