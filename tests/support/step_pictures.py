"""Pictures of every step of the lessons as a browser of some size shows them, on sheets of twelve.

    python -m tests.support.step_pictures FOLDER WIDTH HEIGHT LANGUAGE [LESSON...]

It also lists what is wrong on the page by itself: text wider than its box, formulas not set, a
title out of sight.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

from onpath.app.lab import commands as c
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from tests.support.browser import CHROMIUM, PLAIN, Tab, wait_for
from tests.support.built_in import built_in_course

COURSE, _ = built_in_course()
PRESENTED = 1900  # [px], from this width on the steps are shown in large type
ONE_PICTURE = """() => new Promise(done => {
    drawn = true
    requestAnimationFrame(() => requestAnimationFrame(() => { drawn = false; done() }))
})"""
SELDOM_DRAWN = """
    drawn = false
    requestAnimationFrame = act => setTimeout(() => act(performance.now()), drawn ? 400 : 50)
    const context = WebGL2RenderingContext.prototype
    for (const what of Object.keys(Object.getOwnPropertyDescriptors(context))) {
        if (!/^(draw[EAR]|clear$|clearB|blit)/.test(what)) continue
        const does = context[what]
        context[what] = function (...given) { if (drawn) does.apply(this, given) }
    }
"""
"""The scene is drawn in software, which takes seconds: only for the pictures, and then it stays."""
ACROSS, DOWN = 4, 3  # pictures on a sheet
WRONG = """() => {
    const RAW = /.{0,20}(\\$|\\\\[a-z]|\\{\\{|\\*\\*).{0,20}/g
    const seen = box => box.offsetParent !== null && box.getBoundingClientRect().width > 0
    const found = []
    for (const box of document.querySelectorAll(".op-text, .op-text *, .op-box, .op-box *")) {
        if (!seen(box) || box.closest("math, .katex, svg")) continue
        const style = getComputedStyle(box)
        const over = box.scrollWidth - box.clientWidth
        const cut = style.overflowX === "visible" && style.display !== "inline"
        if (cut && box.clientWidth > 0 && over > 1)
            found.push(`${over} px too wide: ${box.tagName} ${box.textContent.slice(0, 50)}`)
    }
    for (const box of document.querySelectorAll(".op-text, .op-box"))
        for (const raw of (seen(box) && box.innerText.match(RAW)) || [])
            found.push("not set: " + raw)
    return found
}"""


def shots(tab: Tab, name: str, folder: Path) -> Iterator[Path]:
    """Save a picture of each step of a lesson, and say what is wrong there."""
    for index, step in enumerate(COURSE.lesson(name, "en").steps):
        tab.ask(c.TakeStep(name, index))
        run = tab.lab.lessons
        wait_for(lambda index=index: run.lesson is not None and run.index == index)
        tab.wait_until_built()
        read = tab.button(run.words("lesson.skip_run"))
        if step.kind == "run" and read.count():
            read.click()
            read.wait_for(state="detached")
        tab.settle()
        tab.page.evaluate(ONE_PICTURE)
        file = folder / f"{name}-{index + 1:02}.png"
        tab.page.screenshot(path=file, type="png")
        for fault in tab.page.evaluate(WRONG):
            sys.stdout.write(f"{name} {index + 1}: {fault}\n")
        yield file


def sheets(files: list[Path], folder: Path, prefix: str) -> None:
    """Put the pictures on sheets."""
    for first in range(0, len(files), ACROSS * DOWN):
        pictures = [Image.open(file) for file in files[first : first + ACROSS * DOWN]]
        width = min(480, pictures[0].width)
        height = round(width * pictures[0].height / pictures[0].width)
        sheet = Image.new("RGB", (ACROSS * width, DOWN * height), "white")
        for place, picture in enumerate(pictures):
            at = (place % ACROSS * width, place // ACROSS * height)
            sheet.paste(picture.resize((width, height), Image.Resampling.LANCZOS), at)
        sheet.save(folder / f"sheet-{prefix}-{first // (ACROSS * DOWN):02}.png")


def photograph(
    browser: Browser, server: LabServer, folder: Path, size: tuple[int, int], language: str
) -> None:
    """Save pictures and sheets of all lessons that are named on the command line, or of all."""
    width, height = size
    files = list[Path]()
    for name in sys.argv[5:] or COURSE.lessons:
        context = browser.new_context(viewport={"width": width, "height": height})
        context.add_init_script(SELDOM_DRAWN)
        tab = Tab(server, context)
        tab.ask(c.SetLanguage(language), c.Set("presenting", width >= PRESENTED))
        tab.wait_until_built()
        files += shots(tab, name, folder)
        if tab.errors:
            sys.stdout.write(f"{name}: {tab.errors}\n")
        context.close()
    sheets(files, folder, f"{width}-{language}")


def main() -> None:
    """See the module."""
    folder, width, height, language = Path(sys.argv[1]), *map(int, sys.argv[2:4]), sys.argv[4]
    folder.mkdir(parents=True, exist_ok=True)
    server = LabServer("127.0.0.1", 0, LoopCache())
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=PLAIN)
        photograph(browser, server, folder, (width, height), language)
        browser.close()
    server.stop()


if __name__ == "__main__":
    main()
