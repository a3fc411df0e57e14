"""Every nickname can be seen and told apart, and none is a formula in the record of a class."""

from __future__ import annotations

import csv
import io
import unicodedata
from itertools import groupby

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from onpath.app.classroom.admission import LONGEST_NAME, cleaned, not_among
from onpath.app.classroom.classroom import Member
from onpath.app.classroom.results import class_csv
from onpath.app.common.visible_text import MOST_MARKS, comparison_key, is_visible
from onpath.lessons.course import Course
from onpath.lessons.progress import Notes, Progress
from tests.support.lesson_texts import LESSON, write_lesson

INVISIBLE = (
    "\u3164\u2800\u115f\u1160\uffa0\u034f\u17b4\u17b5\u180b\ufe0f\u200b\u00ad\u2060\U000e0100"
)
EQUALS = "=\uff1d\ufe66\u207c\u208c\u2a75\ua78a\U0001f7f0"
OTHER_STARTS = "+\uff0b\ufe62\ufb29\u2795-\uff0d\ufe63\u2212\u2796@\uff20\ufe6b|\uff5c%\uff05"
names = st.text(
    st.characters(categories=["L", "N", "P", "S", "Z", "C"]) | st.sampled_from(INVISIBLE)
)
marked = st.text(st.characters(categories=["M"]) | st.sampled_from("ae \u1100\u3164"))


def is_mark(character: str) -> bool:
    return unicodedata.category(character)[0] == "M"


@pytest.mark.parametrize("character", INVISIBLE)
def test_what_cannot_be_seen_is_no_nickname(character: str) -> None:
    for name in (character, character * 30, f" {character} {character}"):
        with pytest.raises(ValueError, match="nickname"):
            cleaned(name)
    assert cleaned(f"A{character}\u0308da").replace(" ", "") in ("Äda", "Ada")


def test_marks_that_stand_alone_are_no_nickname() -> None:
    with pytest.raises(ValueError, match="nickname"):
        cleaned("\u0301\u0302 \u0303")


@given(names | marked | st.text())
@example("Z" + "\u0334" * 24 + "algo")
@example("\u3164Ada")
@example("\u1100\u034f\u1161")
@example("a\u0301\u034f\u0301\u0301\u0301")
def test_a_nickname_is_seen_and_stable(text: str) -> None:
    try:
        name = cleaned(text)
    except ValueError:
        return
    assert 0 < len(name) <= LONGEST_NAME and cleaned(name) == name
    assert unicodedata.is_normalized("NFC", name)
    assert all(c == " " or is_visible(c) for c in name) and not is_mark(name[0])
    runs = [len(list(run)) for marks, run in groupby(name, is_mark) if marks]
    assert max(runs, default=0) <= MOST_MARKS


@pytest.mark.parametrize(
    "name", ["Zoë", "Nguyễn Thị Hậu", "दिव्या", "สุกัญญา", "مُحَمَّد", "김민준", "👩 Ada"]
)
def test_names_of_many_languages_stay_as_they_are(name: str) -> None:
    assert cleaned(name) == unicodedata.normalize("NFC", name)


def test_names_that_differ_in_width_alone_are_told_apart() -> None:
    assert not_among({comparison_key("Ada")}, cleaned("Ａｄａ")) == "Ａｄａ 2"


@pytest.fixture(scope="module")
def course(tmp_path_factory: pytest.TempPathFactory) -> Course:
    from onpath.lessons.course import read_course

    folder = tmp_path_factory.mktemp("course")
    write_lesson(folder, LESSON)
    return read_course([folder])[0]


def cell_of(course: Course, name: str) -> str:
    """The nickname as it stands in the record."""
    progress = Progress(notes={next(iter(course.lessons)): Notes()})
    data = class_csv([Member(1, name, progress, False, 0.0, 0)], course, "en")
    return next(csv.DictReader(io.StringIO(data.decode("utf-8-sig"))))["nickname"]


@given(
    st.text(st.sampled_from(" \t\u3000\ufeff" + INVISIBLE), max_size=3),
    st.sampled_from(EQUALS + OTHER_STARTS),
    st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=9),
)
def test_no_cell_begins_like_a_formula(course: Course, before: str, sign: str, after: str) -> None:
    assert cell_of(course, before + sign + after) == "'" + before + sign + after


@given(st.text(st.characters(categories=["L", "Nd"]), min_size=1))
def test_what_is_no_formula_stays_as_it_is(course: Course, name: str) -> None:
    assert cell_of(course, "A" + name) == "A" + name
