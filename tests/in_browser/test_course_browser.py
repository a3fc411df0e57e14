"""Every lesson from its first page to its end, by mouse: what is shown is what the lesson says."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime

import pytest

pytest.importorskip("playwright")

from playwright.sync_api import Browser, expect

from onpath.app.exports.report import report
from onpath.app.lab.plot_rows import row_data
from onpath.app.server.lab_server import LabServer
from onpath.lessons.adaptive.branches import is_shown
from onpath.lessons.progress import Notes
from onpath.lessons.schema import (
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Quiz,
    Sketch,
    Step,
    Text,
)
from onpath.lessons.words import ENGLISH
from onpath.models.systems.law_parameters import LEVEL_SET
from tests.support.browser import WAIT, Tab, wait_for
from tests.support.built_in import built_in_course
from tests.support.pupil import Pupil
from tests.support.solutions import passed

pytestmark = pytest.mark.thorough
expect.set_options(timeout=WAIT * 1e3)

COURSE, _ = built_in_course()
NUMBERS = COURSE.numbers()
LESSONS = list(COURSE.lessons)
Asked = Choice | Sketch | Quiz | NumberQuestion | OpenQuestion | Derivation
MISSING = """([htmls, other]) => {
    const bare = text => text.replace(/\\s+/g, "")
    const shown = other ? new DOMParser().parseFromString(other, "text/html") : document
    const body = shown.body.cloneNode(true)
    for (const veiled of body.querySelectorAll(".veiled [data-block]")) veiled.remove()
    const page = bare(body.textContent)
    return htmls.filter(html => {
        const wanted = document.createElement("div")
        wanted.innerHTML = html
        return !page.includes(bare(wanted.textContent))
    })
}"""
"""Which of some texts are not on the page, or in another one that is given."""


@pytest.fixture
def tab(browser: Browser, server: LabServer) -> Iterator[Tab]:
    """A student's tab in which time runs four times as fast."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    tab = Tab(server, context, draws=False)
    Pupil(tab).hurry()
    yield tab
    context.close()


def missing(tab: Tab, *htmls: str, record: str = "") -> list[str]:
    """Which of some texts the page does not show, or the record, if it is given."""
    wanted = [str(html) for html in htmls if html]
    found: list[str] = tab.page.evaluate(MISSING, [wanted, record])
    return found


def texts(step: Step) -> list[str]:
    """The texts of a step that everybody is shown, and that hold no number of the student's."""
    return [
        str(b.html) for b in step.blocks if isinstance(b, Text) and not b.when if "{{" not in b.html
    ]


def assert_open(pupil: Pupil, step: Step) -> None:
    """Assert that this step is open, with its robot and plots, and says nothing too early."""
    tab, run, setup = pupil.tab, pupil.tab.lab.lessons, pupil.lesson.setup_at(pupil.index)
    assert run.waits == bool(step.predictions()) and not (run.waits and tab.simulation.running)
    assert tab.simulation.entry.name == (setup.robot or pupil.lesson.front.robot)
    if step.kind == "run":
        absent = missing(tab, *texts(step))
        assert run.has_played() or len(absent) == len(texts(step))
    else:
        assert_shown(pupil, step)


def assert_shown(pupil: Pupil, step: Step) -> None:
    """Assert that the page shows the step that is open: its texts, questions, tasks and plots."""
    tab = pupil.tab
    shown = tab.page.locator("#op-column .step.open")
    expect(shown).to_have_attribute("id", f"step-{pupil.index + 1}")
    questions = [b.question for b in step.blocks if isinstance(b, Asked)]
    assert missing(tab, *texts(step), *questions, *(task.text for task in step.tasks())) == []
    before = pupil.lesson.steps[pupil.index - 1] if step.kind == "run" and pupil.index else step
    if any(isinstance(block, Sketch) for block in before.predictions()):  # in the plots' place
        expect(tab.page.locator(".board, .compared canvas").first).to_be_visible()
        return
    wanted = pupil.lesson.setup_at(pupil.index).plots
    is_level_set = tab.simulation.parameters.across == LEVEL_SET
    motors = tab.simulation.entry.make(tab.simulation.parameters).system.motor_units
    fields = tab.simulation.sample_layout.fields
    rows = row_data(fields, is_level_set, ENGLISH, motors=motors)
    named = {row.name: f"{row.label} [{row.unit}]" for row in rows}
    named |= {"phase": ENGLISH("plot.phase_name")}
    for plot in wanted:
        expect(tab.page.get_by_role("img", name=named[plot], exact=True)).to_have_count(1)


def assert_done(pupil: Pupil, step: Step) -> None:
    """Assert that the page shows what became of the step: answers, verdicts, what was predicted."""
    tab, run = pupil.tab, pupil.tab.lab.lessons
    index = pupil.index
    for place, block in enumerate(step.blocks):
        if isinstance(block, Quiz):
            chosen = block.options[run.notes.quiz[f"{index}.{place}"]]
            right = next(option for option in block.options if option.right)
            assert missing(tab, chosen.answer, right.answer) == []
        elif isinstance(block, NumberQuestion):
            assert missing(tab, block.answer) == []
    for task in step.tasks():
        why = task.explanations.get(run.notes.ways.get(task.id, 0), "")
        assert passed(tab, task) and missing(tab, why) == []
    if step.kind == "run":
        assert_shown(pupil, step)
    before = (
        pupil.lesson.steps[index - 1].predictions() if step.script is not None and index else []
    )
    for prediction in before:
        assert missing(tab, "You were: fairly sure") == []
        if isinstance(prediction, Choice):
            option = run.notes.answers[str(index - 1)].option
            assert option is not None
            right = next(each for each in prediction.options if each.right)
            assert missing(tab, prediction.options[option].answer, right.answer) == []
        else:
            expect(tab.page.locator(".compared canvas")).to_be_visible()


def what_was_done(lesson: Lesson, notes: Notes) -> list[str]:
    """What the end of a lesson tells of it: all that was asked, answered and passed."""
    told = [str(task.text) for task in lesson.tasks()]
    for index, step in enumerate(lesson.steps):
        for place, block in enumerate(step.blocks):
            chosen = None
            if isinstance(block, Asked):
                told.append(block.question)
            if isinstance(block, Choice):
                chosen = notes.answers[str(index)].option
            elif isinstance(block, Quiz):
                chosen = notes.quiz[f"{index}.{place}"]
            elif isinstance(block, NumberQuestion | OpenQuestion | Derivation):
                told.append(block.answer)
            if isinstance(block, Choice | Quiz) and chosen is not None:
                told += [block.options[chosen].text, block.options[chosen].answer]
    return told


def assert_told(pupil: Pupil) -> None:
    """Assert that of the texts for some answers only the page shows those for the given ones."""
    lesson, notes, index = pupil.lesson, pupil.tab.lab.lessons.notes, pupil.index
    for place, block in enumerate(pupil.step.blocks):
        if isinstance(block, Text) and block.when:
            told = is_shown(block.when, lesson.steps, notes, index, place)
            assert (missing(pupil.tab, block.html) == []) == told, block.html


class Checking(Pupil):
    """A pupil for whom every step is compared with the lesson, before and after it is done."""

    def do(self) -> None:
        """See `Pupil.do`."""
        step = self.step
        assert_open(self, step)
        super().do()
        if not step.predictions():
            assert_done(self, step)
            assert_told(self)

    def number(self, block: NumberQuestion, given: float) -> None:
        """See `Pupil.number`; a text for those who are wrong is shown to them only."""
        super().number(block, given)
        assert_told(self)


@pytest.mark.timeout(500)
@pytest.mark.parametrize("name", LESSONS)
def test_a_lesson_is_done_from_its_first_page_to_its_end_by_mouse(tab: Tab, name: str) -> None:
    front = COURSE.lesson(name, "en").front
    pupil = Checking(tab, right=LESSONS.index(name) % 2 == 0)
    pupil.open(f"{NUMBERS[name]}. {front.title}", name)
    seen = [step.title for step in pupil.steps()]
    run, lesson = tab.lab.lessons, pupil.lesson
    assert seen == [step.title for step in lesson.steps if not step.when or step.title in seen]
    wait_for(lambda: run.ended)
    tab.page.get_by_role("heading", name="What you predicted, and what happened").wait_for()
    tab.wait_until_built()
    tasks = len(lesson.required_tasks())
    if tasks:  # the lessons on the paper have none that must be passed
        assert missing(tab, f"{tasks} of {tasks} task") == []
    told = [*front.takeaway, *what_was_done(lesson, run.notes)]
    assert missing(tab, *told) == []
    record = report(run, "", datetime(2026, 1, 2, tzinfo=UTC)).decode()
    assert missing(tab, *told, record=record) == []
    assert set(run.notes.tasks) == {task.id for task in lesson.tasks()}
    assert tab.errors == []
