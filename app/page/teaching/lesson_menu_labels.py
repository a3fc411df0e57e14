"""Labels of lessons, tests and steps in the menus of the teacher's page."""

from __future__ import annotations

from onpath.lessons.concept_test.titles import titles_of_tests
from onpath.lessons.course import Course
from onpath.lessons.schema import Lesson
from onpath.lessons.words import Words


def lesson_titles(course: Course, words: Words) -> dict[str, str]:
    """Names of lessons and tests by title."""
    lessons = {
        f"{number}. {course.lesson(name, words.language).front.title}": name
        for name, number in course.numbers().items()
    }
    return {**lessons, **{title: name for name, title in titles_of_tests(course, words).items()}}


def step_titles(lesson: Lesson, words: Words) -> list[str]:
    """The steps of a lesson, in order."""
    return [
        f"{number}. {words(f'kind.{step.kind}')}: {step.title}"
        for number, step in enumerate(lesson.steps, start=1)
    ]
