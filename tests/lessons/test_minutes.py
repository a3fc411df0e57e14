"""The estimated minutes of a lesson are those of its parts."""

from __future__ import annotations

from pathlib import Path

import pytest

from onpath.app.cli.lessons import long_pages_list
from onpath.app.cli.main import run_command
from onpath.app.lab.lesson_state import LessonState
from onpath.app.view.lessons import lesson_card
from onpath.lessons.course import read_course
from onpath.lessons.formulas import to_html
from onpath.lessons.minutes import (
    MINUTES,
    PAGE,
    WORDS,
    Minutes,
    lesson_minutes,
    long_pages,
    optional_minutes,
    page_words,
    required_minutes,
    step_minutes,
    together,
    word_count,
)
from onpath.lessons.parse import read_lesson
from tests.support.built_in import built_in_course
from tests.support.lesson_texts import LESSON, write_lesson

BEFORE = "Which one *waits*?"


def spent(folder: Path, text: str = LESSON) -> Minutes:
    return together(map(step_minutes, read_lesson(write_lesson(folder, text)).steps))


OPTIONAL = "```step\noptional = true\n```\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [("one *two* three, four.", 4), ("$x^2 = 4$", 3), ("a — b", 2), ("", 0)],
)
def test_words_are_letters_and_numbers(text: str, words: int) -> None:
    assert word_count(to_html(text)) == words


def test_more_words_take_longer_unless_they_are_folded(tmp_path: Path) -> None:
    more = " ".join(["word"] * WORDS)
    read = spent(tmp_path, LESSON.replace(BEFORE, f"{more} {BEFORE}"))
    assert read.reading == pytest.approx(spent(tmp_path).reading + 1)
    folded = f"```fold More\n{more}\n```\n\n{BEFORE}"
    assert spent(tmp_path, LESSON.replace(BEFORE, folded)) == spent(tmp_path)


def test_a_text_for_some_answers_only_takes_no_time(tmp_path: Path) -> None:
    more = " ".join(["word"] * WORDS)
    some = LESSON.replace("# explain: Why", f"```when wrong\n{more}\n```\n\n# explain: Why")
    assert spent(tmp_path, some) == spent(tmp_path)
    steps = read_lesson(write_lesson(tmp_path, some)).steps
    assert max(map(page_words, steps)) < WORDS


def test_runs_take_their_own_time_and_everything_done_a_fixed_one(tmp_path: Path) -> None:
    plain = spent(tmp_path)
    assert plain.runs == pytest.approx((2.0 + 1.0) / 60)
    assert plain.predictions == MINUTES["sketch"] + MINUTES["choice"] + MINUTES["quiz"]
    assert plain.tasks == MINUTES["play"] + MINUTES["task"]
    longer = spent(tmp_path, LESSON.replace("until = 1.0", "until = 31.0"))
    assert longer.total == pytest.approx(plain.total + 0.5)


def test_the_estimate_is_listed_and_on_the_card(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Also that of earlier files, which state minutes of their own."""
    write_lesson(tmp_path, LESSON.replace("minutes = 1", "minutes = 77"))
    course, found = read_course([tmp_path])
    lesson = course.lesson("01-a", "en")
    assert found == [] and lesson_minutes(lesson) == round(spent(tmp_path).total)
    minutes, *_ = lesson_card(lesson, LessonState(course), "1").facts
    assert f"{lesson_minutes(lesson)} min" in minutes
    assert run_command(["lessons", "list", str(tmp_path), "--steps"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert float(lines[1].split()[1]) == pytest.approx(spent(tmp_path).total, abs=0.051)
    assert len(lines) == 2 + len(lesson.steps)


def test_optional_steps_are_counted_apart(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = spent(tmp_path).total
    write_lesson(tmp_path, LESSON.replace("# quiz: Say\n", f"# quiz: Say\n{OPTIONAL}"))
    course, found = read_course([tmp_path])
    lesson = course.lesson("01-a", "en")
    last = step_minutes(lesson.steps[-1]).total
    assert found == [] and lesson.steps[-1].optional and last > 0
    assert required_minutes(lesson).total == pytest.approx(whole - last)
    assert optional_minutes(lesson).total == pytest.approx(last)
    [fact] = lesson_card(lesson, LessonState(course), "1").facts
    assert fact.startswith(f"{round(required_minutes(lesson).total)} ")
    assert run_command(["lessons", "list", str(tmp_path), "--steps"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert float(lines[1].split()[1]) == pytest.approx(whole - last, abs=0.051)
    assert [line.endswith(" optional") for line in lines[2:]] == [
        step.optional for step in lesson.steps
    ]


@pytest.mark.parametrize("over", [False, True])
def test_a_page_of_more_than_300_words_is_noted_unless_they_are_folded(
    tmp_path: Path, over: bool
) -> None:
    first = read_lesson(write_lesson(tmp_path, LESSON)).steps[0]
    more = "word " * (PAGE - page_words(first) + over)
    folded = f"\n\n```fold More\n{'word ' * PAGE}\n```\n\n"
    write_lesson(tmp_path, LESSON.replace(BEFORE, f"{more}{folded}{BEFORE}", 1))
    course, found = read_course([tmp_path])
    assert found == []
    noted = long_pages_list(course).splitlines()
    assert [f"{PAGE + 1} words" in line for line in noted] == [True] * over


def test_the_built_in_pages_have_at_most_300_words() -> None:
    course, _ = built_in_course()
    versions = [lesson for each in course.lessons.values() for lesson in each.values()]
    assert [(lesson.name, found) for lesson in versions if (found := long_pages(lesson))] == []
