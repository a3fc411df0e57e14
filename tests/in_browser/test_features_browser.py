"""The list of what pages without a server have: what it names is there, what it denies is not."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pytest

import onpath
from onpath.lessons.words import ENGLISH
from onpath.models.closed_loop.lab_settings import SETTINGS
from onpath.models.control.laws.own import LABEL
from onpath.models.control.settable import specs
from onpath.models.systems.parameters import Parameters
from tests.support.checkout import ROOT
from tests.support.site_export import LESSON, exported_site
from tests.support.site_reader import WAIT, SiteReader
from tests.support.waiting import wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.thorough
LIST = ROOT / "app" / "exports" / "standalone" / "README.md"
FIGURE, LESSONS, FREE, LAB = "exported figure", "site: lessons", "site: free lab", "lab"
NOT = ("no", "-", "fixed")
"""How a cell begins that denies something."""
OF_STEPS = "those of the step", "in steps"
"""How a cell begins of what steps have that ask for it; test_site_whole compares each of them."""
OWN = "across = -K1*xi - K2*dxi; along = 9*(2 - dtheta)"

NAMED = "button, a, summary, label, input, option, h2, legend, canvas, [role=slider]"
SEEN = """([scope, marks, named]) => {
    const shown = each => each.checkVisibility() && !each.matches(":empty:not(canvas, input)")
    const all = [...document.querySelectorAll(scope)]
    const within = marks => all.flatMap(each => [...each.querySelectorAll(marks)]).filter(shown)
    const name = each => `${each.innerText} ${each.ariaLabel ?? ""} ${each.title ?? ""}`
    return [marks.filter(each => within(each).length), within(named).map(name)]
}"""


@dataclass(frozen=True)
class Row:
    """How one sees whether a page has what a row of the list tells.

    Attributes:
        marks: CSS selectors of what is shown.
        said: keys of what the controls are called, there or in the lab.
        names: what else they are called.
    """

    marks: tuple[str, ...] = ()
    said: tuple[str, ...] = ()
    names: tuple[str, ...] = ()

    @property
    def every_name(self) -> tuple[str, ...]:
        return (*map(ENGLISH, self.said), *self.names)


def _labels(*parameters: str) -> tuple[str, ...]:
    return tuple(specs(Parameters)[name].label for name in parameters)


PARTS = ("run.hold_both", "run.pause", "run.step", "run.reset")
ROWS = {
    "robots, laws, paths, parameters": Row((".robot canvas", ".title")),
    "hold back along the path, pull, pause, step, reset": Row(said=PARTS),
    "hold across the path": Row(names=(SETTINGS["hold_direction"].spec.label,)),
    "speed, gains, and other numbers of the loop's settings": Row(
        (".form input",), names=_labels("K1", "K2")
    ),
    "parameters that need another loop (torque limit, delay, modes)": Row(
        names=_labels("torque_limit", "delay")
    ),
    "choice of the law of each robot": Row(said=("standalone.law",)),
    "own laws": Row(names=(LABEL,)),
    "drag of a path's points, with its checks": Row(said=("standalone.drag_hint",)),
    "points added and removed, freehand strokes, undo": Row(
        said=("design.add", "design.remove", "scene.draw", "design.undo")
    ),
    "poles, in words and numbers": Row((".form [data-kind=note]",)),
    "distance over time": Row((".plot canvas",), ("chart.title",)),
    "a lens on each end-point": Row((".lens canvas",)),
    "slow motion": Row((".transport select",)),
    "aiming points, traces, forces, captions, live region": Row(
        ("[role=status]", ".title .caption")
    ),
    "runs of the lessons, links that set numbers": Row(said=("lesson.play", "lesson.replay")),
    "what to watch in a run; symbols of a text, shown on the robots": Row(
        (".op-watch", ".symbols")
    ),
    "predictions as choice or curve, confidence and reason, truth over the curve": Row(
        (".choice input", ".board", ".compared canvas"), ("lesson.commit", "answer.how_sure")
    ),
    "tasks, hints, quizzes, numbers, own words": Row((".task", ".quiz input", ".task details")),
    "marks and arrows in the scene, start beside the path": Row(
        said=("start.show", "breakdown.slowly"), names=(SETTINGS["start_beside"].spec.label,)
    ),
    "progress": Row(("#save", "#read", "#forget")),
    "labels, tube, coordinates, rank test, both errors, effective mass, singular zone": Row(
        said=tuple(f"show.{name}" for name in ("labels", "tube", "grid", "rank", "errors", "mass"))
    ),
    "sound": Row(said=("display.sounds",)),
    "one-sided wall": Row(names=(SETTINGS["wall"].spec.label,)),
    "looking back over the last minute": Row(said=("chart.look",)),
    "set-ups, share codes, labs that are kept": Row(said=("keep.share", "keep.paste")),
    "classroom, concept test, routes, record as a page": Row(said=("keep.report", "class.export")),
    "export of CSV, pictures and films, identification": Row(
        said=("export.table", "export.picture", "export.film", "gains.identify")
    ),
    "view": Row((".robot canvas",)),
}
ELSEWHERE = {
    "going on from the past; undo of it",  # test_strip_browser
    "why a robot has stopped; the link's deflection",  # test_figure_browser
    # test_site_answers_browser:
    "numbers of the student's curves in a text, texts for some answers only",
    "other numbers of the student's in a text, steps for some answers only",
    "tasks that must be better than the run before",
    # test_site_browser, test_figure_browser:
    "languages, keyboard, print, light and dark pages",
}
"""Rows that no name and no part of a page shows, and where they are tested."""


def listed() -> dict[str, dict[str, str]]:
    """The table: what a page may have -> column -> what is said of it there."""
    lines = [line for line in LIST.read_text("utf-8").splitlines() if line.startswith("|")]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    columns = cells[0][1:]
    assert columns == [FIGURE, LESSONS, FREE, LAB]
    first = next(i for i, row in enumerate(cells) if row[0] == "robots, laws, paths, parameters")
    last = next(i for i, row in enumerate(cells) if row[0] == "view")
    return {row[0]: dict(zip(columns, row[1:], strict=True)) for row in cells[first : last + 1]}


class Seen:
    """Everything that a reader comes across on some pages."""

    def __init__(self) -> None:
        self.marks, self.names = set[str](), set[str]()

    def look(self, reader: SiteReader, scope: str = "body") -> None:
        marks = [mark for row in ROWS.values() for mark in row.marks]
        found, names = reader.page.evaluate(SEEN, [scope, marks, NAMED])
        self.marks |= set(found)
        self.names |= {" ".join(name.split()) for name in names}

    def has(self, row: Row) -> dict[str, bool]:
        """What a row looks for, and whether it was seen."""
        named = {word: self._named(word) for word in row.every_name}
        return {mark: mark in self.marks for mark in row.marks} | named

    def _named(self, word: str) -> bool:
        whole = re.compile(rf"(?<!\w){re.escape(word)}(?!\w)")
        return any(whole.search(name) for name in self.names)


@pytest.fixture(scope="module")
def seen(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Seen]]:
    """What is seen of a figure with all that its author can give, of a lesson, of the free lab."""
    folder = tmp_path_factory.mktemp("seen")
    found = {name: Seen() for name in (FIGURE, LESSONS, FREE)}
    laws = (OWN, "path_following")
    file = onpath.figure(law=laws, choices=["set_point"]).save(folder / "figure.html")
    figure = SiteReader(browser, file.as_uri())
    wait_for(lambda: figure.page.evaluate("'onpath' in window"), WAIT)
    for each in _running_and_paused(figure):
        found[FIGURE].look(each)
    site = exported_site(folder, ("en",))
    start = SiteReader(browser, f"{site.as_uri()}/index.html")
    wait_for(lambda: start.page.evaluate("Boolean(window.site?.figure)"), WAIT)
    for each in _running_and_paused(start):
        found[FREE].look(each, "section[aria-labelledby=lab]")
    found[LESSONS].look(start, "main > section:not([aria-labelledby=lab])")
    lesson = SiteReader(browser, f"{site.as_uri()}/{LESSON}.html", reduced_motion="reduce")
    for each in _every_step(lesson):
        found[LESSONS].look(each)
    yield found
    for reader in (figure, start, lesson):
        reader.context.close()


def _running_and_paused(reader: SiteReader) -> Iterator[SiteReader]:
    """A page with a figure, also while its time stands still: then one can go on by a step."""
    yield from _before_and_while_held(reader)
    yield from _paused(reader)


def _paused(reader: SiteReader) -> Iterator[SiteReader]:
    reader.page.get_by_role("button", name=ENGLISH("run.pause"), exact=True).first.click()
    reader.page.get_by_role("button", name=ENGLISH("run.step"), exact=True).first.wait_for()
    yield reader


def _before_and_while_held(reader: SiteReader) -> Iterator[SiteReader]:
    """A page with a figure that says what its robots do once they are held, if they can be."""
    yield reader
    hold = reader.page.locator(".transport button.main:visible")
    if hold.count():
        hold.first.click()
        told = reader.page.locator(".live[role=status]:not(:empty)")
        captions = reader.page.locator(".title .caption:not(:empty)")
        wait_for(lambda: told.count() and captions.count(), WAIT)
        yield reader


def _every_step(reader: SiteReader) -> Iterator[SiteReader]:
    """A lesson at each of its steps, before and after what happens in it."""
    steps: int = reader.page.evaluate("site.page.steps.length")
    for index in range(steps):
        reader.page.evaluate("index => { void site.open(index) }", index)
        reader.ready()
        yield from _before_and_while_held(reader)
        if reader.page.evaluate("site.page.steps[site.index].kind === 'run'"):
            reader.page.evaluate(
                "document.querySelector('.step.open :is(.lead, .play button)').click()"
            )
            reader.played(10)
            yield reader
        elif reader.page.evaluate("site.view.waits"):
            option = reader.page.locator(".step.open .choice input").first
            if option.count():
                option.check()  # only then one is asked how sure one is
                yield reader
            reader.page.evaluate("() => { site.go(1) }")  # skips it
            yield reader
    reader.page.evaluate("site.stage.run(true)")
    yield reader
    yield from _paused(reader)


def _denied(cell: str) -> bool:
    return cell.startswith(tuple(f"{word}{end}" for word in NOT for end in (" ", ":", ";"))) or (
        cell in NOT
    )


def test_every_row_of_the_list_can_be_seen() -> None:
    assert set(listed()) == {*ROWS, *ELSEWHERE}
    assert not set(ROWS) & set(ELSEWHERE)


@pytest.mark.parametrize("column", [FIGURE, LESSONS, FREE])
def test_what_the_list_names_is_there_and_what_it_denies_is_not(
    seen: dict[str, Seen], column: str
) -> None:
    wrong = dict[str, dict[str, bool]]()
    for name, row in ROWS.items():
        cell = listed()[name][column]
        if cell.startswith(OF_STEPS):
            continue
        has = seen[column].has(row)
        assert has, f"{name}: nothing to look for"
        if set(has.values()) != {not _denied(cell)}:
            wrong[f"{name}: {cell}"] = has
    assert wrong == {}
