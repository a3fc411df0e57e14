"""The static site of some lessons, as tests open it."""

from __future__ import annotations

import shutil
from pathlib import Path

from onpath.app.exports.site.write_site import write_site
from onpath.lessons.course import BUILT_IN, read_course

LESSON = "01-path-or-timetable"


def exported_site(
    folder: Path, languages: tuple[str, ...] = ("en", "de"), lessons: tuple[str, ...] = (LESSON,)
) -> Path:
    """Write the site of lesson 1, or of others, into a folder, and return it."""
    home = folder / "course"
    for lesson in lessons:
        shutil.copytree(BUILT_IN / lesson, home / lesson)
    course, problems = read_course([home])
    assert not problems
    write_site(folder / "site", course, home, languages)
    return folder / "site"
