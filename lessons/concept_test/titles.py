"""Titles of the concept tests."""

from __future__ import annotations

from onpath.lessons.concept_test.concept_test import AFTER, BEFORE
from onpath.lessons.course import Course
from onpath.lessons.words import Words


def titles_of_tests(course: Course, words: Words) -> dict[str, str]:
    """Name of each test -> its displayed title; empty if the course has none."""
    if not course.tests:
        return {}
    title = course.lesson(BEFORE, words.language).front.title
    return {
        BEFORE: words("test.title_before", title=title),
        AFTER: words("test.title_after", title=title),
    }
