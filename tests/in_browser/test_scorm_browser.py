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
from tests.support.site_export import LESSON
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Frame, Page

RUNTIME = Path(__file__).parents[1] / "vendor" / "scorm-again"
WAIT = 90.0
MADE = {
    "1.2": ("scorm12.min.js", "API", "Scorm12API"),
    "2004": ("scorm2004.min.js", "API_1484_11", "Scorm2004API"),
}
STATUS = {"1.2": "cmi.core.lesson_status", "2004": "cmi.completion_status"}
SCORE = {"1.2": "cmi.core.score.raw", "2004": "cmi.score.scaled"}
FULL = {"1.2": 100, "2004": 1}
MOST = {"1.2": 4096, "2004": 64000}
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
        yield version, f"http://127.0.0.1:{server.server_port}/index.html"
        server.shutdown()


class Opened:
    """The package's page in the run-time, begun with what the platform has kept."""

    def __init__(self, browser: Browser, platform: tuple[str, str], kept: Any = None) -> None:
        self.version, address = platform
        self.page: Page = browser.new_page(viewport={"width": 1280, "height": 900})
        self.complaints = list[str]()
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(address)
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
        """Turn the page so often; a prediction that is skipped takes one press more."""
        for _ in range(steps):
            step = self.ask("site.index")
            while self.ask("site.index") == step:
                self.frame.locator("#next").click()

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
    first = float(opened.told(score))
    assert first > 0
    data = json.loads(opened.told("cmi.suspend_data"))
    assert data[f"notes.{LESSON}"]["seen"] == 4
    kept = opened.left()

    opened = Opened(browser, platform, kept)
    wait_for(lambda: opened.ask("site.index") == 3, WAIT)
    opened.forward(opened.ask("site.page.steps.length") - 3)
    assert float(opened.told(score)) > first
    assert opened.told(status) == "incomplete"  # a task is to be done
    opened.ask(  # as if all had been passed
        """site.page.steps.forEach(step => step.blocks.forEach(block => {
            if (block.kind === "task") site.notes.tasks[block.id] = 1
        }));
        site.save()"""
    )
    assert opened.told(status) == "completed"
    assert float(opened.told(score)) == FULL[version]
    kept = opened.left()

    opened = Opened(browser, platform, kept)
    assert opened.told(status) == "completed"  # it does not become incomplete again
    opened.left()


def test_what_the_platform_keeps_has_room(browser: Browser, platform: tuple[str, str]) -> None:
    """Long curves are left out of SCORM 1.2's 4,096 characters, answers are not."""
    opened = Opened(browser, platform)
    opened.ask(
        """const times = Array.from({length: 200}, (_, i) => i / 7)
        site.notes.truths["2"] = {times, tracker: times, follower: times}
        site.notes.answers["1"] = {option: 1, sure: "sure"}
        site.save()"""
    )
    text = opened.told("cmi.suspend_data")
    notes = json.loads(text)[f"notes.{LESSON}"]
    assert notes["answers"]["1"] == {"option": 1, "sure": "sure"}
    assert ("truths" in notes) == (platform[0] == "2004")
    assert len(text) <= MOST[platform[0]]
    opened.left()
