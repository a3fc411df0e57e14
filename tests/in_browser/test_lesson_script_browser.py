"""A lesson full of script runs nothing in a real browser, in the lab and as an exported page."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("playwright")

from latex2mathml.converter import convert
from playwright.sync_api import Browser

from onpath.app.exports.site.write_site import write_site
from onpath.app.lab.commands import TakeStep
from onpath.app.lab.loops.loop_cache import LoopCache
from onpath.app.server.lab_server import LabServer
from onpath.app.server.server_options import ServerOptions
from onpath.lessons import formulas
from onpath.lessons.course import Course, read_course
from tests.support.browser import Tab
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.site_reader import SiteReader

pytestmark = pytest.mark.thorough
ALIVE = ", ".join(
    (
        *("math [style]", "math [href]", "math [src]", "math script", "math svg", "[onerror]"),
        *(".op-text script", ".op-text a", ".op-text img[src]"),
    )
)
"""What would run, load or lie over the page."""
NAME, TITLE = "01-a", "<img src=x onerror=hit()>"
EVIL = "\n\n".join(
    [
        r"$\text{<img/src=\"x\"/onerror=\"document.title='hit'\">}$",
        r"$\mbox{<script>document.title='hit'</script>}$",
        r"$\text{</mtext></math><svg/onload=\"document.title='hit'\">}$",
        r"$\href{javascript:document.title='hit'}{press}$",
        r"$\style{position:fixed;inset:0}{over}$",
        "![x](http://evil.invalid/t.png)",
        "Harmless.",
    ]
).replace(r"\"", '"')


@pytest.fixture
def home(tmp_path: Path) -> Path:
    text = LESSON.replace("Which one *waits*?", f"{EVIL}\n\nWhich").replace("Look around", TITLE)
    text = text.replace('text = "this"', f"text = '''{EVIL.splitlines()[0]}'''")
    write_lesson(tmp_path / "course", text, name=NAME)
    return tmp_path / "course"


@pytest.fixture
def course(home: Path, monkeypatch: pytest.MonkeyPatch) -> Course:
    """Read as if the reader refused nothing, so that the last barrier stands alone."""
    monkeypatch.setattr(formulas, "refused", lambda html: ())
    monkeypatch.setattr(formulas, "_converted", lambda text, display: convert(text))
    monkeypatch.setattr("onpath.lessons.prose._pictures", lambda children, home: ())
    monkeypatch.setattr("onpath.lessons.parse.text_faults", lambda text: ())
    course, problems = read_course([home])
    assert problems == []
    return course


@pytest.fixture
def tab(browser: Browser, course: Course) -> Iterator[Tab]:
    server = LabServer("127.0.0.1", 0, LoopCache(), ServerOptions(course=course))
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    yield Tab(server, context, draws=False)
    context.close()
    server.stop()


def test_nothing_runs_in_the_lab(tab: Tab) -> None:
    asked = list[str]()
    tab.page.on("request", lambda request: asked.append(request.url))
    for index in (0, 3):
        tab.ask(TakeStep(NAME, index))
        tab.page.get_by_text("Harmless." if index == 0 else "Which?").first.wait_for()
        assert tab.page.title() != "hit"
        assert tab.page.locator("math").count() > 0
        assert tab.page.locator(ALIVE).count() == 0
    assert not [address for address in asked if "evil" in address]
    assert tab.errors == []


def test_nothing_runs_on_an_exported_page(browser: Browser, home: Path, course: Course) -> None:
    write_site(home.parent / "site", course, home, ["en"])
    reader = SiteReader(browser, (home.parent / "site" / f"{NAME}.html").as_uri())
    reader.ready()
    assert reader.page.title() != "hit" and reader.page.locator("math").count() > 5
    assert reader.page.locator("script:not([src]):not([type*=json])").count() == 0
    assert reader.page.locator(ALIVE).count() == 0
    assert not [address for address in reader.requests if "evil" in address]
    assert reader.complaints == []
    reader.context.close()
