"""The static site of the first lesson, as tests open it."""

from __future__ import annotations

import shutil
from pathlib import Path

from onpath.app.exports.site.write_site import write_site
from onpath.lessons.course import BUILT_IN, read_course

LESSON = "01-path-or-timetable"


def exported_site(folder: Path, languages: tuple[str, ...] = ("en", "de")) -> Path:
    """Write the site of lesson 1 into a folder, and return it."""
    home = folder / "course"
    shutil.copytree(BUILT_IN / LESSON, home / LESSON)
    course, problems = read_course([home])
    assert not problems
    write_site(folder / "site", course, home, languages)
    return folder / "site"
