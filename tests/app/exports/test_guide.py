"""The teacher's guide, the worksheets and their keys hold everything that the lessons ask, once."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from onpath.app.cli.main import run_command
from onpath.app.exports import course_material
from onpath.app.exports.guide import guide, worksheet
from onpath.app.lab.dry_runs.step_truth import computed_truth
from onpath.assets.messages import languages
from onpath.lessons.action_schema import Action, Laws, Script
from onpath.lessons.action_words import script_words
from onpath.lessons.concept_test.concept_test import questions
from onpath.lessons.course import BUILT_IN, Course
from onpath.lessons.progress import Truth
from onpath.lessons.schema import (
    Block,
    Choice,
    Derivation,
    NumberQuestion,
    OpenQuestion,
    Quiz,
    Sketch,
    Text,
)
from onpath.lessons.task_schema import Task
from onpath.lessons.words import ENGLISH, Words
from onpath.models.systems.catalogue import FIVE_BAR
from tests.support.built_in import built_in_course
from tests.support.concept_key import found_in, key_of
from tests.support.lesson_texts import LESSON, REFERENCE, write_lesson

pytestmark = pytest.mark.thorough

ARTICLE = re.compile(r'<article[^>]* data-asked="([^"]+)">(.*?)</article>', re.DOTALL)
OPTION = re.compile(r'<li><span class="letter">☐ (\w)</span>(.*?)</li>', re.DOTALL)
in_every_language = pytest.mark.parametrize("language", languages())


@cache
def course() -> Course:
    """The built-in lessons."""
    return built_in_course()[0]


@cache
def truth_of(name: str, index: int) -> Truth | None:
    """See `computed_truth`; the same in every language."""
    return computed_truth(course().lesson(name, "en"), index)


@pytest.fixture
def computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """What happens in the built-in lessons is simulated once for all of these tests."""
    monkeypatch.setattr(
        course_material, "computed_truth", lambda lesson, index: truth_of(lesson.name, index)
    )


def asked(name: str, language: str) -> Iterator[tuple[str, Block]]:
    """Every prediction, question and task of a lesson with its key."""
    for index, step in enumerate(course().lesson(name, language).steps):
        for place, block in enumerate(step.blocks):
            if not isinstance(block, Text):
                yield f"{name}.{index}.{place}", block


def concept_questions(language: str) -> dict[str, Block]:
    """The questions of the concept test, by key."""
    return {
        f"test-{letter}.{at}": block
        for letter, form in zip("AB", course().forms(language), strict=True)
        for at, block in enumerate(questions(form).values())
    }


def texts(block: Block) -> list[str]:
    """What the guide says of a block."""
    if isinstance(block, Task):
        return [block.text, *block.explanations.values()]
    if isinstance(block, Sketch):
        return [block.question, block.usual, block.answer, block.ask, "data:image/svg+xml"]
    if isinstance(block, NumberQuestion | OpenQuestion):
        return [block.question, block.answer]
    if isinstance(block, Derivation):
        lines = [text for line in block.line for text in (line.question, line.answer)]
        return [block.question, block.answer, *lines]
    assert isinstance(block, Choice | Quiz)
    told = [text for option in block.options for text in (option.text, option.answer)]
    asks = [block.ask] if isinstance(block, Choice) else []
    aims = [block.misconception] if isinstance(block, Quiz) and block.misconception else []
    return [block.question, *told, *asks, *aims, *getattr(block, "reasons", ())]


@in_every_language
@pytest.mark.usefixtures("computed_once")
def test_the_guide_has_every_question_once_with_its_answer(language: str) -> None:
    page = guide(course(), BUILT_IN, course().lessons, Words(language), test=True)
    assert page.count("<main>") == page.count("<h1>") == 1
    articles = ARTICLE.findall(page)
    every = {key: block for name in course().lessons for key, block in asked(name, language)}
    tests = concept_questions(language)
    every |= tests
    assert [key for key, _ in articles] == list(every)
    for key, article in articles:
        for text in texts(every[key]):
            assert text in article, (key, text)
        if isinstance(every[key], Task):
            assert re.search(r'<ol class="solution">\s*<li>', article), key
    without = guide(course(), BUILT_IN, course().lessons, Words(language))
    assert [key for key, _ in ARTICLE.findall(without)] == list(every)[: -len(tests)]
    assert found_in([*key_of(course().forms(language))], without) == []
    for name in course().lessons:
        front = course().lesson(name, language).front
        assert page.count(f'data-lesson="{name}"') == 1
        assert front.needs in page and front.goals in page and front.misconception in page


@in_every_language
def test_the_lessons_tell_a_teacher_everything(language: str) -> None:
    """No lesson leaves out what the guide needs of it."""
    for name in course().lessons:
        front = course().lesson(name, language).front
        assert front.needs and front.goals and front.misconception, name
        for key, block in asked(name, language):
            assert isinstance(block, Quiz) or all(texts(block)), key


@pytest.mark.usefixtures("computed_once")
@pytest.mark.parametrize("language", languages())
@pytest.mark.parametrize("name", list(course().lessons))
def test_a_worksheet_has_every_question_once_and_only_its_key_the_answers(
    name: str, language: str
) -> None:
    page, key = worksheet(course(), BUILT_IN, name, Words(language))
    assert all(each.count("<main>") == each.count("<h1>") == 1 for each in (page, key))
    every = dict(asked(name, language))
    sheet, answers = dict(ARTICLE.findall(page)), dict(ARTICLE.findall(key))
    assert sorted(k for k, _ in ARTICLE.findall(page)) == sorted(every) == sorted(answers)
    for each, block in every.items():
        first, *_ = texts(block)
        assert first in sheet[each] and first in answers[each]
        if isinstance(block, Sketch):
            assert block.answer in answers[each]
            assert block.answer not in page and block.usual not in page
            empty, drawn = (len(found[each]) for found in (sheet, answers))
            assert "data:image/svg+xml" in sheet[each] and drawn > empty  # no curve to copy
        elif isinstance(block, Task):
            assert block.passed in answers[each] and block.passed not in page
        elif isinstance(block, NumberQuestion | OpenQuestion):
            assert block.answer in answers[each] and block.answer not in page
        elif isinstance(block, Derivation):
            assert all(line.question in sheet[each] for line in block.line)
            assert all(line.answer in answers[each] for line in block.line)
            assert not any(line.answer in page for line in block.line)
        else:
            assert isinstance(block, Choice | Quiz)
            (right,) = [option for option in block.options if option.right]
            assert right.text in answers[each] and right.answer in answers[each]
            at = {text: letter for letter, text in OPTION.findall(sheet[each])}
            assert at.keys() == {option.text for option in block.options}
            assert f"{Words(language)('guide.right')} {at[right.text]}." in answers[each]
            assert not any(option.answer in sheet[each] for option in block.options)


def test_a_solution_is_told_in_words() -> None:
    script = Script(
        (
            Action(at=0.5, set={"K1": 600, "K2": 50.5}),
            Action(at=3.0, hold=True),
            Action(at=3.0, pull=(30.0, -2.5), only="follower"),
            Action(at=5.0, hold=False),
            Action(at=6.0, path="ellipse"),
            Action(at=7.0, laws=Laws(left="path_following")),
            Action(at=8.0, run=False),
            Action(at=9.0, move=(3, 1.0, 2.0)),
        ),
        until=10.0,
    )
    said = list(script_words(script, FIVE_BAR.parameters(), ENGLISH))
    assert len(said) == 7
    assert "0.5 s" in said[0] and "= 600" in said[0] and "= 50.5" in said[0]
    assert "hold back; pull by 30 mm to the right and −2.5 mm up (Follower)" in said[1]
    assert "let go" in said[2] and "ellipse" in said[3].lower() and "left" in said[4]


def test_lessons_of_ones_own_have_a_guide_and_a_worksheet(tmp_path: Path) -> None:
    """Also those without any of the teacher's texts; whatever they say is escaped."""
    write_lesson(tmp_path, LESSON.replace('"Hold back."', '"`<script>alert(1)</script>`"'))
    files = [tmp_path / name for name in ("g.html", "w.html", "k.html")]
    own = ["--lessons", str(tmp_path)]
    assert run_command(["lessons", "guide", "--html", str(files[0]), *own]) == 0
    sheets = ["--html", str(files[1]), "--key", str(files[2]), "--language", "de"]
    assert run_command(["lessons", "worksheet", "1", *sheets, *own]) == 0
    for file in files:
        page = file.read_text(encoding="utf-8")
        assert "<script" not in page and "&lt;script&gt;" in page and "default-src 'none'" in page
    assert files[0].read_text(encoding="utf-8").count("<article") == 4
    assert 'lang="de"' in files[1].read_text(encoding="utf-8")
    into = tmp_path.with_name(f"{tmp_path.name}-sheets")
    assert run_command(["lessons", "worksheet", "--all", str(into), *sheets[4:], *own]) == 0
    written = {file.name: file.read_bytes() for file in into.iterdir()}
    assert written == {
        "01-a.html": files[1].read_bytes(),
        "01-a-key.html": files[2].read_bytes(),
    }


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["guide"], "nothing to write"),
        (["worksheet", "1"], "nothing to write"),
        (["guide", "--html", "{}/g.html"], "no folder"),
        (["guide", "07-flexible", "--html", "{}"], "did you mean 07-flexible-link"),
        (["worksheet", "99", "--html", "{}"], "unknown lesson '99'"),
        (["worksheet", "--html", "{}"], "which lesson"),
        (["worksheet", "1", "--all", "."], "name neither one nor files"),
        (["worksheet", "--all", "{}/sheets"], "No such file"),
        (["worksheet", "1", "--variant", "-1", "--html", "{}"], "expected 0 or more"),
        (["guide", "--language", "xx", "--html", "{}"], "there are de, en"),
    ],
)
def test_what_cannot_be_written_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], said: str
) -> None:
    file = tmp_path / "page.html"
    assert run_command(["lessons", *(each.format(file) for each in arguments)]) == 2
    assert said in capsys.readouterr().err and not file.exists()


def test_lessons_with_problems_are_not_printed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_lesson(tmp_path, reference=REFERENCE.replace("hold.", "other."))
    given = ["--html", str(tmp_path / "g.html"), "--lessons", str(tmp_path)]
    assert run_command(["lessons", "guide", *given]) == 2
    assert "reference.toml" in capsys.readouterr().err


def test_a_pdf_without_a_browser_is_refused_with_a_way_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("onpath.app.exports.print_page.find_browser", lambda: None)
    write_lesson(tmp_path)
    pdf = tmp_path / "g.pdf"
    assert run_command(["lessons", "guide", "--pdf", str(pdf), "--lessons", str(tmp_path)]) == 2
    assert "--html" in capsys.readouterr().err and not pdf.exists()


@pytest.mark.thorough
def test_a_guide_without_formulas_has_no_font() -> None:
    course, _ = built_in_course()
    text = guide(course, BUILT_IN, ["01-path-or-timetable"], ENGLISH)
    assert ("font-src" in text) == ("<math" in text) == ("STIX" in text)
