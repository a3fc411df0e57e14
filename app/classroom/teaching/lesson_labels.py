"""Labels of lessons, tests and steps in the menus of the teacher's page."""

from __future__ import annotations

from onpath.lessons.concept_test.concept_test import SITTINGS, sitting_of
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


def step_label(lesson: Lesson, index: int, words: Words, large: bool = False) -> str:
    """A step, by number, kind and title; for a projector without the title, which may tell what
    will happen, and in a test, whose forms have other titles. A teacher also reads that a task is
    meant to be found by trying."""
    step = lesson.steps[index]
    label = f"{index + 1}. {words(f'kind.{step.kind}')}"
    if large or sitting_of(lesson.name) in SITTINGS:
        return label
    exploratory = any(task.exploratory for task in step.tasks())
    return f"{label}: {step.title}" + f" ({words('guide.exploratory')})" * exploratory


def step_titles(lesson: Lesson, words: Words) -> list[str]:
    """The steps of a lesson, in order."""
    return [step_label(lesson, index, words) for index in range(len(lesson.steps))]
