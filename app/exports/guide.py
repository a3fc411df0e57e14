"""The teacher's guide and the worksheets of the lessons, as pages to print.

The pages are rendered from the templates in assets/templates/guide.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from onpath.app.common.templates import render
from onpath.app.exports.course_material import taught_lesson
from onpath.lessons.concept_test.concept_test import BEFORE
from onpath.lessons.course import Course
from onpath.lessons.option_order import LETTERS
from onpath.lessons.words import Words


def guide(course: Course, folder: Path, names: Iterable[str], words: Words) -> str:
    """The teacher's guide to some lessons as a standalone page.

    A guide to all lessons also has the concept test.

    Args:
        folder: contains the lessons' own folders.

    Raises:
        ValueError: the reference solutions of a lesson cannot be read.
    """
    lessons = [taught_lesson(course, folder, name, words) for name in names]
    whole = {taught.lesson.name for taught in lessons} == {*course.lessons}
    test = course.lesson(BEFORE, words.language) if whole and course.tests else None
    return render(
        "guide/guide.html",
        lessons=lessons,
        test=test,
        words=words,
        letters=LETTERS,
        version=version("onpath"),
    )


def worksheet(course: Course, folder: Path, name: str, words: Words) -> tuple[str, str]:
    """A lesson's worksheet of two pages, and its key, as standalone pages.

    Raises:
        ValueError: see `guide`.
    """
    taught = taught_lesson(course, folder, name, words)
    fields = {"taught": taught, "words": words, "letters": LETTERS}
    return render("guide/worksheet.html", **fields), render("guide/key.html", **fields)
