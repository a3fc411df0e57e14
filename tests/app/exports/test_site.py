"""The static site as files: readable without scripts, and strict about what may run."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from onpath.app.cli.main import run_command
from onpath.app.exports.site.pages import MESSAGES, POLICY
from onpath.app.exports.site.step_figures import figure_of, step_figure
from onpath.app.exports.site.task_data import MESSAGES as CHECKS
from onpath.app.server.built_in_course import built_in_course
from onpath.app.steps.player_words import player_words
from onpath.app.view.page_words import words_message
from onpath.assets import asset_path
from onpath.lessons.course import BUILT_IN, REFERENCE, read_references
from onpath.lessons.lecture import LECTURE
from onpath.lessons.schema import Text
from onpath.lessons.words import ENGLISH
from onpath.models.systems.catalogue import ROBOTS
from onpath.models.systems.flexible_robot import BENT
from tests.support.concept_key import asked_in, found_in, key_of
from tests.support.site_export import LESSON, exported_site

pytestmark = pytest.mark.thorough

FIGURE = 600_000  # [B]
EVENTS = re.compile(r"^on[a-z]+$")


class Seen(HTMLParser):
    """What a browser without scripts sees of a page, and what it loads."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.text, self.loaded, self.inline, self.tags = "", list[str](), list[str](), list[str]()
        self.alts = list[str]()
        self._hidden = 0
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        own = dict(attrs)
        self.loaded += [v for n, v in attrs if n in ("src", "href") and v]
        self.inline += [n for n in own if n == "style" or EVENTS.match(n)]
        if tag == "img":
            self.alts.append(own.get("alt") or "")
        if tag in ("script", "style"):
            self._hidden += 1
            if own.get("type") != "application/json" and "src" not in own:
                self.inline.append(tag)

    def handle_endtag(self, tag: str) -> None:
        self._hidden -= tag in ("script", "style")

    def handle_data(self, data: str) -> None:
        if not self._hidden:
            self.text += data


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return exported_site(tmp_path_factory.mktemp("site"), lessons=(LESSON, LECTURE))


def test_the_concept_test_is_not_in_it(site: Path) -> None:
    for language in ("en", "de"):
        forms = built_in_course().forms(language)
        for file in filter(Path.is_file, site.rglob("*")):
            text = file.read_bytes().decode("utf-8", "replace")
            assert found_in([*key_of(forms), *asked_in(forms)], text) == [], file


@pytest.mark.parametrize("language", ["en", "de"])
def test_without_scripts_all_of_a_lesson_is_there(site: Path, language: str) -> None:
    name = f"{LESSON}.html" if language == "en" else f"{LESSON}.{language}.html"
    seen = Seen((site / name).read_text("utf-8"))
    lesson = built_in_course().lesson(LESSON, language)
    words = " ".join(seen.text.split())
    for step in lesson.steps:
        for block in step.blocks:
            for html in (
                [block.html]
                if isinstance(block, Text)
                else [getattr(block, n, "") for n in ("question", "text", "passed")]
                + [o.answer for o in getattr(block, "options", ())]
                + list(getattr(block, "hints", ()))
            ):
                assert " ".join(Seen(str(html)).text.split()) in words
    assert seen.tags.count("math") > 10
    runs = [step for step in lesson.steps if step.script]
    pictures = list((site / "site" / "pictures").glob(f"{LESSON}-*-{language}.svg"))
    assert len(pictures) == len(runs) and all(seen.alts)
    assert sum(" 47" in alt or "46.9" in alt for alt in seen.alts) == 1  # the arches


@pytest.mark.parametrize(("language", "name"), [("en", "lecture.html"), ("de", "lecture.de.html")])
def test_the_lecture_has_notes_and_is_linked(site: Path, language: str, name: str) -> None:
    start = "index.html" if language == "en" else f"index.{language}.html"
    assert name in Seen((site / start).read_text("utf-8")).loaded
    words = " ".join(Seen((site / name).read_text("utf-8")).text.split())
    for step in built_in_course().lecture[language].steps:
        assert " ".join(Seen(str(step.notes)).text.split()) in words


def test_nothing_of_a_page_is_inline_or_from_elsewhere(site: Path) -> None:
    for page in site.glob("*.html"):
        seen = Seen(page.read_text("utf-8"))
        assert seen.inline == []
        for address in seen.loaded:
            if address.startswith(("https://", "data:image/", "#")):
                continue  # a reader follows it; a picture in a lesson's text; in the page
            assert (site / address.partition("#")[0]).is_file(), address
        assert POLICY.replace("'", "&#39;") in page.read_text("utf-8")
    assert "unsafe-eval" not in POLICY.replace("wasm-unsafe-eval", "")


def test_pages_say_what_they_are(site: Path) -> None:
    found = set[str]()
    for page in site.glob("*.html"):
        text = page.read_text("utf-8")
        (said,) = re.findall(r'<meta name="description" content="([^"<]{20,})">', text)
        assert "icon.svg" in text and text.count("<main") == text.count("<h1") == 1
        found.add(said)
    assert len(found) == len([*site.glob("*.html")])


def test_figures_share_their_kernels(site: Path) -> None:
    kernels = list((site / "site" / "kernels").iterdir())
    # the free lab's; that of the lesson's steps, in two languages; two more of the lecture: its
    # steps with a path to bend, and with a flexible link
    assert len(kernels) == 4


def test_each_figure_of_a_site_is_small(site: Path) -> None:
    """What a figure adds to the script that all share: its numbers, and its kernels."""
    found = 0
    for page in site.glob("*.html"):
        (text,) = re.findall(r'id="data">(.*?)</script>', page.read_text("utf-8"), re.DOTALL)
        for figure in json.loads(text)["figures"]:
            kernels = site / "site" / "kernels" / f"{figure['module']}.js"
            assert len(json.dumps(figure)) + kernels.stat().st_size < FIGURE, page.name
            found += 1
    assert found >= 20 and (site / "site" / "site.js").stat().st_size < FIGURE


PAGES = asset_path("web") / "pages"


def test_all_that_the_scripts_say_is_in_the_pages() -> None:
    site = _reached(PAGES / "figure.ts", PAGES / "player.ts", PAGES / "start.ts")
    only_lab = _reached(PAGES / "lab.ts") - site
    given = {*MESSAGES, *CHECKS, *player_words(ENGLISH), "lesson.step", "site.done", "point"}
    asked = _asked(site)
    assert len(asked) > 15 and asked <= given | {"site.refused", "site.cut"}
    told = json.loads(words_message(ENGLISH.language))["words"]
    assert len(_asked(only_lab)) > 2 and _asked(only_lab) <= {*told}


def _reached(*files: Path) -> set[Path]:
    """The scripts that some need, those that they need, and so on."""
    found, left = set[Path](), list(files)
    while left:
        file = left.pop().resolve()
        if file not in found:
            found.add(file)
            names = re.findall(r' from "(\.[^"]+)"', file.read_text("utf-8"))
            left += [file.parent / f"{name}.ts" for name in names]
    return found


def _asked(files: set[Path]) -> set[str]:
    says = re.compile(r"(phrase|tell)\(")
    lines = [line for file in files for line in file.read_text("utf-8").splitlines()]
    return {key for line in lines if says.search(line) for key in _keys(line)}


def _keys(line: str) -> list[str]:
    return re.findall(r'"((?:lesson|site|report|answer|check)\.[a-z_]+)"', line)


def test_a_task_is_offered_if_its_solution_can_be_done_here() -> None:
    course, offered = built_in_course(), dict[str, bool]()
    for name in course.lessons:
        lesson = course.lesson(name, "en")
        references, _ = read_references(lesson, BUILT_IN / name / REFERENCE)
        for i, step in enumerate(lesson.steps):
            texts = [block for block in step.blocks if isinstance(block, Text)]
            links = [act for text in texts for link in text.links for act in link.actions]
            for task in step.tasks():
                can_pass = step_figure(lesson, i).can_pass(task, references[task.id], links)
                offered[task.id] = can_pass
    assert len(offered) == 34
    assert {name for name, can_pass in offered.items() if not can_pass} == {
        *("excite", "excite-well"),  # identification
    }


def test_a_bent_link_is_not_called_stable_where_its_output_changes() -> None:
    lesson = built_in_course().lesson("07-flexible-link", "en")
    either, flexible = ENGLISH("stop.bent_or_unstable"), ROBOTS["flexible"]
    reasons = flexible.make(flexible.parameters()).reasons(None, flexible.parameters())
    assert [ENGLISH.sentence(reason) for reason in reasons].count(either) == 1
    said = {
        i: figure_of(step_figure(lesson, i), ENGLISH)["laws"][1]["stops"]
        for i, step in enumerate(lesson.steps)
        if step.script and any("alpha" in (action.set or {}) for action in step.script.do)
    }
    assert said and all(either in stops for stops in said.values())
    first = figure_of(step_figure(lesson, 2), ENGLISH)["laws"][1]["stops"]
    assert ENGLISH.sentence(BENT) in first


def test_a_folder_with_something_else_in_it_is_left_alone(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "diary.txt").write_text("dear diary")
    assert run_command(["export", "site", str(tmp_path / "mine")]) == 2
    assert "not empty" in capsys.readouterr().err
    assert [file.name for file in (tmp_path / "mine").iterdir()] == ["diary.txt"]
    assert run_command(["export", "site", str(tmp_path / "a" / "b")]) == 2
    assert run_command(["export", "site", str(tmp_path / "c"), "--language", "xx"]) == 2
