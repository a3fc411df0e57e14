"""The lab's page in windows of every size, in both languages, for mouse and finger.

Nothing is outside of the window, cut, or over something else, and what a finger is to touch is
large enough for it: in the free lab, in a step with controls, in a prediction, and in each sheet.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from onpath.app.lab import commands as c
from onpath.lessons.words import Words
from tests.support.browser import THREE_FRAMES, Tab
from tests.support.free_lab import fresh

if TYPE_CHECKING:
    from playwright.sync_api import Browser, ViewportSize

    from onpath.app.server.lab_server import LabServer

pytestmark = pytest.mark.thorough
SIZES = ((1280, 800), (1366, 768), (1920, 1080), (820, 1180), (390, 844), (640, 400))
"""Laptops, a projector, a tablet, a telephone, and a laptop's page enlarged twice."""
WIDE: ViewportSize = {"width": 1280, "height": 800}
LEAST, MOST = (360, 640), (2560, 1440)
LESSON, OTHER = "01-path-or-timetable", "04-across-and-along"
STEPS = ((LESSON, 1), (LESSON, 6), (OTHER, 7))
"""A prediction, a task with controls, and two tasks."""
LOOKS = 20  # at most, until a page has followed its window
FIRST = 10  # controls that are seen at first in the panel
FAULTS = """touch => {
    const faults = [], controls = "button, select, input, textarea, a[href]"
    const seen = element => element.checkVisibility({visibilityProperty: true})
    const says = (what, element) => {
        const {left, top, width, height} = element.getBoundingClientRect()
        const name = element.ariaLabel || element.textContent.trim() || element.className
        const place = [left, top, width, height].map(Math.round)
        faults.push([what, element.tagName, name.slice(0, 30), ...place])
    }
    const named = ["#op-head", "#op-panel", "#op-column", "#op-strip", "#op-stage"]
    const parts = named.map(each => document.querySelector(each)).filter(each => each && seen(each))
    const isDrawer = each => getComputedStyle(each).boxShadow !== "none"
    parts.forEach((part, i) => {
        const {left, top, right, bottom} = part.getBoundingClientRect()
        const isOut = left < -1 || top < -1 || right > innerWidth + 1 || bottom > innerHeight + 1
        if (isOut) says("outside", part)
        if (right - left < 100 || bottom - top < 30) says("no room", part)
        for (const each of parts.slice(0, i)) {
            const other = each.getBoundingClientRect()
            const across = Math.min(right, other.right) - Math.max(left, other.left)
            const down = Math.min(bottom, other.bottom) - Math.max(top, other.top)
            const isOver = across > 1 && down > 1
            if (isOver && !isDrawer(part) && !isDrawer(each)) says(`over ${each.id}`, part)
        }
    })
    const dialog = document.querySelector("dialog[open]")
    const own = dialog ? [dialog] : parts
    for (const element of new Set(own.flatMap(each => [...each.querySelectorAll(controls)]))) {
        if (!seen(element) || element.matches("[inert] *, .op-unseen *")) continue
        if (element.closest(".task")) element.closest(".words").scrollTo(0, 1e5)
        element.scrollIntoView({block: "center", behavior: "instant"})
        const hit = element.closest("label") ?? element
        const {left, top, right, bottom, width, height} = hit.getBoundingClientRect()
        if (!width || !height) continue
        if (left < -1 || right > innerWidth + 1) says("outside", element)
        const isCut = element.scrollWidth > element.clientWidth + 1
        if (isCut && element.matches("button:not(.back)")) says("cut", element)
        const takes = (dx, dy) => {
            const [x, y] = [(left + right) / 2 + dx, (top + bottom) / 2 + dy]
            const found = document.elementFromPoint(x, y)
            return found && (hit.contains(found) || found.contains(element))
        }
        if (!takes(0, 0)) says("covered", element)
        if (!touch || element.matches("a, p button, [type=range], .act")) continue // in a line
        if (height < 43.5 && !(takes(0, 20) && takes(0, -20))) says("too low", element)
        if (width < 43.5 && !(takes(20, 0) && takes(-20, 0))) says("too narrow", element)
    }
    for (const words of dialog ? [] : document.querySelectorAll(".step.open .words")) {
        const area = words.getBoundingClientRect(), end = words.scrollHeight - words.clientHeight
        for (let at = 0; at <= end; at += Math.max(words.clientHeight / 5, 20)) {
            words.scrollTo(0, at)
            for (const element of words.querySelectorAll(`.form :is(${controls})`)) {
                const {left, top, width, height} = element.getBoundingClientRect()
                const [x, y] = [left + width / 2, top + height / 2]
                if (!width || y < area.top + 1 || y > area.bottom - 1) continue
                const row = element.closest(".field") ?? element
                const isFree = row.contains(document.elementFromPoint(x, y))
                if (!isFree) says(`covered at ${at}`, element)
            }
        }
    }
    for (const each of [document.documentElement, ...own])
        if (each.scrollWidth > each.clientWidth + 1) says("scrolls sideways", each)
    return faults
}"""
"""What is outside, cut, covered, over something else, or too small for a finger."""
SHOWN = """() => {
    const panel = document.querySelector("#op-panel"), {bottom} = panel.getBoundingClientRect()
    const all = "select, .tiles, .track, .do, .use, summary, textarea, .switch"
    return [...panel.querySelectorAll(all)].filter(each =>
        each.checkVisibility({visibilityProperty: true})
        && each.getBoundingClientRect().bottom < bottom).length
}"""
MORE = ("controls.help", "display.title", "compare.title", "keep.title")
SHEETS = ("lesson.lessons", "search.title", *MORE)
"""Names of the buttons that open them; those of `MORE` are in the menu."""


def drawn(rng: np.random.Generator) -> list[tuple[int, int]]:
    """One of the common sizes, and one at random."""
    width, height = rng.integers(LEAST, np.add(MOST, 1)).tolist()
    return [SIZES[rng.integers(len(SIZES))], (width, height)]


def found(tab: Tab, sizes: list[tuple[int, int]], touch: bool) -> list[Any]:
    """What is wrong at which size, once the page has followed."""
    faults = list[Any]()
    for width, height in sizes:
        tab.page.set_viewport_size({"width": width, "height": height})
        left: list[Any] = []
        for _ in range(LOOKS):
            tab.page.evaluate(THREE_FRAMES)
            left = tab.page.evaluate(FAULTS, touch)
            if not left:
                break
        faults += [[width, height, *each] for each in left]
    return faults


@pytest.mark.parametrize(("touch", "language"), [(False, "en"), (True, "de")])
def test_nothing_is_outside_cut_covered_or_too_small(
    browser: Browser, server: LabServer, touch: bool, language: str
) -> None:
    rng = np.random.default_rng(51)
    context = fresh(browser, has_touch=touch)
    used = Tab(server, context, draws=False)
    page = used.page
    assert page.evaluate("matchMedia('(pointer: coarse)').matches") == touch
    page.set_viewport_size(WIDE)
    used.ask(c.SetRunning(False), c.SetLanguage(language))
    words = Words(language)
    page.get_by_role("button", name=words("setup.draw"), exact=True).wait_for()
    assert found(used, list(SIZES), touch) == []
    for name in SHEETS:
        page.set_viewport_size(WIDE)
        for each in (*(["head.more"] if name in MORE else []), name):
            page.get_by_role("button", name=words(each), exact=True).click()
        page.get_by_role("dialog").wait_for()
        assert found(used, drawn(rng), touch) == [], name
        page.keyboard.press("Escape")
    for step in STEPS:
        used.ask(c.TakeStep(*step))
        used.wait_until_built()
        assert found(used, drawn(rng), touch) == [], step
    assert used.errors == []
    context.close()


def test_the_first_sight_has_few_controls(tab: Tab) -> None:
    tab.page.set_viewport_size(WIDE)
    assert 0 < tab.page.evaluate(SHOWN) <= FIRST
