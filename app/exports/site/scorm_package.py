"""A lesson of the static site as a package for learning platforms: SCORM 1.2 or SCORM 2004."""

from __future__ import annotations

import tempfile
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from onpath.app.common.atomic_file import whole_file
from onpath.app.common.templates import render
from onpath.app.exports.site.pages import Package, Version
from onpath.app.exports.site.write_site import write_lesson
from onpath.lessons.course import Course

TEMPLATES: dict[Version, str] = {"1.2": "imsmanifest_12.xml", "2004": "imsmanifest_2004.xml"}
MANIFEST = "imsmanifest.xml"
DATE = (1980, 1, 1, 0, 0, 0)
"""Date of all files, so that the same lesson gives the same package."""


def write_package(
    file: Path, course: Course, home: Path, name: str, language: str, kind: Package
) -> None:
    """Write the package of a lesson.

    Args:
        home: contains the lessons' own folders.

    Raises:
        ValueError: the lesson cannot be shown, or the file cannot be written.
    """
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        page = write_lesson(folder, course, home, name, language, kind)
        files = sorted(each.relative_to(folder) for each in folder.rglob("*") if each.is_file())
        manifest = render(
            f"scorm/{TEMPLATES[kind.version]}",
            identifier=f"onpath-{name}-{language}",
            title=course.lesson(name, language).front.title,
            page=page,
            files=[each.as_posix() for each in files],
        )
        with whole_file(file) as target, ZipFile(target, "w", ZIP_DEFLATED) as package:
            package.writestr(_dated(MANIFEST), manifest)
            for each in files:
                package.writestr(_dated(each.as_posix()), (folder / each).read_bytes())


def _dated(name: str) -> ZipInfo:
    entry = ZipInfo(name, DATE)
    entry.compress_type = ZIP_DEFLATED
    return entry
