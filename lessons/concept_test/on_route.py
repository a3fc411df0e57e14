"""The concept test before and after a route that asks for it."""

from __future__ import annotations

from onpath.lessons.concept_test.concept_test import AFTER, BEFORE, taken
from onpath.lessons.course import Course
from onpath.lessons.progress import Notes, Progress
from onpath.lessons.routes import Route


def first_step(route: Route, course: Course, progress: Progress) -> tuple[str, int]:
    """Lesson and index of the first step of a route, or of the first step after its test."""
    if _is_left(BEFORE, route, course, progress):
        return BEFORE, 0
    return route.stop[0].lesson, route.stop[0].steps[0] - 1


def last_test(route: Route | None, course: Course, progress: Progress) -> str:
    """Name of the test at the end of a route; empty if there is none left to do."""
    return AFTER if route is not None and _is_left(AFTER, route, course, progress) else ""


def _is_left(name: str, route: Route, course: Course, progress: Progress) -> bool:
    """Whether a test belongs to a route and has not been handed in."""
    notes = progress.notes.get(taken(progress, name), Notes())
    return route.test and name in course.tests and not notes.handed_in
