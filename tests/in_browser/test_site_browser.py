"""The static site in Chromium, from files and web servers: by mouse, by keys, by finger."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from onpath.app.exports.site.pages import POLICY
from tests.support.axe import RUN, SCRIPT, unnamed
from tests.support.browser import THREE_FRAMES
from tests.support.fingers import fingers
from tests.support.site import NGINX
from tests.support.site_export import LESSON, exported_site
from tests.support.site_lesson import END, lesson_one_by_keys, lesson_one_by_mouse
from tests.support.site_reader import PHONE, WAIT, SiteReader
from tests.support.site_servers import nginx, python_server
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.thorough
PAGE = f"{LESSON}.html"
TIME = "what => window.site?.[what]?.simulation.time ?? 0"
FREE = "Boolean(window.site?.figure)"
PAPER = {"light": "#ffffff", "dark": "#25262b"}
BOARD = ".step.open canvas.board"
INKED = "name => document.querySelector(name).getContext('2d').strokeStyle"
"""The colour of the rim of the letters on a canvas, which are drawn last."""
TOUCHED = ".step.open :is(button, summary, select, .options label):visible, header a"
SMALL = """all => all.filter(each => each.getBoundingClientRect().height < 44)
    .map(each => each.textContent)"""
CUT = """width => [...document.querySelectorAll("main *")].filter(each => {
    const {right, width: own} = each.getBoundingClientRect()
    const {overflowX, overflowY} = getComputedStyle(each)
    const hides = overflowX !== "visible" && each.scrollWidth > each.clientWidth + 2 ||
        overflowY !== "visible" && each.scrollHeight > each.clientHeight + 2
    return own && (right > width + 1 || hides && !each.matches(".live, math *"))
}).map(each => each.outerHTML.slice(0, 80))"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return exported_site(tmp_path_factory.mktemp("site"), ("en",))


@pytest.fixture(scope="module")
def addresses(site: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """Where the site is found."""
    with ExitStack() as stack:
        found = {"files": site.as_uri(), "python": stack.enter_context(python_server(site))}
        if NGINX:
            own = tmp_path_factory.mktemp("nginx")
            found["nginx"] = stack.enter_context(nginx(site, own, POLICY))
        yield found


def read_on(
    browser: Browser, addresses: dict[str, str], where: str, page: str, **more: Any
) -> SiteReader:
    if where not in addresses:
        pytest.skip("nginx is not installed (apt install nginx)")
    return SiteReader(browser, f"{addresses[where]}/{page}", **more)


def at_peace(reader: SiteReader, address: str) -> None:
    """Nothing was refused, and nothing asked of anybody else."""
    assert reader.complaints == []
    assert all(url.startswith((address, "blob:")) for url in reader.requests), reader.requests
    reader.context.close()


def test_its_pages_open_and_move(browser: Browser, addresses: dict[str, str]) -> None:
    for address in addresses.values():
        reader = SiteReader(browser, f"{address}/index.html")
        page = reader.page
        wait_for(lambda page=page: page.evaluate(TIME, "figure") > 0.3, WAIT)
        page.get_by_role("link", name="Path or timetable?").click()
        wait_for(lambda page=page: page.evaluate(TIME, "stage") > 0.3, WAIT)
        at_peace(reader, address)


def test_lesson_1_by_mouse_and_its_progress_is_kept_and_carried(
    browser: Browser, addresses: dict[str, str], tmp_path: Path
) -> None:
    reader = read_on(browser, addresses, "nginx", PAGE)
    lesson_one_by_mouse(reader)
    reader.page.reload()
    wait_for(lambda: reader.page.get_by_text(END).is_visible(), WAIT)
    assert reader.page.locator("#step-13 .compared").count() == 3
    reader.page.get_by_role("link", name="Lessons").click()
    done = reader.page.locator(f"[data-lesson='{LESSON}']")
    wait_for(lambda: "12" in done.inner_text(), WAIT)
    with reader.page.expect_download() as download:
        reader.press("Save as a file")
    file = tmp_path / "progress.json"
    download.value.save_as(file)
    said = done.inner_text()
    at_peace(reader, addresses["nginx"])

    other = read_on(browser, addresses, "files", "index.html")
    done = other.page.locator(f"[data-lesson='{LESSON}']")
    assert done.inner_text() == ""
    broken = tmp_path / "broken.json"
    broken.write_text(
        json.dumps({"format": "onpath-progress-1", "lessons": {LESSON: {"seen": []}}})
    )
    for given, expected in ((broken, ""), (file, said)):
        other.page.locator("#read").set_input_files(given)
        wait_for(lambda: other.page.locator("#told").inner_text() != "", WAIT)
        assert done.inner_text() == expected
        other.page.evaluate("document.querySelector('#told').textContent = ''")
    for answer, left in (("dismiss", said), ("accept", "")):
        other.page.once("dialog", lambda dialog, answer=answer: getattr(dialog, answer)())
        other.press("Delete")
        assert done.inner_text() == left
    other.page.locator("#read").set_input_files(file)
    wait_for(lambda: done.inner_text() == said, WAIT)
    other.page.goto(f"{addresses['files']}/{PAGE}")
    wait_for(lambda: other.page.get_by_text(END).is_visible(), WAIT)
    at_peace(other, addresses["files"])


def test_lesson_1_by_keys_alone(browser: Browser, addresses: dict[str, str]) -> None:
    reader = read_on(browser, addresses, "python", PAGE)
    lesson_one_by_keys(reader)
    at_peace(reader, addresses["python"])


def test_with_one_thumb_on_a_telephone(browser: Browser, addresses: dict[str, str]) -> None:
    reader = read_on(browser, addresses, "files", PAGE, **PHONE)
    page = reader.page
    reader.ready()
    reader.button("Hold both back").tap()
    assert page.evaluate("site.stage.simulation.held")
    reader.button("Pause").tap()
    x, y = reader.place(page.locator(".step.open .robot canvas").first)
    tip = "site.stage.figure.views[0].pixel(site.stage.simulation.sides[0].tip())"
    dx, dy = page.evaluate(tip)
    pulled = "site.stage.simulation.happenings.map(each => each.name)"
    reader.swipe(*([x + dx, y + dy - way] for way in (0, 10, 20, 30)))
    assert page.evaluate(pulled) == ["hold", "pull", "release"]
    reader.button("Next").tap()
    board = page.locator(BOARD)
    x, y = reader.place(board)
    scrolled = page.evaluate("scrollY")
    first, second = (x + 120, y + 60), (x + 250, y + 40)
    with fingers(page) as tell:
        for kind, *at in (
            ("touchStart", (x + 60, y + 190)),
            ("touchMove", first),
            ("touchStart", first, (x + 150, y + 60)),  # a second finger does not draw
            ("touchMove", first, second),
            ("touchMove", first),  # it is lifted
            ("touchMove", (x + 200, y + 120)),
            ("touchMove", (x + 300, y + 190)),
            ("touchEnd",),
        ):
            tell(kind, *at)
            page.evaluate(THREE_FRAMES)
    assert page.evaluate("scrollY") == scrolled
    reader.button("Commit to this prediction").tap()
    drawn = page.evaluate("site.notes.given.find(each => each.item === '1').answer.values")
    assert len(drawn) == 4 and max(drawn) == drawn[1]
    reader.button("Next").tap()
    reader.ready()
    reader.button("Let it happen").tap()
    reader.played(8.5)
    reader.button("Next").tap()
    reader.button("Next").tap()
    page.locator(".step.open label").filter(has_text="As far as before").tap()
    reader.button("Commit to this prediction").tap()
    assert page.evaluate("site.notes.given.map(each => each.item)") == ["1", "4"]
    for number in range(12):
        page.evaluate("number => site.open(number)", number)
        assert page.evaluate("document.documentElement.scrollWidth") == 390, number
        assert page.locator(TOUCHED).evaluate_all(SMALL) == [], number
    at_peace(reader, addresses["files"])


def test_keys_pull_further_each_time_and_from_zero_after_the_hand_has_let_go(
    browser: Browser, addresses: dict[str, str]
) -> None:
    reader = read_on(browser, addresses, "files", PAGE)
    page = reader.page
    reader.ready()

    def pulled(*keys: str) -> list[list[float] | None]:
        for key in keys:
            page.keyboard.press(key)
        by = page.evaluate("site.stage.simulation.sides.map(side => side.pulledBy)")
        return [each and [round(1e3 * metres, 6) for metres in each] for each in by]

    assert pulled("d", "d", "w") == [[10, 5], [10, 5]]
    assert pulled("r") == [None, None]
    assert pulled("d") == [[5, 0], [5, 0]]
    assert pulled("x") == [None, None]
    assert pulled("a") == [[-5, 0], [-5, 0]]
    page.evaluate("site.stage.act([{release: true}])")
    assert pulled("a", "s") == [[-5, -5], [-5, -5]]
    at_peace(reader, addresses["files"])


def test_a_point_of_the_path_is_dragged_by_a_finger(
    browser: Browser, addresses: dict[str, str]
) -> None:
    reader = read_on(browser, addresses, "files", "index.html", **PHONE)
    page = reader.page
    wait_for(lambda: page.evaluate(FREE), WAIT)
    reader.button("Pause").tap()
    spots = "site.figure.simulation.followed.spots()"
    x, y = reader.place(page.locator(".robot canvas").first)
    before, scrolled = np.array(page.evaluate(spots)), page.evaluate("scrollY")
    dx, dy = page.evaluate(f"site.figure.views[0].pixel({spots}[2])")
    x, y = x + 8, y + 10  # a finger is beside it
    reader.swipe([x + dx, y + dy], [x + dx, y + dy + 4], [x + dx, y + dy + 8])
    after = np.array(page.evaluate(spots))
    assert after[2][1] < before[2][1] - 0.004 and page.evaluate("scrollY") == scrolled
    np.testing.assert_array_equal(np.delete(after, 2, 0), np.delete(before, 2, 0))
    assert page.evaluate("site.figure.simulation.selected") == 2
    at_peace(reader, addresses["files"])


@pytest.mark.parametrize("name", ["index.html", PAGE])
def test_axe_finds_nothing_serious_on_light_or_dark_pages(
    browser: Browser, addresses: dict[str, str], name: str
) -> None:
    more = {"bypass_csp": True, "reduced_motion": "reduce"}  # the policy would refuse axe, too
    reader = read_on(browser, addresses, "files", name, **more)
    page = reader.page
    page.wait_for_function("window.site?.stage || window.site?.figure")
    page.add_script_tag(path=SCRIPT)
    assert_readable(reader, name)
    for number in range(page.evaluate("site.page.steps?.length ?? 0")):
        page.evaluate("number => site.open(number)", number)
        assert_readable(reader, f"{number}")
        answered(reader)
        assert_readable(reader, f"{number}, answered")
    reader.context.close()


def assert_readable(reader: SiteReader, where: str) -> None:
    """Assert that axe finds nothing serious, whatever scheme is chosen; a board follows it."""
    page = reader.page
    for scheme, ink in PAPER.items():
        page.emulate_media(color_scheme=scheme)  # pyright: ignore[reportArgumentType]
        paper = page.evaluate("getComputedStyle(document.documentElement).backgroundColor")
        assert (sum(json.loads(f"[{paper[4:-1]}]")) < 150) == (scheme == "dark")
        if page.locator(BOARD).count():
            wait_for(lambda ink=ink: page.evaluate(INKED, BOARD) == ink, WAIT)
        assert page.evaluate(RUN) == [] and unnamed(page) == [], f"{where}, {scheme}"


def answered(reader: SiteReader) -> None:
    """All that the open step asks, with all that it hides."""
    step = reader.page.locator(".step.open")
    for option in step.locator(".choice").get_by_role("radio").all()[:1]:
        option.check()
        reader.press("Commit to this prediction")
    if step.locator(".sketch").count():
        reader.press("Skip the prediction")  # and see the run
        reader.ready()
    for play in step.get_by_role("button", name="Let it happen", exact=True).all():
        play.click()
        reader.played(10)
    for question in step.locator(".quiz[data-block]").all():
        question.get_by_role("radio").first.check()
        question.get_by_role("button", name="Check").click()
    for second in step.locator("[data-second]:visible").all():
        for option in second.get_by_role("radio").all()[:1]:
            option.check()
        for number in second.get_by_role("textbox").all():
            number.fill("1")
        second.get_by_role("button", name="Check").click()
    step.locator("details").evaluate_all("all => all.forEach(each => (each.open = true))")


def test_without_scripts_the_text_is_shown(browser: Browser, addresses: dict[str, str]) -> None:
    reader = read_on(browser, addresses, "files", PAGE, java_script_enabled=False)
    page = reader.page
    assert page.get_by_text("Four arches, not one bump").is_visible()
    assert page.locator("math").first.is_visible()
    assert page.locator("img[alt*='over 8 s']").first.is_visible()
    assert page.get_by_role("button").count() == 0
    reader.context.close()


def test_what_was_read_and_answered_is_printed_whole(
    browser: Browser, addresses: dict[str, str]
) -> None:
    reader = read_on(browser, addresses, "files", PAGE, reduced_motion="reduce")
    page = reader.page
    reader.ready()
    page.evaluate("site.open(4)")
    page.get_by_role("radio", name="As far as before").check()
    reader.press("Commit to this prediction")
    page.set_viewport_size({"width": 718, "height": 1000})  # A4 within its margins
    page.emulate_media(media="print")
    page.evaluate("dispatchEvent(new Event('resize'))")
    assert page.evaluate(CUT, 718) == []
    seen = [page.locator(f"#step-{i + 1}").is_visible() for i in range(12)]
    assert seen == [i < 5 for i in range(12)]
    assert page.get_by_role("radio", name="As far as before").is_visible()
    assert page.get_by_role("button").count() == 0
    assert not page.get_by_text("Yes: nearly 50 mm.").is_visible()
    assert len(page.pdf()) > 20_000
    reader.context.close()
