"""The concept test as it is written in two forms, and which of them a student gets."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from markupsafe import Markup

from onpath.lessons.concept_test.concept_test import (
    AFTER,
    BEFORE,
    FOLDERS,
    SITTINGS,
    both_sittings,
    dealt,
    dealt_in_class,
    form_of,
    handed_in,
    name_of,
    own_test,
    questions,
    right_in,
    sitting_of,
)
from onpath.lessons.course import BUILT_IN, Course, read_course, read_folder
from onpath.lessons.parse import read_lesson
from onpath.lessons.problems import LessonError
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.strategies import rates
from tests.support.built_in import built_in_course
from tests.support.given import notes_with

COURSE, PROBLEMS = built_in_course()
NAMES = [name_of(sitting, form) for form in (0, 1) for sitting in SITTINGS]
FRONT = '+++\ntitle = "A"\nsummary = "B"\n+++\n\n'
ITEM = """# quiz: One

```quiz
misconception = "It is not."
question = "Is it?"
options = [{ text = "Yes", right = true, answer = "So." }, { text = "No", answer = "Not so." }]
```
"""
OF_THE_LESSONS = {
    "en": r"tracker|follower|\bpaths?\b|\bclocks?\b|timetable|invarian|zero dynamics|\brank\b"
    r"|\boutputs?\b|\barms?\b|robot|\btubes?\b|\bgains?\b|feedback|lineari[sz]|reference",
    "de": r"nachläufer|bahn|\buhr\b|fahrplan|invarian|nulldynamik|\brang\b|ausgang|ausgänge"
    r"|\barme?s?\b|roboter|schlauch|verstärkung|rückführ|lineari|sollpunkt",
}
"""Words by which somebody who has heard the lessons would know what is meant."""


def test_each_form_asks_about_the_same_twelve_beliefs_in_every_language() -> None:
    assert not PROBLEMS and list(COURSE.tests) == NAMES
    assert not set(NAMES) & set(COURSE.lessons)
    for name in NAMES:
        assert set(COURSE.tests[name]) == set(COURSE.languages())
    for language in COURSE.languages():
        asked = [list(questions(form).values()) for form in COURSE.forms(language)]
        beliefs = [[block.misconception for block in form] for form in asked]
        assert beliefs[0] == beliefs[1] and len(set(beliefs[0]) - {""}) == 12
        for form in asked:
            assert all(len(block.options) == 4 for block in form)
            assert len({option.text for block in form for option in block.options}) == 48
        pages = [[block.treated for block in form] for form in asked]
        assert pages[0] == pages[1] and None not in pages[0]


@pytest.mark.parametrize("language", COURSE.languages())
def test_half_of_each_form_is_about_other_bodies_without_a_word_of_the_lessons(
    language: str,
) -> None:
    first, second = (list(questions(form).values()) for form in COURSE.forms(language))
    known = re.compile(OF_THE_LESSONS[language], re.IGNORECASE)
    for one, other in zip(first, second, strict=True):
        assert one.transfer != other.transfer
        for block in (one, other):
            texts = [Markup(each).striptags() for each in (block.question, *_texts(block.options))]
            words = [word for text in texts for word in known.findall(text)]
            assert bool(words) != block.transfer, (block.question, words)
    assert sum(block.transfer for block in first) == len(first) / 2


def _texts(options: tuple[object, ...]) -> list[str]:
    return [getattr(option, "text") for option in options]  # noqa: B009


def test_a_test_has_questions_only(tmp_path: Path) -> None:
    file = tmp_path / FOLDERS[0] / "en.md"
    file.parent.mkdir()
    file.write_text(FRONT + ITEM, "utf-8")
    assert len(questions(read_lesson(file))) == 1
    run = "# run: Two\n\n```script\nuntil = 2.0\n```\n"
    for bad in ("", "# explain: Words\n\nWords.\n", ITEM + run, ITEM + ITEM[ITEM.index("```") :]):
        file.write_text(FRONT + bad, "utf-8")
        with pytest.raises(LessonError, match="test"):
            read_lesson(file)


def written(folder: Path, *forms: str) -> Path:
    """A course with nothing but some forms of a test, in order."""
    for name, items in zip(FOLDERS, forms, strict=False):
        (folder / name).mkdir()
        (folder / name / "en.md").write_text(FRONT + items, "utf-8")
    return folder


def test_a_second_form_has_as_many_questions_about_the_same_beliefs(tmp_path: Path) -> None:
    for at, (second, fault) in enumerate(
        {
            ITEM: "",
            ITEM + ITEM: "2 questions, and 1 in the first form",
            ITEM.replace("It is not", "It is"): "not the misconception of 'One'",
            ITEM.replace("question", 'treated = { lesson = "a", step = 1 }\nquestion'): "no step 1",
        }.items()
    ):
        (tmp_path / str(at)).mkdir()
        course, problems = read_course([written(tmp_path / str(at), ITEM, second)])
        assert list(course.tests) == NAMES
        assert [fault in problem.text for problem in problems] == [True] * bool(fault), problems
    (tmp_path / "alone" / FOLDERS[1]).mkdir(parents=True)
    (tmp_path / "alone" / FOLDERS[1] / "en.md").write_text(FRONT + ITEM, "utf-8")
    (problem,) = read_course([tmp_path / "alone"])[1]
    assert "no first form" in problem.text


@pytest.mark.parametrize("form", (0, 1))
def test_a_form_is_checked_alone_as_well(form: int) -> None:
    course, problems, folder = read_folder(BUILT_IN / FOLDERS[form])
    assert not problems and folder == BUILT_IN and not course.lessons
    assert list(course.tests) == [name_of(sitting, form) for sitting in SITTINGS]
    ours = {each.group.partition(" ")[0] for each in rates(course) if each.count}
    assert ours == set(course.languages()) == set(COURSE.languages())
    assert course.forms("en")[0].steps == COURSE.forms("en")[form].steps


@pytest.mark.thorough
def test_a_course_may_have_a_test_of_its_own_or_none(tmp_path: Path) -> None:
    course, problems = read_course([BUILT_IN, written(tmp_path, ITEM)])
    assert not problems and list(course.tests) == list(SITTINGS)
    assert len(questions(course.lesson(AFTER, "en"))) == 1
    assert both_sittings({}) == {} and not Course({}).has(BEFORE) and Course({}).forms("en") == []


# Which form.


@given(st.text(max_size=12), st.integers(0, 12))
def test_half_of_a_class_gets_each_form_first(code: str, pairs: int) -> None:
    first = [dealt_in_class(code, number) for number in range(1, 2 * pairs + 1)]
    assert sum(first) == pairs
    assert all(a != b for a, b in zip(first[::2], first[1::2], strict=True))


def test_either_form_is_as_likely_in_a_class_and_alone() -> None:
    for deal in (lambda n: dealt(f"{n}"), lambda n: dealt_in_class(f"{n}", 1)):
        found = [deal(n) for n in range(400)]
        assert abs(sum(found) - 200) < 4 * 10  # four standard deviations


@given(st.integers(0, 1), st.lists(st.sampled_from([*NAMES, "01-a"]), min_size=1, max_size=6))
def test_a_student_gets_each_form_once_and_keeps_it(first: int, opened: list[str]) -> None:
    progress, got = Progress(), dict[str, str]()
    for name in opened:
        own = own_test(name, NAMES, progress, first)
        assert sitting_of(own) == sitting_of(name)
        assert got.setdefault(sitting_of(name), own) == own
        progress = Progress(notes={**progress.notes, own: Notes()})
    forms = {form_of(own) for sitting, own in got.items() if sitting in SITTINGS}
    assert len(forms) == len(set(got) & set(SITTINGS))
    assert got.get(BEFORE, name_of(BEFORE, first)) == name_of(BEFORE, first)
    assert own_test(opened[0], SITTINGS, progress, first) == sitting_of(opened[0])


def test_a_missing_answer_is_wrong_and_one_to_another_version_unknown() -> None:
    form, none = COURSE.forms("en")[0], [False] * 12
    assert right_in(form, Notes(handed_in=True)) == none
    gone = notes_with(quiz={"0.1": 99, "77.0": 0}, handed_in=True)
    assert right_in(form, gone) == none
    for sitting in SITTINGS:
        for at in (0, 1):
            done = Progress(notes={name_of(sitting, at): Notes(handed_in=True)})
            assert handed_in(done, sitting) == (at, Notes(handed_in=True))
        assert handed_in(Progress(notes={sitting: Notes()}), sitting) is None
        assert handed_in(Progress(), sitting) is None
