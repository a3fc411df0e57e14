"""Where the parts of figures and lessons are, in windows and frames of every size.

Both robots and the button that holds them are seen at once, with nothing over them, and stay where
they are while the text scrolls; no control is cut or outside of the window, also with longer words
and larger letters.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import onpath
from tests.support.browser import THREE_FRAMES
from tests.support.site_export import exported_site
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Frame

pytestmark = pytest.mark.thorough
WAIT = 60.0  # [s]
LEAST, MOST = (320, 480), (2560, 1440)
EDGES = [
    *(LEAST, (320, 1440), (2560, 480), MOST, (390, 844), (820, 1180), (1000, 700), (1024, 768)),
    *((719, 480), (720, 480), (719, 721), (720, 720), (720, 761), (960, 600), (1060, 480)),
]
"""Phones, tablets, learning platforms, and sizes at which the layout changes."""
DRAWN = 6  # sizes of each step
LARGER = 1.5  # letters, with a window that is larger in proportion
LESSONS = ("01-path-or-timetable", "03-the-five-bar", "07-flexible-link")
PLACES = ("figure", "figure.de", *(f"{LESSONS[i]}{own}" for i, own in enumerate(("", ".de", ""))))

SETTLED = """async () => {
    const {figure} = window.site?.stage ?? {figure: window.site?.figure ?? window.onpath}
    if (!figure) return
    figure.simulation.hold(true)
    figure.advance(300)
    document.querySelector(".step.open .asked.choice input")?.click()
}"""
"""The words about the robots are then as long as they become, and a question asks all it asks."""
LONGER = """() => {
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT)
    const within = "button, option, label, summary, .title, .bar, .value, a"
    for (let text; (text = walk.nextNode());) {
        const around = text.parentElement
        if (text.made === text.data || !around.closest(within) || around.closest("math")) continue
        const more = word => word + word.slice(0, Math.ceil(0.4 * word.length))
        text.data = text.data.replace(/\\p{L}{2,}/gu, more)
        text.made = text.data
    }
}"""
"""A language whose words are longer by 40 %."""
FAULTS = """larger => {
    const faults = []
    const step = document.querySelector(".step.open")
    const own = step ?? document
    const figure = step ? site.stage?.figure : window.onpath ?? site.figure
    const says = (what, element, box = element.getBoundingClientRect()) => {
        const where = [box.left, box.top, box.width, box.height].map(Math.round)
        faults.push([what, element.tagName, element.textContent.slice(0, 30), ...where])
    }
    const look = ways => {
        const hold = own.querySelector(".brakes > button.main")
        const robots = own.querySelectorAll(".seen > canvas")
        for (const element of [...robots, ...(hold ? [hold] : [])]) {
            const box = element.getBoundingClientRect()
            const {left, top, right, bottom, width, height} = box
            const [across, down] = [Math.min(200, 0.45 * innerWidth / larger), 150]
            const isSmall = width < across || height < down - 0.5
            if (element !== hold && isSmall) says("too small", element, box)
            const isBeside = left < -0.5 || right > innerWidth + 0.5
            const isOver = top < -0.5 || bottom > innerHeight + 0.5
            if (isBeside || isOver) says(`outside ${ways}`, element)
            const ends = element === hold ? [0.5] : [0.05, 0.5, 0.95] // a button has round corners
            for (const x of ends) for (const y of ends) {
                const found = document.elementFromPoint(left + x * width, top + y * height)
                if (!element.contains(found)) says(`covered ${ways}`, element)
            }
        }
    }
    const columns = step?.querySelectorAll(".words, .beside")
    const scrolling = step ? [step, ...columns] : [document.documentElement]
    const scroll = to => scrolling.forEach(each => each.scrollTo(0, to))
    scroll(0)
    look("at first")
    scroll(1e5)
    look("scrolled")
    scroll(0)
    const controls = "button, select, input, textarea, summary, a"
    for (const element of document.querySelectorAll(controls)) {
        const box = element.getBoundingClientRect()
        if (!element.checkVisibility() || !box.width) continue
        if (element.matches(".skip, [type=file]")) continue
        const {clientWidth, scrollWidth, clientHeight, scrollHeight} = element
        const isCut = scrollWidth > clientWidth + 1 || scrollHeight > clientHeight + 1
        if (box.left < -0.5 || box.right > innerWidth + 0.5) says("outside", element)
        if (clientWidth && isCut && element.matches("button, summary, a")) says("cut", element)
    }
    for (const element of [document.documentElement, ...scrolling])
        if (element.clientWidth && element.scrollWidth > element.clientWidth + 1)
            says("scrolls sideways", element)
    for (const {sheet, drawn} of figure?.lenses ?? []) {
        const box = sheet.canvas.getBoundingClientRect()
        if (!box.width) continue
        const scale = 1e3 * 0.28 * box.width / 2 / drawn // mm
        if (!(box.width >= 80 && Math.abs(box.width - box.height) < 1)) says("a lens", sheet.canvas)
        if (!(scale > 0.05 && scale < 100)) says(`scale ${scale}`, sheet.canvas)
    }
    const parts = [".scene", ".words", ".pager"]
    const [scene, words, pager] = parts.map(each => own.querySelector(each))
    if (step && scene && words) {
        const bar = getComputedStyle(pager).position === "sticky" ? pager.offsetHeight : 0
        const stacked = getComputedStyle(step).display === "flex"
        const beneath = step.clientHeight - scene.offsetHeight - bar
        const room = stacked ? beneath : words.clientHeight
        if (room < 60) says(`${room} px of text`, words)
    }
    return faults
}"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with figures and a site of lessons."""
    folder = tmp_path_factory.mktemp("pages")
    exported_site(folder, ("en", "de"), LESSONS)
    figure = onpath.figure(title="A robot")
    for name, language in (("figure", "en"), ("figure.de", "de")):
        figure.save(folder / "site" / f"{name}.html", language=language)
    return folder / "site"


def opened(browser: Browser, file: Path, framed: bool = False) -> Frame:
    """A page without motion, in a window or in a frame that fills one."""
    page = browser.new_context(reduced_motion="reduce").new_page()
    if framed:
        page.goto("about:blank")
        host = file.with_name("host.html")
        style = "position: fixed; inset: 0; width: 100%; height: 100%; border: 0"
        host.write_text(f'<!doctype html><iframe src="{file.name}" style="{style}"></iframe>')
        page.goto(host.as_uri())
        wait_for(lambda: len(page.frames) == 2, WAIT)
    else:
        page.goto(file.as_uri())
    frame = page.frames[-1]
    wait_for(lambda: frame.evaluate("Boolean(window.onpath || window.site)"), WAIT)
    return frame


def steps(frame: Frame) -> Iterator[int]:
    """Opens one step after the other; a figure has one."""
    for step in range(frame.evaluate("window.site?.page.steps?.length ?? 1")):
        if frame.evaluate("Boolean(window.site?.page.steps)"):
            frame.evaluate("step => site.open(step)", step)
        frame.evaluate(SETTLED)
        yield step


def found(
    frame: Frame, sizes: list[tuple[int, int]], longer: bool = False, larger: float = 1
) -> Any:
    """What is wrong at which size."""
    faults = list[Any]()
    for width, height in sizes:
        size = {"width": round(larger * width), "height": round(larger * height)}
        frame.page.set_viewport_size(size)  # pyright: ignore[reportArgumentType]
        frame.evaluate(THREE_FRAMES)
        if longer:
            frame.evaluate(LONGER)
        faults += [[width, height, *each] for each in frame.evaluate(FAULTS, larger)]
    return faults


def drawn(rng: np.random.Generator, edges: int = 3) -> list[tuple[int, int]]:
    """Sizes at random, and some of those that are known to be hard."""
    some = [EDGES[i] for i in rng.choice(len(EDGES), edges, replace=False)]
    free = rng.integers(LEAST, np.add(MOST, 1), (DRAWN - edges, 2)).tolist()
    return some + [(width, height) for width, height in free]


@pytest.mark.parametrize("place", PLACES)
def test_the_robots_are_seen_and_no_control_is_cut_at_any_size(
    browser: Browser, pages: Path, place: str
) -> None:
    rng = np.random.default_rng(PLACES.index(place))
    frame = opened(browser, pages / f"{place}.html", framed=place == PLACES[-1])
    for step in steps(frame):
        assert found(frame, drawn(rng) if step else EDGES + drawn(rng)) == [], step
    frame.page.context.close()


@pytest.mark.parametrize("place", [PLACES[1], PLACES[3]])
@pytest.mark.parametrize("way", ["longer words", "larger letters"])
def test_also_with_longer_words_and_larger_letters(
    browser: Browser, pages: Path, place: str, way: str
) -> None:
    rng = np.random.default_rng(9)
    frame = opened(browser, pages / f"{place}.html")
    longer, larger = way == "longer words", LARGER if way == "larger letters" else 1
    for step in steps(frame):
        frame.evaluate("size => document.documentElement.style.fontSize = size", f"{100 * larger}%")
        faults = found(frame, [LEAST, *drawn(rng)], longer, larger)
        assert [each for each in faults if not (longer and "px of text" in each[2])] == [], step
    frame.page.context.close()


def test_an_idle_walk_through_a_lesson_keeps_little(browser: Browser, pages: Path) -> None:
    """What a student has not done is not in the notes, and what can be computed again neither."""
    for lesson in LESSONS:
        frame = opened(browser, pages / f"{lesson}.html")
        for _ in steps(frame):
            pass
        frame.evaluate("site.open(site.page.steps.length)")
        kept = frame.evaluate("({...localStorage})")
        assert sum(map(len, kept.values())) < 1000, json.dumps(kept)
        frame.page.context.close()
