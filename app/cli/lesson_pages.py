"""`onpath lessons guide` and `onpath lessons worksheet`: pages for teachers to print."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from onpath.app.cli.lesson_play import chosen_lesson
from onpath.app.common.atomic_file import check_file, whole_file

if TYPE_CHECKING:
    from onpath.lessons.course import Course
    from onpath.lessons.words import Words


@dataclass(frozen=True)
class WriteGuide:
    """Write the teacher's guide: what the lessons ask, timing, answers, solutions and reasons."""

    names: Annotated[tuple[str, ...], tyro.conf.Positional] = ()
    """Names or numbers of lessons; by default all."""
    html: Path | None = None
    """Write a page that prints as A4."""
    pdf: Path | None = None
    """Write a PDF; needs Chromium and Playwright."""
    lessons: Path | None = None
    """Folder of lessons; by default the built-in ones."""
    language: str = "en"
    """Language of the guide."""
    concept_test: bool = False
    """Add the concept test with its answers; do not publish such a guide."""

    def run(self) -> None:
        """Write the guide."""
        from onpath.app.exports.guide import guide

        files = {"--html": self.html, "--pdf": self.pdf}
        _check(files, "--html FILE or --pdf FILE")
        course, folder, words = _course(self.lessons, self.language)
        names = [chosen_lesson(course, asked).name for asked in self.names]
        chosen = names or list(course.lessons)
        page = guide(course, folder, chosen, words, self.concept_test)
        _write(page, self.html, self.pdf)


@dataclass(frozen=True)
class WriteWorksheet:
    """Write a lesson's worksheet, with axes to draw on and room to write, and its key."""

    lesson: Annotated[str, tyro.conf.Positional] = ""
    """Name or number of the lesson."""
    all: Path | None = None
    """Write the worksheets and keys of all lessons as pages into this folder instead, and make the
    folder if there is none."""
    html: Path | None = None
    """Write a page that prints as A4."""
    pdf: Path | None = None
    """Write a PDF; needs Chromium and Playwright."""
    key: Path | None = None
    """Write the key as a page."""
    variant: int = 1
    """Number of the order of the options, printed on sheet and key; 0: the order in the guide."""
    lessons: Path | None = None
    """Folder of lessons; by default the built-in ones."""
    language: str = "en"
    """Language of the worksheet."""

    def run(self) -> None:
        """Write the worksheet and the key."""
        from onpath.app.exports.guide import worksheet

        if self.variant < 0:
            raise ValueError(f"--variant {self.variant}: expected 0 or more")
        files = {"--html": self.html, "--pdf": self.pdf, "--key": self.key}
        if self.all is not None:
            return self._write_all(self.all, any((self.lesson, *files.values())))
        if not self.lesson:
            raise ValueError("which lesson? expected its name or number, or --all FOLDER")
        _check(files, "--html FILE, --pdf FILE or --key FILE")
        course, folder, words = _course(self.lessons, self.language)
        name = chosen_lesson(course, self.lesson).name
        page, key = worksheet(course, folder, name, words, self.variant)
        _write(page, self.html, self.pdf)
        _write(key, self.key, None)

    def _write_all(self, into: Path, is_of_one: bool) -> None:
        """Write the worksheets and keys of all lessons; nothing if one of them has a problem."""
        from onpath.app.exports.guide import worksheet

        if is_of_one:
            raise ValueError("--all: the folder gets all lessons; name neither one nor files")
        course, folder, words = _course(self.lessons, self.language)
        made = {
            name: worksheet(course, folder, name, words, self.variant) for name in course.lessons
        }
        into.mkdir(exist_ok=True)
        for name, (page, key) in made.items():
            _write(page, into / f"{name}.html", None)
            _write(key, into / f"{name}-key.html", None)


def _check(files: dict[str, Path | None], wanted: str) -> None:
    if not any(files.values()):
        raise ValueError(f"nothing to write: expected {wanted}")
    for option, path in files.items():
        check_file(path, (".pdf",) if option == "--pdf" else (".html",), option)


def _course(folder: Path | None, language: str) -> tuple[Course, Path, Words]:
    """The lessons of a folder, which must have no problems, and the words of a language.

    Raises:
        ValueError: a lesson has problems, or there is no such language.
    """
    from onpath.assets.messages import languages
    from onpath.lessons.course import BUILT_IN, read_course
    from onpath.lessons.words import Words

    if language not in languages():
        raise ValueError(f"--language {language}: there are {', '.join(languages())}")
    course, problems = read_course([folder or BUILT_IN])
    if problems:
        raise ValueError(str(problems[0]))
    return course, folder or BUILT_IN, Words(language)


def _write(page: str, html: Path | None, pdf: Path | None) -> None:
    """Write a page, and print the names of the files."""
    from onpath.app.exports.print_page import print_page

    if html is not None:
        with whole_file(html) as path:
            path.write_text(page, encoding="utf-8")
        print(html)
    if pdf is not None:
        with whole_file(pdf) as path:
            print_page(page, path)
        print(pdf)
