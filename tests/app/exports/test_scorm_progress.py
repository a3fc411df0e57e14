"""What a package's page tells a learning platform (scorm-again): progress, score and completion."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any
from zipfile import ZipFile

import numpy as np
import pytest

from onpath.app.cli.main import run_command
from tests.support.node_page import NodePage, needs_node
from tests.support.scorm import DO_ALL, FULL, JUDGED, MADE, MOST, RUNTIME, SCORE, STATUS
from tests.support.site_export import LESSON
from tests.support.waiting import wait_for

pytestmark = [pytest.mark.thorough, needs_node]
WAIT = 60.0  # [s]
MODE = {"1.2": "lesson_mode", "2004": "mode"}
TASK = """site.page.steps.flatMap(step => step.optional ? [] : step.blocks)
    .find(block => block.kind === "task" && block.checks).id"""
NOTICE = "document.querySelector('#notice').textContent"
LEFT_AND_BACK = """["pagehide", "pageshow"].forEach(
    kind => dispatchEvent(Object.assign(new Event(kind), {persisted: true})))"""
"""As a browser tells of a page that it keeps, and shows again."""
PLATFORM = """({refuses, verb, name}) => {
    const told = globalThis.told = []
    const values = {}
    const answer = (does, what, value) => {
        told.push([does, what, value])
        if (refuses.some(each => (what + " " + does).includes(each))) return "false"
        if (does === "GetLastError") return "391"
        if (does === "GetErrorString") return "Disk full"
        if (does === "SetValue") values[what] = value
        return does === "GetValue" ? values[what] ?? "" : "true"
    }
    const verbs = ["Initialize", "Finish", "Terminate", "GetValue", "SetValue", "Commit"]
    globalThis[name] = Object.fromEntries([...verbs, "GetLastError", "GetErrorString"].map(
        each => [verb + each, (what = "", value) => answer(each, what, value)]))
}"""
"""A platform of few words, which refuses some of what it is told."""
RUN_TIME = """({kept, name, kind}) => {
    globalThis[name] = new globalThis[kind]({autocommit: false, logLevel: 5})
    if (kept) globalThis[name].loadFromJSON(kept)
    globalThis.api = () => globalThis[name]
}"""
FORWARD = """steps => {
    for (const end = site.index + steps; site.index < end;) document.querySelector("#next").click()
}"""
"""Turns the page so often; a prediction that is skipped takes one press more."""


@pytest.fixture(scope="module", params=["1.2", "2004"])
def version(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def package(version: str, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The page of a package, with its scripts."""
    folder: Path = tmp_path_factory.mktemp("package")
    file = folder / "lesson.zip"
    arguments = ["lesson", LESSON, "--scorm", str(file), "--version", version, "--partial-score"]
    assert run_command(["export", *arguments]) == 0
    ZipFile(file).extractall(folder)
    text = (folder / f"{LESSON}.html").read_text("utf-8")
    return re.sub(
        r'<script[^>]*src="([^"]+)"[^>]*></script>',
        lambda found: f"<script>{(folder / found[1]).read_text('utf-8')}</script>",
        text,
    )


class Opened:
    """The package's page in a run-time, begun with what the platform has kept.

    Args:
        refuses: what a platform of few words refuses; None: the run-time is scorm-again.
        partial: whether the teacher wants the score of an unfinished lesson.
    """

    def __init__(
        self,
        version: str,
        package: str,
        kept: Any = None,
        refuses: list[str] | None = None,
        partial: bool = False,
    ) -> None:
        self.page, self._version = NodePage(), version
        script, name, kind = MADE[version]
        if refuses is None:
            run_time = (RUNTIME / script).read_text("utf-8")
            self.page.set_content(f"<script>{run_time}</script>")
            self.page.evaluate(RUN_TIME, {"kept": kept, "name": name, "kind": kind})
        else:
            verb = "LMS" if version == "1.2" else ""
            self.page.evaluate(PLATFORM, {"refuses": refuses, "verb": verb, "name": name})
        wanted, usual = (f'"version":"{version}","partial":{each}' for each in ("true", "false"))
        assert wanted in package
        self.page.set_content(package if partial else package.replace(wanted, usual))
        wait_for(lambda: self.ask("'site' in globalThis"), WAIT)

    def ask(self, what: str) -> Any:
        return self.page.evaluate(what)

    def told(self, name: str) -> str:
        """A value of the run-time, also after it has ended."""
        return self.page.evaluate(
            "name => name.split('.').slice(1).reduce((value, part) => value[part], api().cmi)", name
        )

    def notice(self) -> str:
        return self.ask(NOTICE)

    def forward(self, steps: int) -> None:
        self.page.evaluate(FORWARD, steps)

    def left(self) -> Any:
        """What the platform keeps when the page is left."""
        self.ask("dispatchEvent(new Event('pagehide'))")
        wait_for(lambda: self.ask("api().isTerminated()"), WAIT)
        kept = self.ask("JSON.parse(JSON.stringify(api().cmi))")
        self.close()
        return kept

    def close(self) -> None:
        assert self.ask("complaints") == []
        self.page.close()


@contextmanager
def opened(*given: Any, **more: Any) -> Iterator[Opened]:
    """A page that is left in the end."""
    page = Opened(*given, **more)
    yield page
    page.close()


@pytest.mark.parametrize("partial", [False, True])
def test_a_score_is_sent_when_something_was_judged_and_the_teacher_wants_it(
    version: str, package: str, partial: bool
) -> None:
    """By default, only for a finished lesson; never for looking at it."""
    with opened(version, package, refuses=[], partial=partial) as page:

        def scores() -> list[str]:
            told = page.ask("told")
            return [e[2] for e in told if e[0] == "SetValue" and e[1].endswith("score.raw")]

        page.forward(page.ask("site.page.steps.length"))
        assert scores() == []
        judged = page.ask(JUDGED)
        page.ask(f"site.student.pass({TASK}, 1)")
        assert scores() == ([str(round(100 / len(judged)))] if partial else [])
        page.ask(DO_ALL)
        assert scores()[-1] == "100"


def test_a_right_second_answer_to_a_quiz_counts_half_and_the_platform_is_told_both(
    version: str, package: str
) -> None:
    """After it, the page shows the right one."""
    page = Opened(version, package)
    judged = page.ask(JUDGED)
    step, place, right = next(each for each in judged if each[2] is not None)
    page.ask(f"site.open({step})")
    for option in (1 - min(right, 1), right):
        page.ask(
            f"""() => {{
                const question = document.querySelector(".step.open [data-block='{place}']")
                for (const each of question.querySelectorAll("input"))
                    each.checked = each.value === "{option}"
                question.querySelector("button").click()
            }}"""
        )
    given = page.ask("site.notes.given")
    assert [(e["item"], e["attempt"], e["right"]) for e in given] == [
        (f"{step}.{place}", 1, False),
        (f"{step}.{place}", 2, True),
    ]
    page.ask(DO_ALL)
    percent = np.floor(100 * (1 - 0.5 / len(judged)) + 0.5)
    assert float(page.told(SCORE[version])) == percent / 100 * FULL[version]
    assert page.told(STATUS[version]) == "completed"
    told = [(e["id"], e["result"]) for e in page.left()["interactions"].values()]
    wrong = "wrong" if version == "1.2" else "incorrect"
    ids = [f"{LESSON}.{step}.{place}.{attempt}" for attempt in (1, 2)]
    assert told == [(ids[0], wrong), (ids[1], "correct")]


def test_what_is_passed_remains_so(version: str, package: str) -> None:
    """The platform judges by its own rule; and a score that it has is not made less."""
    status, raw = STATUS[version], "cmi.core.score.raw" if version == "1.2" else "cmi.score.raw"
    for verdict in ("passed", "failed") if version == "1.2" else ("completed",):
        kept: Any = {"completion_status": verdict, "score": {"raw": "70"}}
        if version == "1.2":
            kept = {"core": {"lesson_status": verdict, "score": {"raw": "70"}}}
        page = Opened(version, package, kept)
        page.forward(2)
        assert page.told(status) == verdict and float(page.told(raw)) == 70
        page.ask(DO_ALL)
        assert float(page.told(raw)) == 100
        assert page.told(status) == ("passed" if verdict == "passed" else "completed")
        page.left()


@pytest.mark.parametrize("way", ["review", "browse", "no-credit"])
def test_a_visit_without_credit_changes_no_result(version: str, package: str, way: str) -> None:
    own = {"credit": way} if way == "no-credit" else {MODE[version]: way}
    page = Opened(version, package, {"core": own} if version == "1.2" else own)
    before = page.told(STATUS[version])
    page.ask(DO_ALL)
    assert page.told(STATUS[version]) == before != "completed"
    assert page.told(SCORE[version]) == ""
    assert (page.told("cmi.suspend_data") == "") == (way != "no-credit")
    assert ("nothing of what you do now is kept" in page.notice()) == (way != "no-credit")
    page.left()


def test_texts_that_are_cut_are_told(version: str, package: str) -> None:
    page = Opened(version, package)
    page.ask(
        """() => {
            for (const step of [1, 4, 7, 8, 9, 10])
                site.notes.given.push({
                    item: String(step), answer: {option: 0, why: "because ".repeat(124)},
                })
            site.student.save()
            site.student.save()
        }"""
    )
    assert page.notice().count("your longest texts") == (version == "1.2")
    assert len(page.ask("site.notes.given[0].answer.why")) == 992  # in the page, they are whole
    assert len(page.told("cmi.suspend_data")) <= MOST[version]
    page.left()


@pytest.mark.parametrize("refused", ["Initialize", "suspend_data SetValue", "Commit"])
def test_what_the_platform_refuses_is_said_once(version: str, package: str, refused: str) -> None:
    with opened(version, package, refuses=[refused]) as page:
        page.forward(2)
        assert page.notice().count("did not take your progress: Disk full (391)") == 1
        if refused == "Initialize":
            asked = {verb for verb, *_ in page.ask("told")}
            assert asked == {"Initialize", "GetLastError", "GetErrorString"}


def test_a_platform_need_not_know_the_bounds_of_a_score(version: str, package: str) -> None:
    with opened(version, package, refuses=["score.min", "score.max"]) as page:
        page.forward(2)
        assert page.notice() == ""


def test_a_page_that_comes_back_begins_a_new_session(version: str, package: str) -> None:
    """Or says that the platform gives it none, as scorm-again."""
    with opened(version, package, refuses=[]) as page:
        page.ask(LEFT_AND_BACK)
        page.ask("told.length = 0")
        page.forward(1)
        names = [name for verb, name, _ in page.ask("told") if verb == "SetValue"]
        assert "cmi.suspend_data" in names and page.notice() == ""
    with opened(version, package) as page:
        page.ask(LEFT_AND_BACK)
        assert "did not take your progress" in page.notice()
        page.forward(1)


def test_progress_is_short_and_comes_back(version: str, package: str) -> None:
    page = Opened(version, package)
    assert page.told(STATUS[version]) == "incomplete"
    page.forward(3)
    assert json.loads(page.told("cmi.suspend_data"))[f"notes.{LESSON}"]["seen"] == 4
    assert len(page.told("cmi.suspend_data")) < 1000
    kept = page.left()
    page = Opened(version, package, kept)
    wait_for(lambda: page.ask("site.index") == 3, WAIT)
    page.left()
