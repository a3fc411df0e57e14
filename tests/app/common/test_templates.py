"""HTML is created only by templates, and text inserted into them is escaped."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from datetime import datetime
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from markupsafe import Markup
from msgspec.structs import replace

from onpath.app.classroom import class_html
from onpath.app.classroom.classroom import Member
from onpath.app.classroom.results import distribution
from onpath.app.common.templates import environment, phrase
from onpath.app.exports.report import report
from onpath.app.lab.lesson_run import LessonRun
from onpath.app.lab.snapshots.page_snapshot import LessonSnapshot
from onpath.app.view.lesson_message import lesson_message
from onpath.app.view.lesson_view import LessonView
from onpath.assets import asset_path
from onpath.lessons.course import Course
from onpath.lessons.given import Answer
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.schema import (
    Choice,
    Derivation,
    Lesson,
    NumberQuestion,
    OpenQuestion,
    Option,
    Quiz,
    Step,
)
from onpath.lessons.words import ENGLISH, Words, languages
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.checkout import ROOT
from tests.support.given import notes_with

TAG = re.compile(r"</?(?!br\b)[a-zA-Z][a-zA-Z0-9]*(\s[a-z-]+=|\s*/?>)")  # markdown may have <br/>
BYTES_ALONE = "app/viser_adapter/page_scripts.py"  # puts our files into viser's page, no values
TYPES_ALONE = "app/channel/typescript.py"  # writes types, such as Changes<Message>
VOID = {"br", "wbr", "img", "input", "meta", "line", "polyline"}
HOSTILE = ["<img src=x onerror=alert(1)>", '"><script>alert(2)</script>', "'{0}{{ 7 }}{% x %}&lt;"]
DAY = datetime(2025, 3, 2)
COURSE = built_in_course()[0]
NAME = next(iter(COURSE.lessons))
ROBOT = FIVE_BAR.make(FIVE_BAR.parameters())


@dataclass
class Parsed(HTMLParser):
    """A piece of HTML whose tags are all closed.

    Attributes:
        shape: tags with the names of their attributes, in order.
        said: all that is text, of attributes too.
    """

    content: str
    shape: list[tuple[str, ...]] = field(default_factory=list)
    said: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self._open: list[str] = []
        self.feed(self.content)
        self.close()
        assert self._open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_startendtag(tag, attrs)
        if tag not in VOID:
            self._open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.shape.append((tag, *(name for name, _ in attrs)))
        self.said += [value or "" for _, value in attrs]

    def handle_endtag(self, tag: str) -> None:
        assert self._open.pop() == tag
        self.shape.append(("/", tag))

    def handle_data(self, data: str) -> None:
        self.said.append(data)


def titled(text: str) -> tuple[Lesson, LessonRun]:
    """A lesson with a text for its titles and summary, and the way through it."""
    lesson = COURSE.lesson(NAME, "en")
    front = replace(lesson.front, title=text, summary=text)
    steps = tuple(replace(step, title=text) for step in lesson.steps)
    lesson = replace(lesson, front=front, steps=steps)
    return lesson, LessonRun(Course({NAME: {"en": lesson}}), Progress(lesson=NAME))


def view_of(run: LessonRun) -> LessonView:
    """The lessons as a student's page sees them."""
    shown = LessonSnapshot(0, run.progress, playing=False, verdicts={}, truth=None)
    return LessonView(run.course, run.words, shown)


def heading(text: str) -> str:
    return lesson_message(view_of(titled(text)[1]), ROBOT).head


def place(text: str) -> str:
    _, run = titled(text)
    member = Member(1, "Ada", Progress(lesson=NAME))
    return class_html.table([member], run.course, 0.0, ENGLISH)


def nickname(text: str) -> str:
    return class_html.table([Member(1, text)], COURSE, 0.0, ENGLISH)


def choices(text: str) -> str:
    block = Choice(text, (Option(text, text), Option(text, text, right=True)))
    found = distribution(block, NAME, "0", [])
    return class_html.prediction_view(block, found, None, True, ENGLISH)


def gone(text: str) -> str:
    run = LessonRun(COURSE, Progress(notes={text: Notes()}))
    return report(run, "x" + text, DAY).decode()


PLACES: dict[str, Callable[[str], str]] = {
    "heading": heading,
    "place": place,
    "nickname": nickname,
    "choices": choices,
    "class code": lambda text: class_html.class_code(text, False, text, 1, ENGLISH),
    "report": gone,
}
texts = st.sampled_from(HOSTILE) | st.text(max_size=40)


@pytest.mark.parametrize("place", PLACES)
@settings(max_examples=30, deadline=None)
@given(texts)
def test_no_text_changes_what_a_page_is_made_of(place: str, text: str) -> None:
    page, plain = Parsed(PLACES[place](text)), Parsed(PLACES[place]("x"))
    assert page.shape == plain.shape
    if place not in ("report", "class code"):  # there a code is written in another way
        assert any(text in said for said in page.said)


@given(texts, texts)
def test_only_markup_among_the_values_of_a_phrase_stays_markup(name: str, other: str) -> None:
    def words(key: str, **values: object) -> str:
        return "{a} & {b}".format(**values)

    made = phrase(words, "any", a=Markup("<b>{}</b>").format(name), b=other)  # type: ignore[arg-type]
    page = Parsed(made)
    assert page.shape == [("b",), ("/", "b")]
    assert "".join(page.said) == f"{name} & {other}"


class HostileWords(Words):
    """A catalogue whose every entry is full of markup."""

    def __call__(self, key: str, **values: Any) -> str:
        return super().__call__(key, **values) + HOSTILE[0] + "'\""


def test_no_catalogue_changes_what_a_page_is_made_of() -> None:

    def pages(words: Words) -> Iterator[str]:
        run = LessonRun(COURSE, Progress(lesson=NAME))
        run.words = words
        yield from pieces(run, words)
        yield class_html.table([Member(1, "Ada")], COURSE, 0.0, words)
        yield class_html.class_code("https://a.example/c/a/", False, "a", 1, words)

    ours, theirs = pages(ENGLISH), pages(HostileWords())
    for plain, hostile in zip(ours, theirs, strict=True):
        assert Parsed(hostile).shape == Parsed(plain).shape


def pieces(run: LessonRun, words: Words) -> Iterator[str]:
    """The open step on the student's page and on the teacher's, each block in all its states."""
    lesson, step = run.lesson, run.step
    assert lesson is not None and step is not None
    for notes in answered(step, run):
        run.progress = replace(run.progress, notes={lesson.name: notes})
        message = lesson_message(view_of(run), ROBOT)
        yield from map(str, (message.head, *message.sections.values(), message.pager))
    for block in step.predictions():
        sketch = Answer(times=(0.0, 1.0), values=(0.0, 1.0))
        ways = [Progress(notes={lesson.name: notes_with(answers={str(run.index): sketch})})]
        found = distribution(block, lesson.name, str(run.index), ways)
        for revealed in (True, False):
            yield class_html.prediction_view(block, found, None, revealed, words)


def answered(step: Step, run: LessonRun) -> Iterator[Notes]:
    """Notes in which the step's questions are not answered, and in which they are."""
    notes, answers = run.notes, dict[str, Any](quiz={}, numbers={}, written={})
    yield notes
    for place, block in enumerate(step.blocks):
        key = f"{run.index}.{place}"
        if isinstance(block, NumberQuestion):
            answers["numbers"][key] = block.number
        elif isinstance(block, Derivation):
            answers["written"][key] = "1\n2\n3"
        elif isinstance(block, OpenQuestion):
            answers["written"][key] = "<b>"
        elif isinstance(block, Quiz):
            answers["quiz"][key] = 0
        elif isinstance(block, Choice):
            why = Answer(option=0, sure="certain", reason=0 if block.reasons else None, why="<b>")
            answers["answers"] = {str(run.index): why}
    yield replace(notes, given=notes_with(**answers).given)


@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("name", COURSE.lessons)
def test_every_step_of_every_lesson_is_well_formed(name: str, language: str) -> None:
    """An undefined value in a template raises."""
    lesson = COURSE.lesson(name, language)
    tasks = {task.id: 1.5 for task in lesson.tasks()}
    for index in range(len(lesson.steps)):
        notes = {name: notes_with(step=index, tasks=tasks, hints=dict.fromkeys(tasks, 9))}
        run = LessonRun(COURSE, Progress(lesson=name, language=language, notes=notes))
        for piece in pieces(run, run.words):
            assert type(piece) is str  # viser's messages hold nothing else
            assert Parsed(piece).shape


# Where HTML is made.


def strings(tree: ast.AST) -> Iterator[str]:
    """All strings of a module but docstrings."""
    told = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and id(node) not in told:
            yield node.value.decode("latin-1") if isinstance(node.value, bytes) else str(node.value)


def hand_made(source: str) -> bool:
    """Whether a module writes HTML, escapes it, or calls something markup."""
    tree = ast.parse(source)
    imported = {
        f"{node.module}.{alias.name}"
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    } | {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.Import)
        for alias in node.names
    }
    return bool(imported & {"html", "html.escape", "markupsafe.Markup"}) or any(
        TAG.search(text) for text in strings(tree)
    )


def test_html_is_made_in_templates_only() -> None:
    allowed = {BYTES_ALONE, TYPES_ALONE, "app/common/templates.py"}
    found = {
        str(file.relative_to(ROOT))
        for file in (ROOT / "app").rglob("*.py")
        if hand_made(file.read_text("utf-8"))
    }
    assert found <= allowed
    for source in ("import html", "from html import escape", "a = f'<div>{b}'", "a = '</p>'"):
        assert hand_made(source)


def test_a_lesson_makes_markup_in_one_place() -> None:
    """By a call of `Markup`; its name alone is a type."""
    found = {
        file.name
        for file in (ROOT / "lessons").rglob("*.py")
        for node in ast.walk(ast.parse(file.read_text("utf-8")))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == "Markup"
        and node.args
    }
    assert found == {"safe_html.py"}


@pytest.mark.parametrize(
    "piece",
    [
        class_html.class_code("https://a.example/", False, "K7P", 1, ENGLISH),
        report(LessonRun(COURSE, Progress()), "K7P", DAY).decode(),
    ],
)
def test_codes_are_not_translated(piece: str) -> None:
    assert re.search(r'translate="no"[^>]*>\s*K7P', piece)


TEMPLATES = sorted(file for file in asset_path("templates").rglob("*.*"))


@pytest.mark.parametrize("file", TEMPLATES, ids=lambda file: file.name)
def test_templates_trust_nothing_and_take_colours_from_the_palette(file: Path) -> None:
    source = file.read_text("utf-8")
    environment().parse(source)
    assert not re.search(r"\|\s*safe\b|\bautoescape\b|\bMarkup\b", source)
    assert not re.search(r"#[0-9a-fA-F]{3,8}\b", source)
