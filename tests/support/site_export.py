"""The static site of some lessons, as tests open it."""

from __future__ import annotations

from pathlib import Path

from onpath.app.exports.site.write_site import write_site
from onpath.app.server.built_in_course import built_in_course
from onpath.lessons.course import BUILT_IN, Course
from onpath.lessons.lecture import LECTURE

LESSON = "01-path-or-timetable"


def exported_site(
    folder: Path, languages: tuple[str, ...] = ("en", "de"), lessons: tuple[str, ...] = (LESSON,)
) -> Path:
    """Write the site of lesson 1, or of others, into a folder, and return it."""
    whole = built_in_course()
    course = Course(
        {name: whole.lessons[name] for name in lessons if name != LECTURE},
        tests=whole.tests,
        lecture=whole.lecture if LECTURE in lessons else {},
    )
    write_site(folder / "site", course, BUILT_IN, languages)
    return folder / "site"
