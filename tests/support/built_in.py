"""The built-in lessons, read once for all tests in this process."""

from __future__ import annotations

from functools import cache

from onpath.lessons.course import BUILT_IN, Course, read_course
from onpath.lessons.problems import Problem


@cache
def built_in_course() -> tuple[Course, list[Problem]]:
    """See `read_course`. Nobody changes a course."""
    return read_course([BUILT_IN])
