"""The teacher's guide and the worksheets of the lessons, as pages to print.

The pages are rendered from the templates in assets/templates/guide.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from onpath.app.common.templates import render
from onpath.app.exports.course_material import AskedBlock, taught_lesson
from onpath.app.view.lessons import route_stops
from onpath.lessons.concept_test.concept_test import FORMS
from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.course import Course
from onpath.lessons.minutes import lesson_minutes
from onpath.lessons.option_order import LETTERS, option_order
from onpath.lessons.schema import Choice, Option, Quiz
from onpath.lessons.words import Words


def guide(
    course: Course, folder: Path, names: Iterable[str], words: Words, test: bool = False
) -> str:
    """The teacher's guide to some lessons as a standalone page.

    Args:
        folder: contains the lessons' own folders.
        test: whether the concept test and its answers are in it.

    Raises:
        ValueError: the reference solutions of a lesson cannot be read.
    """
    lessons = [taught_lesson(course, folder, name, words) for name in names]
    forms = course.forms(words.language)
    whole = {taught.lesson.name for taught in lessons} == {*course.lessons}
    return render(
        "guide/guide.html",
        lessons=lessons,
        routes=[(route, route_stops(route, course, words)) for route in course.routes.values()],
        lecture=bool(course.lecture),
        tests=list(titles_of_tests(course, words).values()),
        test_minutes=lesson_minutes(forms[0]) if forms else 0,
        forms=list(zip(FORMS, forms, strict=False)) if test else [],
        apart=bool(forms) and whole and not test,
        numbers=course.numbers(),
        words=words,
        letters=LETTERS,
        version=version("onpath"),
    )


def worksheet(
    course: Course, folder: Path, name: str, words: Words, variant: int = 1
) -> tuple[str, str]:
    """A lesson's worksheet and its key, as standalone pages.

    Args:
        variant: decides the order of options, see `option_order`; 0: the author's.

    Raises:
        ValueError: see `guide`.
    """

    def options(asked: AskedBlock) -> list[Option]:
        shown = asked.block.options if isinstance(asked.block, Choice | Quiz) else ()
        order = option_order(len(shown), asked.key, str(variant) if variant else "")
        return [shown[index] for index in order]

    taught = taught_lesson(course, folder, name, words)
    fields = {
        "taught": taught,
        "variant": variant,
        "options_of": options,
        "words": words,
        "letters": LETTERS,
    }
    return render("guide/worksheet.html", **fields), render("guide/key.html", **fields)
