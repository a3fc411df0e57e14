"""The lesson report is complete, and foreign text in it is escaped."""

from __future__ import annotations

import base64
import re
from dataclasses import dataclass, field
from datetime import datetime
from html.parser import HTMLParser
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from typing_extensions import override

from onpath.app.common.palette import AZURE, SELECTED, VERMILLION
from onpath.app.exports.exporter import Delivery, Exporter
from onpath.app.exports.report import report
from onpath.app.lab import commands as c
from onpath.app.lab.lab import Lab
from onpath.app.lab.lesson_run import LessonRun
from onpath.lessons import prose
from onpath.lessons.course import Course, read_course
from onpath.lessons.given import Answer
from onpath.lessons.progress import Notes, Progress, Truth
from onpath.lessons.words import Words
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.given import notes_with
from tests.support.lab import do, loop_cache, run
from tests.support.lesson_texts import LESSON, write_lesson
from tests.support.waiting import wait_for

NAME, CODE, MADE = "01-a", "k7mf2xqa9tzr", datetime(2025, 3, 2, 14, 5)
VOID = {"meta", "img", "br", "hr", "link", "input"}
HOSTILE = "<script>alert(1)</script>\"'><img src=x onerror=alert(2)>"
SKETCH = Answer(times=(0.0, 1.0, 2.0), values=(0.0, 41.0, 5.0))
TRUTH = Truth("distance", (0.0, 0.5, 2.0), (0.0, 47.0, 1.0), (0.0, 2.0, 0.5))


@dataclass
class Page(HTMLParser):
    """What a page is made of; every tag that is opened must be closed."""

    content: bytes
    texts: list[str] = field(default_factory=list)
    tags: list[tuple[str, dict[str, str | None]]] = field(default_factory=list)
    open_tags: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self.feed(self.content.decode())
        self.close()
        assert self.open_tags == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open_tags.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open_tags.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)

    @property
    def text(self) -> str:
        return re.sub(r"\s+", " ", "".join(self.texts))

    def pictures(self) -> list[str]:
        """The SVGs in it."""
        sources = [attrs["src"] or "" for tag, attrs in self.tags if tag == "img"]
        start = "data:image/svg+xml;base64,"
        assert all(source.startswith(start) for source in sources)
        return [base64.b64decode(source[len(start) :]).decode() for source in sources]


def read(folder: Path, text: str = LESSON) -> Course:
    write_lesson(folder, text)
    course, problems = read_course([folder])
    assert problems == []
    return course


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    """Of one small lesson."""
    return read(tmp_path_factory.mktemp("course"))


def page_of(course: Course, notes: dict[str, Notes], language: str = "en") -> Page:
    return Page(report(LessonRun(course, Progress(language=language, notes=notes)), CODE, MADE))


def full() -> Notes:
    return notes_with(
        seen=8,
        answers={"1": SKETCH, "3": Answer(option=0)},
        truths={"1": TRUTH, "3": TRUTH},
        tasks={"hold": 0.0},
        quiz={"7.0": 1},
    )


def strokes(picture: str, colour: str) -> int:
    """How many curves have a colour; matplotlib groups them as `line2d`."""
    return len(re.findall(rf'<path d="M[^"]*"[^>]*clip-path[^>]*stroke: {colour}', picture))


def test_a_sketch_stands_beside_what_both_robots_did(course: Course) -> None:
    page = page_of(course, {NAME: notes_with(seen=3, answers={"1": SKETCH}, truths={"1": TRUTH})})
    assert "Draw the distance." in page.text
    assert "41 mm at 1 s" in page.text
    assert "Tracker 47 mm at 0.5 s" in page.text and "Follower 2 mm at 0.5 s" in page.text
    (picture,) = page.pictures()
    for colour in (SELECTED, VERMILLION, AZURE):
        assert strokes(picture, colour.hex) == 1
    (alone,) = page_of(course, {NAME: notes_with(seen=2, answers={"1": SKETCH})}).pictures()
    assert strokes(alone, SELECTED.hex) == 1 and strokes(alone, VERMILLION.hex) == 0


def test_all_that_was_done_is_counted(course: Course) -> None:
    page = page_of(course, {NAME: full()})
    cells = re.findall(rb"<td>(.*?)</td>", page.content)
    assert cells == [b"1. A lesson", b"8 of 8", b"1 of 1", b"2 of 2", b"0 of 1"]
    for said in (
        "k7mf-2xqa-9tzr",
        "2025-03-02",
        "You chose: this",
        "Correct answer: that",
        "✓ Passed",
    ):
        assert said in page.text
    assert "You chose: b" in page.text and "Correct answer: a" in page.text
    right = notes_with(answers={"3": Answer(option=1)}, truths={"3": TRUTH})
    assert b"<td>1 of 1</td></tr>" in page_of(course, {NAME: right}).content


def test_the_answer_is_not_told_before_it_has_happened(course: Course) -> None:
    page = page_of(course, {NAME: notes_with(seen=4, answers={"3": Answer(option=0)})})
    assert "You chose: this" in page.text and "<td>–</td></tr>".encode() in page.content
    assert "Right" not in page.text.replace("Choices right", "") and "that" not in page.text


def test_what_was_skipped_is_said(course: Course) -> None:
    page = page_of(course, {NAME: notes_with(seen=3, answers={"1": Answer()}, truths={"1": TRUTH})})
    assert Words("en")("lesson.skipped") in page.text
    (picture,) = page.pictures()
    assert strokes(picture, SELECTED.hex) == 0 and strokes(picture, VERMILLION.hex) == 1


def test_it_loads_nothing_and_runs_nothing(course: Course) -> None:
    page = page_of(course, {NAME: full()})
    policies = [a["content"] for t, a in page.tags if a.get("http-equiv")]
    assert policies == ["default-src 'none'; style-src 'unsafe-inline'; img-src data:"]
    assert not {tag for tag, _ in page.tags} & {"script", "link", "iframe", "object", "embed"}
    assert b"url(" not in page.content and b"@import" not in page.content


def test_the_same_record_gives_the_same_bytes(course: Course) -> None:
    progress = Progress(notes={NAME: full()})
    first = report(LessonRun(course, progress), CODE, MADE)
    assert first == report(LessonRun(course, progress), CODE, MADE)
    assert first != report(LessonRun(course, progress), CODE, MADE.replace(day=3))


def test_hostile_texts_stay_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Even if the check of lessons let them pass, which refuses HTML."""
    monkeypatch.setattr(prose, "HTML", re.compile("(?!)"))
    literal = "'''\\2 " + HOSTILE.replace("'", "’") + "'''"  # no two options are the same
    text = re.sub(r'(title|summary|question|text|answer) = "([^"]*)"', rf"\1 = {literal}", LESSON)
    text = re.sub(r"^# (\w+): .+$", rf"# \1: {HOSTILE}", text, flags=re.M)
    notes = {NAME: full(), HOSTILE: Notes()}
    page = page_of(read(tmp_path, text), notes)
    assert page.text.count("<script>alert(1)</script>") >= 12
    assert not any(tag == "script" or "onerror" in attrs for tag, attrs in page.tags)
    bad = report(LessonRun(read(tmp_path, text), Progress(notes=notes)), HOSTILE, MADE)
    assert b"<script" not in bad and b"<img src=x" not in bad


def test_an_empty_record_says_so(course: Course) -> None:
    for language in ("en", "de"):
        page = page_of(course, {}, language)
        assert Words(language)("report.none") in page.text
        assert not {tag for tag, _ in page.tags} & {"table", "section", "img"}


def test_german_is_german(tmp_path: Path) -> None:
    course = built_in_course()[0]
    name = next(name for name in course.lessons if "de" in course.lessons[name])
    notes = notes_with(
        seen=3, answers={"1": SKETCH}, truths={"1": replace(TRUTH, times=(0.0, 0.5, 1.0))}
    )
    page = page_of(course, {name: notes}, "de")
    german, english = (Words(language) for language in ("de", "en"))
    for key in ("title", "lesson", "seen", "tasks", "predictions", "to_do", "not_passed"):
        assert german(f"report.{key}") in page.text
        assert english(f"report.{key}") not in page.text
    assert course.lessons[name]["de"].front.title in page.text
    assert "Nachläufer 47 mm bei 0,5 s" in page.text and "02.03.2025" in page.text
    assert ("html", {"lang": "de"}) in page.tags


def test_notes_that_no_longer_fit_are_left_out_and_counted(course: Course) -> None:
    foreign = notes_with(
        step=70,
        seen=99,
        answers={"0": SKETCH, "x": SKETCH, "1": Answer(option=1), "3": Answer(option=2)},
        truths={"1": replace(TRUTH, quantity="lag"), "-1": TRUTH},
        tasks={"gone": 1.0},
        quiz={"7.0": 2, "7": 0, "1.0": 0},
    )
    page = page_of(course, {NAME: foreign, "99-gone": full()})
    words = Words("en")
    assert words("report.strange", count=10) in page.text
    assert words("report.gone", name="99-gone") in page.text
    assert b"<td>8 of 8</td>" in page.content and page.pictures() == []
    assert "no longer" not in page_of(course, {NAME: full()}).text


numbers = st.floats(allow_nan=True, allow_infinity=True)
points = st.lists(numbers, max_size=5).map(tuple)
keys = st.sampled_from(["0", "1", "3", "7.0", "hold", "", "²", "<b>"])
answers = st.builds(Answer, option=st.none() | st.integers(0, 3), times=points, values=points)
truths = st.builds(
    Truth,
    quantity=st.sampled_from(["distance", "no"]),
    times=points,
    tracker=points,
    follower=points,
)
any_notes = st.builds(
    notes_with,
    seen=st.integers(0, 1000),
    answers=st.dictionaries(keys, answers, max_size=3),
    truths=st.dictionaries(keys, truths, max_size=3),
    tasks=st.dictionaries(keys, numbers, max_size=3),
    quiz=st.dictionaries(keys, st.integers(0, 3), max_size=3),
)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.dictionaries(st.sampled_from([NAME, "gone", "\x00<"]), any_notes, max_size=2))
def test_any_notes_make_a_page(course: Course, notes: dict[str, Notes]) -> None:
    assert page_of(course, notes).content.endswith(b"</html>\n")


def test_numbers_beyond_the_axes_make_a_page(course: Course) -> None:
    huge = Truth("distance", (0.0, 1e300, -1e308), (1e308, -1e308, 0.0), (0.0, 5e-324, 1.0))
    page = page_of(course, {NAME: notes_with(answers={"1": SKETCH}, truths={"1": huge})})
    assert len(page.pictures()) == 1


class Client(Delivery):
    """Keeps what a browser would have been sent."""

    def __init__(self) -> None:
        self.sent: dict[str, bytes] = {}

    @override
    def making(self, name: str, words: Words) -> None: ...

    @override
    def ready(self, name: str, content: bytes, words: Words) -> None:
        self.sent[name] = content

    @override
    def failed(self, name: str, words: Words) -> None: ...


@pytest.mark.thorough
def test_it_is_sent_as_it_was_when_it_was_requested(course: Course) -> None:
    lab, client = Lab(loop_cache(), FIVE_BAR, course), Client()
    do(lab, c.OpenLesson(NAME), c.GoToStep(1))
    do(lab, c.Predict(times=(0.0, 2.0), values=(5.0, 30.0)), c.GoToStep(1), c.PlayStep())
    run(lab, 2.3)
    exporter = Exporter(client)
    exporter.report(CODE)
    exporter.serve(lab)
    wait_for(lambda: client.sent, 240.0)
    page = Page(client.sent["onpath-report.html"])
    assert "k7mf-2xqa-9tzr" in page.text and "30 mm at 2 s" in page.text
    (picture,) = page.pictures()
    assert strokes(picture, SELECTED.hex) == strokes(picture, VERMILLION.hex) == 1


def test_what_to_take_away_is_shown_to_students_who_reached_the_end(tmp_path: Path) -> None:
    point = "Remember the path."
    text = LESSON.replace("minutes = 1", f'minutes = 1\ntakeaway = ["{point}"]')
    course = read(tmp_path, text)
    assert point in page_of(course, {NAME: full()}).text
    assert point not in page_of(course, {NAME: replace(full(), seen=7)}).text
