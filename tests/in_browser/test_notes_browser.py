"""What the static site's pages keep of a student, and say when they cannot."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from tests.support.site_export import LESSON, exported_site
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.thorough
WAIT = 60.0  # [s]


@pytest.fixture(scope="module")
def page(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    site = exported_site(tmp_path_factory.mktemp("site"), ("en",))
    page = browser.new_page()
    page.goto((site / f"{LESSON}.html").as_uri())
    wait_for(lambda: page.evaluate("'packed' in window"), WAIT)
    yield page
    page.close()


def test_a_browser_that_keeps_nothing_says_so_in_a_lesson(browser: Browser, page: Page) -> None:
    context = browser.new_context()
    other = context.new_page()
    other.add_init_script("Storage.prototype.setItem = () => { throw new Error('full') }")
    other.goto(page.url)
    notice = other.locator("#notice")
    wait_for(lambda: "keeps nothing for this page" in notice.inner_text(), WAIT)
    other.locator("#next").click()
    assert notice.locator("p").count() == 1 and page.locator("#notice p").count() == 0
    context.close()


def test_what_was_written_last_is_read_also_when_there_was_no_room_for_it(page: Page) -> None:
    assert page.evaluate("""() => {
        const { progress } = site.student, { setItem } = Storage.prototype
        const read = ["first"]
        progress.set("some", read[0])
        Storage.prototype.setItem = () => { throw new Error("full") }
        progress.set("some", "second")
        read.push(progress.get("some"))
        Storage.prototype.setItem = setItem
        progress.set("some", "third")
        read.push(progress.get("some"))
        localStorage.setItem("onpath.some", "by another page")
        read.push(progress.get("some"))
        localStorage.removeItem("onpath.some")
        document.querySelector("#notice").replaceChildren()
        return read
    }""") == ["first", "second", "third", "by another page"]


TASK = """() => {
    const at = site.page.steps.findIndex(step => step.blocks.some(block => block.ways?.length))
    site.open(at)
    return site.page.steps[at].blocks.find(block => block.ways?.length).id
}"""


def test_hints_are_noted_and_what_is_said_after_a_task_depends_on_how_it_was_passed(
    browser: Browser, page: Page
) -> None:
    """The last hint that was read counts; the reason is told to those who open it."""
    context = browser.new_context()
    other = context.new_page()
    other.goto(page.url)
    wait_for(lambda: other.evaluate("'packed' in window"), WAIT)
    task = other.evaluate(TASK)
    step, hints = other.locator(".step.open"), "task => site.student.notes.hints[task] ?? 0"
    assert other.evaluate(hints, task) == 0
    for hint, noted in ((2, 2), (1, 2), (3, 3)):
        step.locator("summary").filter(has_text=f"Hint {hint}").click()
        wait_for(lambda noted=noted: other.evaluate(hints, task) == noted, WAIT)
    why = step.get_by_text("Why did this work?")
    assert why.count() > 1 and not any(each.is_visible() for each in why.all())
    other.evaluate(
        """task => {
            const { student } = site
            student.notes.given.push({item: task, number: 0, right: true, way: 1})
            student.save()
        }""",
        task,
    )
    other.reload()
    wait_for(lambda: other.evaluate("'packed' in window"), WAIT)
    assert other.evaluate(TASK) == task and other.evaluate(hints, task) == 3
    (told,) = (each for each in why.all() if each.is_visible())
    reason = step.get_by_text("You have hardly stiffened the spring.")
    assert not reason.is_visible()
    told.click()
    wait_for(reason.is_visible, WAIT)
    context.close()


SOON = """() => {
    const { simulation } = site.stage, ticks = seconds => Math.round(seconds / simulation.data.dt)
    simulation.set({ K1: 600, K2: 50 })
    simulation.advance(ticks(1))
    simulation.hold(true)
    simulation.advance(ticks(2.6))
    simulation.reset()
    return site.student.notes.given.filter(each => each.way !== undefined).map(each => each.item)
}"""


def test_a_task_that_is_done_counts_however_soon_its_run_ends(browser: Browser, page: Page) -> None:
    """The page judges the tasks twice a second; a run may be reset at once after its success."""
    context = browser.new_context()
    other = context.new_page()
    other.goto(page.url)
    wait_for(lambda: other.evaluate("'packed' in window"), WAIT)
    task = other.evaluate(TASK)
    wait_for(lambda: other.evaluate("site.ready"), WAIT)
    assert other.evaluate(SOON) == [task]
    context.close()
