"""`onpath export lesson`: a lesson as a package for a learning platform."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro


@dataclass(frozen=True)
class ExportLesson:
    """Write a lesson as a SCORM package, for Moodle, ILIAS and other learning platforms."""

    lesson: Annotated[str, tyro.conf.Positional]
    """Name or number of the lesson, as 1b or 01b-let-the-clock-wait."""
    scorm: Path
    """The .zip file to write."""
    version: Literal["1.2", "2004"] = "1.2"
    """Version of SCORM. 1.2 stores only 4,096 characters: there, points of drawn curves and
    the ends of the longest texts are left out if need be."""
    partial_score: bool = False
    """Whether an unfinished lesson has a score, too: the share that is right so far."""
    language: str = "en"
    """Language of the lesson."""
    lessons: Path | None = None
    """Folder of lessons; by default the built-in ones."""

    def run(self) -> None:
        """Write the package, and print its size."""
        from onpath.app.cli.lesson_play import chosen_lesson
        from onpath.app.common.atomic_file import check_file
        from onpath.app.exports.site.pages import Package
        from onpath.app.exports.site.scorm_package import write_package
        from onpath.assets.messages import languages
        from onpath.lessons.course import BUILT_IN, read_course
        from onpath.models.systems.parameter_specs import unknown_name

        if self.language not in languages():
            raise unknown_name(self.language, languages(), "language")
        home = self.lessons or BUILT_IN
        course, problems = read_course([home])
        if problems:
            raise ValueError(str(problems[0]))
        name = chosen_lesson(course, self.lesson).name
        check_file(self.scorm, (".zip",), "--scorm")
        kind = Package(self.version, self.partial_score)
        write_package(self.scorm, course, home, name, self.language, kind)
        size = self.scorm.stat().st_size
        print(f"{self.scorm}: SCORM {self.version}, {size / 1e3:.0f} kB")
