"""What a student answered in a lesson of the static site is shown there as in the lab."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from onpath.app.exports.site.write_site import write_site
from onpath.lessons.course import read_course
from tests.support.format_texts import FORMAT_LESSON, FORMAT_REFERENCE
from tests.support.lesson_texts import write_lesson
from tests.support.site_reader import SiteReader

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.thorough
NAME = "01-a"
NUMBER = """```number
question = "How many?"
number = 60
tolerance = 0.5
answer = "Sixty."
```

```when right
Sixty *it is*.
```

# task: Do"""


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A lesson whose texts depend on answers, as a page."""
    folder: Path = tmp_path_factory.mktemp("answers")
    home = folder / "course"
    write_lesson(home, FORMAT_LESSON.replace("# task: Do", NUMBER), FORMAT_REFERENCE, NAME)
    course, problems = read_course([home])
    assert problems == []
    write_site(folder / "site", course, home, ["en"])
    return (folder / "site" / f"{NAME}.html").as_uri()


def opened(browser: Browser, address: str) -> SiteReader:
    return SiteReader(browser, address, reduced_motion="reduce")


def predict(reader: SiteReader, option: str) -> str:
    """Choose in the fourth step; return what the explanation says then."""
    page = reader.page
    page.evaluate("site.open(3)")
    page.get_by_role("radio", name=option).check()
    reader.press("Commit to this prediction")
    page.evaluate("site.open(5)")
    return page.locator(".step.open").inner_text()


def test_a_text_has_the_numbers_of_the_curve_that_was_drawn(browser: Browser, address: str) -> None:
    reader = opened(browser, address)
    page = reader.page
    page.evaluate("site.open(5)")
    assert "You drew nothing, and chose: –." in page.locator(".step.open").inner_text()
    page.evaluate("site.open(1)")
    for place, ups in ((0, 1), (16, 5), (32, 1)):
        page.locator(".step.open .point").nth(place).focus()
        for _ in range(ups):
            page.keyboard.press("ArrowUp")
    reader.press("Commit to this prediction")
    values = page.evaluate("site.notes.given.find(each => each.item === '1').answer.values")
    drawn = f"You drew {max(values):.3g}, and chose: –."
    page.evaluate("site.open(5)")
    assert drawn in page.locator(".step.open").inner_text()
    page.evaluate("site.open(2)")  # only the lab can play it: the truth comes with the page
    assert page.locator(".step.open .compared canvas").is_visible()
    times = page.evaluate("site.notes.truths['1'].times")
    assert times[0] == 0 and times[-1] > 0.9
    page.evaluate("site.open(5)")
    page.reload()
    assert drawn in page.locator(".step.open").inner_text()
    reader.context.close()


@pytest.mark.parametrize("option", ["this", "that"])
def test_a_text_for_the_wrong_answer_is_shown_for_that_alone(
    browser: Browser, address: str, option: str
) -> None:
    reader = opened(browser, address)
    reader.page.evaluate("site.open(5)")
    assert "It was not that" not in reader.page.locator(".step.open").inner_text()
    assert ("It was not that" in predict(reader, option)) == (option == "this")
    reader.context.close()


def test_a_text_for_a_right_number_is_shown_once_it_is_given(
    browser: Browser, address: str
) -> None:
    reader = opened(browser, address)
    page = reader.page
    page.evaluate("site.open(6)")
    told = page.get_by_text("Sixty it is.")
    for given, shown in (("", False), ("59.4", False), ("59.5", True), ("61", False)):
        page.locator(".step.open .number input").fill(given)
        reader.press("Check")
        assert told.is_visible() == shown, given
    assert reader.complaints == []
    reader.context.close()


def test_what_only_the_lab_knows_of_a_student_is_said_or_shown_to_all(
    browser: Browser, address: str
) -> None:
    """A step for some answers is shown, and a task that compares with the run before is not one."""
    reader = opened(browser, address)
    page = reader.page
    titles = page.locator(".words h2").evaluate_all("all => all.map(each => each.textContent)")
    assert "Only for some" in titles
    page.evaluate("site.open(7)")
    assert page.get_by_text("This task can be done only in the lab").is_visible()
    assert page.locator(".step.open .verdicts").inner_text() == ""
    reader.context.close()
