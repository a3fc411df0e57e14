"""A SCORM package in a run-time (scorm-again): progress, score and completion, also resumed."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZipFile

import pytest

from onpath.app.cli.main import run_command
from tests.support.scorm import DO_ALL, FULL, MADE, MOST, RUNTIME, SCORE, STATUS
from tests.support.site_export import LESSON
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Frame, Page

WAIT = 90.0
PROGRESS = {"1.2": None, "2004": "cmi.progress_measure"}
NOTICE = "document.querySelector('#notice').innerText"
HOST = """<!doctype html><script src="{script}"></script>
<iframe width="1200" height="800"></iframe>
<script>
window.opened = data => {{
    window.{name} = new {kind}({{autocommit: false, logLevel: 5}})
    if (data) window.{name}.loadFromJSON(data)
    document.querySelector("iframe").src = "package/{page}"
}}
window.api = () => window.{name}
window.kept = () => JSON.parse(JSON.stringify(window.{name}.cmi))
</script>"""
pytestmark = pytest.mark.thorough


@pytest.fixture(scope="module", params=["1.2", "2004"])
def platform(request: pytest.FixtureRequest, tmp_path_factory: Any) -> Iterator[tuple[str, str]]:
    """The version, and the address of a page with a run-time around the package's page."""
    version: str = request.param
    folder: Path = tmp_path_factory.mktemp("platform")
    file = folder / "lesson.zip"
    arguments = ["lesson", LESSON, "--scorm", str(file), "--version", version]
    assert run_command(["export", *arguments]) == 0
    ZipFile(file).extractall(folder / "package")
    script, name, kind = MADE[version]
    (folder / script).write_bytes((RUNTIME / script).read_bytes())
    host = HOST.format(script=script, name=name, kind=kind, page=f"{LESSON}.html")
    (folder / "index.html").write_text(host)
    handler = partial(SimpleHTTPRequestHandler, directory=str(folder))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever).start()
        yield version, f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


class Opened:
    """The package's page in the run-time, begun with what the platform has kept."""

    def __init__(
        self,
        browser: Browser,
        platform: tuple[str, str],
        kept: Any = None,
    ) -> None:
        self.version, address = platform
        self.page: Page = browser.new_page(viewport={"width": 1280, "height": 900})
        self.complaints = list[str]()
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(f"{address}/index.html")
        self.page.evaluate("data => opened(data)", kept)
        self.page.wait_for_function(
            "() => 'site' in document.querySelector('iframe').contentWindow", timeout=1e3 * WAIT
        )

    @property
    def frame(self) -> Frame:
        return self.page.frames[1]

    def ask(self, what: str) -> Any:
        return self.frame.evaluate(what)

    def told(self, name: str) -> str:
        """A value of the run-time, also after it has ended."""
        return self.page.evaluate(
            "name => name.split('.').slice(1).reduce((value, part) => value[part], api().cmi)", name
        )

    def forward(self, steps: int) -> None:
        """Turn the page so often; what is skipped takes one press more."""
        for _ in range(steps):
            step = self.ask("site.index")
            while self.ask("site.index") == step:
                self.frame.locator(".pager :is(#next, .without):visible").click()

    def left(self) -> Any:
        """What the platform keeps when the page is left."""
        self.page.evaluate("document.querySelector('iframe').src = 'about:blank'")
        wait_for(lambda: self.page.evaluate("api().isTerminated()"), WAIT)
        kept = self.page.evaluate("kept()")
        assert self.complaints == []
        self.page.close()
        return kept


def test_a_lesson_is_interrupted_resumed_and_completed(
    browser: Browser, platform: tuple[str, str]
) -> None:
    version = platform[0]
    status, score = STATUS[version], SCORE[version]
    opened = Opened(browser, platform)
    assert opened.told(status) == "incomplete"
    opened.forward(3)
    data = json.loads(opened.told("cmi.suspend_data"))
    assert data[f"notes.{LESSON}"]["seen"] == 4
    kept = opened.left()

    opened = Opened(browser, platform, kept)
    wait_for(lambda: opened.ask("site.index") == 3, WAIT)
    opened.forward(opened.ask("site.page.steps.length") - 3)
    assert opened.told(status) == "incomplete"  # Next was pressed, and nothing done
    assert opened.told(score) == ""
    assert len(opened.told("cmi.suspend_data")) < 1000
    if name := PROGRESS[version]:
        assert 0.3 < float(opened.told(name)) < 0.9
    opened.ask(DO_ALL)
    assert opened.told(status) == "completed"
    assert float(opened.told(score)) == FULL[version]
    assert opened.ask(NOTICE) == ""
    kept = opened.left()

    opened = Opened(browser, platform, kept)
    assert opened.told(status) == "completed"  # it does not become incomplete again
    opened.left()


@pytest.mark.parametrize("platform", ["1.2"], indirect=True)
def test_a_drawn_curve_is_kept_beside_long_reasons(
    browser: Browser, platform: tuple[str, str]
) -> None:
    """In SCORM 1.2's 4,096 characters; the curve of a run is computed again."""
    opened = Opened(browser, platform)
    opened.ask(
        """const times = Array.from({length: 147}, (_, i) => i / 20)
        const values = times.map(time => 40 * Math.abs(Math.sin(1.5 * time)))
        site.notes.played["2"] = true
        const give = (step, answer) => site.notes.given.push({item: String(step), answer})
        give(1, {times, values, why: "a".repeat(999)})
        for (const step of [4, 7]) give(step, {option: 1, why: "b".repeat(999)})
        site.student.save()"""
    )
    assert len(opened.told("cmi.suspend_data")) <= MOST[platform[0]]
    assert opened.ask(NOTICE) == ""
    opened = Opened(browser, platform, opened.left())
    for step in (1, 2, opened.ask("site.page.steps.length")):
        opened.ask(f"site.open({step})")
        shown = opened.frame.locator(".step.open")
        wait_for(
            lambda shown=shown: shown.locator(
                ":is(.beneath, .compared) .plot canvas"
            ).first.is_visible(),
            WAIT,
        )
        assert not shown.get_by_text("You skipped the prediction").first.is_visible()
    wait_for(lambda: opened.ask("'1' in site.notes.truths"), WAIT)
    assert max(opened.ask("site.notes.truths[1].tracker")) > 40
    again = opened.frame.get_by_text("let it happen again to see them")
    assert not any(each.is_visible() for each in again.all())
    drawn = opened.ask("site.notes.given.find(each => each.item === '1').answer.values")
    assert len(drawn) >= 20 and max(drawn) == pytest.approx(40, abs=0.1)
    opened.left()


@pytest.mark.parametrize("platform", ["2004"], indirect=True)
def test_a_skipped_prediction_can_still_be_made(
    browser: Browser, platform: tuple[str, str]
) -> None:
    opened = Opened(browser, platform)
    frame = opened.frame
    opened.ask("site.open(4)")
    frame.get_by_role("button", name="Skip the prediction").click()
    opened.ask("site.open(4)")
    assert frame.get_by_text("You can still make it here").is_visible()
    opened.ask("site.open(4)")
    frame.get_by_role("radio", name="As far as before").check()
    frame.locator(".step.open .lead").click()
    assert "option" in opened.ask("site.notes.given.findLast(each => each.item === '4').answer")
    assert frame.get_by_role("radio", name="As far as before").is_disabled()
    opened.left()


@pytest.mark.parametrize("platform", ["2004"], indirect=True)
def test_without_a_platform_the_page_says_where_progress_is(
    browser: Browser, platform: tuple[str, str]
) -> None:
    page = browser.new_page()
    page.goto(f"{platform[1]}/package/{LESSON}.html")
    wait_for(lambda: "No learning platform" in page.evaluate(NOTICE), WAIT)
    page.close()
