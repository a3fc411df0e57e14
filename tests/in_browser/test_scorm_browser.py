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
PROGRESS = {"1.2": None, "2004": "cmi.progress_measure"}
STATUS = {"1.2": "cmi.core.lesson_status", "2004": "cmi.completion_status"}
SCORE = {"1.2": "cmi.core.score.raw", "2004": "cmi.score.scaled"}
FULL = {"1.2": 100, "2004": 1}
MODE = {"1.2": "lesson_mode", "2004": "mode"}
DO_ALL = """site.page.steps.forEach((step, i) => {
    site.notes.seen = i + 1
    if (step.script) site.notes.played[i] = true
    step.blocks.forEach((block, j) => {
        if (block.kind === "task") site.notes.tasks[block.id] = 1
        if (block.kind === "quiz") site.notes.quiz[`${i}.${j}`] = block.right
        if (block.kind === "choice") site.notes.answers[i] = {option: 0}
        if (block.kind === "sketch") site.notes.answers[i] = {times: [0, 1], values: [0, 1]}
    })
}); site.student.save()"""
"""As if all had been done, and all of it right."""
JUDGED = """site.page.steps.flatMap((step, i) => step.optional ? [] : step.blocks.flatMap(
    (block, j) => ["quiz", "task"].includes(block.kind) ? [[i, j, block.right ?? null]] : []))"""
"""Step and place of what is judged, and the right option of a quiz."""
TASK = """site.page.steps.flatMap(step => step.optional ? [] : step.blocks)
    .find(block => block.kind === "task" && block.checks).id"""
NOTICE = "document.querySelector('#notice').innerText"
LEFT_AND_BACK = """["pagehide", "pageshow"].forEach(
    kind => dispatchEvent(new PageTransitionEvent(kind, {persisted: true})))"""
"""As a browser tells of a page that it keeps, and shows again."""
PLATFORM = """<!doctype html><iframe width="1200" height="800"></iframe>
<script>
window.opened = refuses => {{
    const told = window.told = []
    const values = {{}}
    const answer = (verb, name, value) => {{
        told.push([verb, name, value])
        const refused = refuses.some(each => (name + " " + verb).includes(each))
        if (refused) return "false"
        if (verb === "GetLastError") return "391"
        if (verb === "GetErrorString") return "Disk full"
        if (verb === "SetValue") values[name] = value
        return verb === "GetValue" ? values[name] ?? "" : "true"
    }}
    const verbs = ["Initialize", "Finish", "Terminate", "GetValue", "SetValue", "Commit"]
    window.{name} = Object.fromEntries([...verbs, "GetLastError", "GetErrorString"].map(
        verb => ["{verb}" + verb, (name = "", value) => answer(verb, name, value)]))
    document.querySelector("iframe").src = "package/{page}"
}}
</script>"""
"""A platform of few words, which refuses some of what it is told."""
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
    arguments = ["lesson", LESSON, "--scorm", str(file), "--version", version, "--partial-score"]
    assert run_command(["export", *arguments]) == 0
    ZipFile(file).extractall(folder / "package")
    script, name, kind = MADE[version]
    (folder / script).write_bytes((RUNTIME / script).read_bytes())
    host = HOST.format(script=script, name=name, kind=kind, page=f"{LESSON}.html")
    (folder / "index.html").write_text(host)
    verb = "LMS" if version == "1.2" else ""
    page = folder / "package" / f"{LESSON}.html"
    (page.parent / "partial.html").write_text(page.read_text())
    wanted, usual = (f'"version":"{version}","partial":{each}' for each in ("true", "false"))
    assert wanted in page.read_text()
    page.write_text(page.read_text().replace(wanted, usual))
    for file, own in (("plain.html", page.name), ("partial.html", "partial.html")):
        (folder / file).write_text(PLATFORM.format(name=name, verb=verb, page=own))
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
        host: str = "index.html",
    ) -> None:
        self.version, address = platform
        self.page: Page = browser.new_page(viewport={"width": 1280, "height": 900})
        self.complaints = list[str]()
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(f"{address}/{host}")
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


@pytest.mark.parametrize("partial", [False, True])
def test_a_score_is_sent_when_something_was_judged_and_the_teacher_wants_it(
    browser: Browser, platform: tuple[str, str], partial: bool
) -> None:
    """By default, only for a finished lesson; never for looking at it."""
    opened = Opened(browser, platform, [], "partial.html" if partial else "plain.html")

    def scores() -> list[str]:
        told = opened.page.evaluate("told")
        return [each[2] for each in told if each[0] == "SetValue" and each[1].endswith("score.raw")]

    opened.forward(opened.ask("site.page.steps.length"))
    assert scores() == []
    judged = opened.ask(JUDGED)
    opened.ask(f"site.student.pass({TASK}, 1)")
    assert scores() == ([str(round(100 / len(judged)))] if partial else [])
    opened.ask(DO_ALL)
    assert scores()[-1] == "100"
    opened.page.close()


def test_the_first_answer_to_a_quiz_counts(browser: Browser, platform: tuple[str, str]) -> None:
    """After it, the page shows the right one."""
    opened = Opened(browser, platform)
    judged = opened.ask(JUDGED)
    step, place, right = next(each for each in judged if each[2] is not None)
    opened.ask(f"site.open({step})")
    question = opened.frame.locator(f".step.open [data-block='{place}']")
    for option in (1 - min(right, 1), right):
        question.locator(f"input[value='{option}']").check()
        question.get_by_role("button").click()
    assert question.get_by_text("Right.").is_visible()
    opened.ask(DO_ALL)
    share = 1 - 1 / len(judged)
    assert float(opened.told(SCORE[platform[0]])) == share * FULL[platform[0]]
    assert opened.told(STATUS[platform[0]]) == "completed"
    opened.left()


def test_what_is_passed_remains_so(browser: Browser, platform: tuple[str, str]) -> None:
    """The platform judges by its own rule; and a score that it has is not made less."""
    version = platform[0]
    status, raw = STATUS[version], "cmi.core.score.raw" if version == "1.2" else "cmi.score.raw"
    for verdict in ("passed", "failed") if version == "1.2" else ("completed",):
        kept: Any = {"completion_status": verdict, "score": {"raw": "70"}}
        if version == "1.2":
            kept = {"core": {"lesson_status": verdict, "score": {"raw": "70"}}}
        opened = Opened(browser, platform, kept)
        opened.forward(2)
        assert opened.told(status) == verdict and float(opened.told(raw)) == 70
        opened.ask(DO_ALL)
        assert float(opened.told(raw)) == 100
        assert opened.told(status) == ("passed" if verdict == "passed" else "completed")
        opened.left()


@pytest.mark.parametrize("way", ["review", "browse", "no-credit"])
def test_a_visit_without_credit_changes_no_result(
    browser: Browser, platform: tuple[str, str], way: str
) -> None:
    version = platform[0]
    own = {"credit": way} if way == "no-credit" else {MODE[version]: way}
    opened = Opened(browser, platform, {"core": own} if version == "1.2" else own)
    before = opened.told(STATUS[version])
    opened.ask(DO_ALL)
    assert opened.told(STATUS[version]) == before != "completed"
    assert opened.told(SCORE[version]) == ""
    assert (opened.told("cmi.suspend_data") == "") == (way != "no-credit")
    assert ("nothing of what you do now is kept" in opened.ask(NOTICE)) == (way != "no-credit")
    opened.left()


def test_a_drawn_curve_is_kept_beside_long_reasons(
    browser: Browser, platform: tuple[str, str]
) -> None:
    """In SCORM 1.2's 4,096 characters; the curve of a run is computed again."""
    opened = Opened(browser, platform)
    opened.ask(
        """const times = Array.from({length: 147}, (_, i) => i / 20)
        const values = times.map(time => 40 * Math.abs(Math.sin(1.5 * time)))
        site.notes.played["2"] = true
        site.notes.answers["1"] = {times, values, why: "a".repeat(999)}
        for (const step of [4, 7]) site.notes.answers[step] = {option: 1, why: "b".repeat(999)}
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
    drawn = opened.ask("site.notes.answers[1].values")
    assert len(drawn) >= 20 and max(drawn) == pytest.approx(40, abs=0.1)
    opened.left()


def test_texts_that_are_cut_are_told(browser: Browser, platform: tuple[str, str]) -> None:
    opened = Opened(browser, platform)
    opened.ask(
        """for (const step of [1, 4, 7, 8, 9, 10])
            site.notes.answers[step] = {option: 0, why: "because ".repeat(124)}
        site.student.save(); site.student.save()"""
    )
    assert opened.ask(NOTICE).count("your longest texts") == (platform[0] == "1.2")
    assert len(opened.ask("site.notes.answers[1].why")) == 992  # in the page, they are whole
    opened.left()


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
    frame.locator(".step.open .commit").click()
    assert "option" in opened.ask("site.notes.answers[4]")
    assert frame.get_by_role("radio", name="As far as before").is_disabled()
    opened.left()


@pytest.mark.parametrize("refused", ["Initialize", "suspend_data SetValue", "Commit"])
def test_what_the_platform_refuses_is_said_once(
    browser: Browser, platform: tuple[str, str], refused: str
) -> None:
    opened = Opened(browser, platform, [refused], "plain.html")
    opened.forward(2)
    assert opened.ask(NOTICE).count("did not take your progress: Disk full (391)") == 1
    if refused == "Initialize":
        asked = {verb for verb, *_ in opened.page.evaluate("told")}
        assert asked == {"Initialize", "GetLastError", "GetErrorString"}
    assert opened.complaints == []
    opened.page.close()


def test_a_platform_need_not_know_the_bounds_of_a_score(
    browser: Browser, platform: tuple[str, str]
) -> None:
    opened = Opened(browser, platform, ["score.min", "score.max"], "plain.html")
    opened.forward(2)
    assert opened.ask(NOTICE) == "" and opened.complaints == []
    opened.page.close()


def test_a_page_that_comes_back_begins_a_new_session(
    browser: Browser, platform: tuple[str, str]
) -> None:
    """Or says that the platform gives it none, as scorm-again."""
    opened = Opened(browser, platform, [], "plain.html")
    opened.ask(LEFT_AND_BACK)
    opened.page.evaluate("told.length = 0")
    opened.forward(1)
    names = [name for verb, name, _ in opened.page.evaluate("told") if verb == "SetValue"]
    assert "cmi.suspend_data" in names and opened.ask(NOTICE) == ""
    opened.page.close()

    opened = Opened(browser, platform)
    opened.ask(LEFT_AND_BACK)
    assert "did not take your progress" in opened.ask(NOTICE)
    opened.forward(1)
    assert opened.complaints == []
    opened.page.close()


def test_without_a_platform_the_page_says_where_progress_is(
    browser: Browser, platform: tuple[str, str]
) -> None:
    page = browser.new_page()
    page.goto(f"{platform[1]}/package/{LESSON}.html")
    wait_for(lambda: "No learning platform" in page.evaluate(NOTICE), WAIT)
    page.close()
