"""The static site in Chromium, opened from its files: lesson 1 whole, and what it says of tasks."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from onpath.app.exports.site.task_data import check_data
from onpath.app.lab.step_truth import computed_truth
from onpath.lessons.benches import robot_names
from onpath.lessons.checks import verdict
from onpath.lessons.course import BUILT_IN, REFERENCE, read_course, read_references
from onpath.lessons.record import Record
from onpath.lessons.words import ENGLISH
from onpath.models.control.benches import DEFAULT_LAWS
from onpath.models.control.laws.own import short_name
from tests.support.axe import RUN, SCRIPT
from tests.support.random_records import some_check, some_record
from tests.support.site_export import LESSON, exported_site
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

WAIT = 60.0  # [s]
OPEN = "Boolean(window.site?.stage) && !document.querySelector('.step.open .stage:empty')"
MILLIMETRE = 1.0


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return exported_site(tmp_path_factory.mktemp("site"))


class Student:
    """A browser on a page of the site, and what it complains of."""

    def __init__(self, browser: Browser, address: str, **more: Any) -> None:
        self.context = browser.new_context(**{"viewport": {"width": 1200, "height": 800}, **more})
        self.page: Page = self.context.new_page()
        self.requests, self.complaints = list[str](), list[str]()
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.goto(address)

    def ready(self) -> None:
        """Wait for the figure of the open step."""
        wait_for(lambda: self.page.evaluate(OPEN), WAIT)

    def press(self, name: str) -> None:
        self.page.get_by_role("button", name=name, exact=True).click()

    def step(self) -> str:
        return self.page.locator(".step.open .words h2").inner_text()

    def advance(self, seconds: float) -> None:
        """Let simulated time pass at once, as the figure's clock would."""
        self.page.evaluate(
            "seconds => site.stage.figure.advance(Math.round(1000 * seconds))", seconds
        )

    def happens(self, seconds: float) -> None:
        """Press, and let a script play to its end."""
        self.press("Let it happen")
        self.advance(seconds)
        wait_for(
            lambda: self.page.get_by_role("button", name="Let it happen again").count() == 1, WAIT
        )

    def passed(self) -> bool:
        return "Passed" in self.page.locator(".step.open .task .verdicts").first.inner_text()

    def slide(self, name: str, value: float) -> None:
        slider = self.page.locator(".step.open").get_by_role("slider", name=name)
        slider.fill(str(value))


def lesson_one_by_mouse(student: Student) -> None:
    """Every step of lesson 1, as its texts say."""
    page = student.page
    student.ready()
    student.press("Hold both back")
    wait_for(lambda: "torn off" in page.locator(".step.open .stage").inner_text(), WAIT)
    student.press("Next")
    board = page.locator(".step.open canvas.board").bounding_box()
    assert board and student.step() == "Draw what the tracker does"
    x, y = board["x"] + 60, board["y"] + board["height"] - 40
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 150, y - 120, steps=12)
    page.mouse.move(x + 300, y, steps=12)
    page.mouse.up()
    student.press("Commit to this prediction")
    student.press("Next")
    student.ready()
    assert not page.get_by_text("Four arches, not one bump").is_visible()
    student.happens(8.5)
    assert page.get_by_text("Four arches, not one bump").is_visible()
    assert page.locator(".step.open .compared canvas").is_visible()
    student.press("Next")
    student.press("Next")
    page.get_by_role("radio", name="As far as before").check()
    student.press("Commit to this prediction")
    student.press("Next")
    student.ready()
    student.happens(8.5)
    assert page.locator(".step.open .compared").get_by_text("Yes: 49.5 mm.").is_visible()
    student.press("Next")
    student.ready()
    student.slide("K1", 600)
    student.slide("K2", 50)
    student.advance(1)
    student.press("Hold both back")
    student.advance(2.6)
    wait_for(student.passed, WAIT)
    student.press("Next")
    page.get_by_role("radio", name="Hardly at all").check()
    student.press("Commit to this prediction")
    student.press("Next")
    student.ready()
    student.happens(9.5)
    assert page.locator(".step.open .wrong").first.inner_text() == "Not quite."
    student.press("Next")
    student.ready()
    for _ in range(6):
        page.keyboard.press("d")
    student.advance(1)
    page.keyboard.press("x")
    student.advance(2)
    wait_for(student.passed, WAIT)
    page.get_by_role("radio", name="There is no time in").check()
    page.get_by_role("radio", name="Putting chocolates").check()
    assert page.locator(".step.open .right").filter(has_text="Right.").count() == 2
    student.press("Next")
    student.press("Finish")
    assert "11" in page.locator("#counts").inner_text()
    assert page.get_by_text("A timetable says where the end-point must be").is_visible()


def test_lesson_1_whole_by_mouse_from_its_files(browser: Browser, site: Path) -> None:
    student = Student(browser, (site / f"{LESSON}.html").as_uri())
    lesson_one_by_mouse(student)
    assert student.complaints == []
    assert all(url.startswith("file:") for url in student.requests)
    student.context.close()


@pytest.mark.parametrize("step", [2, 8])
def test_what_happens_is_what_happens_in_the_lab(browser: Browser, site: Path, step: int) -> None:
    lesson = read_course([BUILT_IN])[0].lesson(LESSON, "en")
    truth = computed_truth(lesson, step - 1)
    assert truth
    student = Student(browser, f"{(site / LESSON).as_uri()}.html#{step}")
    student.ready()
    student.page.locator("#next").click()  # skips the prediction
    wait_for(lambda: student.page.evaluate("site.index") == step, WAIT)
    student.ready()
    student.happens(10)
    found = student.page.evaluate(f"site.stage.simulation.curve('{truth.quantity}')")
    for robot in ("tracker", "follower"):
        here = np.interp(truth.times, found["times"], found[robot])
        difference = np.abs(here - np.array(getattr(truth, robot)))
        assert difference.max() < MILLIMETRE and np.median(difference) < 0.01, robot
    student.context.close()


def test_tasks_accept_the_solution_and_not_the_failure(browser: Browser, site: Path) -> None:
    lesson = read_course([BUILT_IN])[0].lesson(LESSON, "en")
    references, _ = read_references(lesson, BUILT_IN / LESSON / REFERENCE)
    student = Student(browser, (site / f"{LESSON}.html").as_uri())
    for i, step in enumerate(lesson.steps):
        for task in step.tasks():
            for script, expected in (
                (references[task.id].solution, True),
                (references[task.id].failure, False),
            ):
                student.page.evaluate("i => site.open(i)", i)
                wait_for(lambda i=i: student.page.evaluate("site.index") == i, WAIT)
                student.ready()
                student.press("Pause")
                student.page.evaluate("site.stage.simulation.setUp()")
                passed, now = False, 0.0
                for action in sorted(script.do, key=lambda each: each.at):
                    student.advance(action.at - now)
                    now = action.at
                    student.page.evaluate(DO, act_of(action))
                for _ in range(30):
                    student.advance(0.1)
                    passed |= student.page.evaluate(JUDGED)
                assert passed == expected, (task.id, expected)
    student.context.close()


DO = """([what, value]) => {
    const {simulation} = site.stage
    if (what !== "set") return simulation[what](value)
    const {names} = simulation.data
    for (const [name, number] of Object.entries(value)) simulation.set(names.indexOf(name), number)
}"""
JUDGED = """() => {
    const {page, index, stage} = site
    const {checks} = page.steps[index].blocks.find(block => block.kind === "task")
    return judge(checks, stage.simulation.record(), page.words).every(each => each.passed)
}"""


def act_of(action: Any) -> list[Any]:
    if action.what == "hold":
        return ["hold", action.hold]
    if action.what == "set":
        return ["set", action.set]
    if action.what == "release":
        return ["pull", None]
    assert action.what == "pull"
    return ["pull", [each / 1e3 for each in action.pull]]


@pytest.mark.parametrize("name", ["index.html", f"{LESSON}.html"])
def test_axe_finds_nothing_serious(browser: Browser, site: Path, name: str) -> None:
    student = Student(browser, (site / name).as_uri(), bypass_csp=True)  # it would refuse axe, too
    student.page.wait_for_function("window.site?.stage || window.site?.figure")
    student.page.add_script_tag(path=SCRIPT)
    assert student.page.evaluate(RUN) == []
    if name != "index.html":
        for _ in range(3):
            student.page.locator("#next").click()
            assert student.page.evaluate(RUN) == []
    student.context.close()


def test_without_scripts_the_text_is_shown(browser: Browser, site: Path) -> None:
    student = Student(browser, (site / f"{LESSON}.html").as_uri(), java_script_enabled=False)
    page = student.page
    assert page.get_by_text("Four arches, not one bump").is_visible()
    assert page.locator("math").first.is_visible()
    assert page.locator("img[alt*='over 8 s']").first.is_visible()
    assert page.get_by_role("button").count() == 0
    student.context.close()


@pytest.fixture(scope="module")
def checking(browser: Browser, site: Path) -> Iterator[Page]:
    student = Student(browser, (site / f"{LESSON}.html").as_uri())
    student.ready()
    yield student.page
    student.context.close()


JUDGE_ALL = (
    """cases => cases.map(({check, record}) => judge([check], record, site.page.words)[0])"""
)


@settings(max_examples=40, suppress_health_check=list(HealthCheck), deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_checks_say_and_decide_what_the_lab_s_do(checking: Page, seed: int) -> None:
    rng = np.random.default_rng(seed)
    cases, expected = list[dict[str, Any]](), list[dict[str, Any]]()
    for _ in range(60):
        record, check = some_record(rng), some_check(rng)
        names = robot_names(record.laws, ENGLISH)
        data = check_data(check, record.parameters, names, ENGLISH)
        cases.append({"check": data, "record": as_data(record)})
        found = verdict(check, record, ENGLISH)
        expected.append({"passed": found.passed, "words": found.words})
    assert checking.evaluate(JUDGE_ALL, json.dumps(cases)) == expected


def as_data(record: Record) -> dict[str, Any]:
    """A record as the page keeps one."""
    laws = {bench: short_name(law) for bench, law in {**DEFAULT_LAWS, **record.laws}.items()}
    gains = {
        name: getattr(record.parameters, name) for name in ("K1", "K2", "task", "encoder_counts")
    }
    own = {"path": record.path, "robot": record.robot, "length": record.length()}
    return {
        "times": record.times.tolist(),
        "end": record.end,
        "values": {r: {q: c.tolist() for q, c in own.items()} for r, own in record.values.items()},
        "happenings": [asdict(event) for event in record.happenings],
        "run": record.run,
        "settings": gains | laws | own,
    }
